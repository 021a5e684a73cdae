//! A picture of a run: force, depth and tick time over time.
//!
//! Drawn at twice the size and averaged down, since the backend does not smooth its lines. A curve keeps the
//! smallest and the largest value under each pixel column, so that 10⁵ ticks stay quick and no spike is lost.

mod curve;

use anyhow::{Context, Result, anyhow};
use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::{
    BitMapBackend, Cartesian2d, ChartBuilder, ChartContext, Color, DrawingArea, IntoDrawingArea,
    IntoFont, PathElement, RGBColor, Rectangle, Text, TextStyle, WHITE,
};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontStyle, FontTransform, ShapeStyle, register_font};

use self::curve::{band, decimated};

/// What is drawn; all vectors have one entry per tick.
pub(crate) struct PlotData {
    /// First line: scene and method.
    pub(crate) title: String,
    /// Second line: figures of the run.
    pub(crate) subtitle: String,
    /// Simulated time [s], increasing.
    pub(crate) time: Vec<f64>,
    /// End of the time axis [s].
    pub(crate) end: f64,
    /// Force on the hand: x, y, z and magnitude [N].
    pub(crate) force: [Vec<f64>; 4],
    /// How deep the haptic tool is past the visual one [mm].
    pub(crate) depth: Vec<f64>,
    /// Time a tick took [µs].
    pub(crate) tick: Vec<f64>,
    /// Line under the tick times.
    pub(crate) tick_note: String,
    /// Whether the tool touches.
    pub(crate) contact: Vec<bool>,
}

/// Size of the picture [px].
const SIZE: (u32, u32) = (1600, 1200);

/// Drawn this many times larger, then averaged.
const OVERSAMPLING: u32 = 2;

/// Where the frames begin [px].
const LEFT: u32 = 112;

const FONT: &str = "sans-serif";
const INK: RGBColor = RGBColor(34, 40, 49);
const GRID: RGBColor = RGBColor(222, 226, 232);
const TOUCH: RGBColor = RGBColor(241, 244, 248);
const MAGNITUDE: RGBColor = RGBColor(34, 40, 49);
// The three components: distinguishable with any common colour vision (Okabe and Ito's palette).
const AXES: [RGBColor; 3] = [
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(0, 114, 178),
];
const DEPTH: RGBColor = RGBColor(130, 60, 150);
const TICK: RGBColor = RGBColor(0, 114, 178);

type Area<'a> = DrawingArea<BitMapBackend<'a>, Shift>;
type Chart<'a, 'b> =
    ChartContext<'a, BitMapBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// The picture as a PNG file.
///
/// # Errors
/// When the drawing library refuses, which no data of a run should cause.
pub(crate) fn png(data: &PlotData) -> Result<Vec<u8>> {
    for style in [FontStyle::Normal, FontStyle::Bold] {
        register_font(FONT, style, epaint_default_fonts::UBUNTU_LIGHT)
            .map_err(|_| anyhow!("the built-in font is damaged"))?;
    }
    let (width, height) = (SIZE.0 * OVERSAMPLING, SIZE.1 * OVERSAMPLING);
    let mut buffer = vec![0; (width * height * 3) as usize];
    draw(&mut buffer, (width, height), data).map_err(|error| anyhow!("plot: {error}"))?;
    encode(&averaged(&buffer, width, height))
}

/// Blocks of `OVERSAMPLING`² pixels become one.
fn averaged(large: &[u8], width: u32, height: u32) -> Vec<u8> {
    let (width, factor) = (width as usize, OVERSAMPLING as usize);
    let mut small = Vec::with_capacity(large.len() / (factor * factor));
    for y in (0..height as usize).step_by(factor) {
        for x in (0..width).step_by(factor) {
            for channel in 0..3 {
                let block = (0..factor * factor).map(|i| {
                    let (dx, dy) = (i % factor, i / factor);
                    u32::from(large[((y + dy) * width + x + dx) * 3 + channel])
                });
                let sum: u32 = block.sum();
                small.push(u8::try_from(sum / (OVERSAMPLING * OVERSAMPLING)).unwrap_or(u8::MAX));
            }
        }
    }
    small
}

fn encode(pixels: &[u8]) -> Result<Vec<u8>> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, SIZE.0, SIZE.1);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header().context("plot: PNG header")?;
    writer.write_image_data(pixels).context("plot: PNG data")?;
    writer.finish().context("plot: PNG end")?;
    Ok(file)
}

/// Points to pixels of the large picture.
const fn px(size: u32) -> u32 {
    size * OVERSAMPLING
}

fn text(size: u32) -> TextStyle<'static> {
    (FONT, px(size)).into_font().color(&INK)
}

type DrawResult = Result<(), Box<dyn std::error::Error>>;

fn draw(buffer: &mut [u8], size: (u32, u32), data: &PlotData) -> DrawResult {
    let root = BitMapBackend::with_buffer(buffer, size).into_drawing_area();
    root.fill(&WHITE)?;
    let (head, body) = root.split_vertically(px(92));
    let left = i32::try_from(px(LEFT))?;
    head.draw(&Text::new(
        data.title.as_str(),
        (left, i32::try_from(px(20))?),
        text(34),
    ))?;
    head.draw(&Text::new(
        data.subtitle.as_str(),
        (left, i32::try_from(px(60))?),
        text(22),
    ))?;
    let (force, rest) = body.split_vertically(px(460));
    let (depth, tick) = rest.split_vertically(px(300));
    draw_force(&force, data)?;
    draw_depth(&depth, data)?;
    draw_tick(&tick, data)?;
    root.present()?;
    Ok(())
}

/// How a panel is labelled and scaled.
struct Panel {
    value: &'static str,
    range: (f64, f64),
    /// The lowest panel names the time axis.
    time: Option<&'static str>,
}

/// Room above a panel's frame for its legend or note [px].
const PANEL_HEAD: u32 = 36;

fn chart<'a, 'b>(
    area: &'a Area<'b>,
    data: &PlotData,
    panel: &Panel,
) -> Result<Chart<'a, 'b>, Box<dyn std::error::Error>>
where
    'b: 'a,
{
    let foot = if panel.time.is_some() { 76 } else { 36 };
    let mut chart = ChartBuilder::on(area)
        .margin_right(px(36))
        .margin_top(px(PANEL_HEAD))
        .x_label_area_size(px(foot))
        .y_label_area_size(px(LEFT))
        .build_cartesian_2d(0.0..data.end.max(1e-3), panel.range.0..panel.range.1)?;
    for (from, to) in touching(data) {
        chart.draw_series([Rectangle::new(
            [(from, panel.range.0), (to, panel.range.1)],
            TOUCH.filled(),
        )])?;
    }
    let mut mesh = chart.configure_mesh();
    mesh.axis_style(INK.stroke_width(OVERSAMPLING))
        .bold_line_style(GRID.stroke_width(OVERSAMPLING))
        .light_line_style(WHITE.mix(0.0))
        .x_labels(11)
        .y_labels(6)
        .label_style(text(20))
        .axis_desc_style(text(22));
    if let Some(time) = panel.time {
        mesh.x_desc(time);
    }
    mesh.draw()?;
    let height = i32::try_from(area.dim_in_pixel().1 + px(PANEL_HEAD) - px(foot))?;
    let upright = (FONT, px(22))
        .into_font()
        .transform(FontTransform::Rotate270);
    let style = upright.color(&INK).pos(Pos::new(HPos::Center, VPos::Top));
    area.draw(&Text::new(
        panel.value,
        (i32::try_from(px(22))?, height / 2),
        style,
    ))?;
    Ok(chart)
}

/// A curve as separate strokes: the backend's joined strokes shoot far beyond sharp corners.
fn strokes(chart: &mut Chart<'_, '_>, curve: &[(f64, f64)], style: ShapeStyle) -> DrawResult {
    let strokes = curve
        .windows(2)
        .map(|ends| PathElement::new([ends[0], ends[1]], style));
    chart.draw_series(strokes)?;
    Ok(())
}

/// Spans of time [s] in contact.
fn touching(data: &PlotData) -> Vec<(f64, f64)> {
    let mut spans: Vec<(f64, f64)> = Vec::new();
    let mut before = false;
    for (&time, &touches) in data.time.iter().zip(&data.contact) {
        match (before, touches, spans.last_mut()) {
            (true, true, Some(span)) => span.1 = time,
            (false, true, _) => spans.push((time, time)),
            _ => {}
        }
        before = touches;
    }
    spans
}

/// A range that shows `values` and zero, with air above.
fn range(values: &[&[f64]]) -> (f64, f64) {
    let all = values.iter().flat_map(|list| list.iter().copied());
    let (low, high) = all.fold((0.0_f64, 0.0_f64), |(low, high), v| {
        (low.min(v), high.max(v))
    });
    let span = (high - low).max(1e-3);
    let below = if low < 0.0 { 0.05 } else { 0.0 };
    (low - below * span, high + 0.08 * span)
}

fn columns(area: &Area<'_>) -> usize {
    area.dim_in_pixel().0 as usize
}

fn draw_force(area: &Area<'_>, data: &PlotData) -> DrawResult {
    let lists: Vec<&[f64]> = data.force.iter().map(Vec::as_slice).collect();
    let panel = Panel {
        value: "force on the hand [N]",
        range: range(&lists),
        time: None,
    };
    let mut chart = chart(area, data, &panel)?;
    let [red, green, blue] = AXES;
    let curves = [
        (3, "magnitude", MAGNITUDE, 3),
        (0, "x", red, 2),
        (1, "y", green, 2),
        (2, "z", blue, 2),
    ];
    let mut left = px(LEFT);
    for (index, name, color, thickness) in curves {
        let style = color.stroke_width(px(thickness));
        let curve = decimated(&data.time, &data.force[index], columns(area));
        strokes(&mut chart, &curve, style)?;
        left = legend(area, left, name, style)?;
    }
    let right = head_right(area)?;
    let swatch = px(26);
    let label = "in contact";
    let style = text(20).pos(Pos::new(HPos::Right, VPos::Center));
    let (width, _) = area.estimate_text_size(label, &style)?;
    area.draw(&Text::new(label, right, style))?;
    let end = right.0 - i32::try_from(width + px(8))?;
    let half = i32::try_from(px(8))?;
    let corners = [
        (end - i32::try_from(swatch)?, right.1 - half),
        (end, right.1 + half),
    ];
    area.draw(&Rectangle::new(corners, TOUCH.filled()))?;
    area.draw(&Rectangle::new(corners, GRID.stroke_width(OVERSAMPLING)))?;
    Ok(())
}

/// One entry in the row above the panel, from pixel `left`; where the next one begins.
fn legend(
    area: &Area<'_>,
    left: u32,
    name: &str,
    style: ShapeStyle,
) -> Result<u32, Box<dyn std::error::Error>> {
    let (line, gap) = (px(28), px(8));
    let (x, y) = (i32::try_from(left)?, i32::try_from(px(PANEL_HEAD) / 2)?);
    area.draw(&PathElement::new(
        [(x, y), (x + i32::try_from(line)?, y)],
        style,
    ))?;
    let font = text(20).pos(Pos::new(HPos::Left, VPos::Center));
    let (width, _) = area.estimate_text_size(name, &font)?;
    area.draw(&Text::new(
        name.to_owned(),
        (x + i32::try_from(line + gap)?, y),
        font,
    ))?;
    Ok(left + line + gap + width + px(24))
}

/// Right end of the row above a panel's frame.
fn head_right(area: &Area<'_>) -> Result<(i32, i32), std::num::TryFromIntError> {
    let y = i32::try_from(px(PANEL_HEAD) / 2)?;
    let right = i32::try_from(area.dim_in_pixel().0 - px(36))?;
    Ok((right, y))
}

fn draw_depth(area: &Area<'_>, data: &PlotData) -> DrawResult {
    let panel = Panel {
        value: "depth [mm]",
        range: range(&[&data.depth]),
        time: None,
    };
    let mut chart = chart(area, data, &panel)?;
    let curve = decimated(&data.time, &data.depth, columns(area));
    strokes(&mut chart, &curve, DEPTH.stroke_width(px(2)))?;
    legend(
        area,
        px(LEFT),
        "haptic tool past the visual tool",
        DEPTH.stroke_width(px(2)),
    )?;
    Ok(())
}

fn draw_tick(area: &Area<'_>, data: &PlotData) -> DrawResult {
    // The operating system interrupts now and then, up to milliseconds; the axis shows the usual and cuts those off.
    let mut sorted = data.tick.clone();
    sorted.sort_unstable_by(f64::total_cmp);
    let usual = sorted.get(sorted.len() * 99 / 100).copied();
    let panel = Panel {
        value: "tick time [µs]",
        range: (0.0, usual.unwrap_or(1.0).max(1e-3) * 2.0),
        time: Some("time [s]"),
    };
    let mut chart = chart(area, data, &panel)?;
    let (low, middle, high) = band(&data.time, &data.tick, columns(area) / 4);
    let spread = TICK.mix(0.4).stroke_width(px(2));
    for ((time, low), (_, high)) in low.iter().zip(&high) {
        let top = high.min(panel.range.1);
        chart.draw_series([PathElement::new([(*time, *low), (*time, top)], spread)])?;
    }
    strokes(&mut chart, &middle, INK.stroke_width(px(2)))?;
    let next = legend(area, px(LEFT), "median", INK.stroke_width(px(2)))?;
    legend(
        area,
        next,
        "from fastest to slowest",
        spread.stroke_width(px(8)),
    )?;
    let style = text(20).pos(Pos::new(HPos::Right, VPos::Center));
    let right = head_right(area)?;
    area.draw(&Text::new(data.tick_note.as_str(), right, style))?;
    Ok(())
}

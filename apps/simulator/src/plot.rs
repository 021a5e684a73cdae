//! A picture of a run: force, depth and tick time over time.
//!
//! Drawn at twice the size and averaged down, since the backend does not smooth its lines. A curve keeps the
//! smallest and the largest value under each pixel column, so that 10⁵ ticks stay quick and no spike is lost.

mod curve;
mod label;

use anyhow::{Context, Result, anyhow};
use plotters::coord::Shift;
use plotters::coord::ranged1d::Ranged;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::{
    BitMapBackend, Cartesian2d, ChartBuilder, ChartContext, Circle, Color, DrawingArea,
    IntoDrawingArea, PathElement, Polygon, RGBColor, Rectangle, WHITE,
};
use plotters::style::ShapeStyle;

use self::curve::{band, decimated, spans};
use self::label::{Label, Run, Typeface, numbers, whole};

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
    /// Whether the visual tool is held at an orientation that the hand has left.
    pub(crate) held: Vec<bool>,
}

/// Size of the picture [px].
const SIZE: (u32, u32) = (1600, 1200);

/// Drawn this many times larger, then averaged.
const OVERSAMPLING: u32 = 2;

/// Where the frames begin [px].
const LEFT: u32 = 112;

const INK: RGBColor = RGBColor(34, 40, 49);
const GRID: RGBColor = RGBColor(222, 226, 232);
const TOUCH: RGBColor = RGBColor(239, 243, 248);
const HELD: RGBColor = RGBColor(253, 241, 218);
/// Wide and pale beneath the components, so that both show where they coincide.
const MAGNITUDE: RGBColor = RGBColor(172, 180, 191);
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
    let typeface = Typeface::new().map_err(|_| anyhow!("the built-in font is damaged"))?;
    let (width, height) = (SIZE.0 * OVERSAMPLING, SIZE.1 * OVERSAMPLING);
    let mut buffer = vec![0; (width * height * 3) as usize];
    draw(&mut buffer, (width, height), data, &typeface)
        .map_err(|error| anyhow!("plot: {error}"))?;
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

/// Pixels as coordinates.
fn at(pixels: u32) -> i32 {
    i32::try_from(pixels).unwrap_or(i32::MAX)
}

type DrawResult = Result<(), Box<dyn std::error::Error>>;

fn draw(buffer: &mut [u8], size: (u32, u32), data: &PlotData, typeface: &Typeface) -> DrawResult {
    let root = BitMapBackend::with_buffer(buffer, size).into_drawing_area();
    root.fill(&WHITE)?;
    let (head, body) = root.split_vertically(px(92));
    let (force, rest) = body.split_vertically(px(460));
    let (depth, tick) = rest.split_vertically(px(300));
    let sheet = |area| Sheet {
        area,
        data,
        typeface,
    };
    let title = sheet(head);
    title.write(&data.title, (at(px(LEFT)), at(px(36))), 34, 0.0)?;
    title.write(&data.subtitle, (at(px(LEFT)), at(px(72))), 22, 0.0)?;
    sheet(force).force()?;
    sheet(depth).depth()?;
    sheet(tick).tick()?;
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

/// Room to the right of the frames [px].
const RIGHT: u32 = 36;

/// A part of the picture and what goes on it.
struct Sheet<'a, 'b> {
    area: Area<'b>,
    data: &'a PlotData,
    typeface: &'a Typeface,
}

impl<'b> Sheet<'_, 'b> {
    /// A line of text with the part `before` of its width before the point `at`.
    fn write(&self, text: &str, at: (i32, i32), size: u32, before: f32) -> DrawResult {
        Label {
            typeface: self.typeface,
            text,
            at,
            size: px(size),
            color: INK,
            before,
            run: Run::Right,
        }
        .draw(&self.area)
    }

    fn chart<'c>(&'c self, panel: &Panel) -> Result<Chart<'c, 'b>, Box<dyn std::error::Error>> {
        let data = self.data;
        let foot = if panel.time.is_some() { 76 } else { 36 };
        let mut chart = ChartBuilder::on(&self.area)
            .margin_right(px(RIGHT))
            .margin_top(px(PANEL_HEAD))
            .x_label_area_size(px(foot))
            .y_label_area_size(px(LEFT))
            .build_cartesian_2d(0.0..data.end.max(1e-3), panel.range.0..panel.range.1)?;
        for (flags, color) in [(&data.contact, TOUCH), (&data.held, HELD)] {
            for (from, to) in spans(&data.time, flags) {
                let corners = [(from, panel.range.0), (to, panel.range.1)];
                chart.draw_series([Rectangle::new(corners, color.filled())])?;
            }
        }
        self.axes(&mut chart, panel)?;
        Ok(chart)
    }

    /// Grid, frame and numbers.
    fn axes(&self, chart: &mut Chart<'_, 'b>, panel: &Panel) -> DrawResult {
        let end = self.data.end.max(1e-3);
        let (low, high) = panel.range;
        let coordinates = chart.as_coord_spec();
        let times = coordinates.x_spec().key_points(11);
        let values = coordinates.y_spec().key_points(6);
        let grid = GRID.stroke_width(OVERSAMPLING);
        let ink = INK.stroke_width(OVERSAMPLING);
        let upright = times.iter().map(|&time| [(time, low), (time, high)]);
        let level = values.iter().map(|&value| [(0.0, value), (end, value)]);
        chart.draw_series(
            upright
                .chain(level)
                .map(|ends| PathElement::new(ends, grid)),
        )?;
        let frame = [(0.0, high), (0.0, low), (end, low)];
        chart.draw_series([PathElement::new(frame, ink)])?;
        let (left, top) = self.area.get_base_pixel();
        let pixel = |time: f64, value: f64| {
            let (x, y) = chart.plotting_area().map_coordinate(&(time, value));
            (x - left, y - top)
        };
        for (&time, number) in times.iter().zip(numbers(&times)) {
            let (x, y) = pixel(time, low);
            self.write(&number, (x, y + at(px(18))), 20, 0.5)?;
        }
        for (&value, number) in values.iter().zip(numbers(&values)) {
            let (x, y) = pixel(0.0, value);
            self.write(&number, (x - at(px(10)), y), 20, 1.0)?;
        }
        let (middle, foot) = (pixel(end / 2.0, low), pixel(0.0, f64::midpoint(low, high)));
        if let Some(time) = panel.time {
            self.write(time, (middle.0, middle.1 + at(px(48))), 22, 0.5)?;
        }
        Label {
            typeface: self.typeface,
            text: panel.value,
            at: (at(px(24)), foot.1),
            size: px(22),
            color: INK,
            before: 0.5,
            run: Run::Up,
        }
        .draw(&self.area)
    }

    /// One entry in the row above the panel, from pixel `left`; where the next one begins.
    fn legend(
        &self,
        left: i32,
        name: &str,
        style: ShapeStyle,
    ) -> Result<i32, Box<dyn std::error::Error>> {
        let text = left + at(px(36));
        let y = at(px(PANEL_HEAD) / 2);
        let line = [(left, y), (left + at(px(28)), y)];
        self.area.draw(&PathElement::new(line, style))?;
        self.write(name, (text, y), 20, 0.0)?;
        Ok(text + self.width(name) + at(px(24)))
    }

    /// One entry for a shading, its text ending at pixel `right`; where the one before it may end.
    fn shading(
        &self,
        right: i32,
        name: &str,
        color: RGBColor,
    ) -> Result<i32, Box<dyn std::error::Error>> {
        let y = at(px(PANEL_HEAD) / 2);
        self.write(name, (right, y), 20, 1.0)?;
        let end = right - self.width(name) - at(px(8));
        let corners = [(end - at(px(26)), y - at(px(8))), (end, y + at(px(8)))];
        self.area.draw(&Rectangle::new(corners, color.filled()))?;
        let border = GRID.stroke_width(OVERSAMPLING);
        self.area.draw(&Rectangle::new(corners, border))?;
        Ok(corners[0].0 - at(px(24)))
    }

    /// Width of a legend's text [px].
    fn width(&self, text: &str) -> i32 {
        whole(self.typeface.width(text, px(20)))
    }

    /// Right end of the frames [px].
    fn right(&self) -> i32 {
        at(self.area.dim_in_pixel().0 - px(RIGHT))
    }

    fn columns(&self) -> usize {
        self.area.dim_in_pixel().0 as usize
    }

    fn force(&self) -> DrawResult {
        let data = self.data;
        let lists: Vec<&[f64]> = data.force.iter().map(Vec::as_slice).collect();
        let mut chart = self.chart(&Panel {
            value: "force on the hand [N]",
            range: range(&lists),
            time: None,
        })?;
        let [red, green, blue] = AXES;
        let curves = [
            (3, "magnitude", MAGNITUDE, 6),
            (0, "x", red, 2),
            (1, "y", green, 2),
            (2, "z", blue, 2),
        ];
        let mut left = at(px(LEFT));
        for (index, name, color, thickness) in curves {
            let style = color.stroke_width(px(thickness));
            let curve = decimated(&data.time, &data.force[index], self.columns());
            strokes(&mut chart, &curve, style)?;
            if thickness > 2 {
                // The corners between wide strokes.
                let dots = curve
                    .iter()
                    .map(|&point| Circle::new(point, px(thickness) / 2, color.filled()));
                chart.draw_series(dots)?;
            }
            left = self.legend(left, name, style)?;
        }
        let right = self.shading(self.right(), "in contact", TOUCH)?;
        if data.held.contains(&true) {
            self.shading(right, "orientation held", HELD)?;
        }
        Ok(())
    }

    fn depth(&self) -> DrawResult {
        let data = self.data;
        let mut chart = self.chart(&Panel {
            value: "depth [mm]",
            range: range(&[&data.depth]),
            time: None,
        })?;
        let style = DEPTH.stroke_width(px(2));
        let curve = decimated(&data.time, &data.depth, self.columns());
        strokes(&mut chart, &curve, style)?;
        self.legend(at(px(LEFT)), "haptic tool past the visual tool", style)?;
        Ok(())
    }

    fn tick(&self) -> DrawResult {
        let data = self.data;
        let limit = usual_limit(&data.tick);
        let mut chart = self.chart(&Panel {
            value: "tick time [µs]",
            range: (0.0, limit),
            time: Some("time [s]"),
        })?;
        let (low, middle, high) = band(&data.time, &data.tick, self.columns() / 4);
        let spread = TICK.mix(0.4).stroke_width(px(2));
        for ((time, low), (_, high)) in low.iter().zip(&high) {
            let column = [(*time, *low), (*time, high.min(limit))];
            chart.draw_series([PathElement::new(column, spread)])?;
            if *high > limit {
                let (x, y) = chart.plotting_area().map_coordinate(&(*time, limit));
                let (left, top) = self.area.get_base_pixel();
                self.arrow((x - left, y - top))?;
            }
        }
        let median = INK.stroke_width(px(2));
        strokes(&mut chart, &middle, median)?;
        let next = self.legend(at(px(LEFT)), "median", median)?;
        let next = self.legend(next, "from fastest to slowest", spread.stroke_width(px(8)))?;
        let above = data.tick.iter().filter(|&&time| time > limit).count();
        let y = at(px(PANEL_HEAD) / 2);
        if above > 0 {
            self.arrow((next + at(px(6)), y - at(px(6))))?;
            let plural = if above == 1 { "" } else { "s" };
            let note = format!("{above} tick{plural} above the axis");
            self.write(&note, (next + at(px(20)), y), 20, 0.0)?;
        }
        self.write(&data.tick_note, (self.right(), y), 20, 1.0)
    }

    /// A small triangle that points up at `tip`.
    fn arrow(&self, (x, y): (i32, i32)) -> DrawResult {
        let (half, height) = (at(px(5)), at(px(10)));
        let corners = [(x, y), (x - half, y + height), (x + half, y + height)];
        self.area.draw(&Polygon::new(corners, TICK.filled()))?;
        Ok(())
    }
}

/// Top of the axis of tick times [µs]. The operating system interrupts now and then, up to milliseconds; the axis shows the
/// usual and cuts those off.
fn usual_limit(ticks: &[f64]) -> f64 {
    let mut sorted = ticks.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let usual = sorted.get(sorted.len() * 99 / 100).copied();
    usual.unwrap_or(1.0).max(1e-3) * 2.0
}

/// A curve as separate strokes: the backend's joined strokes shoot far beyond sharp corners.
fn strokes(chart: &mut Chart<'_, '_>, curve: &[(f64, f64)], style: ShapeStyle) -> DrawResult {
    let strokes = curve
        .windows(2)
        .map(|ends| PathElement::new([ends[0], ends[1]], style));
    chart.draw_series(strokes)?;
    Ok(())
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

#[cfg(test)]
mod tests {
    use plotters::prelude::RGBColor;

    use super::{HELD, MAGNITUDE, PlotData, TICK, TOUCH, png, usual_limit};

    /// A run of a second that pushes along x, its tick times all 1 µs.
    fn data() -> PlotData {
        let time: Vec<f64> = (0..1000).map(|i| f64::from(i) * 1e-3).collect();
        let push: Vec<f64> = time.iter().map(|t| 4.0 * t).collect();
        PlotData {
            title: "title".to_owned(),
            subtitle: "subtitle".to_owned(),
            end: 1.0,
            force: [push.clone(), vec![0.0; 1000], vec![0.0; 1000], push.clone()],
            depth: push,
            tick: vec![1.0; 1000],
            tick_note: "note".to_owned(),
            contact: (0..1000).map(|i| i >= 200).collect(),
            held: vec![false; 1000],
            time,
        }
    }

    /// Pixels of exactly this colour.
    fn count(data: &PlotData, color: RGBColor) -> usize {
        let reader = png::Decoder::new(std::io::Cursor::new(png(data).unwrap()));
        let mut reader = reader.read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        let wanted = [color.0, color.1, color.2];
        pixels.chunks_exact(3).filter(|p| **p == wanted).count()
    }

    #[test]
    fn held_ticks_are_shaded_and_only_then_in_the_legend() {
        let mut data = data();
        assert_eq!(count(&data, HELD), 0);
        let touched = count(&data, TOUCH);
        data.held[500..600].fill(true);
        let held = count(&data, HELD);
        // A tenth of the width of three panels; contact is eight tenths.
        let part = held as f64 / touched as f64;
        assert!((0.1..0.15).contains(&part), "{held} of {touched}");
    }

    #[test]
    fn the_magnitude_shows_beneath_a_component_that_equals_it() {
        assert!(count(&data(), MAGNITUDE) > 3000);
    }

    #[test]
    fn ticks_above_the_axis_are_marked() {
        let mut data = data();
        let before = count(&data, TICK);
        data.tick[300] = 1e4;
        data.tick[700] = 1e4;
        assert!((usual_limit(&data.tick) - 2.0).abs() < 1e-12);
        // Three triangles, one of them in the legend, of 50 pixels each.
        let marked = count(&data, TICK) - before;
        assert!((75..=165).contains(&marked), "{marked}");
    }
}

//! Text on the picture. The drawing library sets glyphs at whole pixels and without the room to their left, which tears
//! words apart; here each one stands where the font puts it.

use std::error::Error;

use ab_glyph::{Font, FontRef, InvalidFont, ScaleFont, point};
use plotters::coord::Shift;
use plotters::prelude::{BitMapBackend, Color, DrawingArea, RGBColor};

/// Height of capitals and digits over the font's line height.
const CAPITALS: f32 = 0.6;

/// The one font of the picture.
pub(super) struct Typeface(FontRef<'static>);

impl Typeface {
    /// That of the window.
    pub(super) fn new() -> Result<Self, InvalidFont> {
        FontRef::try_from_slice(epaint_default_fonts::UBUNTU_LIGHT).map(Self)
    }

    /// Width of a line whose height is `size` [px].
    pub(super) fn width(&self, text: &str, size: u32) -> f32 {
        self.set(text, size).1
    }

    /// Each character with its place along the line, and the line's width [px].
    fn set(&self, text: &str, size: u32) -> (Vec<(char, f32)>, f32) {
        let font = self.0.as_scaled(size as f32);
        let (mut places, mut x, mut before) = (Vec::new(), 0.0, None);
        for character in text.chars() {
            let id = font.glyph_id(character);
            x += before.map_or(0.0, |before| font.kern(before, id));
            places.push((character, x));
            x += font.h_advance(id);
            before = Some(id);
        }
        (places, x)
    }
}

/// Which way a line runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Run {
    Right,
    Up,
}

/// A line of text, its capitals centred on the line through `at`.
pub(super) struct Label<'a> {
    pub(super) typeface: &'a Typeface,
    pub(super) text: &'a str,
    pub(super) at: (i32, i32),
    /// Line height [px].
    pub(super) size: u32,
    pub(super) color: RGBColor,
    /// Which part of the width lies before `at`: 0, 0.5 or 1.
    pub(super) before: f32,
    pub(super) run: Run,
}

impl Label<'_> {
    /// Onto an area whose first pixel is (0, 0).
    pub(super) fn draw(
        &self,
        area: &DrawingArea<BitMapBackend<'_>, Shift>,
    ) -> Result<(), Box<dyn Error>> {
        let (places, width) = self.typeface.set(self.text, self.size);
        let font = self.typeface.0.as_scaled(self.size as f32);
        let left = -width * self.before;
        let baseline = self.size as f32 * CAPITALS / 2.0;
        for (character, x) in places {
            let mut glyph = font.scaled_glyph(character);
            glyph.position = point(left + x, baseline);
            let Some(outline) = font.outline_glyph(glyph) else {
                continue;
            };
            let corner = outline.px_bounds().min;
            let mut covered = Vec::new();
            outline.draw(|x, y, cover| covered.push((x, y, cover)));
            for (x, y, cover) in covered {
                let (x, y) = (whole(corner.x + x as f32), whole(corner.y + y as f32));
                let pixel = match self.run {
                    Run::Right => (self.at.0 + x, self.at.1 + y),
                    Run::Up => (self.at.0 + y, self.at.1 - x),
                };
                let color = self.color.mix(f64::from(cover.min(1.0)));
                area.draw_pixel(pixel, &color)?;
            }
        }
        Ok(())
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "a whole number of pixels, within the picture"
)]
pub(super) fn whole(pixels: f32) -> i32 {
    pixels.round() as i32
}

/// Numbers at `marks` of an axis, with as many decimals as tell them apart.
pub(super) fn numbers(marks: &[f64]) -> Vec<String> {
    let step = marks.windows(2).map(|pair| pair[1] - pair[0]);
    let step = step.fold(f64::INFINITY, f64::min);
    let decimals = (0..9).find(|&n| {
        let scaled = step * 10_f64.powi(n);
        scaled >= 0.999 && (scaled - scaled.round()).abs() < 1e-3
    });
    let decimals = decimals.unwrap_or(0).unsigned_abs() as usize;
    marks
        .iter()
        // Adding zero makes −0 a 0.
        .map(|mark| format!("{:.decimals$}", mark + 0.0))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::{Typeface, numbers};

    #[test]
    fn numbers_have_the_decimals_that_tell_them_apart() {
        assert_eq!(numbers(&[-2.0, -0.0, 2.0]), ["-2", "0", "2"]);
        assert_eq!(numbers(&[0.0, 0.25, 0.5]), ["0.00", "0.25", "0.50"]);
        assert_eq!(numbers(&[0.0, 0.1, 0.2, 0.3]), ["0.0", "0.1", "0.2", "0.3"]);
        assert_eq!(numbers(&[7.0]), ["7"]);
    }

    #[test]
    fn widths_add_up() {
        let typeface = Typeface::new().unwrap();
        let width = |text| typeface.width(text, 40);
        assert!(width("") < 1e-6);
        assert!((width("1234") - 4.0 * width("1")).abs() < 1e-3);
        assert!(width("j") > 4.0 && width("W") > 3.0 * width("j"));
    }
}

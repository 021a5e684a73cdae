//! Numbers in messages: five significant digits locate an element and can be read.

use glam::DVec3;

/// `value` to five significant digits, with an exponent where it is very large or small.
pub(crate) fn number(value: f64) -> String {
    let rounded: f64 = format!("{value:.4e}").parse().unwrap_or(value);
    let plain = rounded == 0.0 || !rounded.is_finite() || (1e-4..1e6).contains(&rounded.abs());
    if plain {
        rounded.to_string()
    } else {
        format!("{rounded:e}")
    }
}

/// `(x, y, z)`, each as [`number`].
pub(crate) fn point(p: DVec3) -> String {
    format!("({}, {}, {})", number(p.x), number(p.y), number(p.z))
}

#[cfg(test)]
mod tests {
    use super::{number, point};
    use glam::DVec3;

    #[test]
    fn numbers_in_messages_are_short() {
        for (value, text) in [
            (0.025_611_749_338_328_015, "0.025612"),
            (1e300, "1e300"),
            (-1.0 / 3.0 * 1e-7, "-3.3333e-8"),
            (123_456.0, "123460"),
            (0.0, "0"),
            (f64::NAN, "NaN"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(number(value), text);
        }
        assert_eq!(point(DVec3::new(1.0, -0.5, 2e-9)), "(1, -0.5, 2e-9)");
    }
}

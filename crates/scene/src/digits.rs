//! Numbers in messages.

/// `value` as it was written where that is short, else to five significant digits, with an exponent where it is very
/// large or small.
pub(crate) fn number(value: f64) -> String {
    /// Characters that are still read at a glance.
    const SHORT: usize = 9;
    let written = value.to_string();
    if written.len() <= SHORT {
        return written;
    }
    let rounded: f64 = format!("{value:.4e}").parse().unwrap_or(value);
    let plain = rounded == 0.0 || !rounded.is_finite() || (1e-4..1e6).contains(&rounded.abs());
    if plain {
        rounded.to_string()
    } else {
        format!("{rounded:e}")
    }
}

/// As [`number`], unless a number that `accepts` refuses would be rounded to one it takes.
pub(crate) fn refused(value: f64, accepts: impl Fn(f64) -> bool) -> String {
    let short = number(value);
    if short.parse().is_ok_and(accepts) {
        format!("{value:?}")
    } else {
        short
    }
}

#[cfg(test)]
mod tests {
    use super::{number, refused};

    #[test]
    fn numbers_are_short_but_never_look_right_when_they_are_refused() {
        assert_eq!(number(1e300), "1e300");
        assert_eq!(number(0.025_611_749_338_328_015), "0.025612");
        assert_eq!(number(-0.006), "-0.006");
        assert_eq!(number(123_456.0), "123456");
        let accepts = |v: f64| v <= 1000.0;
        assert_eq!(refused(12_345.678_912_3, accepts), "12346");
        assert_eq!(refused(1_000.000_001, accepts), "1000.000001");
    }
}

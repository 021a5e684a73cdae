//! Lines and numbers of text formats.

use std::borrow::Cow;

use super::{LoadError, at_line};
use crate::triangle_mesh::MAX_COORDINATE;

/// Text lines with their numbers from 1, ended by `\n`, `\r\n` or `\r`, without white space at either end; bytes
/// that are not UTF-8 (names and comments in other encodings) are replaced. A line that ends in a backslash
/// goes on in the next, unless the backslash belongs to a comment, where it is usually part of a path.
///
/// # Errors
/// UTF-16 and UTF-32 text, and bytes that are not text.
pub(super) fn text_lines(
    bytes: &[u8],
) -> Result<impl Iterator<Item = (usize, Cow<'_, str>)>, LoadError> {
    if let Some(error) = other_encoding(bytes) {
        return Err(error);
    }
    if bytes.contains(&0) {
        return Err(LoadError::Encoding {
            found: "binary data (a zero byte), not text",
            remedy: "check that the file is complete and of the kind its extension says",
        });
    }
    let mut lines = Lines {
        rest: bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes),
        number: 0,
    };
    Ok(std::iter::from_fn(move || {
        let (number, first) = lines.next()?;
        if !first.ends_with('\\') || first.contains('#') {
            return Some((number, first));
        }
        let mut text = first.into_owned();
        while text.ends_with('\\') {
            text.pop();
            let Some((_, more)) = lines.next() else { break };
            text.push(' ');
            text.push_str(&more);
        }
        Some((number, Cow::Owned(text)))
    }))
}

/// The error for text in an encoding other than UTF-8: told by its byte order mark, or without one by the zero
/// bytes that UTF-16 puts beside every letter of these formats.
pub(super) fn other_encoding(bytes: &[u8]) -> Option<LoadError> {
    let start = &bytes[..bytes.len().min(64) & !1];
    let zeros = |odd: usize| {
        let pairs = start.as_chunks::<2>().0;
        pairs.len() >= 2 && pairs.iter().all(|p| p[odd] == 0 && p[1 - odd] != 0)
    };
    let found = match bytes {
        [0, 0, 0xFE, 0xFF, ..] => "UTF-32 text (big-endian byte order mark)",
        [0xFF, 0xFE, 0, 0, ..] => "UTF-32 text (little-endian byte order mark)",
        [0xFE, 0xFF, ..] => "UTF-16 text (big-endian byte order mark)",
        [0xFF, 0xFE, ..] => "UTF-16 text (little-endian byte order mark)",
        _ if zeros(0) => "UTF-16 text (big-endian)",
        _ if zeros(1) => "UTF-16 text (little-endian)",
        _ => return None,
    };
    let remedy = "save the file as UTF-8 text";
    Some(LoadError::Encoding { found, remedy })
}

struct Lines<'a> {
    rest: &'a [u8],
    /// Lines given so far.
    number: usize,
}

impl<'a> Iterator for Lines<'a> {
    type Item = (usize, Cow<'a, str>);

    fn next(&mut self) -> Option<Self::Item> {
        if self.rest.is_empty() {
            return None;
        }
        self.number += 1;
        let ends = |b: &u8| matches!(b, b'\n' | b'\r');
        let length = self.rest.iter().position(ends).unwrap_or(self.rest.len());
        let (line, rest) = self.rest.split_at(length);
        self.rest = match rest {
            [b'\r', b'\n', rest @ ..] | [b'\r' | b'\n', rest @ ..] => rest,
            _ => rest,
        };
        let text = match String::from_utf8_lossy(line) {
            Cow::Borrowed(text) => Cow::Borrowed(text.trim()),
            Cow::Owned(text) => Cow::Owned(text.trim().to_owned()),
        };
        Some((self.number, text))
    }
}

/// Parses a coordinate that a mesh can have.
pub(super) fn coordinate(token: &str, line: usize) -> Result<f64, LoadError> {
    let value: f64 = token
        .parse()
        .map_err(|_| at_line(line, format!("`{}` is not a number", shortened(token))))?;
    if value.abs() < MAX_COORDINATE {
        return Ok(value);
    }
    let shown = shortened(token);
    Err(at_line(
        line,
        if value.is_finite() {
            format!(
                "coordinate `{shown}` is too large: coordinates must be below {MAX_COORDINATE:e}"
            )
        } else {
            format!("coordinate `{shown}` is not finite")
        },
    ))
}

/// At most 40 characters of a token, for messages.
pub(super) fn shortened(token: &str) -> String {
    token.chars().take(40).collect()
}

#[cfg(test)]
mod tests {
    use super::{coordinate, text_lines};
    use crate::load::LoadError;

    fn lines(text: &str) -> Vec<(usize, String)> {
        let lines = text_lines(text.as_bytes()).unwrap();
        lines.map(|(n, l)| (n, l.into_owned())).collect()
    }

    #[test]
    fn every_line_ending_counts_once() {
        let expected = |numbers: [usize; 3]| {
            let words = ["a", "b", "c"].map(str::to_owned);
            numbers.into_iter().zip(words).collect::<Vec<_>>()
        };
        for text in ["a\nb\nc", "a\r\nb\r\nc\r\n", "a\rb\rc", "a\r\nb\rc\n"] {
            assert_eq!(lines(text), expected([1, 2, 3]), "{text:?}");
        }
        let text = "a\n\r\nb\r\r c \n";
        let filled = |(_, l): &(usize, String)| !l.is_empty();
        let kept: Vec<_> = lines(text).into_iter().filter(filled).collect();
        assert_eq!(kept, expected([1, 3, 5]));
    }

    #[test]
    fn continued_lines_keep_the_number_of_the_first() {
        assert_eq!(
            lines("f 1 \\\r\n 2 \\\n 3\nv"),
            [(1, "f 1  2  3".to_owned()), (4, "v".to_owned())]
        );
        assert_eq!(lines("f 1 \\"), [(1, "f 1 ".to_owned())]);
        // The path of the exporter, not a continued line.
        assert_eq!(lines("# C:\\models\\\nv 0 0 0").len(), 2);
    }

    #[test]
    fn encodings_are_told_with_and_without_their_mark() {
        let encoded = |units: &[u16], bytes: fn(u16) -> [u8; 2]| -> Vec<u8> {
            units.iter().flat_map(|&u| bytes(u)).collect()
        };
        let plain: Vec<u16> = "v 0 0 0\n".encode_utf16().collect();
        let marked: Vec<u16> = [0xFEFF].into_iter().chain(plain.iter().copied()).collect();
        for (units, name) in [(&plain, "endian)"), (&marked, "endian byte order mark)")] {
            for (bytes, order) in [
                (u16::to_be_bytes as fn(u16) -> [u8; 2], "big"),
                (u16::to_le_bytes, "little"),
            ] {
                let bytes = encoded(units, bytes);
                let message = text_lines(&bytes).err().unwrap().to_string();
                let expected = format!("UTF-16 text ({order}-{name}");
                assert!(message.starts_with(&expected), "{message}");
            }
        }
        let zero = text_lines(b"v 0 0 0\nv 1\0 2 3\n").err().unwrap();
        assert!(matches!(zero, LoadError::Encoding { found, .. } if found.contains("zero byte")));
    }

    #[test]
    fn coordinates_are_finite_and_not_huge() {
        assert!(coordinate("-1e14", 1).is_ok());
        for (token, what) in [
            ("1e300", "too large"),
            ("-3e38", "too large"),
            ("1e999", "not finite"),
            ("NaN", "not finite"),
            ("-infinity", "not finite"),
            ("1.#INF", "not a number"),
            ("0x10", "not a number"),
            ("1,5", "not a number"),
        ] {
            let message = coordinate(token, 7).unwrap_err().to_string();
            assert!(
                message.starts_with("line 7: ") && message.contains(what),
                "{message}"
            );
        }
    }
}

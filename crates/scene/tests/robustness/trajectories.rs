//! Motions cut short, and every cell exchanged.

use std::path::Path;

use pliant_scene::{Place, SceneError, read_trajectory};

use crate::position;

const FILE: &str = "m.csv";

/// With a comment, a blank line, columns in another order and a feed.
const ODD: &str = "# by hand\n\nqw,qx,qy,qz,t_s,x_m,y_m,z_m,feed_m\n1,0,0,0,0.5,1,2,3,0\n# turned\n\
0.6,0.8,0,0,1.5,-1,2e-1,3,0.0\n\n0,0,-1,0,2.5,1,2,3,-0\n";

/// Beginnings of the shipped motions, and the odd one.
fn motions() -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/trajectories");
    let mut motions: Vec<(String, String)> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .map(|path| {
            let text = std::fs::read_to_string(&path).unwrap();
            let head: Vec<&str> = text.split_inclusive('\n').take(9).collect();
            (path.display().to_string(), head.concat())
        })
        .collect();
    motions.sort();
    assert_eq!(motions.len(), 6, "the shipped motions");
    motions.push(("odd".to_owned(), ODD.to_owned()));
    motions
}

/// Line and column of an error, which must lie in `text`.
fn place(error: &SceneError, text: &str) -> (usize, usize) {
    let Place::File { file, line, column } = &error.place else {
        panic!("{error}: no place in a file");
    };
    assert_eq!(file, FILE);
    let found = text.split('\n').nth(line - 1);
    let length = found
        .unwrap_or_else(|| panic!("{error}: no such line"))
        .chars()
        .count();
    assert!(
        (1..=length + 1).contains(column),
        "{error}: that line has {length}"
    );
    let message = error.fault.to_string();
    assert!(message.len() > 10 && message.len() < 2000, "{message}");
    (*line, *column)
}

/// Spans of all cells, header included.
fn cells(text: &str) -> Vec<(usize, usize)> {
    let mut cells = Vec::new();
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let mut at = start;
        start += line.len();
        if line.trim().is_empty() || line.starts_with('#') {
            continue;
        }
        for cell in line.trim_end().split(',') {
            cells.push((at, at + cell.len()));
            at += cell.len() + 1;
        }
    }
    cells
}

#[test]
fn a_motion_cut_short_at_any_byte_is_refused_on_its_last_line_or_sound() {
    for (name, text) in motions() {
        let count = cells(&text).len();
        let columns = if name == "odd" { 9 } else { 8 };
        assert_eq!(count % columns, 0);
        let mut sound = 0;
        for cut in 0..text.len() {
            let left = &text[..cut];
            match read_trajectory(left.as_bytes(), FILE) {
                Ok(motion) => {
                    sound += 1;
                    // Whole lines, but for the digits of the last number.
                    assert_eq!(cells(left).len() % columns, 0, "{name} at {cut}");
                    assert_eq!(motion.knots().len() + 1, cells(left).len() / columns);
                }
                Err(error) => {
                    let (line, _) = place(&error, left);
                    let last = left.trim_end().split('\n').count();
                    let next = left.split('\n').count();
                    assert!((last..=next).contains(&line), "{name} at {cut}: {error}");
                }
            }
        }
        assert!(sound > 0, "{name}");
    }
}

#[test]
fn a_cell_that_is_no_number_is_refused_where_it_stands() {
    for (name, text) in motions() {
        let columns = if name == "odd" { 9 } else { 8 };
        for &(start, end) in cells(&text).iter().skip(columns) {
            for cell in [
                "", "abc", "NaN", "inf", "-inf", "-", "0x10", "1e999", "1.2.3", "1 2", "\u{b5}",
                "\0", "''",
            ] {
                let damaged = format!("{}{cell}{}", &text[..start], &text[end..]);
                let what = format!("{name}: {cell:?} for {}", &text[start..end]);
                let error = read_trajectory(damaged.as_bytes(), FILE).expect_err(&what);
                assert_eq!(
                    place(&error, &damaged),
                    position(&text, start),
                    "{what}: {error}"
                );
                let message = error.fault.to_string();
                let expected = format!("`{cell}` is no finite number; expected one");
                assert_eq!(message, expected, "{what}");
            }
        }
    }
}

#[test]
fn a_number_that_makes_no_motion_is_refused_on_its_line() {
    for (name, text) in motions() {
        let columns = if name == "odd" { 9 } else { 8 };
        let all = cells(&text);
        let header: Vec<&str> = all[..columns]
            .iter()
            .map(|&(start, end)| &text[start..end])
            .collect();
        for (index, &(start, end)) in all.iter().enumerate().skip(columns) {
            for number in ["-1", "1e300", "-1e300", "1000000.5", "7", "0.1"] {
                let damaged = format!("{}{number}{}", &text[..start], &text[end..]);
                let column = header[index % columns];
                let what = format!("{name}: {number} for {column} {}", &text[start..end]);
                let Err(error) = read_trajectory(damaged.as_bytes(), FILE) else {
                    let value: f64 = number.parse().unwrap();
                    let fits = match column {
                        "feed_m" => false,
                        "x_m" | "y_m" | "z_m" => value.abs() <= 1e6,
                        _ => true,
                    };
                    assert!(fits, "{what} was accepted");
                    continue;
                };
                let found = place(&error, &damaged);
                let at = position(&text, start);
                match column {
                    "x_m" | "y_m" | "z_m" | "feed_m" => assert_eq!(found, at, "{what}: {error}"),
                    // A time too late shows at the next one.
                    "t_s" => assert!(
                        found.0 == at.0 || found.0 > at.0 && found.0 <= at.0 + 3,
                        "{what}: {error}"
                    ),
                    _ => assert_eq!(found.0, at.0, "{what}: {error}"),
                }
            }
        }
    }
}

#[test]
fn a_damaged_header_is_refused_where_it_stands() {
    for (name, text) in motions() {
        let columns = if name == "odd" { 9 } else { 8 };
        for &(start, end) in &cells(&text)[..columns] {
            let column = &text[start..end];
            let at = position(&text, start);
            for other in [
                format!("{column}x"),
                column.to_uppercase(),
                "\"".to_owned() + column,
                "0".to_owned(),
                String::new(),
            ] {
                let damaged = format!("{}{other}{}", &text[..start], &text[end..]);
                let error = read_trajectory(damaged.as_bytes(), FILE).expect_err(&other);
                assert_eq!(place(&error, &damaged), at, "{name}: {other}: {error}");
                assert!(error.to_string().contains("unknown column `"), "{error}");
            }
            let damaged = format!("{}{column},{}", &text[..start], &text[start..]);
            let error = read_trajectory(damaged.as_bytes(), FILE).unwrap_err();
            let second = position(&damaged, start + column.len() + 1);
            assert_eq!(place(&error, &damaged), second, "{error}");
            assert!(error.to_string().contains("there twice"), "{error}");
            let cut = if text[end..].starts_with(',') {
                end + 1
            } else {
                end
            };
            let damaged = format!("{}{}", &text[..start], &text[cut..]);
            let error = read_trajectory(damaged.as_bytes(), FILE).unwrap_err();
            // A feed left out, or an empty name behind the last comma, shows as something else.
            assert!(
                (at.0..=at.0 + 1).contains(&place(&error, &damaged).0),
                "{error}"
            );
        }
    }
}

#[test]
fn a_comma_too_few_or_too_many_is_refused_on_its_line() {
    for (name, text) in motions() {
        for (at, _) in text.match_indices(',') {
            for instead in ["", ",,", ";", "\t"] {
                let damaged = format!("{}{instead}{}", &text[..at], &text[at + 1..]);
                let error = read_trajectory(damaged.as_bytes(), FILE).expect_err(&name);
                let line = position(&text, at).0;
                assert_eq!(
                    place(&error, &damaged).0,
                    line,
                    "{name}: {instead}: {error}"
                );
            }
        }
    }
}

#[test]
fn bytes_quotes_and_line_ends_are_survived() {
    for (name, text) in motions() {
        let expected = read_trajectory(text.as_bytes(), FILE).unwrap();
        let windows = format!("\u{feff}{}", text.replace('\n', "\r\n"));
        let read = read_trajectory(windows.as_bytes(), FILE).unwrap();
        assert_eq!(read.knots().len(), expected.knots().len(), "{name}");
        for at in 0..=text.len() {
            for byte in [0xff, 0, b'"', b'\r', b'\n', b'#', b',', b'\\'] {
                let mut bytes = text.clone().into_bytes();
                bytes.insert(at, byte);
                if let Err(error) = read_trajectory(&bytes, FILE) {
                    let readable = String::from_utf8_lossy(&bytes);
                    let found = place(&error, &readable);
                    if byte == 0xff {
                        assert_eq!(found, position(&text, at), "{name}: {error}");
                    }
                }
            }
        }
    }
}

#[test]
fn messages_quote_the_beginning_of_long_cells() {
    let long = "9".repeat(1_000_000);
    let header = "t_s,x_m,y_m,z_m,qx,qy,qz,qw\n";
    for text in [
        format!("{long}\n"),
        format!("{header}{long},0,0,0,0,0,0,1\n"),
        format!("{header}0,{long},0,0,0,0,0,1\n"),
        format!("{header}0,\"{long}"),
        format!("{header}{}", ",".repeat(1_000_000)),
        format!("{header}{}", "\n".repeat(1_000_000)),
        format!("{header}{}0,0,0,0,0,0,0,2\n", "# note\n".repeat(200_000)),
    ] {
        let error = read_trajectory(text.as_bytes(), FILE).unwrap_err();
        place(&error, &text);
    }
}

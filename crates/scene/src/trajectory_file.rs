//! Recorded motions: CSV with the columns `t_s, x_m, y_m, z_m, qx, qy, qz, qw`, in any order, and optionally `feed_m`.
//!
//! Times in seconds, positions in metres, quaternions of the handle's orientation. Lines that begin with `#` are
//! comments.

use csv::{ReaderBuilder, StringRecord, Trim};
use glam::{DQuat, DVec3};
use pliant_device::{TimedPose, Trajectory, TrajectoryError};
use pliant_spatial::Pose;

use crate::digits::number;
use crate::error::{Fault, Place, SceneError, line_and_column, shortened};

/// The columns a file must have.
const COLUMNS: [&str; 8] = ["t_s", "x_m", "y_m", "z_m", "qx", "qy", "qz", "qw"];

/// How far a flexible tool is fed; rigid tools have none.
const FEED: &str = "feed_m";

/// Reads a trajectory; `file_name` is cited in errors.
///
/// # Errors
/// With line and column, when columns are missing, a number is none, or the samples make no trajectory.
pub fn read_trajectory(bytes: &[u8], file_name: &str) -> Result<Trajectory, SceneError> {
    let text = str::from_utf8(bytes).map_err(|error| {
        let readable = str::from_utf8(&bytes[..error.valid_up_to()]).unwrap_or_default();
        Table::new(readable, file_name).fault(
            readable.len(),
            0,
            "not UTF-8 text; expected a CSV file",
        )
    })?;
    Table::new(text.strip_prefix('\u{feff}').unwrap_or(text), file_name).read()
}

struct Table<'a> {
    text: &'a str,
    file: &'a str,
}

/// Where each known column is in the file.
struct Header {
    /// In the order of [`COLUMNS`].
    columns: [usize; 8],
    feed: Option<usize>,
    count: usize,
}

impl Header {
    /// The column of what [`Trajectory::new`] calls a quantity.
    fn column_of(&self, quantity: &str) -> usize {
        match quantity {
            "position x" => self.columns[1],
            "position y" => self.columns[2],
            "position z" => self.columns[3],
            _ => self.columns[0],
        }
    }
}

/// Why samples make no motion, for those who see lines and columns, in short numbers.
pub(crate) fn in_words(error: &TrajectoryError) -> String {
    match *error {
        TrajectoryError::OutOfRange {
            quantity,
            value,
            limit,
            ..
        } => format!(
            "the {quantity} is {}, beyond ±{}; times are in seconds and positions in metres",
            number(value),
            number(limit)
        ),
        TrajectoryError::OutOfOrder { time, previous, .. } => format!(
            "the time {} s is before {} s of the sample before it; sort the lines by time",
            number(time),
            number(previous)
        ),
        TrajectoryError::Quaternion { norm, .. } => format!(
            "the quaternion has norm {}, a rotation has 1; check the column order qx, qy, qz, qw",
            number(norm)
        ),
        TrajectoryError::Speed { speed } => format!(
            "at {} times the speed no usable times are left between samples; choose one nearer 1",
            number(speed)
        ),
        _ => error.to_string(),
    }
}

impl<'a> Table<'a> {
    const fn new(text: &'a str, file: &'a str) -> Self {
        Self { text, file }
    }

    fn read(&self) -> Result<Trajectory, SceneError> {
        let mut reader = ReaderBuilder::new()
            .trim(Trim::All)
            .comment(Some(b'#'))
            .flexible(true)
            .has_headers(false)
            .from_reader(self.text.as_bytes());
        let mut header = None;
        let mut samples = Vec::new();
        let mut rows = Vec::new();
        for record in reader.records() {
            let record = record.map_err(|error| {
                let at = error.position().map_or(0, csv::Position::byte);
                self.fault(self.row_start(at), 0, &error.to_string())
            })?;
            let row = self.row_start(record.position().map_or(0, csv::Position::byte));
            match &header {
                None => header = Some(self.header(&record, row)?),
                Some(header) => {
                    samples.push(self.sample(header, &record, row)?);
                    rows.push(row);
                }
            }
        }
        let Some(header) = header else {
            let message = format!(
                "the file is empty; expected the columns {}",
                COLUMNS.join(",")
            );
            return Err(self.fault(0, 0, &message));
        };
        Trajectory::new(&samples).map_err(|error| {
            let row = error.row().and_then(|row| rows.get(row)).copied();
            let column = match error {
                TrajectoryError::OutOfOrder { .. } => header.columns[0],
                TrajectoryError::Quaternion { .. } => header.columns[4],
                TrajectoryError::OutOfRange { quantity, .. } => header.column_of(quantity),
                _ => 0,
            };
            self.fault(row.unwrap_or(self.text.len()), column, &in_words(&error))
        })
    }

    fn header(&self, record: &StringRecord, row: usize) -> Result<Header, SceneError> {
        let expected = || format!("expected {} and optionally {FEED}", COLUMNS.join(","));
        for (index, name) in record.iter().enumerate() {
            if name != FEED && !COLUMNS.contains(&name) {
                let message = format!("unknown column `{}`; {}", shortened(name), expected());
                return Err(self.fault(row, index, &message));
            }
            if record.iter().take(index).any(|earlier| earlier == name) {
                let message = format!("column `{name}` is there twice; {}", expected());
                return Err(self.fault(row, index, &message));
            }
        }
        let position = |wanted: &str| record.iter().position(|name| name == wanted);
        let mut columns = [0; 8];
        for (slot, name) in columns.iter_mut().zip(COLUMNS) {
            *slot = position(name).ok_or_else(|| {
                self.fault(
                    row,
                    0,
                    &format!("column `{name}` is missing; {}", expected()),
                )
            })?;
        }
        Ok(Header {
            columns,
            feed: position(FEED),
            count: record.len(),
        })
    }

    fn sample(
        &self,
        header: &Header,
        record: &StringRecord,
        row: usize,
    ) -> Result<TimedPose, SceneError> {
        if record.len() != header.count {
            let message = format!(
                "this line has {} fields; the header has {}",
                record.len(),
                header.count
            );
            return Err(self.fault(row, record.len().min(header.count), &message));
        }
        let number = |column: usize| -> Result<f64, SceneError> {
            let field = &record[column];
            let value: Option<f64> = field.parse().ok();
            value.filter(|value| value.is_finite()).ok_or_else(|| {
                self.fault(
                    row,
                    column,
                    &format!("`{}` is no finite number; expected one", shortened(field)),
                )
            })
        };
        if let Some(feed) = header.feed
            && number(feed)? != 0.0
        {
            let message = "the feed is not 0, and a rigid tool cannot be fed; set it to 0 or remove the column";
            return Err(self.fault(row, feed, message));
        }
        let mut values = [0.0; 8];
        for (value, &column) in values.iter_mut().zip(&header.columns) {
            *value = number(column)?;
        }
        let [time, x, y, z, qx, qy, qz, qw] = values;
        let rotation = DQuat::from_xyzw(qx, qy, qz, qw);
        Ok(TimedPose {
            time,
            pose: Pose::new(rotation, DVec3::new(x, y, z)),
        })
    }

    /// First byte of the row that the CSV reader found from `at` on: it counts from before blank lines and comments.
    fn row_start(&self, at: u64) -> usize {
        let mut start = usize::try_from(at).map_or(self.text.len(), |at| at.min(self.text.len()));
        while let Some((line, rest)) = self
            .text
            .get(start..)
            .and_then(|text| text.split_once('\n'))
        {
            if !line.trim().is_empty() && !line.starts_with('#') {
                break;
            }
            start = self.text.len() - rest.len();
        }
        start
    }

    /// A fault of field `column`, from 0, of the row that begins at byte `row`.
    fn fault(&self, row: usize, column: usize, message: &str) -> SceneError {
        let line_text = self.text.get(row..).unwrap_or_default();
        let line_text = line_text.lines().next().unwrap_or_default();
        let (line, line_column) = line_and_column(self.text, row);
        let place = Place::File {
            file: self.file.to_owned(),
            line,
            column: line_column + field_column(line_text, column),
        };
        SceneError::new(place, Fault::Trajectory(message.to_owned()))
    }
}

/// Characters before field `index` of a CSV line, blanks before the field included.
fn field_column(line: &str, index: usize) -> usize {
    let mut commas = 0;
    let mut quoted = false;
    let mut characters = 0;
    for c in line.chars() {
        match c {
            _ if commas == index && !c.is_whitespace() => break,
            '"' => quoted = !quoted,
            ',' if !quoted => commas += 1,
            _ => {}
        }
        characters += 1;
    }
    characters
}

#[cfg(test)]
mod tests {
    use super::read_trajectory;

    const HEADER: &str = "t_s,x_m,y_m,z_m,qx,qy,qz,qw\n";

    fn message(text: &str) -> String {
        read_trajectory(text.as_bytes(), "m.csv")
            .unwrap_err()
            .to_string()
    }

    #[test]
    fn columns_come_in_any_order_and_comments_and_marks_are_skipped() {
        let text = "\u{feff}# made by hand\n\nqw,qx,qy,qz, t_s ,x_m,y_m,z_m,feed_m\r\n\
                    # start\r\n1,0,0,0,0,1,2,3,0\r\n1,0,0,0,2,2,2,3,0\r\n";
        let trajectory = read_trajectory(text.as_bytes(), "m.csv").unwrap();
        assert!((trajectory.duration() - 2.0).abs() < 1e-15);
        let pose = trajectory.sample(0.0).0;
        assert!((pose.translation - glam::DVec3::new(1.0, 2.0, 3.0)).length() < 1e-15);
        assert!((pose.rotation.w - 1.0).abs() < 1e-15);
    }

    #[test]
    fn each_fault_is_told_with_its_place() {
        let row = "0,0,0,0,0,0,0,1\n";
        for (text, start, part) in [
            (String::new(), "m.csv:1:1: ", "empty"),
            (HEADER.to_owned(), "m.csv:2:1: ", "no samples"),
            (
                "t_s,x_mm\n".to_owned(),
                "m.csv:1:5: ",
                "unknown column `x_mm`",
            ),
            ("t_s,t_s\n".to_owned(), "m.csv:1:5: ", "twice"),
            ("t_s,x_m\n".to_owned(), "m.csv:1:1: ", "`y_m` is missing"),
            (
                format!("{HEADER}{row}1,0,abc,0,0,0,0,1\n"),
                "m.csv:3:5: ",
                "`abc`",
            ),
            (
                format!("{HEADER}# note\n\n{row}1, 0, nan,0,0,0,0,1\n"),
                "m.csv:5:7: ",
                "`nan`",
            ),
            (
                format!("{HEADER}{row}1,0,0,0,0,0,1\n"),
                "m.csv:3:14: ",
                "7 fields",
            ),
            (
                format!("{HEADER}{row}1,0,0,0,0,0,0,1,9\n"),
                "m.csv:3:17: ",
                "9 fields",
            ),
            (
                format!("{HEADER}{row}-1,0,0,0,0,0,0,1\n"),
                "m.csv:3:1: ",
                "before",
            ),
            (
                format!("{HEADER}0,0,0,0,0,0,0.5,1\n"),
                "m.csv:2:9: ",
                "norm",
            ),
            (
                "t_s,x_m,y_m,z_m,qx,qy,qz,qw,feed_m\n0,0,0,0,0,0,0,1,0.01\n".to_owned(),
                "m.csv:2:17: ",
                "rigid tool cannot be fed",
            ),
        ] {
            let message = message(&text);
            assert!(message.starts_with(start), "{text:?}: {message}");
            assert!(message.contains(part), "{text:?}: {message}");
        }
        let error = read_trajectory(b"t_s\n\xff", "m.csv").unwrap_err();
        assert!(
            error.to_string().starts_with("m.csv:2:1: not UTF-8"),
            "{error}"
        );
    }
}

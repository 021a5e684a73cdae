//! The GLB container (specification §4): header and chunks, checked against the bytes that are there.

use super::super::text::other_encoding;
use super::super::{LoadError, LoadReport};

const MAGIC: &[u8] = b"glTF";
const JSON: &[u8] = b"JSON";
const BIN: &[u8] = b"BIN\0";

/// Parts of a file.
pub(super) struct Container<'a> {
    pub(super) json: &'a [u8],
    pub(super) binary: Option<&'a [u8]>,
}

/// Tells GLB from JSON text and cuts the former into its chunks.
pub(super) fn split<'a>(
    bytes: &'a [u8],
    report: &mut LoadReport,
) -> Result<Container<'a>, LoadError> {
    if bytes.starts_with(MAGIC) {
        return chunks(bytes, report);
    }
    let json = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    if json.len() < bytes.len() {
        report.note("byte order mark ignored", "byte 0");
    }
    if json.trim_ascii_start().first() == Some(&b'{') {
        return Ok(Container { json, binary: None });
    }
    if let Some(error) = other_encoding(bytes) {
        return Err(error);
    }
    Err(LoadError::Encoding {
        found: "neither GLB (`glTF` at the start) nor JSON text (`{` at the start)",
        remedy: "check that the file is a glTF 2.0 file in UTF-8",
    })
}

fn fault(offset: usize, message: impl Into<String>) -> LoadError {
    let message = message.into();
    LoadError::Binary { offset, message }
}

fn word(bytes: &[u8], offset: usize) -> Result<usize, LoadError> {
    let four = bytes.get(offset..).and_then(<[u8]>::first_chunk);
    let value = u32::from_le_bytes(
        *four.ok_or_else(|| fault(offset, "the GLB file ends within a header"))?,
    );
    usize::try_from(value).map_err(|_| fault(offset, "a length beyond the address space"))
}

/// The bytes that the header claims, which must be there.
fn stated_part<'a>(bytes: &'a [u8], report: &mut LoadReport) -> Result<&'a [u8], LoadError> {
    let version = word(bytes, 4)?;
    if version != 2 {
        return Err(fault(
            4,
            format!("GLB version {version}: only version 2 is supported"),
        ));
    }
    let length = word(bytes, 8)?;
    if length < 20 {
        return Err(fault(
            8,
            format!("the GLB header states a length of {length} bytes: a file has at least 20"),
        ));
    }
    let Some(file) = bytes.get(..length) else {
        return Err(fault(
            8,
            format!(
                "the GLB header states {length} bytes, the file has {}: it is truncated",
                bytes.len()
            ),
        ));
    };
    if length < bytes.len() {
        report.note(
            "runs of bytes after the end of the GLB ignored",
            format!("byte {length}"),
        );
    }
    Ok(file)
}

fn chunks<'a>(bytes: &'a [u8], report: &mut LoadReport) -> Result<Container<'a>, LoadError> {
    let file = stated_part(bytes, report)?;
    let length = file.len();
    let (mut json, mut binary) = (None, None);
    let at_byte = |offset| format!("byte {offset}");
    let mut offset = 12;
    let mut chunk = 0;
    while offset < length {
        let size = word(file, offset)?;
        let start = offset + 8;
        let Some(kind) = file.get(offset + 4..start) else {
            return Err(fault(offset, "the GLB file ends within a chunk header"));
        };
        let Some(content) = start.checked_add(size).and_then(|end| file.get(start..end)) else {
            let left = length - start;
            return Err(fault(
                offset,
                format!("a chunk of {size} bytes, but only {left} are left: it is truncated"),
            ));
        };
        match (kind, json, binary) {
            (JSON, None, _) => json = Some(content),
            (JSON, Some(_), _) => {
                return Err(fault(offset, "a second JSON chunk: there must be one"));
            }
            (_, None, _) => return Err(fault(offset, "the first chunk is not JSON: it must be")),
            (BIN, _, None) => {
                if chunk > 1 {
                    report.note(
                        "binary chunks behind others read, though it must be the second",
                        at_byte(offset),
                    );
                }
                binary = Some(content);
            }
            (BIN, _, Some(_)) => {
                return Err(fault(offset, "a second binary chunk: there may be one"));
            }
            _ => report.note("chunks of unknown type ignored", at_byte(offset)),
        }
        if size % 4 != 0 {
            report.note(
                "chunks whose length is no multiple of 4 read",
                at_byte(offset),
            );
        }
        offset = start + size;
        chunk += 1;
    }
    match json {
        Some([]) => Err(fault(12, "the JSON chunk is empty")),
        Some(json) => Ok(Container { json, binary }),
        None => Err(fault(12, "no JSON chunk")),
    }
}

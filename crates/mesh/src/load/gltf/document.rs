//! The JSON text (specification §3.2): required extensions first, then the version, then the rest.
//!
//! The types of the `gltf` crate demand more than the specification (every scene has `nodes`, every texture a
//! `source`), and a fault anywhere makes them refuse the whole file. Where they do, all that triangles do not
//! need is left out and the rest tried again.

use ::gltf::json::{Root, Value, deserialize};

use super::super::text::{other_encoding, shortened};
use super::super::{LoadError, LoadReport};
use super::element;

/// Required extensions that change nothing about the shape of a model start like this.
const HARMLESS: [&str; 9] = [
    "KHR_materials_",
    "EXT_materials_",
    "KHR_texture_",
    "EXT_texture_",
    "MSFT_texture_",
    "KHR_lights_",
    "EXT_lights_",
    "KHR_xmp",
    "KHR_animation_",
];

/// Members of the file that triangles do not need.
const OPTIONAL: [&str; 10] = [
    "animations",
    "cameras",
    "extensions",
    "extras",
    "images",
    "materials",
    "samplers",
    "skins",
    "textures",
    "extensionsUsed",
];

/// Members that hold sizes and real numbers, or anything.
const NO_INDICES: [&str; 13] = [
    "byteLength",
    "byteOffset",
    "byteStride",
    "count",
    "extensions",
    "extras",
    "matrix",
    "max",
    "min",
    "rotation",
    "scale",
    "translation",
    "weights",
];

/// Most objects in the text: each takes up to some hundred bytes of memory, and three bytes of text are enough
/// for one.
const MAX_OBJECTS: usize = 1 << 19;

/// Most separators in the text: each can make a value of 32 bytes.
const MAX_VALUES: usize = 1 << 23;

/// Parses and checks the text up to the version.
///
/// # Errors
/// Another encoding; more values than memory should hold; an extension that cannot be read; another version than
/// 2.x; text that is not JSON or not glTF, with line and column.
pub(super) fn parse(json: &[u8], report: &mut LoadReport) -> Result<Root, LoadError> {
    if let Some(error) = other_encoding(json) {
        return Err(error);
    }
    let padding = json.iter().rev().take_while(|&&b| b == 0).count();
    let json = &json[..json.len() - padding];
    if padding > 0 {
        report.note(
            "runs of zero bytes behind the JSON text ignored",
            format!("byte {}", json.len()),
        );
    }
    let (mut objects, mut values) = (0, 0);
    for byte in json {
        objects += usize::from(*byte == b'{');
        values += usize::from(matches!(byte, b'[' | b','));
    }
    limited("JSON objects", objects, MAX_OBJECTS)?;
    limited("JSON values", values, MAX_VALUES)?;
    let root = match Root::from_slice(json) {
        Ok(root) => root,
        Err(error) => second_try(json, error.to_string(), report).ok_or_else(|| {
            // The place comes again in front of the message.
            let message = error.to_string();
            let message = message.split(" at line ").next().unwrap_or_default();
            LoadError::Json {
                line: error.line(),
                column: error.column(),
                message: message.to_owned(),
            }
        })??,
    };
    check_extensions(root.extensions_required.iter().map(String::as_str))?;
    // Ten digits in a row, because the crate takes indices modulo 2³².
    let long = |run: &[u8]| run.len() > 9 && run[0].is_ascii_digit();
    let mut runs = json.chunk_by(|a, b| a.is_ascii_digit() && b.is_ascii_digit());
    if runs.any(long)
        && let Ok(value) = deserialize::from_slice(json)
    {
        check_indices("", &value)?;
    }
    check_version("asset.version", &root.asset.version)?;
    if let Some(least) = &root.asset.min_version {
        check_version("asset.minVersion", least)?;
        if least != "2.0" {
            let message = format!("`{}`: only 2.0 is supported", shortened(least));
            return Err(element("asset.minVersion", message));
        }
    }
    Ok(root)
}

fn limited(what: &'static str, count: usize, limit: usize) -> Result<(), LoadError> {
    if count > limit {
        return Err(LoadError::TooLarge { what, limit });
    }
    Ok(())
}

/// The file without the parts that triangles do not need; none if it is no better. An extension that cannot be
/// read explains the fault better than the fault does.
fn second_try(
    json: &[u8],
    fault: String,
    report: &mut LoadReport,
) -> Option<Result<Root, LoadError>> {
    let mut value: Value = deserialize::from_slice(json).ok()?;
    let required = value.get("extensionsRequired").and_then(Value::as_array);
    let names = required.into_iter().flatten().filter_map(Value::as_str);
    if let Err(error) = check_extensions(names) {
        return Some(Err(error));
    }
    if let Some(version) = value.pointer("/asset/version").and_then(Value::as_str)
        && let Err(error) = check_version("asset.version", version)
    {
        return Some(Err(error));
    }
    drop_extras(&mut value);
    let file = value.as_object_mut()?;
    for name in OPTIONAL {
        file.remove(name);
    }
    let scenes = file.get_mut("scenes").and_then(Value::as_array_mut);
    for scene in scenes
        .into_iter()
        .flatten()
        .filter_map(Value::as_object_mut)
    {
        scene
            .entry("nodes")
            .or_insert_with(|| Value::Array(Vec::new()));
    }
    let root = deserialize::from_value(value).ok()?;
    report.note("faults outside of the triangles ignored", fault);
    Some(Ok(root))
}

/// Takes away what programs keep for themselves: it can be any value, and the crate expects an object.
fn drop_extras(value: &mut Value) {
    match value {
        Value::Array(items) => items.iter_mut().for_each(drop_extras),
        Value::Object(members) => {
            members.remove("extras");
            members.values_mut().for_each(drop_extras);
        }
        _ => {}
    }
}

/// No index and no code is beyond 2³² − 1, to the depth of 128 that the parser allows.
fn check_indices(path: &str, value: &Value) -> Result<(), LoadError> {
    match value {
        Value::Number(number) if number.as_u64().is_some_and(|n| n > u64::from(u32::MAX)) => {
            let path = path.trim_start_matches('.');
            Err(element(
                path,
                format!("{number} is out of range: at most 4294967295"),
            ))
        }
        Value::Array(items) => items
            .iter()
            .enumerate()
            .try_for_each(|(i, item)| check_indices(&format!("{path}[{i}]"), item)),
        Value::Object(members) => members
            .iter()
            .filter(|(name, _)| !NO_INDICES.contains(&name.as_str()))
            .try_for_each(|(name, item)| check_indices(&format!("{path}.{name}"), item)),
        _ => Ok(()),
    }
}

fn check_extensions<'a>(required: impl Iterator<Item = &'a str>) -> Result<(), LoadError> {
    let unknown = |name: &&str| !HARMLESS.iter().any(|harmless| name.starts_with(harmless));
    let names: Vec<&str> = required.filter(unknown).collect();
    if names.is_empty() {
        Ok(())
    } else {
        Err(needs(&names))
    }
}

/// The error that names extensions and what helps.
pub(super) fn needs(names: &[&str]) -> LoadError {
    let compressed = |name: &&str| name.contains("compression") || name.contains("meshopt");
    let remedy = if names.iter().any(compressed) {
        "export the model again without compression"
    } else if names.contains(&"KHR_mesh_quantization") {
        "export the model again with unquantized positions; fingers feel the steps of integers"
    } else {
        "export the model again without"
    };
    let listed: Vec<String> = names.iter().take(8).map(|name| shortened(name)).collect();
    let names = if names.len() == 1 {
        format!("extension {}", listed[0])
    } else {
        format!("extensions {}", listed.join(", "))
    };
    LoadError::Extension { names, remedy }
}

fn check_version(path: &str, version: &str) -> Result<(), LoadError> {
    let digits = |s: &str| !s.is_empty() && s.bytes().all(|b| b.is_ascii_digit());
    match version.split_once('.') {
        Some(("2", minor)) if digits(minor) => Ok(()),
        _ => Err(element(
            path,
            format!("`{}`: expected 2.0", shortened(version)),
        )),
    }
}

//! Buffers (specification §3.6.1): the binary chunk, data URIs and files beside the model.

use std::borrow::Cow;

use ::gltf::json::Root;
use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};

use super::super::LoadError;
use super::super::text::shortened;
use super::document::needs;
use super::element;

/// Most bytes that external buffers may have in all: a file can name the same one again and again.
const MAX_EXTERNAL: usize = 1 << 29;

/// The buffers of a file, each fetched at the first use.
pub(super) struct Buffers<'a> {
    root: &'a Root,
    binary: Option<&'a [u8]>,
    resolver: &'a mut dyn FnMut(&str) -> Result<Vec<u8>, String>,
    contents: Vec<Option<Cow<'a, [u8]>>>,
    external: usize,
}

impl<'a> Buffers<'a> {
    pub(super) fn new(
        root: &'a Root,
        binary: Option<&'a [u8]>,
        resolver: &'a mut dyn FnMut(&str) -> Result<Vec<u8>, String>,
    ) -> Self {
        Self {
            root,
            binary,
            resolver,
            contents: vec![None; root.buffers.len()],
            external: 0,
        }
    }

    /// The content of a buffer that exists, cut to its stated length.
    pub(super) fn get(&mut self, index: usize) -> Result<&[u8], LoadError> {
        if self.contents[index].is_none() {
            let content = self.fetched(index)?;
            self.contents[index] = Some(content);
        }
        Ok(self.contents[index].as_deref().unwrap_or_default())
    }

    fn fetched(&mut self, index: usize) -> Result<Cow<'a, [u8]>, LoadError> {
        let buffer = &self.root.buffers[index];
        let path = format!("buffers[{index}]");
        let stated = usize::try_from(buffer.byte_length.0).unwrap_or(usize::MAX);
        let mut content = match &buffer.uri {
            Some(uri) => Cow::Owned(fetch(uri, &path, self.resolver)?),
            None => match self.binary {
                Some(binary) if index == 0 => Cow::Borrowed(binary),
                _ => return Err(no_data(self.root, path)),
            },
        };
        if content.len() < stated {
            let message = format!(
                "byteLength is {stated}, but only {} bytes are there: the data is cut short",
                content.len()
            );
            return Err(element(path, message));
        }
        match &mut content {
            Cow::Borrowed(bytes) => *bytes = &bytes[..stated],
            Cow::Owned(bytes) => {
                bytes.truncate(stated);
                bytes.shrink_to_fit();
                self.external = self.external.saturating_add(stated);
                if self.external > MAX_EXTERNAL {
                    let (what, limit) = ("bytes of external buffers", MAX_EXTERNAL);
                    return Err(LoadError::TooLarge { what, limit });
                }
            }
        }
        Ok(content)
    }
}

/// The error for data that is nowhere: usually it is compressed by an extension the file merely "uses".
pub(super) fn no_data(root: &Root, path: String) -> LoadError {
    let mut used = root.extensions_used.iter().map(String::as_str);
    match used.find(|name| name.contains("_compression")) {
        Some(name) => needs(&[name]),
        None => element(
            path,
            "has no data: neither a buffer view, a uri nor a binary chunk holds it",
        ),
    }
}

/// Data URIs are decoded here, relative paths given to the caller, others refused.
fn fetch(
    uri: &str,
    path: &str,
    resolver: &mut dyn FnMut(&str) -> Result<Vec<u8>, String>,
) -> Result<Vec<u8>, LoadError> {
    if uri
        .get(..5)
        .is_some_and(|s| s.eq_ignore_ascii_case("data:"))
    {
        let parts = uri[5..].split_once(',');
        let Some((kind, encoded)) =
            parts.and_then(|(kind, data)| Some((kind.strip_suffix(";base64")?, data)))
        else {
            return Err(element(
                path,
                "its data: URI is not base64 (`data:…;base64,…`)",
            ));
        };
        if kind.ends_with(';') || kind.contains(";;") {
            let message = "its data: URI is broken: the media type has an empty parameter (`;;`)";
            return Err(element(path, message));
        }
        let config =
            GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent);
        return GeneralPurpose::new(&STANDARD, config)
            .decode(encoded.trim())
            .map_err(|e| element(path, format!("its data: URI is broken: {e}")));
    }
    let shown = shortened(uri);
    let scheme = uri.split_once(':').is_some_and(|(s, _)| {
        s.bytes()
            .all(|b| b.is_ascii_alphanumeric() || b"+-.".contains(&b))
    });
    if scheme || uri.starts_with(['/', '\\']) || uri.is_empty() {
        return Err(element(
            path,
            format!("`{shown}` is not a relative path: put the buffer beside the file"),
        ));
    }
    let name = percent_decoded(uri)
        .ok_or_else(|| element(path, format!("`{shown}` is not a valid URI")))?;
    resolver(&name).map_err(|e| element(path, format!("`{shown}`: {e}")))
}

fn percent_decoded(uri: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.bytes();
    while let Some(byte) = rest.next() {
        bytes.push(if byte == b'%' {
            let digits = [rest.next()?, rest.next()?].map(char::from);
            let [high, low] = digits.map(|digit| digit.to_digit(16));
            u8::try_from(16 * high? + low?).ok()?
        } else {
            byte
        });
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::fetch;

    #[test]
    fn only_relative_paths_reach_the_caller() {
        let mut asked = Vec::new();
        let mut fetched = |uri: &str| {
            let found = fetch(uri, "buffers[0]", &mut |name| {
                asked.push(name.to_owned());
                Ok(vec![7])
            });
            found.map_err(|e| e.to_string())
        };
        for uri in ["a%20b.bin", "%C3%A9/../c.bin", "a;b,c.bin"] {
            assert_eq!(fetched(uri), Ok(vec![7]), "{uri}");
        }
        for (uri, what) in [
            ("http://x/a.bin", "not a relative path"),
            ("c:a.bin", "not a relative path"),
            ("/etc/passwd", "not a relative path"),
            ("\\\\server\\a", "not a relative path"),
            ("", "not a relative path"),
            ("a%", "not a valid URI"),
            ("a%+1b", "not a valid URI"),
            ("%ff.bin", "not a valid URI"),
            ("data:,abc", "not base64"),
            ("data:;base64", "not base64"),
            ("data:a/b;base64,A", "broken"),
            ("data:a/b;base64,A*==", "broken"),
            ("data:a/b;;base64,AA==", "empty parameter"),
        ] {
            let error = fetched(uri).unwrap_err();
            assert!(
                error.starts_with("buffers[0]: ") && error.contains(what),
                "{uri}: {error}"
            );
        }
        assert_eq!(fetched("data:a/b;base64,AA=="), Ok(vec![0]));
        assert_eq!(fetched("DATA:;base64,AA"), Ok(vec![0]));
        assert_eq!(asked, ["a b.bin", "é/../c.bin", "a;b,c.bin"]);
    }
}

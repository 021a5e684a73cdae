//! Buffers, buffer views and accessors (specification §3.6), each range checked before it is read.

use std::borrow::Cow;

use ::gltf::json::Root;
use ::gltf::json::accessor::{Accessor, ComponentType, Type};
use ::gltf::json::validation::Checked;
use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use glam::DVec3;

use super::super::{LoadError, MAX_LOADED};
use super::{QUANTIZATION, Shared, element};

/// Most elements a sparse accessor without buffer view (all zeros but a few) may have.
const MAX_IMPLIED: usize = 1 << 20;

/// Elements read in all, so that many accessors over the same bytes cannot fill memory and time.
const BUDGET: usize = 4 * MAX_LOADED;

/// The data of a file.
pub(super) struct Data<'a> {
    root: &'a Root,
    binary: Option<&'a [u8]>,
    resolver: &'a mut dyn FnMut(&str) -> Result<Vec<u8>, String>,
    buffers: Vec<Option<Cow<'a, [u8]>>>,
    budget: usize,
}

/// Where the elements of an accessor lie.
struct Span {
    view: usize,
    offset: u64,
    count: usize,
    /// Bytes per element.
    size: usize,
}

impl<'a> Data<'a> {
    pub(super) fn new(
        root: &'a Root,
        binary: Option<&'a [u8]>,
        resolver: &'a mut dyn FnMut(&str) -> Result<Vec<u8>, String>,
    ) -> Self {
        Self {
            root,
            binary,
            resolver,
            buffers: vec![None; root.buffers.len()],
            budget: BUDGET,
        }
    }

    /// Positions of an accessor.
    pub(super) fn positions(&mut self, index: usize) -> Result<Shared, LoadError> {
        let quantized = |name: &String| name == QUANTIZATION;
        let integers = self.root.extensions_used.iter().any(quantized)
            || self.root.extensions_required.iter().any(quantized);
        let allowed = |c| c == ComponentType::F32 || (integers && c != ComponentType::U32);
        let values = self.read::<3>(index, Type::Vec3, &allowed)?;
        let points: Vec<DVec3> = values.into_iter().map(DVec3::from_array).collect();
        match points.iter().position(|p| !p.is_finite()) {
            Some(k) => Err(element(
                format!("accessors[{index}]"),
                format!("element {k} is {}: positions must be finite", points[k]),
            )),
            None => Ok(Shared::new(points)),
        }
    }

    /// Indices of an accessor, all below `limit`.
    pub(super) fn indices(&mut self, index: usize, limit: usize) -> Result<Vec<u32>, LoadError> {
        let allowed = |c| {
            matches!(
                c,
                ComponentType::U8 | ComponentType::U16 | ComponentType::U32
            )
        };
        let values = self.read::<1>(index, Type::Scalar, &allowed)?;
        let mut indices = Vec::with_capacity(values.len());
        for (k, [value]) in values.into_iter().enumerate() {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "unsigned integers of 32 bits at most"
            )]
            let vertex = value as u32;
            if vertex as usize >= limit {
                let message =
                    format!("element {k} is index {vertex}, but there are {limit} positions");
                return Err(element(format!("accessors[{index}]"), message));
            }
            indices.push(vertex);
        }
        Ok(indices)
    }

    /// An accessor that exists and has the given type and one of the allowed component types.
    fn typed_accessor(
        &self,
        index: usize,
        kind: Type,
        allowed: &dyn Fn(ComponentType) -> bool,
    ) -> Result<(&'a Accessor, ComponentType), LoadError> {
        let path = format!("accessors[{index}]");
        let root = self.root;
        let Some(accessor) = root.accessors.get(index) else {
            return Err(element(
                path,
                format!(
                    "does not exist: the file has {} accessors",
                    root.accessors.len()
                ),
            ));
        };
        let Checked::Valid(component) = accessor.component_type else {
            return Err(element(
                path,
                "componentType is not one of the specification",
            ));
        };
        let component = component.0;
        if !matches!(accessor.type_, Checked::Valid(t) if t == kind) || !allowed(component) {
            let expected = if kind == Type::Vec3 {
                "VEC3 of FLOAT for positions"
            } else {
                "SCALAR of UNSIGNED integers for indices"
            };
            return Err(element(
                path,
                format!("has the wrong type: expected {expected}"),
            ));
        }
        Ok((accessor, component))
    }

    fn read<const N: usize>(
        &mut self,
        index: usize,
        kind: Type,
        allowed: &dyn Fn(ComponentType) -> bool,
    ) -> Result<Vec<[f64; N]>, LoadError> {
        let path = format!("accessors[{index}]");
        let (accessor, component) = self.typed_accessor(index, kind, allowed)?;
        let count = usize::try_from(accessor.count.0).unwrap_or(usize::MAX);
        self.budget = self.budget.checked_sub(count).ok_or(LoadError::TooLarge {
            what: "accessor elements",
            limit: BUDGET,
        })?;
        let size = N * component.size();
        let decode = |bytes: &[u8]| -> [f64; N] {
            std::array::from_fn(|k| {
                number(
                    &bytes[k * component.size()..],
                    component,
                    accessor.normalized,
                )
            })
        };
        let mut values = if let Some(view) = accessor.buffer_view {
            let offset = accessor.byte_offset.map_or(0, |o| o.0);
            let span = Span {
                view: view.value(),
                offset,
                count,
                size,
            };
            let (bytes, stride) = self.bytes(&span, &path)?;
            (0..count)
                .map(|i| decode(&bytes[i * stride..i * stride + size]))
                .collect()
        } else if accessor.sparse.is_none() {
            return Err(self.no_data(path));
        } else if count > MAX_IMPLIED {
            return Err(element(
                path,
                format!("{count} elements without a buffer view: at most {MAX_IMPLIED}"),
            ));
        } else {
            vec![[0.0; N]; count]
        };
        self.apply_sparse(index, &decode, size, &mut values)?;
        Ok(values)
    }

    /// Replaces single elements (specification §3.6.2.3).
    fn apply_sparse<const N: usize>(
        &mut self,
        index: usize,
        decode: &dyn Fn(&[u8]) -> [f64; N],
        size: usize,
        values: &mut [[f64; N]],
    ) -> Result<(), LoadError> {
        let Some(sparse) = &self.root.accessors[index].sparse else {
            return Ok(());
        };
        let path = format!("accessors[{index}].sparse");
        let count = usize::try_from(sparse.count.0).unwrap_or(usize::MAX);
        let Checked::Valid(kind) = sparse.indices.component_type else {
            return Err(element(
                path,
                "componentType of the indices is not an unsigned integer",
            ));
        };
        let kind = kind.0;
        let span = Span {
            view: sparse.indices.buffer_view.value(),
            offset: sparse.indices.byte_offset.0,
            count,
            size: kind.size(),
        };
        let (bytes, stride) = self.bytes(&span, &path)?;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "unsigned integers of 32 bits at most"
        )]
        let targets: Vec<usize> = (0..count)
            .map(|i| number(&bytes[i * stride..], kind, false) as usize)
            .collect();
        let span = Span {
            view: sparse.values.buffer_view.value(),
            offset: sparse.values.byte_offset.0,
            count,
            size,
        };
        let (bytes, stride) = self.bytes(&span, &path)?;
        for (i, target) in targets.into_iter().enumerate() {
            let total = values.len();
            let Some(value) = values.get_mut(target) else {
                return Err(element(
                    path,
                    format!("index {i} is {target}, but the accessor has {total} elements"),
                ));
            };
            *value = decode(&bytes[i * stride..i * stride + size]);
        }
        Ok(())
    }

    /// The bytes from the first element on, long enough for all of them, and the distance between elements.
    fn bytes(&mut self, span: &Span, path: &str) -> Result<(&[u8], usize), LoadError> {
        let Some(view) = self.root.buffer_views.get(span.view) else {
            let message = format!(
                "refers to bufferViews[{}], but the file has {}",
                span.view,
                self.root.buffer_views.len()
            );
            return Err(element(path, message));
        };
        let stride = view.byte_stride.map_or(span.size, |s| s.0);
        if stride < span.size {
            let message = format!(
                "byteStride {stride} is smaller than the {} bytes of an element of {path}",
                span.size
            );
            return Err(element(format!("bufferViews[{}]", span.view), message));
        }
        if span.count == 0 {
            return Ok((&[], stride));
        }
        let (start, length) = (view.byte_offset.map_or(0, |o| o.0), view.byte_length.0);
        let needed = (span.count as u64 - 1)
            .checked_mul(stride as u64)
            .and_then(|n| n.checked_add(span.size as u64)?.checked_add(span.offset));
        if needed.is_none_or(|n| n > length) {
            let message = format!(
                "{} elements do not fit in the {length} bytes of bufferViews[{}]",
                span.count, span.view
            );
            return Err(element(path, message));
        }
        let buffer_index = view.buffer.value();
        let buffer = self.buffer(buffer_index, span.view)?;
        let end = start
            .checked_add(length)
            .and_then(|e| usize::try_from(e).ok())
            .filter(|&e| e <= buffer.len());
        let (Some(end), Ok(first)) = (end, usize::try_from(start.saturating_add(span.offset)))
        else {
            let message = format!(
                "bytes {start} to {} lie beyond the {} of buffers[{buffer_index}]",
                start.saturating_add(length),
                buffer.len()
            );
            return Err(element(format!("bufferViews[{}]", span.view), message));
        };
        Ok((&buffer[first..end], stride))
    }

    /// The content of a buffer, fetched at the first use and cut to its stated length.
    fn buffer(&mut self, index: usize, view: usize) -> Result<&[u8], LoadError> {
        let Some(buffer) = self.root.buffers.get(index) else {
            let message = format!(
                "refers to buffers[{index}], but the file has {}",
                self.root.buffers.len()
            );
            return Err(element(format!("bufferViews[{view}]"), message));
        };
        if self.buffers[index].is_none() {
            let path = format!("buffers[{index}]");
            let content = match &buffer.uri {
                Some(uri) => Cow::Owned(fetch(uri, &path, self.resolver)?),
                None => match self.binary {
                    Some(binary) if index == 0 => Cow::Borrowed(binary),
                    _ => return Err(self.no_data(path)),
                },
            };
            let stated = usize::try_from(buffer.byte_length.0).unwrap_or(usize::MAX);
            if content.len() < stated {
                return Err(element(
                    path,
                    format!(
                        "byteLength is {stated}, but only {} bytes are there",
                        content.len()
                    ),
                ));
            }
            self.buffers[index] = Some(content);
        }
        let content = self.buffers[index].as_deref().unwrap_or_default();
        let stated = usize::try_from(buffer.byte_length.0).unwrap_or(usize::MAX);
        Ok(&content[..stated.min(content.len())])
    }

    /// The error for data that is nowhere: usually it is compressed by an extension the file merely "uses".
    fn no_data(&self, path: String) -> LoadError {
        let compression = |name: &&String| name.contains("_compression");
        match self.root.extensions_used.iter().find(compression) {
            Some(name) => LoadError::Extension {
                name: super::super::shortened(name),
            },
            None => element(
                path,
                "has no data: neither a buffer view, a uri nor a binary chunk holds it",
            ),
        }
    }
}

fn number(bytes: &[u8], component: ComponentType, normalized: bool) -> f64 {
    fn take<const N: usize>(bytes: &[u8]) -> [u8; N] {
        std::array::from_fn(|k| bytes[k])
    }
    let (value, full) = match component {
        ComponentType::I8 => (f64::from(i8::from_le_bytes(take(bytes))), 127.0),
        ComponentType::U8 => (f64::from(bytes[0]), 255.0),
        ComponentType::I16 => (f64::from(i16::from_le_bytes(take(bytes))), 32767.0),
        ComponentType::U16 => (f64::from(u16::from_le_bytes(take(bytes))), 65535.0),
        ComponentType::U32 => return f64::from(u32::from_le_bytes(take(bytes))),
        ComponentType::F32 => return f64::from(f32::from_le_bytes(take(bytes))),
    };
    if normalized {
        (value / full).max(-1.0)
    } else {
        value
    }
}

/// Data URIs are decoded here, relative paths given to the caller, others refused.
fn fetch(
    uri: &str,
    path: &str,
    resolver: &mut dyn FnMut(&str) -> Result<Vec<u8>, String>,
) -> Result<Vec<u8>, LoadError> {
    if let Some(data) = uri.strip_prefix("data:") {
        let Some((_, encoded)) = data.split_once(";base64,") else {
            return Err(element(path, "its data: URI is not base64"));
        };
        let config =
            GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent);
        return GeneralPurpose::new(&STANDARD, config)
            .decode(encoded.trim_ascii())
            .map_err(|e| element(path, format!("its data: URI is broken: {e}")));
    }
    let shown = super::super::shortened(uri);
    let scheme = uri.split_once(':').is_some_and(|(s, _)| {
        s.len() > 1
            && s.bytes()
                .all(|b| b.is_ascii_alphanumeric() || b"+-.".contains(&b))
    });
    if scheme || uri.starts_with('/') || uri.is_empty() {
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
            let pair = [rest.next()?, rest.next()?];
            u8::from_str_radix(std::str::from_utf8(&pair).ok()?, 16).ok()?
        } else {
            byte
        });
    }
    String::from_utf8(bytes).ok()
}

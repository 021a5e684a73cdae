//! Accessors and buffer views (specification §3.6), each range checked before it is read.

use ::gltf::json::Root;
use ::gltf::json::accessor::{Accessor, ComponentType, Type};
use ::gltf::json::validation::Checked;
use glam::DVec3;

use super::super::{LoadError, MAX_LOADED};
use super::buffer::{Buffers, no_data};
use super::element;

/// Most elements a sparse accessor without buffer view (all zeros but a few) may have.
const MAX_IMPLIED: usize = 1 << 20;

/// Elements read in all, so that many accessors over the same bytes cannot fill memory and time.
const BUDGET: usize = 4 * MAX_LOADED;

/// Most accessors, buffer views and buffers that are looked at to explain a file without triangles.
const MAX_EXPLAINED: usize = 1000;

const UNKNOWN_COMPONENT: &str = "componentType is not one of the specification";

/// The data of a file.
pub(super) struct Data<'a> {
    root: &'a Root,
    buffers: Buffers<'a>,
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
    pub(super) fn new(root: &'a Root, buffers: Buffers<'a>) -> Self {
        Self {
            root,
            buffers,
            budget: BUDGET,
        }
    }

    /// Positions of an accessor.
    pub(super) fn positions(&mut self, index: usize) -> Result<Vec<DVec3>, LoadError> {
        let (accessor, component) = self.typed_accessor(index, Type::Vec3)?;
        if component != ComponentType::F32 {
            let integers = component != ComponentType::U32;
            let quantized = if integers {
                " (KHR_mesh_quantization, which cannot be read here)"
            } else {
                ""
            };
            let message = format!(
                "has positions of integers{quantized}: expected componentType 5126 (FLOAT); export them unquantized"
            );
            return Err(element(format!("accessors[{index}]"), message));
        }
        let decode = |bytes: &[u8]| {
            let (numbers, _) = bytes.as_chunks::<4>();
            DVec3::from_array([0, 1, 2].map(|k| f64::from(f32::from_le_bytes(numbers[k]))))
        };
        let points = self.read(index, accessor, (12, DVec3::ZERO), decode)?;
        match points.iter().position(|p| !p.is_finite()) {
            Some(k) => Err(element(
                format!("accessors[{index}]"),
                format!("element {k} is {}: positions must be finite", points[k]),
            )),
            None => Ok(points),
        }
    }

    /// Indices of an accessor, all below `limit`.
    pub(super) fn indices(&mut self, index: usize, limit: usize) -> Result<Vec<u32>, LoadError> {
        let (accessor, component) = self.typed_accessor(index, Type::Scalar)?;
        let path = format!("accessors[{index}]");
        let restart = match component {
            ComponentType::U8 => u32::from(u8::MAX),
            ComponentType::U16 => u32::from(u16::MAX),
            ComponentType::U32 => u32::MAX,
            _ => {
                let message = "has the wrong componentType: indices must be unsigned integers (5121, 5123 or 5125)";
                return Err(element(path, message));
            }
        };
        let decode = |bytes: &[u8]| unsigned(bytes, component);
        let indices = self.read(index, accessor, (component.size(), 0), decode)?;
        match indices.iter().position(|&v| v as usize >= limit) {
            Some(k) if indices[k] == restart => {
                let message = format!(
                    "element {k} is {restart}, the value that restarts primitives: glTF has no restart, write each \
                     strip as a primitive of its own"
                );
                Err(element(path, message))
            }
            Some(k) => {
                let message = format!(
                    "element {k} is index {}, but there are {limit} positions",
                    indices[k]
                );
                Err(element(path, message))
            }
            None => Ok(indices),
        }
    }

    /// What is wrong with the accessors, buffer views and buffers of a file in which no triangle asks for them.
    pub(super) fn faults(&mut self) -> Vec<LoadError> {
        let root = self.root;
        let accessors = 0..root.accessors.len().min(MAX_EXPLAINED);
        let views = 0..root.buffer_views.len().min(MAX_EXPLAINED);
        let buffers = 0..root.buffers.len().min(MAX_EXPLAINED);
        let mut faults: Vec<LoadError> = accessors.filter_map(|i| self.check(i).err()).collect();
        faults.extend(views.filter_map(|i| self.check_view(i).err()));
        faults.extend(buffers.filter_map(|i| self.buffers.get(i).err()));
        faults
    }

    /// Whether an accessor could be read.
    fn check(&mut self, index: usize) -> Result<(), LoadError> {
        let accessor = &self.root.accessors[index];
        let path = format!("accessors[{index}]");
        let Checked::Valid(component) = accessor.component_type else {
            return Err(element(path, UNKNOWN_COMPONENT));
        };
        let Checked::Valid(kind) = accessor.type_ else {
            return Err(element(path, "type is not one of the specification"));
        };
        if kind == Type::Vec3 && component.0 == ComponentType::F32 {
            return self.positions(index).map(drop);
        }
        let size = kind.multiplicity() * component.0.size();
        self.read(index, accessor, (size, ()), |_| ()).map(drop)
    }

    /// Whether a buffer view lies within its buffer.
    fn check_view(&mut self, view: usize) -> Result<(), LoadError> {
        let all = Span {
            view,
            offset: 0,
            count: 1,
            size: 0,
        };
        self.bytes(&all, &format!("bufferViews[{view}]")).map(drop)
    }

    /// An accessor that exists and has the given type, and its component type.
    fn typed_accessor(
        &self,
        index: usize,
        kind: Type,
    ) -> Result<(&'a Accessor, ComponentType), LoadError> {
        let path = format!("accessors[{index}]");
        let root = self.root;
        let Some(accessor) = root.accessors.get(index) else {
            let message = format!(
                "does not exist: the file has {} accessors",
                root.accessors.len()
            );
            return Err(element(path, message));
        };
        let Checked::Valid(component) = accessor.component_type else {
            return Err(element(path, UNKNOWN_COMPONENT));
        };
        if !matches!(accessor.type_, Checked::Valid(t) if t == kind) {
            let expected = if kind == Type::Vec3 {
                "VEC3 for positions"
            } else {
                "SCALAR for indices"
            };
            return Err(element(
                path,
                format!("has the wrong type: expected {expected}"),
            ));
        }
        Ok((accessor, component.0))
    }

    /// All elements, each `size` bytes long; without a buffer view they are as given.
    fn read<T: Clone>(
        &mut self,
        index: usize,
        accessor: &Accessor,
        (size, absent): (usize, T),
        decode: impl Fn(&[u8]) -> T,
    ) -> Result<Vec<T>, LoadError> {
        let path = format!("accessors[{index}]");
        let count = usize::try_from(accessor.count.0).unwrap_or(usize::MAX);
        let mut values = if let Some(view) = accessor.buffer_view {
            let offset = accessor.byte_offset.map_or(0, |o| o.0);
            let span = Span {
                view: view.value(),
                offset,
                count,
                size,
            };
            // The count is backed by bytes before it makes anything.
            self.bytes(&span, &path)?;
            self.spend(count)?;
            let (bytes, stride) = self.bytes(&span, &path)?;
            (0..count)
                .map(|i| decode(&bytes[i * stride..i * stride + size]))
                .collect()
        } else if accessor.sparse.is_none() {
            return Err(no_data(self.root, path));
        } else if count > MAX_IMPLIED {
            let message = format!("{count} elements without a buffer view: at most {MAX_IMPLIED}");
            return Err(element(path, message));
        } else {
            self.spend(count)?;
            vec![absent; count]
        };
        self.apply_sparse(
            accessor,
            &format!("{path}.sparse"),
            (size, decode),
            &mut values,
        )?;
        Ok(values)
    }

    fn spend(&mut self, count: usize) -> Result<(), LoadError> {
        self.budget = self.budget.checked_sub(count).ok_or(LoadError::TooLarge {
            what: "accessor elements",
            limit: BUDGET,
        })?;
        Ok(())
    }

    /// Replaces single elements (specification §3.6.2.3).
    fn apply_sparse<T>(
        &mut self,
        accessor: &Accessor,
        path: &str,
        (size, decode): (usize, impl Fn(&[u8]) -> T),
        values: &mut [T],
    ) -> Result<(), LoadError> {
        let Some(sparse) = &accessor.sparse else {
            return Ok(());
        };
        let count = usize::try_from(sparse.count.0).unwrap_or(usize::MAX);
        let Checked::Valid(kind) = sparse.indices.component_type else {
            let message = "componentType of the indices is not an unsigned integer";
            return Err(element(path, message));
        };
        let kind = kind.0;
        let span = Span {
            view: sparse.indices.buffer_view.value(),
            offset: sparse.indices.byte_offset.0,
            count,
            size: kind.size(),
        };
        self.bytes(&span, path)?;
        self.spend(count)?;
        let (bytes, stride) = self.bytes(&span, path)?;
        let targets: Vec<usize> = (0..count)
            .map(|i| unsigned(&bytes[i * stride..], kind) as usize)
            .collect();
        if let Some(i) = targets.windows(2).position(|w| w[1] <= w[0]) {
            let (this, next) = (targets[i], targets[i + 1]);
            let message = format!(
                "index {} is {next}, behind {this}: sparse indices must increase",
                i + 1
            );
            return Err(element(path, message));
        }
        let span = Span {
            view: sparse.values.buffer_view.value(),
            offset: sparse.values.byte_offset.0,
            count,
            size,
        };
        let (bytes, stride) = self.bytes(&span, path)?;
        for (i, target) in targets.into_iter().enumerate() {
            let total = values.len();
            let Some(value) = values.get_mut(target) else {
                let message =
                    format!("index {i} is {target}, but the accessor has {total} elements");
                return Err(element(path, message));
            };
            *value = decode(&bytes[i * stride..i * stride + size]);
        }
        Ok(())
    }

    /// The bytes from the first element on, long enough for all of them, and the distance between elements.
    fn bytes(&mut self, span: &Span, path: &str) -> Result<(&[u8], usize), LoadError> {
        let root = self.root;
        let Some(view) = root.buffer_views.get(span.view) else {
            let count = root.buffer_views.len();
            let message = format!(
                "refers to bufferViews[{}], but the file has {count}",
                span.view
            );
            return Err(element(path, message));
        };
        let view_path = format!("bufferViews[{}]", span.view);
        let stride = view.byte_stride.map_or(span.size, |s| s.0);
        if stride < span.size {
            let size = span.size;
            let message = format!(
                "byteStride {stride} is smaller than the {size} bytes of an element of {path}"
            );
            return Err(element(view_path, message));
        }
        let (start, length) = (view.byte_offset.map_or(0, |o| o.0), view.byte_length.0);
        let needed = (span.count as u64)
            .saturating_sub(1)
            .checked_mul(stride as u64)
            .and_then(|n| n.checked_add(span.size as u64)?.checked_add(span.offset));
        if span.count > 0 && needed.is_none_or(|n| n > length) {
            let count = span.count;
            let message =
                format!("{count} elements do not fit in the {length} bytes of {view_path}");
            return Err(element(path, message));
        }
        let index = view.buffer.value();
        if index >= root.buffers.len() {
            let count = root.buffers.len();
            let message = format!("refers to buffers[{index}], but the file has {count}");
            return Err(element(view_path, message));
        }
        let buffer = self.buffers.get(index)?;
        let end = start
            .checked_add(length)
            .and_then(|e| usize::try_from(e).ok());
        let Some(content) = end.and_then(|end| buffer.get(usize::try_from(start).ok()?..end))
        else {
            let message = format!(
                "bytes {start} to {} lie beyond the {} of buffers[{index}]",
                start.saturating_add(length),
                buffer.len()
            );
            return Err(element(view_path, message));
        };
        let first = usize::try_from(span.offset).unwrap_or(usize::MAX);
        Ok((content.get(first..).unwrap_or_default(), stride))
    }
}

/// The unsigned integer at the start of `bytes`, which are long enough.
fn unsigned(bytes: &[u8], component: ComponentType) -> u32 {
    match component {
        ComponentType::U8 => u32::from(bytes[0]),
        ComponentType::U16 => u32::from(u16::from_le_bytes([bytes[0], bytes[1]])),
        _ => u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]),
    }
}

//! glTF 2.0 and GLB (Khronos, "glTF 2.0 Specification", 2.0.1): the triangles of the scene.
//!
//! The `gltf` crate supplies the JSON types only. Its reader trusts the file (a 12-byte GLB makes it reserve
//! 4 GiB, a missing accessor makes it panic, node cycles pass), so container, scene graph and accessors are
//! read here with every range checked. Materials and textures are never touched; buffers are asked for only
//! when triangles need them.

mod accessor;
mod buffer;
mod document;
mod glb;
mod scene;

use std::collections::HashMap;

use ::gltf::json::Root;
use ::gltf::json::mesh::{Mode, Primitive, Semantic};
use ::gltf::json::validation::Checked;
use glam::{DAffine3, DVec3};

use super::validate::{Draft, limited};
use super::{LoadError, LoadReport, Loaded};
use crate::digits::point;
use crate::triangle_mesh::MAX_COORDINATE;
use accessor::Data;
use buffer::Buffers;
use scene::Placement;

/// Most primitives placed: instances of meshes of many empty primitives must not take for ever.
const MAX_PRIMITIVES: usize = 1 << 20;

/// Reads a glTF (JSON) or GLB file: the default scene, or all scenes where none is marked, as one mesh in the
/// file's unit (metres by the specification) with its node transforms applied. `resolver` gets the decoded
/// relative path of an external buffer and returns its bytes.
///
/// # Errors
/// Whatever is missing, out of range, unsupported or not glTF 2, with the element; no triangles.
pub fn gltf(
    bytes: &[u8],
    resolver: &mut dyn FnMut(&str) -> Result<Vec<u8>, String>,
) -> Result<Loaded, LoadError> {
    let mut report = LoadReport::default();
    let container = glb::split(bytes, &mut report)?;
    let root = document::parse(container.json, &mut report)?;
    let placements = scene::placements(&root, &mut report)?;
    let mut builder = Builder {
        data: Data::new(&root, Buffers::new(&root, container.binary, resolver)),
        cache: HashMap::new(),
        draft: Draft {
            report,
            ..Draft::default()
        },
    };
    let primitives = |p: &Placement| root.meshes[p.mesh].primitives.len().max(1);
    let count = placements
        .iter()
        .map(primitives)
        .fold(0, usize::saturating_add);
    if count > MAX_PRIMITIVES {
        let (what, limit) = ("instances of primitives", MAX_PRIMITIVES);
        return Err(LoadError::TooLarge { what, limit });
    }
    for placement in &placements {
        builder.place(&root, placement)?;
    }
    builder.finish(&root)
}

fn element(path: impl Into<String>, message: impl Into<String>) -> LoadError {
    LoadError::Element {
        element: path.into(),
        message: message.into(),
    }
}

/// Positions of one accessor and, per position, the vertex it became in the placement being built.
struct Shared {
    points: Vec<DVec3>,
    vertex: Vec<u32>,
    used: Vec<u32>,
}

struct Builder<'a> {
    data: Data<'a>,
    cache: HashMap<usize, Shared>,
    draft: Draft,
}

impl Builder<'_> {
    /// Appends the triangles of one mesh at one node.
    fn place(&mut self, root: &Root, placement: &Placement) -> Result<(), LoadError> {
        for (i, primitive) in root.meshes[placement.mesh].primitives.iter().enumerate() {
            let path = format!("meshes[{}].primitives[{i}]", placement.mesh);
            if primitive.targets.as_ref().is_some_and(|t| !t.is_empty()) {
                self.draft
                    .report
                    .note("primitives loaded without their morph targets", &path);
            }
            let mode = match primitive.mode {
                Checked::Valid(mode) => mode,
                Checked::Invalid => return Err(element(path, "mode is none of 0 to 6")),
            };
            if matches!(
                mode,
                Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip
            ) {
                self.draft
                    .report
                    .note("primitives of points or lines skipped", path);
                continue;
            }
            let Some(position) = primitive
                .attributes
                .get(&Checked::Valid(Semantic::Positions))
            else {
                self.draft
                    .report
                    .note("primitives without POSITION skipped", path);
                continue;
            };
            self.primitive(primitive, position.value(), (mode, &path), placement)?;
        }
        Ok(())
    }

    fn primitive(
        &mut self,
        primitive: &Primitive,
        position: usize,
        (mode, path): (Mode, &str),
        placement: &Placement,
    ) -> Result<(), LoadError> {
        let mut shared = match self.cache.remove(&position) {
            Some(shared) => shared,
            None => Shared::new(self.data.positions(position)?),
        };
        let count = shared.points.len();
        let corners: Vec<u32> = match primitive.indices {
            Some(index) => self.data.indices(index.value(), count)?,
            None => (0..).take(count).collect(),
        };
        let (mut triangles, left_over, collapsed) = triangles_of(mode, &corners);
        if left_over {
            self.draft.report.note(
                "primitives with incomplete last triangle: rest ignored",
                path,
            );
        }
        if collapsed {
            self.draft.report.note(
                "strips or fans with repeated corners: those triangles dropped",
                path,
            );
        }
        limited("triangles", self.draft.triangles.len() + triangles.len())?;
        if placement.mirrored {
            for [_, b, c] in &mut triangles {
                std::mem::swap(b, c);
            }
        }
        let first = self.draft.positions.len();
        for corners in triangles {
            let placed = corners.map(|v| {
                shared.vertex_for(v, &mut self.draft.positions, &placement.world_from_mesh)
            });
            self.draft.triangles.push(placed);
        }
        shared.forget();
        self.cache.insert(position, shared);
        let placed = &self.draft.positions[first..];
        let unfit = |p: &&DVec3| p.is_nan() || p.abs().max_element() >= MAX_COORDINATE;
        if let Some(p) = placed.iter().find(unfit) {
            let message = format!(
                "its transforms take a vertex of {path} to {}: coordinates must be finite and below {MAX_COORDINATE:e}",
                point(*p)
            );
            return Err(element(format!("nodes[{}]", placement.node), message));
        }
        limited("vertices", self.draft.positions.len())
    }

    fn finish(mut self, root: &Root) -> Result<Loaded, LoadError> {
        if self.draft.triangles.is_empty() {
            for fault in self.data.faults() {
                self.draft
                    .report
                    .note("faults in data without triangles", fault);
            }
        }
        let (meshes, nodes) = (root.meshes.len(), root.nodes.len());
        self.draft
            .validated(|| format!("the file has {meshes} mesh(es) and {nodes} node(s)"))
    }
}

impl Shared {
    fn new(points: Vec<DVec3>) -> Self {
        Self {
            vertex: vec![u32::MAX; points.len()],
            points,
            used: Vec::new(),
        }
    }

    fn vertex_for(
        &mut self,
        local: u32,
        positions: &mut Vec<DVec3>,
        world_from_mesh: &DAffine3,
    ) -> u32 {
        let slot = &mut self.vertex[local as usize];
        if *slot == u32::MAX {
            *slot = u32::try_from(positions.len()).expect("three per triangle of at most 2^22");
            positions.push(world_from_mesh.transform_point3(self.points[local as usize]));
            self.used.push(local);
        }
        *slot
    }

    /// Ready for the next placement, in a time that depends on what this one used.
    fn forget(&mut self) {
        for local in self.used.drain(..) {
            self.vertex[local as usize] = u32::MAX;
        }
    }
}

/// Triangles of a triangle list, strip or fan (specification §3.7.2.1); whether corners were left over, and
/// whether triangles with repeated corners (stitches of strips) were dropped.
fn triangles_of(mode: Mode, corners: &[u32]) -> (Vec<[u32; 3]>, bool, bool) {
    let proper = |t: &[u32; 3]| t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
    let all: Vec<[u32; 3]> = match mode {
        Mode::TriangleStrip => corners
            .windows(3)
            .enumerate()
            .map(|(i, w)| {
                if i % 2 == 0 {
                    [w[0], w[1], w[2]]
                } else {
                    [w[0], w[2], w[1]]
                }
            })
            .collect(),
        Mode::TriangleFan => corners
            .get(1..)
            .unwrap_or_default()
            .windows(2)
            .map(|w| [w[0], w[1], corners[0]])
            .collect(),
        _ => {
            let (whole, rest) = corners.as_chunks::<3>();
            return (whole.to_vec(), !rest.is_empty(), false);
        }
    };
    let count = all.len();
    let kept: Vec<[u32; 3]> = all.into_iter().filter(proper).collect();
    let collapsed = kept.len() < count;
    (kept, count == 0, collapsed)
}

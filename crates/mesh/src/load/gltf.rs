//! glTF 2.0 and GLB (Khronos, "glTF 2.0 Specification", 2.0.1): the triangles of the scene.
//!
//! The `gltf` crate supplies the JSON types only. Its reader trusts the file (a 12-byte GLB makes it reserve
//! 4 GiB, a missing accessor makes it panic, node cycles pass), so container, scene graph and accessors are
//! read here with every range checked. Materials and textures are never touched; buffers are asked for only
//! when triangles need them.

mod accessor;
mod glb;
mod scene;

use std::collections::HashMap;
use std::rc::Rc;

use ::gltf::json::Root;
use ::gltf::json::mesh::{Mode, Primitive, Semantic};
use ::gltf::json::validation::Checked;
use glam::{DAffine3, DVec3};

use super::{LoadError, LoadReport, Loaded, MAX_LOADED};
use crate::TriangleMesh;
use accessor::Data;
use scene::Placement;

/// Required extensions that change nothing about the shape of a model start like this.
const HARMLESS: [&str; 4] = [
    "KHR_materials_",
    "KHR_texture_",
    "EXT_texture_",
    "KHR_lights_",
];

/// Allows integer positions, which are read here.
const QUANTIZATION: &str = "KHR_mesh_quantization";

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
    let root = Root::from_slice(container.json).map_err(|e| LoadError::Json {
        line: e.line(),
        column: e.column(),
        message: e.to_string(),
    })?;
    check_header(&root)?;
    let placements = scene::placements(&root, &mut report)?;
    let mut builder = Builder {
        data: Data::new(&root, container.binary, resolver),
        cache: HashMap::new(),
        positions: Vec::new(),
        triangles: Vec::new(),
        report,
    };
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

fn check_header(root: &Root) -> Result<(), LoadError> {
    let version = &root.asset.version;
    let parts = version.split_once('.');
    let digits = |s: &str| !s.is_empty() && s.bytes().all(|b| b.is_ascii_digit());
    if !parts.is_some_and(|(major, minor)| major == "2" && digits(minor)) {
        return Err(element(
            "asset.version",
            format!("`{}`: expected 2.0", super::shortened(version)),
        ));
    }
    if let Some(min) = root.asset.min_version.as_ref().filter(|v| *v != "2.0") {
        return Err(element(
            "asset.minVersion",
            format!("`{}`: only 2.0 is supported", super::shortened(min)),
        ));
    }
    let known =
        |name: &String| name == QUANTIZATION || HARMLESS.iter().any(|h| name.starts_with(h));
    match root.extensions_required.iter().find(|name| !known(name)) {
        Some(name) => Err(LoadError::Extension {
            name: super::shortened(name),
        }),
        None => Ok(()),
    }
}

/// Positions of one accessor and, per position, the vertex it became in the placement being built.
struct Shared {
    points: Rc<Vec<DVec3>>,
    vertex: Vec<u32>,
    used: Vec<u32>,
}

struct Builder<'a> {
    data: Data<'a>,
    cache: HashMap<usize, Shared>,
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    report: LoadReport,
}

impl Builder<'_> {
    /// Appends the triangles of one mesh at one node.
    fn place(&mut self, root: &Root, placement: &Placement) -> Result<(), LoadError> {
        for (i, primitive) in root.meshes[placement.mesh].primitives.iter().enumerate() {
            let path = format!("meshes[{}].primitives[{i}]", placement.mesh);
            if primitive.targets.as_ref().is_some_and(|t| !t.is_empty()) {
                self.report
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
                self.report
                    .note("primitives of points or lines skipped", path);
                continue;
            }
            let Some(position) = primitive
                .attributes
                .get(&Checked::Valid(Semantic::Positions))
            else {
                self.report
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
            None => self.data.positions(position)?,
        };
        let count = shared.points.len();
        let corners: Vec<u32> = match primitive.indices {
            Some(index) => self.data.indices(index.value(), count)?,
            None => (0..).take(count).collect(),
        };
        let (mut triangles, left_over, collapsed) = triangles_of(mode, &corners);
        if left_over {
            self.report.note(
                "primitives with incomplete last triangle: rest ignored",
                path,
            );
        }
        if collapsed {
            self.report.note(
                "strips or fans with repeated corners: those triangles dropped",
                path,
            );
        }
        if self.triangles.len() + triangles.len() > MAX_LOADED {
            let (what, limit) = ("triangles", MAX_LOADED);
            return Err(LoadError::TooLarge { what, limit });
        }
        if placement.mirrored {
            for [_, b, c] in &mut triangles {
                std::mem::swap(b, c);
            }
        }
        for corners in triangles {
            let placed = corners
                .map(|v| shared.vertex_for(v, &mut self.positions, &placement.world_from_mesh));
            self.triangles.push(placed);
        }
        shared.forget();
        self.cache.insert(position, shared);
        Ok(())
    }

    fn finish(self, root: &Root) -> Result<Loaded, LoadError> {
        if self.triangles.is_empty() {
            let notes: Vec<String> = self.report.notes.iter().map(ToString::to_string).collect();
            let counts = format!(
                "the file has {} meshes and {} nodes",
                root.meshes.len(),
                root.nodes.len()
            );
            let found = if notes.is_empty() {
                counts
            } else {
                format!("{counts}; {}", notes.join("; "))
            };
            return Err(LoadError::NoTriangles { found });
        }
        Ok(Loaded {
            mesh: TriangleMesh::new(self.positions, self.triangles)?,
            report: self.report,
        })
    }
}

impl Shared {
    fn new(points: Vec<DVec3>) -> Self {
        Self {
            vertex: vec![u32::MAX; points.len()],
            points: Rc::new(points),
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
            *slot = u32::try_from(positions.len()).expect("three per triangle of at most 2^24");
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

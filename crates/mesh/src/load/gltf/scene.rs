//! The scene graph (specification §3.5): which mesh stands where.

use ::gltf::json::Root;
use ::gltf::json::scene::Node;
use glam::{DAffine3, DMat3, DQuat, DVec3};

use super::super::{LoadError, LoadReport};
use super::element;

/// Most nodes visited: a node below several parents is visited once for each, which can double per level.
const MAX_VISITS: usize = 1 << 18;

/// Determinants up to this, with columns of unit length, are rounding: the columns lie in one plane.
const SINGULAR: f64 = 1e-12;

/// A mesh at a node.
pub(super) struct Placement {
    pub(super) mesh: usize,
    /// The node; 0 for meshes without one.
    pub(super) node: usize,
    pub(super) world_from_mesh: DAffine3,
    /// The transform turns left into right, so triangles must be turned back.
    pub(super) mirrored: bool,
}

/// All mesh nodes below the roots of the scene, in depth-first order of the file.
pub(super) fn placements(
    root: &Root,
    report: &mut LoadReport,
) -> Result<Vec<Placement>, LoadError> {
    let has_parent = check_graph(root, report)?;
    let roots = scene_roots(root, &has_parent, report)?;
    let mut placements = Vec::new();
    let mut stack: Vec<(usize, DAffine3)> = roots
        .iter()
        .rev()
        .map(|&n| (n, DAffine3::IDENTITY))
        .collect();
    let mut visits = 0;
    while let Some((index, world_from_parent)) = stack.pop() {
        visits += 1;
        check_visits(visits)?;
        let node = &root.nodes[index];
        let world_from_mesh = world_from_parent * local_transform(node, index, report)?;
        if let Some(mesh) = node.mesh {
            let mesh = mesh.value();
            if mesh >= root.meshes.len() {
                return Err(missing(
                    format!("nodes[{index}].mesh"),
                    mesh,
                    root.meshes.len(),
                    "meshes",
                ));
            }
            if node.skin.is_some() {
                report.note(
                    "skins ignored: the mesh stands as modelled",
                    format!("nodes[{index}]"),
                );
            }
            let determinant = relative_determinant(&world_from_mesh);
            if !determinant.is_finite() || !world_from_mesh.translation.is_finite() {
                let message = "the product of its transform and those above it overflows";
                return Err(element(format!("nodes[{index}]"), message));
            }
            if determinant.abs() <= SINGULAR {
                report.note(
                    "meshes skipped whose nodes press them flat (a singular transform)",
                    format!("nodes[{index}]"),
                );
            } else {
                let mirrored = determinant < 0.0;
                placements.push(Placement {
                    mesh,
                    node: index,
                    world_from_mesh,
                    mirrored,
                });
            }
        }
        let children = node.children.iter().flatten().rev();
        stack.extend(children.map(|c| (c.value(), world_from_mesh)));
    }
    if placements.is_empty() && root.nodes.is_empty() {
        placements = meshes_alone(root, report);
    }
    Ok(placements)
}

/// Determinant of the linear part over the lengths of its columns (mesh.15): 1 without shear, 0 for a transform that
/// presses space flat, negative for one that mirrors it, whatever the scale. Infinite or NaN when it overflows.
fn relative_determinant(a_from_b: &DAffine3) -> f64 {
    let m = a_from_b.matrix3;
    let columns = [m.x_axis, m.y_axis, m.z_axis];
    if !columns.iter().all(|c| c.is_finite()) {
        return f64::NAN;
    }
    // Twice, because the square of a very small or large length leaves the range of f64.
    let [x, y, z] = columns.map(|c| {
        let scaled = c / c.abs().max_element();
        scaled / scaled.length()
    });
    let determinant = x.dot(y.cross(z));
    if determinant.is_nan() {
        0.0
    } else {
        determinant
    }
}

fn check_visits(visits: usize) -> Result<(), LoadError> {
    if visits <= MAX_VISITS {
        return Ok(());
    }
    Err(LoadError::TooLarge {
        what: "instances of nodes",
        limit: MAX_VISITS,
    })
}

/// Every mesh at the origin, for files that have no nodes.
fn meshes_alone(root: &Root, report: &mut LoadReport) -> Vec<Placement> {
    let place = |mesh| {
        report.note(
            "meshes without a node placed at the origin",
            format!("meshes[{mesh}]"),
        );
        Placement {
            mesh,
            node: 0,
            world_from_mesh: DAffine3::IDENTITY,
            mirrored: false,
        }
    };
    (0..root.meshes.len()).map(place).collect()
}

fn missing(path: String, index: usize, count: usize, what: &str) -> LoadError {
    element(
        path,
        format!("refers to number {index}, but the file has {count} {what}"),
    )
}

/// No node is its own ancestor; returns which have a parent. A node with several parents breaks the
/// specification, but exporters use it for instances and its meaning is plain: one instance below each.
fn check_graph(root: &Root, report: &mut LoadReport) -> Result<Vec<bool>, LoadError> {
    let count = root.nodes.len();
    let mut parents = vec![0_usize; count];
    for (index, node) in root.nodes.iter().enumerate() {
        for (k, child) in node.children.iter().flatten().enumerate() {
            let Some(number) = parents.get_mut(child.value()) else {
                let path = format!("nodes[{index}].children[{k}]");
                return Err(missing(path, child.value(), count, "nodes"));
            };
            *number += 1;
            if *number == 2 {
                report.note(
                    "nodes with several parents placed below each",
                    format!("nodes[{}]", child.value()),
                );
            }
        }
    }
    let has_parent = parents.iter().map(|&n| n > 0).collect();
    // Nodes are taken away once all their parents are (A. B. Kahn 1962); what remains is on or below a loop.
    let mut stack: Vec<usize> = (0..count).filter(|&n| parents[n] == 0).collect();
    while let Some(index) = stack.pop() {
        for child in root.nodes[index].children.iter().flatten() {
            let child = child.value();
            parents[child] -= 1;
            if parents[child] == 0 {
                stack.push(child);
            }
        }
    }
    match parents.iter().position(|&n| n > 0) {
        Some(index) => Err(element(
            format!("nodes[{index}]"),
            "is on or below a loop of nodes: none may be its own ancestor",
        )),
        None => Ok(has_parent),
    }
}

/// Roots of the default scene; of all scenes where none is marked; all nodes without parent where there are
/// no scenes.
fn scene_roots(
    root: &Root,
    has_parent: &[bool],
    report: &mut LoadReport,
) -> Result<Vec<usize>, LoadError> {
    let chosen = match root.scene {
        Some(scene) if scene.value() >= root.scenes.len() => {
            return Err(missing(
                "scene".to_owned(),
                scene.value(),
                root.scenes.len(),
                "scenes",
            ));
        }
        Some(scene) => scene.value()..scene.value() + 1,
        None => 0..root.scenes.len(),
    };
    if root.scenes.is_empty() {
        return Ok((0..has_parent.len()).filter(|&n| !has_parent[n]).collect());
    }
    if chosen.len() < root.scenes.len() {
        report.note(
            "files with several scenes: only the default scene loaded",
            format!("scenes[{}]", chosen.start),
        );
    }
    let mut roots = Vec::new();
    let mut taken = vec![false; has_parent.len()];
    for scene in chosen {
        for (k, node) in root.scenes[scene].nodes.iter().enumerate() {
            let (node, path) = (node.value(), format!("scenes[{scene}].nodes[{k}]"));
            match has_parent.get(node) {
                None => return Err(missing(path, node, has_parent.len(), "nodes")),
                Some(true) => {
                    return Err(element(
                        path,
                        format!("node {node} is the child of a node, not a root"),
                    ));
                }
                Some(false) if taken[node] => {}
                Some(false) => {
                    taken[node] = true;
                    roots.push(node);
                }
            }
        }
    }
    Ok(roots)
}

fn local_transform(
    node: &Node,
    index: usize,
    report: &mut LoadReport,
) -> Result<DAffine3, LoadError> {
    let fault = |what: &str| element(format!("nodes[{index}]"), what);
    if let Some(m) = node.matrix {
        let m = m.map(f64::from);
        if !m.iter().all(|x| x.is_finite()) {
            return Err(fault("matrix has a coefficient that is not finite"));
        }
        #[expect(
            clippy::float_cmp,
            reason = "the specification demands this last row exactly"
        )]
        if [m[3], m[7], m[11], m[15]] != [0.0, 0.0, 0.0, 1.0] {
            return Err(fault("the last row of matrix must be 0 0 0 1"));
        }
        let column = |k: usize| DVec3::new(m[k], m[k + 1], m[k + 2]);
        return Ok(DAffine3::from_mat3_translation(
            DMat3::from_cols(column(0), column(4), column(8)),
            column(12),
        ));
    }
    let three = |v: Option<[f32; 3]>, default: f64| {
        v.map_or(DVec3::splat(default), |v| {
            DVec3::from_array(v.map(f64::from))
        })
    };
    let (translation, scale) = (three(node.translation, 0.0), three(node.scale, 1.0));
    let rotation = node
        .rotation
        .map_or(DQuat::IDENTITY, |q| DQuat::from_array(q.0.map(f64::from)));
    if !translation.is_finite() || !scale.is_finite() || !rotation.is_finite() {
        return Err(fault("translation, rotation or scale is not finite"));
    }
    let length = rotation.length();
    if !(1e-6..1e6).contains(&length) {
        return Err(fault("rotation is no quaternion: its length must be 1"));
    }
    if (length - 1.0).abs() > 1e-3 {
        report.note(
            "rotations brought to unit length",
            format!("nodes[{index}]"),
        );
    }
    Ok(DAffine3::from_scale_rotation_translation(
        scale,
        rotation.normalize(),
        translation,
    ))
}

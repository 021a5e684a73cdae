//! The last step of every reader: what it read becomes a mesh, or the reason why it cannot.

use glam::DVec3;

use super::{LoadError, LoadReport, Loaded, MAX_LOADED};
use crate::triangle_mesh::without_unused;
use crate::{Soundness, TriangleMesh};

/// Positions and triangles on their way into a mesh; no reader gets more of them than [`MAX_LOADED`].
#[derive(Debug, Default)]
pub(super) struct Draft {
    pub(super) positions: Vec<DVec3>,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) report: LoadReport,
}

impl Draft {
    /// Checks that the triangles exist, that every index and coordinate is one a mesh can have, drops vertices
    /// that no triangle uses, and looks at what came out. `contents` says what the file holds.
    ///
    /// # Errors
    /// No triangles; a coordinate that is not finite or too large; an index out of range; too many elements.
    pub(super) fn validated(self, contents: impl FnOnce() -> String) -> Result<Loaded, LoadError> {
        if self.triangles.is_empty() {
            return Err(self.report.nothing_found(contents()));
        }
        limited("triangles", self.triangles.len())?;
        let checked = TriangleMesh::new(self.positions, self.triangles)?;
        let mesh = without_unused(checked);
        limited("vertices", mesh.positions().len())?;
        Ok(Loaded {
            soundness: Soundness::of(&mesh),
            mesh,
            report: self.report,
        })
    }
}

/// Refuses more elements than a reader may make.
pub(super) fn limited(what: &'static str, count: usize) -> Result<(), LoadError> {
    if count > MAX_LOADED {
        let limit = MAX_LOADED;
        return Err(LoadError::TooLarge { what, limit });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::Draft;
    use crate::load::{LoadError, LoadReport};
    use crate::{MeshError, Winding};
    use glam::DVec3;

    fn draft(positions: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Draft {
        Draft {
            positions,
            triangles,
            report: LoadReport::default(),
        }
    }

    #[test]
    fn what_is_no_mesh_is_refused() {
        let contents = || "2 vertices".to_owned();
        let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
        let error = draft(corners.clone(), vec![])
            .validated(contents)
            .unwrap_err();
        assert_eq!(error.to_string(), "no triangles: 2 vertices");
        let error = draft(corners.clone(), vec![[0, 1, 3]]).validated(contents);
        assert!(matches!(
            error,
            Err(LoadError::Mesh(MeshError::IndexOutOfRange {
                vertex: 3,
                ..
            }))
        ));
        for bad in [f64::NAN, f64::INFINITY, 1e300, -1e16] {
            let mut positions = corners.clone();
            positions[1].y = bad;
            let error = draft(positions, vec![[0, 1, 2]]).validated(contents);
            assert!(matches!(
                error,
                Err(LoadError::Mesh(MeshError::BadPosition { vertex: 1, .. }))
            ));
        }
    }

    #[test]
    fn says_what_the_triangles_are_like() {
        // A tetrahedron inside out, every triangle with corners of its own, and a flat triangle apart.
        let p = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let faces = [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]];
        let mut positions: Vec<DVec3> = faces.as_flattened().iter().map(|&v| p[v]).collect();
        let mut triangles: Vec<[u32; 3]> = (0..4).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let loaded = draft(positions.clone(), triangles.clone());
        let sound = loaded.validated(String::new).unwrap().soundness;
        assert_eq!((sound.shells, sound.winding), (1, Winding::Inward));
        assert_eq!(sound.degenerate_triangles, 0);

        positions.extend([9.0, 10.0, 11.0, 12.0].map(DVec3::splat));
        triangles.push([12, 13, 14]);
        let loaded = draft(positions, triangles).validated(String::new).unwrap();
        assert_eq!(loaded.soundness.shells, 2);
        assert_eq!(loaded.soundness.degenerate_triangles, 1);
        assert_eq!(loaded.mesh.positions().len(), 15, "one vertex is not used");
    }
}

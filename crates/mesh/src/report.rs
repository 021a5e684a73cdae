//! What a mesh is: the facts `pliant check` prints, gathered without refusing anything.

use glam::DVec3;

use crate::edge_table::EdgeTable;
use crate::{
    CONVEXITY_TOLERANCE, ConvexMesh, ConvexityError, HalfEdgeMesh, TopologyError, TriangleMesh,
    WeldReport,
};

/// Which way the triangles of a mesh face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Winding {
    /// Closed, counter-clockwise seen from outside: the volume is positive.
    Outward,
    /// Closed, but inside out.
    Inward,
    /// Neighbours are wound in opposite senses.
    Inconsistent,
    /// The surface has borders, so it has no outside.
    Open,
}

/// Facts about a mesh after welding equal positions. Lengths in the unit of the mesh.
#[derive(Clone, Debug)]
pub struct MeshReport {
    /// Vertices that triangles use, equal positions counted once.
    pub vertices: usize,
    /// Triangles with three different corners.
    pub faces: usize,
    /// Undirected edges.
    pub edges: usize,
    /// Pieces that share no vertex.
    pub shells: usize,
    /// Every edge has two triangles or more.
    pub closed: bool,
    /// Why it is no manifold, if so.
    pub manifold: Result<(), TopologyError>,
    /// Open borders; counted for manifolds only.
    pub boundary_loops: Option<usize>,
    /// Triangles of the mesh as given that have no area to speak of.
    pub degenerate_triangles: usize,
    /// Which way the triangles face.
    pub winding: Winding,
    /// Why it is not convex within [`CONVEXITY_TOLERANCE`], if so.
    pub convex: Result<(), ConvexityError>,
    /// Lengths of the bounding box.
    pub size: DVec3,
    /// Enclosed volume; negative when inside out, without meaning unless closed.
    pub signed_volume: f64,
    /// Sum of the triangles' areas.
    pub surface_area: f64,
    /// V − E + F.
    pub euler_number: i64,
    /// What welding equal positions changed.
    pub weld: WeldReport,
}

/// What every loader looks at: whether the triangles can be relied upon. Equal positions count as one vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Soundness {
    /// Triangles that have no area to speak of.
    pub degenerate_triangles: usize,
    /// Pieces that share no vertex.
    pub shells: usize,
    /// Which way the triangles face.
    pub winding: Winding,
}

impl Soundness {
    /// Looks at a mesh as it is, unwelded vertices joined.
    pub fn of(mesh: &TriangleMesh) -> Self {
        let welded = mesh.joined();
        Self {
            degenerate_triangles: mesh.degenerate_triangles().len(),
            shells: welded.shells(),
            winding: Edges::of(&welded).winding(welded.signed_volume()),
        }
    }
}

/// Gathers the facts about a mesh; equal positions count as one vertex.
pub fn inspect(mesh: &TriangleMesh) -> MeshReport {
    let degenerate_triangles = mesh.degenerate_triangles().len();
    let (welded, weld) = mesh.welded(0.0);
    let edges = Edges::of(&welded);
    let signed_volume = welded.signed_volume();
    let (vertices, faces) = (welded.positions().len(), welded.triangles().len());
    let (shells, surface_area) = (welded.shells(), welded.surface_area());
    let size = welded.bounds().size();
    let topology = HalfEdgeMesh::new(&welded);
    // Two copies of a large mesh less while convexity is tested.
    drop(welded);
    MeshReport {
        vertices,
        faces,
        edges: edges.count,
        shells,
        closed: edges.closed,
        boundary_loops: topology.as_ref().ok().map(|t| t.boundary_loops().len()),
        manifold: topology.as_ref().map(|_| ()).map_err(Clone::clone),
        degenerate_triangles,
        winding: edges.winding(signed_volume),
        convex: topology
            .map_err(ConvexityError::from)
            .and_then(|t| ConvexMesh::new(t, CONVEXITY_TOLERANCE))
            .map(|_| ()),
        size,
        signed_volume,
        surface_area,
        euler_number: (vertices.cast_signed() - edges.count.cast_signed() + faces.cast_signed())
            as i64,
        weld,
    }
}

/// Edge facts that hold for any triangles, manifold or not (mesh.3).
struct Edges {
    count: usize,
    closed: bool,
    inconsistent: bool,
}

impl Edges {
    fn of(mesh: &TriangleMesh) -> Self {
        let origin = mesh.triangles().as_flattened();
        let mut edges = Self {
            count: 0,
            closed: true,
            inconsistent: false,
        };
        for (low, halves) in EdgeTable::new(mesh.triangles(), mesh.positions().len()).edges() {
            let up = halves
                .iter()
                .filter(|h| origin[h.1 as usize] == low)
                .count();
            edges.count += 1;
            edges.closed &= halves.len() >= 2;
            edges.inconsistent |= halves.len() >= 2 && 2 * up != halves.len();
        }
        edges
    }

    fn winding(&self, signed_volume: f64) -> Winding {
        if self.inconsistent {
            Winding::Inconsistent
        } else if !self.closed {
            Winding::Open
        } else if signed_volume < 0.0 {
            Winding::Inward
        } else {
            Winding::Outward
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Winding, inspect};
    use crate::{TriangleMesh, generate};
    use glam::DVec3;

    #[test]
    fn tells_what_a_tube_is() {
        let tube = generate::tube(2.0, 1.0, 5.0, 16).unwrap();
        let report = inspect(&tube);
        assert_eq!(
            (report.vertices, report.edges, report.faces),
            (64, 192, 128)
        );
        assert_eq!(
            (report.shells, report.euler_number, report.boundary_loops),
            (1, 0, Some(0))
        );
        assert!(report.closed && report.manifold.is_ok() && report.convex.is_err());
        assert_eq!(report.winding, Winding::Outward);
        assert_eq!(report.size, DVec3::new(5.0, 4.0, 4.0));
        assert_eq!(inspect(&tube.reversed()).winding, Winding::Inward);
    }

    #[test]
    fn welds_before_it_counts() {
        let cube = generate::cuboid(DVec3::ONE).unwrap();
        let soup: Vec<DVec3> = cube
            .triangles()
            .iter()
            .flatten()
            .map(|&v| cube.positions()[v as usize])
            .collect();
        let triangles: Vec<[u32; 3]> = (0..12).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let report = inspect(&TriangleMesh::new(soup.clone(), triangles.clone()).unwrap());
        assert_eq!((report.vertices, report.weld.merged_vertices), (8, 28));
        assert!(report.closed && report.convex.is_ok());

        let mut turned = triangles.clone();
        turned[0].swap(0, 1);
        let report = inspect(&TriangleMesh::new(soup.clone(), turned).unwrap());
        assert_eq!(report.winding, Winding::Inconsistent);
        assert!(report.closed && report.manifold.is_err());

        let report = inspect(&TriangleMesh::new(soup, triangles[1..].to_vec()).unwrap());
        assert_eq!(
            (report.winding, report.closed, report.boundary_loops),
            (Winding::Open, false, Some(1))
        );
    }
}

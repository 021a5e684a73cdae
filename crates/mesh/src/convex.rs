//! Convex meshes: checked once, then relied upon by every collision query.

mod check;
mod directions;

use glam::DVec3;
use thiserror::Error;

use self::directions::Directions;
use crate::digits::{number, point};
use crate::hull::{HullError, convex_hull};
use crate::{Aabb, EdgeId, FaceId, HalfEdgeMesh, TopologyError, TriangleMesh, VertexId};

/// Default of [`ConvexMesh::new`]: height above a face's plane, relative to the diagonal of the bounds, up
/// to which a vertex counts as under it.
///
/// Printing six decimals makes a latitude-longitude sphere of radius 1 concave by 2e-6 of its size, `f32`
/// files by 1e-7, generation in `f64` by 1e-16. The value is what a search over neighbours may miss of a
/// support distance: 1 µm on a tool of 0.1 m.
pub const CONVEXITY_TOLERANCE: f64 = 1e-5;

/// What helps with every mesh that encloses a volume.
const USE_HULL: &str = "use its hull (`convex_hull: true` in a scene, `ConvexMesh::hull` in code)";

/// Why a mesh is not a convex solid. Lengths in the unit of the mesh (metres below scene files), which its texts
/// cannot name; they are rounded to five digits there.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ConvexityError {
    /// The triangles are no manifold.
    #[error("not a manifold: {0}; or {USE_HULL}")]
    Topology(#[from] TopologyError),
    /// There are borders.
    #[error(
        "the surface is open: it has {loops} border loop(s), one along the edge from {} to {}; \
         close it or {USE_HULL}",
        point(.edge[0]), point(.edge[1])
    )]
    Open {
        /// Number of border loops.
        loops: usize,
        /// Ends of an edge on a border.
        edge: [DVec3; 2],
    },
    /// Several pieces.
    #[error("the mesh has {shells} separate shells: use one object per shell or {USE_HULL}")]
    Shells {
        /// Number of pieces.
        shells: usize,
    },
    /// Triangles face inwards.
    #[error(
        "the mesh is inside out: its signed volume is {}; reverse the winding of its triangles or {USE_HULL}",
        number(*.volume)
    )]
    InsideOut {
        /// Signed volume [unit³].
        volume: f64,
    },
    /// No inside.
    #[error(
        "the mesh is flat: {} thick over a size of {}; it encloses no volume",
        number(*.thickness), number(*.size)
    )]
    Flat {
        /// Volume over area [m].
        thickness: f64,
        /// Diagonal of the bounds [m].
        size: f64,
    },
    /// An edge is concave.
    #[error(
        "edge {edge} between {} and {} is concave: vertex {vertex} beyond it is {} above the plane of face {face}, \
         tolerance {}; {USE_HULL}",
        point(.ends[0]), point(.ends[1]), number(*.height), number(*.tolerance),
        edge = .edge.0, vertex = .vertex.0, face = .face.0
    )]
    ConcaveEdge {
        /// The most concave edge.
        edge: EdgeId,
        /// Where it is [m].
        ends: [DVec3; 2],
        /// Face on one side.
        face: FaceId,
        /// Far vertex of the face on the other side.
        vertex: VertexId,
        /// Its height over the plane of `face` [m].
        height: f64,
        /// What is allowed [m].
        tolerance: f64,
    },
    /// A vertex lies above a face that is not next to it.
    #[error(
        "vertex {vertex} at {} is {} above the plane of face {face}, tolerance {}; {USE_HULL}",
        point(*.position), number(*.height), number(*.tolerance),
        vertex = .vertex.0, face = .face.0
    )]
    VertexAboveFace {
        /// The vertex.
        vertex: VertexId,
        /// Where it is [m].
        position: DVec3,
        /// The face.
        face: FaceId,
        /// Height over its plane [m].
        height: f64,
        /// What is allowed [m].
        tolerance: f64,
    },
    /// A face too thin to have a plane lies inside the hull.
    #[error(
        "face {face} at {} is thinner than the tolerance and lies {} inside the hull, allowed {}; {USE_HULL}",
        point(*.position), number(*.depth), number(*.tolerance),
        face = .face.0
    )]
    SunkenFace {
        /// The face.
        face: FaceId,
        /// Its deepest corner [m].
        position: DVec3,
        /// Depth of that corner below the nearest supporting plane that was found [m].
        depth: f64,
        /// What is allowed for thin faces [m].
        tolerance: f64,
    },
    /// The surface covers directions more than once.
    #[error("the surface winds {turns:.2} times around its middle instead of once; {USE_HULL}")]
    Winding {
        /// Solid angle over 4π.
        turns: f64,
    },
    /// No hull could be built.
    #[error("no convex hull: {0}")]
    Hull(#[from] HullError),
}

/// A closed, convex, outward-wound mesh.
///
/// Convex to the tolerance it was checked with: where it is dented by less, the search over neighbours may end on a vertex
/// that much below the highest, so distances and depths of collision queries are good to that tolerance times the diagonal.
/// A [`ConvexMesh::hull`] is convex to rounding.
///
/// Vertices, edges and faces are those of [`ConvexMesh::topology`]; neighbours are also kept in one array
/// (compressed rows) so that hill climbing touches little memory.
#[derive(Clone, Debug)]
pub struct ConvexMesh {
    topology: HalfEdgeMesh,
    neighbour_start: Vec<u32>,
    neighbour_list: Vec<u32>,
    directions: Directions,
    centroid: DVec3,
    radius: f64,
}

impl ConvexMesh {
    /// Checks that the mesh is closed, in one piece, wound outward and convex: no vertex lies more than
    /// `relative_tolerance` times the diagonal of the bounds above the plane of any face.
    ///
    /// The plane of a face thinner than that tolerance says nothing: its corners must lie at most twice the tolerance
    /// below a plane that supports all vertices, or it must share its longest edge with a thicker face.
    ///
    /// # Errors
    /// The first condition that fails, with the worst element and its measure.
    pub fn new(topology: HalfEdgeMesh, relative_tolerance: f64) -> Result<Self, ConvexityError> {
        let mesh = topology.to_triangle_mesh();
        let centroid = check::check(&topology, &mesh, relative_tolerance)?;
        let (neighbour_start, neighbour_list) = adjacency(&topology);
        let radius = topology
            .positions()
            .iter()
            .map(|p| p.distance(centroid))
            .fold(0.0, f64::max);
        let directions = Directions::new(topology.vertex_count(), |direction, from| {
            climb(
                topology.positions(),
                (&neighbour_start, &neighbour_list),
                direction,
                from,
            )
        });
        Ok(Self {
            topology,
            neighbour_start,
            neighbour_list,
            directions,
            centroid,
            radius,
        })
    }

    /// Convex hull of points [m], checked like any other mesh. Vertices keep the order of the points.
    ///
    /// # Errors
    /// Fewer than four points, a non-finite one, or all in one plane.
    pub fn hull(points: &[DVec3]) -> Result<Self, ConvexityError> {
        Self::from_triangles(&convex_hull(points)?)
    }

    /// A triangle mesh that is convex within [`CONVEXITY_TOLERANCE`].
    ///
    /// # Errors
    /// When it is no manifold, or as [`ConvexMesh::new`].
    pub fn from_triangles(mesh: &TriangleMesh) -> Result<Self, ConvexityError> {
        Self::new(HalfEdgeMesh::new(mesh)?, CONVEXITY_TOLERANCE)
    }

    /// Connectivity and normals.
    pub fn topology(&self) -> &HalfEdgeMesh {
        &self.topology
    }

    /// Vertex positions [m].
    pub fn positions(&self) -> &[DVec3] {
        self.topology.positions()
    }

    /// Vertices joined to `vertex` by an edge. Allocates nothing.
    ///
    /// # Panics
    /// When the mesh has no such vertex.
    pub fn neighbours(&self, vertex: u32) -> &[u32] {
        let v = vertex as usize;
        &self.neighbour_list[self.neighbour_start[v] as usize..self.neighbour_start[v + 1] as usize]
    }

    /// A vertex near the one furthest along `direction` (any length): where to start climbing without a better guess.
    /// Allocates nothing.
    pub fn vertex_towards(&self, direction: DVec3) -> u32 {
        self.directions.near(direction)
    }

    /// Smallest box around the mesh [m].
    pub fn bounds(&self) -> Aabb {
        self.topology.bounds()
    }

    /// Centre of the volume [m], inside the mesh.
    pub fn centroid(&self) -> DVec3 {
        self.centroid
    }

    /// Distance from the centroid to the farthest vertex [m].
    pub fn radius(&self) -> f64 {
        self.radius
    }
}

/// The highest vertex along `direction`, by steps to the highest neighbour.
fn climb(positions: &[DVec3], (start, list): (&[u32], &[u32]), direction: DVec3, from: u32) -> u32 {
    let mut at = from as usize;
    let mut height = positions[at].dot(direction);
    loop {
        let before = at;
        for &neighbour in &list[start[before] as usize..start[before + 1] as usize] {
            let candidate = positions[neighbour as usize].dot(direction);
            if candidate > height {
                height = candidate;
                at = neighbour as usize;
            }
        }
        if at == before {
            return u32::try_from(at).expect("vertices have 32-bit indices");
        }
    }
}

fn adjacency(topology: &HalfEdgeMesh) -> (Vec<u32>, Vec<u32>) {
    let mut start = Vec::with_capacity(topology.vertex_count() + 1);
    let mut list = Vec::with_capacity(topology.half_edge_count());
    start.push(0);
    for v in (0..).take(topology.vertex_count()) {
        list.extend(
            topology
                .outgoing(VertexId(v))
                .map(|h| topology.origin(topology.twin(h)).0),
        );
        start.push(u32::try_from(list.len()).expect("half-edges have 32-bit indices"));
    }
    (start, list)
}

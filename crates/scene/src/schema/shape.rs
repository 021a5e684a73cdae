//! Shapes of objects: generated, or read from a mesh file.

use serde::{Deserialize, Serialize};

use crate::quantity::{Count, Factor, Length, RadiusOrPoint, Sizes};

/// Sectors around an axis.
pub type Sectors = Count<3, 4096>;

/// Bands from pole to pole or along a cap.
pub type Bands = Count<2, 4096>;

/// A closed surface in the object's frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename = "shape", rename_all = "snake_case", deny_unknown_fields)]
pub enum ShapeDescription {
    /// A box about the origin.
    Cuboid {
        /// Full lengths along x, y, z [m].
        size: Sizes,
    },
    /// A flat box, thin along z, its upper face in the plane z = 0.
    Plate {
        /// Full length along x [m].
        length: Length,
        /// Full length along y [m].
        width: Length,
        /// Along z [m].
        thickness: Length,
    },
    /// A cylinder along x from the origin.
    Cylinder {
        /// [m].
        radius: Length,
        /// Along x [m].
        length: Length,
        /// Sides of the polygon that stands for the circle; 32.
        #[serde(default = "default_sectors")]
        sectors: Sectors,
    },
    /// A cone or frustum along x from the origin.
    Cone {
        /// At the origin [m].
        base_radius: RadiusOrPoint,
        /// At the other end [m]; 0: a point.
        #[serde(default)]
        tip_radius: RadiusOrPoint,
        /// Along x [m].
        length: Length,
        /// Sides of the polygon that stands for the circle; 32.
        #[serde(default = "default_sectors")]
        sectors: Sectors,
    },
    /// A cylinder along x from the origin, with half spheres on both ends.
    Capsule {
        /// [m].
        radius: Length,
        /// Of the cylinder, between the centres of the half spheres [m].
        length: Length,
        /// Sides of the polygon that stands for the circle; 32.
        #[serde(default = "default_sectors")]
        sectors: Sectors,
        /// Bands of each half sphere; 8.
        #[serde(default = "default_cap_bands")]
        bands: Bands,
    },
    /// An ellipsoid of latitudes and longitudes: `2 · sectors · (bands − 1)` faces.
    LatitudeLongitudeEllipsoid {
        /// Half axes [m].
        radii: Sizes,
        /// Around z.
        sectors: Sectors,
        /// From pole to pole.
        bands: Bands,
    },
    /// The hull of points spread evenly over an ellipsoid: `2 · points − 4` faces, strictly convex.
    FibonacciEllipsoid {
        /// Half axes [m].
        radii: Sizes,
        /// Vertices.
        points: Count<8, 1_000_000>,
    },
    /// A pipe along x from the origin; not convex.
    Tube {
        /// [m].
        outer_radius: Length,
        /// [m].
        inner_radius: Length,
        /// Along x [m].
        length: Length,
        /// Sides of the polygon that stands for the circle; 32.
        #[serde(default = "default_sectors")]
        sectors: Sectors,
        /// Touch the convex hull instead; false.
        #[serde(default)]
        convex_hull: bool,
    },
    /// A file.
    Mesh(MeshFile),
}

/// A mesh file: OBJ, STL, glTF or GLB, by its extension.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename = "mesh", deny_unknown_fields)]
pub struct MeshFile {
    /// Relative to the scene file.
    pub path: String,
    /// Unit of the file's numbers; mesh files do not say it themselves.
    pub unit: Unit,
    /// Applied on top of the unit; 1.
    #[serde(default)]
    pub scale: Factor,
    /// Touch the convex hull instead of the surface itself; false.
    #[serde(default)]
    pub convex_hull: bool,
}

/// Units of length.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename = "unit")]
pub enum Unit {
    /// Metre.
    #[serde(rename = "m")]
    Metre,
    /// Millimetre.
    #[serde(rename = "mm")]
    Millimetre,
    /// Centimetre.
    #[serde(rename = "cm")]
    Centimetre,
    /// 25.4 mm.
    #[serde(rename = "inch")]
    Inch,
}

impl Unit {
    /// Metres per unit.
    pub const fn metres(self) -> f64 {
        match self {
            Self::Metre => 1.0,
            Self::Millimetre => 1e-3,
            Self::Centimetre => 1e-2,
            Self::Inch => 0.0254,
        }
    }

    /// From its name in scene files: `m`, `mm`, `cm`, `inch`.
    pub fn from_name(name: &str) -> Option<Self> {
        match name {
            "m" => Some(Self::Metre),
            "mm" => Some(Self::Millimetre),
            "cm" => Some(Self::Centimetre),
            "inch" => Some(Self::Inch),
            _ => None,
        }
    }
}

pub(super) fn default_sectors() -> Sectors {
    Sectors::new(32)
}

pub(super) fn default_cap_bands() -> Bands {
    Bands::new(8)
}

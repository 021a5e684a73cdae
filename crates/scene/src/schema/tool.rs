//! What the hand holds. Frame `handle`: origin at the clamp, +x along the tool to its tip.

use serde::{Deserialize, Serialize};

use super::shape::{Bands, MeshFile, Sectors, default_cap_bands, default_sectors};
use crate::quantity::{Direction, Length, RadiusOrPoint, Segments};

/// A rigid tool.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename = "tool")]
pub struct ToolDescription {
    /// Its surface.
    pub shape: ToolShape,
    /// Pieces of equal length it is cut into along x, each a convex hull, 1 to 100: each takes time in every tick; 1.
    #[serde(default = "one_segment")]
    pub segments: Segments,
}

/// Surfaces of tools; generated ones start at the clamp and are centred on the x axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename = "tool shape", rename_all = "snake_case", deny_unknown_fields)]
pub enum ToolShape {
    /// Rectangular section.
    Rod {
        /// Along x [m].
        length: Length,
        /// Along y [m].
        width: Length,
        /// Along z [m].
        height: Length,
    },
    /// Round section with flat ends.
    Pin {
        /// Along x [m].
        length: Length,
        /// [m].
        radius: Length,
        /// Sides of the polygon that stands for the circle; 16.
        #[serde(default = "default_tool_sectors")]
        sectors: Sectors,
    },
    /// Round section that shrinks or grows towards the tip.
    Cone {
        /// Along x [m].
        length: Length,
        /// At the clamp [m].
        base_radius: Length,
        /// At the tip [m]; 0: a point.
        tip_radius: RadiusOrPoint,
        /// Sides of the polygon that stands for the circle; 16.
        #[serde(default = "default_tool_sectors")]
        sectors: Sectors,
    },
    /// Round section with half spheres on both ends, inside the length.
    Capsule {
        /// Along x, half spheres included [m].
        length: Length,
        /// [m].
        radius: Length,
        /// Sides of the polygon that stands for the circle; 32.
        #[serde(default = "default_sectors")]
        sectors: Sectors,
        /// Bands of each half sphere; 8.
        #[serde(default = "default_cap_bands")]
        bands: Bands,
    },
    /// A file; each segment is the convex hull of its slice.
    Mesh {
        /// Which file, and how large.
        file: MeshFile,
        /// Direction in the file that runs from the clamp to the tip; x. The clamp is the file's lowest coordinate
        /// along it, and the line through the file's origin becomes the handle's x axis.
        #[serde(default = "along_x")]
        axis: Direction,
    },
}

fn one_segment() -> Segments {
    Segments::ONE
}

fn default_tool_sectors() -> Sectors {
    Sectors::new(16)
}

fn along_x() -> Direction {
    Direction::X
}

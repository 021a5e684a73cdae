//! What the fuzz targets hold true, whatever the input: meshes are sound, errors have a place, queries keep their contract.

mod build;
mod document;
mod mesh;
mod pair;
mod place;
mod soup;

pub use build::build_in_memory;
pub use document::Document;
pub use mesh::{judge_hull, judge_mesh};
pub use pair::{Pair, judge_pair};
pub use place::judge_place;
pub use soup::{Soup, judge_soup};

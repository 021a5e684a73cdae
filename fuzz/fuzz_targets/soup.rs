//! Queries of a convex shape on any few triangles.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pliant_fuzz::{Soup, judge_soup};

fuzz_target!(|soup: Soup| judge_soup(&soup));

//! Collision queries on pairs of any small shapes at any placement.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pliant_fuzz::{Pair, judge_pair};

fuzz_target!(|pair: Pair| judge_pair(&pair));

//! The tools.

use super::materials::{AMPLATZ, LUNDERQUIST, NEEDLE_STEEL, NICKEL_TITANIUM, NYLON, steel};
use super::{Blank, Course, Figure, ToolEntry, assumed, named, read};

const USUAL: &str = "a usual length";
const GAUGE: &str = "needle gauge comparison chart, Wikipedia, regular wall";
const FILE_NAME: &str = "size/taper of the designation (ISO 3630-1)";

/// A root-canal file of 25 mm by its size [m] and taper.
const fn file(blank: Blank, tip: f64, taper: f64) -> Course {
    Course::File {
        blank,
        tip: named(tip, FILE_NAME),
        taper: named(taper, FILE_NAME),
        fluted: assumed(
            16e-3,
            "the distance of the standard's D16; shank as wide as there",
        ),
    }
}

/// A cannula by its chart's diameters [m].
const fn cannula(outer: f64, inner: f64) -> Course {
    Course::Tube {
        outer: read(outer, GAUGE),
        inner: read(inner, GAUGE),
    }
}

const fn usual(length: f64) -> Figure {
    assumed(length, USUAL)
}

const WIRE: Course = Course::Rod {
    diameter: named(0.889e-3, "0.035 in"),
};

/// Files first, then what is stiffer and what is softer.
pub(super) const TOOLS: &[ToolEntry] = &[
    ToolEntry {
        name: "k-file-15-steel",
        description: "root-canal K-file 15/.02, stainless steel, square",
        length: usual(25e-3),
        course: file(Blank::Square, 0.15e-3, 0.02),
        material: steel(0.006),
        elements: 20,
    },
    ToolEntry {
        name: "k-file-25-steel",
        description: "root-canal K-file 25/.02, stainless steel, square",
        length: usual(25e-3),
        course: file(Blank::Square, 0.25e-3, 0.02),
        material: steel(0.006),
        elements: 20,
    },
    ToolEntry {
        name: "k-file-25-niti",
        description: "root-canal K-file 25/.02, nickel-titanium, square",
        length: usual(25e-3),
        course: file(Blank::Square, 0.25e-3, 0.02),
        material: NICKEL_TITANIUM,
        elements: 20,
    },
    ToolEntry {
        name: "rotary-file-20-04-niti",
        description: "rotary file 20/.04, nickel-titanium, square",
        length: usual(25e-3),
        course: file(Blank::Square, 0.20e-3, 0.04),
        material: NICKEL_TITANIUM,
        elements: 20,
    },
    ToolEntry {
        name: "rotary-file-25-06-niti",
        description: "rotary file 25/.06, nickel-titanium, triangular",
        length: usual(25e-3),
        course: file(Blank::Triangle, 0.25e-3, 0.06),
        material: NICKEL_TITANIUM,
        elements: 20,
    },
    ToolEntry {
        name: "explorer-tine",
        description: "tine of a dental explorer, taken as straight, steel",
        length: assumed(20e-3, "as of common explorers"),
        course: Course::Cone {
            root: assumed(1.2e-3, "as of common explorers"),
            tip: assumed(0.3e-3, "as of common explorers"),
        },
        material: steel(0.005),
        elements: 10,
    },
    ToolEntry {
        name: "needle-18g",
        description: "hypodermic needle 18G x 90 mm",
        length: usual(90e-3),
        course: cannula(1.270e-3, 0.838e-3),
        material: NEEDLE_STEEL,
        elements: 10,
    },
    ToolEntry {
        name: "needle-22g",
        description: "spinal needle 22G x 90 mm",
        length: usual(90e-3),
        course: cannula(0.7176e-3, 0.413e-3),
        material: NEEDLE_STEEL,
        elements: 20,
    },
    ToolEntry {
        name: "needle-25g",
        description: "hypodermic needle 25G x 40 mm",
        length: usual(40e-3),
        course: cannula(0.5144e-3, 0.260e-3),
        material: NEEDLE_STEEL,
        elements: 20,
    },
    ToolEntry {
        name: "needle-27g",
        description: "dental needle 27G x 25 mm",
        length: usual(25e-3),
        course: cannula(0.4128e-3, 0.210e-3),
        material: NEEDLE_STEEL,
        elements: 20,
    },
    ToolEntry {
        name: "biopsy-needle-18g",
        description: "biopsy needle 18G x 150 mm; its solid stylet fills the bore",
        length: usual(150e-3),
        course: Course::Rod {
            diameter: read(1.270e-3, GAUGE),
        },
        material: NEEDLE_STEEL,
        elements: 10,
    },
    ToolEntry {
        name: "guidewire-amplatz",
        description: "guidewire 0.035 in, plain Amplatz, 50 mm free",
        length: usual(50e-3),
        course: WIRE,
        material: AMPLATZ,
        elements: 20,
    },
    ToolEntry {
        name: "guidewire-lunderquist",
        description: "guidewire 0.035 in, Lunderquist, 50 mm free",
        length: usual(50e-3),
        course: WIRE,
        material: LUNDERQUIST,
        elements: 10,
    },
    ToolEntry {
        name: "toothbrush-bristle",
        description: "one nylon bristle of a toothbrush",
        length: usual(11e-3),
        course: Course::Rod {
            diameter: assumed(
                0.20e-3,
                "makers state 0.15 to 0.51 mm, for adults 0.18 to 0.28 mm",
            ),
        },
        material: NYLON,
        elements: 20,
    },
    ToolEntry {
        name: "paint-brush-bristle",
        description: "one nylon bristle of a paint brush",
        length: usual(40e-3),
        course: Course::Rod {
            diameter: assumed(0.15e-3, "thin end of what makers state"),
        },
        material: NYLON,
        elements: 20,
    },
    ToolEntry {
        name: "steel-rod",
        description: "plain steel rod 2 x 100 mm",
        length: named(100e-3, "2 x 100 mm"),
        course: Course::Rod {
            diameter: named(2e-3, "2 x 100 mm"),
        },
        material: steel(0.003),
        elements: 10,
    },
];

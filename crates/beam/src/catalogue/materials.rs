//! Materials of the catalogue's tools.

use super::{Figure, ToolMaterial, assumed, read};

const HANDBOOK: &str = "usual handbook value";

const STEEL_POISSON: Figure = read(
    0.29,
    "public model of a needle with fibre-Bragg sensors, steel 304",
);
const STEEL_DENSITY: Figure = assumed(7900.0, HANDBOOK);

/// Steel of files, probes and rods.
pub(super) const fn steel(strain_limit: f64) -> ToolMaterial {
    ToolMaterial {
        young_modulus: assumed(200e9, "as of steel 304 in that public model"),
        poisson_ratio: STEEL_POISSON,
        density: STEEL_DENSITY,
        strain_limit: assumed(
            strain_limit,
            "yield of hard stainless steel, 0.003 to 0.006",
        ),
    }
}

/// Steel of cannulas.
pub(super) const NEEDLE_STEEL: ToolMaterial = ToolMaterial {
    young_modulus: assumed(195e9, "drawn austenitic steel, 190 to 200 GPa"),
    poisson_ratio: STEEL_POISSON,
    density: STEEL_DENSITY,
    strain_limit: assumed(0.004, "yield of hard stainless steel, 0.003 to 0.006"),
};

/// Nickel-titanium of files, before its plateau.
pub(super) const NICKEL_TITANIUM: ToolMaterial = ToolMaterial {
    young_modulus: assumed(
        50e9,
        "literature spans 35 to 75 GPa; a quarter to a fifth of steel (Walia et al., J Endod 1988)",
    ),
    poisson_ratio: assumed(0.33, HANDBOOK),
    density: assumed(6450.0, HANDBOOK),
    strain_limit: assumed(0.01, "start of the superelastic plateau"),
};

const WIRES: &str = "flexural modulus of a 0.035 in wire (Harrison et al., J Endovasc Ther 2011)";

/// A plain Amplatz wire, coil and core taken as one full circle.
pub(super) const AMPLATZ: ToolMaterial = ToolMaterial {
    young_modulus: read(9.5e9, WIRES),
    poisson_ratio: assumed(
        0.3,
        "of a coil on a core it means little; sets torsion only",
    ),
    density: assumed(7000.0, "steel with the gaps of a coil"),
    strain_limit: assumed(f64::MAX, "not known: no limit is set"),
};

/// A Lunderquist wire, coil and core taken as one full circle.
pub(super) const LUNDERQUIST: ToolMaterial = ToolMaterial {
    young_modulus: read(158.4e9, WIRES),
    poisson_ratio: assumed(
        0.3,
        "of a coil on a core it means little; sets torsion only",
    ),
    density: STEEL_DENSITY,
    strain_limit: assumed(0.0078, "hard drawn core wire"),
};

/// Nylon of bristles.
pub(super) const NYLON: ToolMaterial = ToolMaterial {
    young_modulus: assumed(3e9, "dry nylon 6.12; halves when wet"),
    poisson_ratio: assumed(0.4, HANDBOOK),
    density: assumed(1060.0, HANDBOOK),
    strain_limit: assumed(0.05, "yield of drawn nylon"),
};

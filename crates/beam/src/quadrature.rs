//! Integrals along a beam whose section bends or steps at known stations.

use crate::profile::Profile;

/// Abscissae and weights of Gauss's formula with ten points on −1…1 (Abramowitz & Stegun 1964, table 25.4), one of each pair.
const GAUSS: [(f64, f64); 5] = [
    (0.148_874_338_981_631_2, 0.295_524_224_714_752_9),
    (0.433_395_394_129_247_2, 0.269_266_719_309_996_3),
    (0.679_409_568_299_024_4, 0.219_086_362_515_982),
    (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
    (0.973_906_528_517_171_7, 0.066_671_344_308_688_1),
];

/// Calls `add` with points s between two arc positions and their weights [m], piece by piece between the profile's stations.
/// Exact for what a polynomial of degree 19 describes in each piece.
pub(crate) fn over_pieces(
    [start, end]: [f64; 2],
    profile: &Profile,
    length: f64,
    mut add: impl FnMut(f64, f64),
) {
    let mut from = start;
    let between = profile
        .stations(length)
        .filter(|station| *station > start && *station < end);
    for to in between.chain(std::iter::once(end)) {
        over_piece([from, to], &mut add);
        from = to;
    }
}

/// The same for one piece.
pub(crate) fn over_piece([from, to]: [f64; 2], mut add: impl FnMut(f64, f64)) {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    for (abscissa, weight) in GAUSS {
        add(middle - half * abscissa, half * weight);
        add(middle + half * abscissa, half * weight);
    }
}

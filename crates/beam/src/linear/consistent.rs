//! Loads inside elements, brought to the nodes.

use glam::DVec3;

use crate::beam::Beam;
use crate::interpolation::Interpolation;
use crate::load::Loading;
use crate::quadrature::GAUSS;

/// Calls `add(node, [forces, moments])` for what a loading amounts to at the nodes, in the root's frame (beam.8). Allocates
/// nothing.
pub fn consistent_loads(beam: &Beam, loading: &Loading<'_>, mut add: impl FnMut(usize, [f64; 6])) {
    for load in loading.points {
        let (index, fraction) = beam.locate(load.s);
        spread(beam, (index, fraction), [load.force, load.moment], &mut add);
    }
    if loading.line == DVec3::ZERO {
        return;
    }
    for (index, element) in beam.elements().iter().enumerate() {
        for (abscissa, weight) in GAUSS {
            let force = loading.line * (0.5 * weight * element.arc);
            for side in [-abscissa, abscissa] {
                let place = (index, 0.5 + 0.5 * side);
                spread(beam, place, [force, DVec3::ZERO], &mut add);
            }
        }
    }
}

fn spread(
    beam: &Beam,
    (index, fraction): (usize, f64),
    [force, moment]: [DVec3; 2],
    add: &mut impl FnMut(usize, [f64; 6]),
) {
    let element = &beam.elements()[index];
    let to_element = element.rest.transpose();
    let shares = Interpolation::at(beam, index, fraction)
        .to_nodes(element, to_element * force, to_element * moment)
        .map(|share| element.rest * share);
    for (end, pair) in shares.chunks_exact(2).enumerate() {
        let (f, m) = (pair[0], pair[1]);
        add(index + end, [f.x, f.y, f.z, m.x, m.y, m.z]);
    }
}

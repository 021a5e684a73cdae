//! Loads inside elements, brought to the nodes.

use glam::DVec3;

use crate::beam::{Beam, Element};
use crate::interpolation::Interpolation;
use crate::load::Loading;
use crate::quadrature::over_piece;

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
        let ends = [element.start, element.start + element.arc];
        for piece in beam.spec().pieces(ends) {
            over_piece(piece, |s, weight| {
                let place = (index, (s - element.start) / element.arc);
                spread(beam, place, [loading.line * weight, DVec3::ZERO], &mut add);
            });
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
    let mut shares = Interpolation::at(beam, index, fraction).to_nodes(
        element,
        to_element * force,
        to_element * moment,
    );
    if !beam.is_straight() {
        bear_couple(
            element,
            bow(beam, index, fraction).cross(to_element * force),
            &mut shares,
        );
    }
    let shares = shares.map(|share| element.rest * share);
    for (end, pair) in shares.chunks_exact(2).enumerate() {
        let (f, m) = (pair[0], pair[1]);
        add(index + end, [f.x, f.y, f.z, m.x, m.y, m.z]);
    }
}

/// How far the centre line of an element bent at rest is from the place on its chord, in its axes.
fn bow(beam: &Beam, index: usize, fraction: f64) -> DVec3 {
    let element = &beam.elements()[index];
    let place = beam.rest_from(index, element.start + fraction * element.arc);
    let from_node = place.translation - beam.nodes()[index].translation;
    element.rest.transpose() * from_node - DVec3::X * (fraction * element.chord)
}

/// Adds a couple on the element's axes, which go with the chord and, about x, with the mean of both ends.
fn bear_couple(element: &Element, couple: DVec3, shares: &mut [DVec3; 4]) {
    let force = DVec3::new(0.0, couple.z, -couple.y) / element.chord;
    shares[0] -= force;
    shares[2] += force;
    let twist = DVec3::X * (0.5 * couple.x);
    shares[1] += twist;
    shares[3] += twist;
}

//! Residual and tangent of the whole beam.

use glam::{DMat3, DVec3};

use crate::corotational::element::Frame;
use crate::corotational::{AnchoredLoads, Corotational};
use crate::linear::Block;
use crate::material_point::MaterialPoint;

/// How a load turns as its element and its section do.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// Fixed in space.
    Dead,
    /// Fixed to the section.
    Follower,
}

impl Corotational {
    /// Residual (loads less what the beam answers, `share` of the loads) into `unknowns`, tangent into its blocks. Returns the largest
    /// load as a scale [N, N·m], or `None` for a shape that no element can follow.
    pub(super) fn assemble(&mut self, loads: &AnchoredLoads, share: f64) -> Option<()> {
        self.tangent.clear();
        self.unknowns.fill([0.0; 6]);
        for index in 0..self.stiffness.len() {
            let frame = self.frame(index)?;
            let response = frame.response(&self.stiffness[index]);
            let [force, first, second] = response.forces;
            self.add_load(index, [force, -first]);
            self.add_load(index + 1, [-force, -second]);
            self.add_tangent(index, &response.tangent);
        }
        for (kind, list) in [
            (Kind::Dead, &loads.dead),
            (Kind::Follower, &loads.followers),
        ] {
            for (point, load) in list {
                self.add_point_load(kind, point, load.map(|part| part * share))?;
            }
        }
        Some(())
    }

    fn add_load(&mut self, node: usize, [force, moment]: [DVec3; 2]) {
        if let Some(free) = node.checked_sub(1) {
            let own = &mut self.unknowns[free];
            for (sum, value) in own[..3].iter_mut().zip(force.to_array()) {
                *sum += value;
            }
            for (sum, value) in own[3..].iter_mut().zip(moment.to_array()) {
                *sum += value;
            }
        }
    }

    /// Spreads the tangent over (difference of positions, spin 1, spin 2) to the blocks of both nodes.
    fn add_tangent(&mut self, index: usize, tangent: &[[DMat3; 3]; 3]) {
        let [[dd, d1, d2], [m1d, m11, m12], [m2d, m21, m22]] = tangent;
        let (diagonal, below, above) = self.tangent.blocks();
        let second = &mut diagonal[index];
        add_block(second, (0, 0), dd, 1.0);
        add_block(second, (0, 3), d2, 1.0);
        add_block(second, (3, 0), m2d, 1.0);
        add_block(second, (3, 3), m22, 1.0);
        let Some(before) = index.checked_sub(1) else {
            return;
        };
        let first = &mut diagonal[before];
        add_block(first, (0, 0), dd, 1.0);
        add_block(first, (0, 3), d1, -1.0);
        add_block(first, (3, 0), m1d, -1.0);
        add_block(first, (3, 3), m11, 1.0);
        let upper = &mut above[before];
        add_block(upper, (0, 0), dd, -1.0);
        add_block(upper, (0, 3), d2, -1.0);
        add_block(upper, (3, 0), m1d, 1.0);
        add_block(upper, (3, 3), m12, 1.0);
        let lower = &mut below[before];
        add_block(lower, (0, 0), dd, -1.0);
        add_block(lower, (0, 3), d1, 1.0);
        add_block(lower, (3, 0), m2d, -1.0);
        add_block(lower, (3, 3), m21, 1.0);
    }

    fn add_point_load(
        &mut self,
        kind: Kind,
        point: &MaterialPoint,
        load: [DVec3; 2],
    ) -> Option<()> {
        if let (Some(node), Kind::Dead) = (point.at_node(), kind) {
            self.add_load(node, load);
            return Some(());
        }
        let frame = self.frame(point.element)?;
        let placed = point.placed(&frame);
        let to_element = frame.axes.transpose();
        let local = match kind {
            Kind::Dead => load.map(|part| to_element * part),
            Kind::Follower => {
                let section = point.section(&frame, &placed);
                load.map(|part| to_element * (section * part))
            }
        };
        let shares = point.nodal_loads(&frame, &placed, local);
        let [f1, m1, f2, m2] = shares.map(|share| frame.axes * share);
        self.add_load(point.element, [f1, m1]);
        self.add_load(point.element + 1, [f2, m2]);
        self.add_load_tangent(kind, point, &frame, local);
        Some(())
    }

    /// What a load inside an element adds to the tangent as the element's axes turn with their chord and their ends; changes of
    /// the element's own deformation are smaller by its length over the beam's, squared, and left to the iteration.
    fn add_load_tangent(
        &mut self,
        kind: Kind,
        point: &MaterialPoint,
        frame: &Frame,
        local: [DVec3; 2],
    ) {
        let placed = point.placed(frame);
        let roll = frame.roll();
        // Per spin of the element's axes, of the nodal loads less what the loads' own turn makes good.
        let nodal = point.nodal_loads(frame, &placed, local);
        let per_axes = DMat3::IDENTITY.to_cols_array_2d().map(|axis| {
            let axis = DVec3::from_array(axis);
            let turned = match kind {
                Kind::Dead => local.map(|part| -axis.cross(part)),
                Kind::Follower => [DVec3::ZERO; 2],
            };
            let own = point.nodal_loads(frame, &placed, turned);
            [0, 1, 2, 3].map(|index| axis.cross(nodal[index]) + own[index])
        });
        // Per spin of an end relative to these axes: followers turn with their section.
        let per_end = [0, 1].map(|end| {
            DMat3::IDENTITY.to_cols_array_2d().map(|axis| {
                let axis = DVec3::from_array(axis) * point.interpolation.rotation_share(end);
                match kind {
                    Kind::Dead => [DVec3::ZERO; 4],
                    Kind::Follower => {
                        point.nodal_loads(frame, &placed, local.map(|part| axis.cross(part)))
                    }
                }
            })
        });
        for output in 0..4 {
            let column = |of: &[[DVec3; 4]; 3]| {
                DMat3::from_cols(of[0][output], of[1][output], of[2][output])
            };
            let (axes, ends) = (
                column(&per_axes),
                [column(&per_end[0]), column(&per_end[1])],
            );
            // Spin of the axes per difference of positions and spins; the ends' spins relative to them.
            let net = axes - ends[0] - ends[1];
            let inverse = 1.0 / frame.length;
            let difference = DMat3::from_cols(
                DVec3::ZERO,
                (net.z_axis + net.x_axis * roll.lean.z) * inverse,
                -(net.y_axis + net.x_axis * roll.lean.y) * inverse,
            );
            let spins = [0, 1].map(|end| {
                let share = roll.per_spin[end];
                ends[end]
                    + DMat3::from_cols(
                        net.x_axis * share.x,
                        net.x_axis * share.y,
                        net.x_axis * share.z,
                    )
            });
            let turned = |block: DMat3| frame.axes * block * frame.axes.transpose();
            self.add_load_row(
                point.element,
                output,
                [turned(difference), turned(spins[0]), turned(spins[1])],
            );
        }
    }

    /// Subtracts a row of a load's tangent: output 0…3 is force 1, moment 1, force 2, moment 2.
    fn add_load_row(&mut self, element: usize, output: usize, columns: [DMat3; 3]) {
        let [difference, first, second] = columns;
        let (node, row) = (output / 2, 3 * (output % 2));
        let (diagonal, below, above) = self.tangent.blocks();
        let Some(before) = element.checked_sub(1) else {
            if node == 1 {
                add_block(&mut diagonal[0], (row, 0), &difference, -1.0);
                add_block(&mut diagonal[0], (row, 3), &second, -1.0);
            }
            return;
        };
        let (to_first, to_second) = if node == 0 {
            (&mut diagonal[before], &mut above[before])
        } else {
            (&mut below[before], &mut diagonal[element])
        };
        add_block(to_first, (row, 0), &difference, 1.0);
        add_block(to_first, (row, 3), &first, -1.0);
        add_block(to_second, (row, 0), &difference, -1.0);
        add_block(to_second, (row, 3), &second, -1.0);
    }
}

fn add_block(block: &mut Block, (row, column): (usize, usize), values: &DMat3, factor: f64) {
    for i in 0..3 {
        for j in 0..3 {
            block[row + i][column + j] += factor * values.col(j)[i];
        }
    }
}

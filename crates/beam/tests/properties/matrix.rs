//! The assembled matrix: symmetric, with exactly the rigid motions for free, definite once clamped.

use glam::{DMat3, DQuat, DVec3};
use nalgebra::{DMatrix, DVector};
use pliant_beam::{
    BandedLu, Beam, BlockTridiagonal, Definiteness, DenseLu, ForceMethod, Unknowns, assemble,
    rotated, stiffness_10, stiffness_12,
};
use proptest::prelude::{prop, prop_assert, prop_assert_eq, proptest};

use crate::beams::{any_beam, cases};

/// K of a beam that nothing holds, in the root's frame.
pub(crate) fn free(beam: &Beam) -> DMatrix<f64> {
    let size = 6 * beam.nodes().len();
    let mut matrix = DMatrix::zeros(size, size);
    for (index, element) in beam.elements().iter().enumerate() {
        let block = rotated(&stiffness_12(element), &element.rest);
        for (row, values) in block.iter().enumerate() {
            for (column, value) in values.iter().enumerate() {
                matrix[(6 * index + row, 6 * index + column)] += value;
            }
        }
    }
    matrix
}

/// K of the clamped beam.
fn clamped(beam: &Beam, unknowns: Unknowns) -> DMatrix<f64> {
    let size = unknowns.per_node() * beam.elements().len();
    let mut matrix = DMatrix::zeros(size, size);
    assemble(beam, unknowns, |row, column, value| {
        matrix[(row, column)] += value;
    });
    matrix
}

/// With ones on the diagonal: eigenvalues then do not depend on units.
fn scaled(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let scale = matrix.diagonal().map(|value| 1.0 / value.sqrt());
    DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |row, column| {
        matrix[(row, column)] * scale[row] * scale[column]
    })
}

fn eigenvalues(matrix: &DMatrix<f64>) -> Vec<f64> {
    let mut values: Vec<f64> = scaled(matrix)
        .symmetric_eigenvalues()
        .iter()
        .copied()
        .collect();
    values.sort_by(f64::total_cmp);
    values
}

/// Largest entry off symmetry, where the diagonal is one.
fn asymmetry(matrix: &DMatrix<f64>) -> f64 {
    let scaled = scaled(matrix);
    (&scaled - scaled.transpose()).amax()
}

fn square<const N: usize>(matrix: &[[f64; N]; N]) -> DMatrix<f64> {
    DMatrix::from_fn(N, N, |row, column| matrix[row][column])
}

proptest! {
    #![proptest_config(cases(200))]

    #[test]
    fn element_matrices_are_symmetric(
        beam in any_beam(4),
        axis in prop::array::uniform3(-1.0..1.0_f64),
        angle in 0.0..3.0_f64,
    ) {
        let turn = DQuat::from_axis_angle(
            DVec3::from_array(axis).try_normalize().unwrap_or(DVec3::X), angle);
        for element in beam.elements() {
            let own = stiffness_12(element);
            prop_assert!(asymmetry(&square(&own)) <= 1e-14);
            prop_assert!(asymmetry(&square(&rotated(&own, &DMat3::from_quat(turn)))) <= 1e-12);
            prop_assert!(asymmetry(&square(&stiffness_10(element))) <= 1e-14);
        }
    }

    #[test]
    fn clamped_matrices_are_positive_definite(beam in any_beam(12)) {
        let matrix = clamped(&beam, Unknowns::Six);
        prop_assert!(asymmetry(&matrix) <= 1e-12);
        let smallest = eigenvalues(&matrix)[0];
        prop_assert!(smallest > 0.0, "{smallest:e}");
        let mut blocks = BlockTridiagonal::new(beam.elements().len());
        assemble(&beam, Unknowns::Six, |row, column, value| blocks.add(row, column, value));
        prop_assert_eq!(blocks.factorise(), Definiteness::Positive);
    }

    #[test]
    fn nothing_but_six_rigid_motions_is_free(beam in any_beam(10)) {
        let matrix = free(&beam);
        let magnitudes = matrix.abs();
        for mode in 0..6 {
            let unit = DVec3::AXES[mode % 3];
            let mut motion = DVector::zeros(matrix.nrows());
            for (node, pose) in beam.nodes().iter().enumerate() {
                let (moved, turned) = if mode < 3 {
                    (unit, DVec3::ZERO)
                } else {
                    (unit.cross(pose.translation), unit)
                };
                motion.rows_mut(6 * node, 3).copy_from_slice(&moved.to_array());
                motion.rows_mut(6 * node + 3, 3).copy_from_slice(&turned.to_array());
            }
            let (forces, scale) = (&matrix * &motion, &magnitudes * motion.abs());
            for (force, scale) in forces.iter().zip(&scale) {
                prop_assert!(force.abs() <= 1e-11 * scale, "mode {mode}: {force:e} of {scale:e}");
            }
        }
        let values = eigenvalues(&matrix);
        prop_assert!(values[..6].iter().all(|value| value.abs() < 1e-12), "{:?}", &values[..6]);
        prop_assert!(values[6] > 1e-9, "{:e}", values[6]);
    }

    #[test]
    fn all_methods_and_nalgebra_agree(
        beam in any_beam(12),
        loads in prop::collection::vec(-1.0..1.0_f64, 72),
    ) {
        for unknowns in [Unknowns::Six, Unknowns::WithoutTwist] {
            // Bent beams twist as they bend.
            if unknowns == Unknowns::WithoutTwist && !beam.is_straight() {
                continue;
            }
            let matrix = clamped(&beam, unknowns);
            let size = matrix.nrows();
            // One load in units of each unknown's own stiffness.
            let right = DVector::from_fn(size, |row, _| loads[row] * matrix[(row, row)].sqrt());
            let truth = matrix.clone().cholesky().expect("definite").solve(&right);
            let mut dense = DenseLu::of(&beam, unknowns);
            let mut banded = BandedLu::of(&beam, unknowns);
            prop_assert_eq!(dense.size() * dense.size(), dense.stiffness().len());
            prop_assert_eq!(banded.stored(), size * (2 * unknowns.half_band() + 1));
            prop_assert!(dense.factorise() && banded.factorise());
            let (mut by_dense, mut by_band) = (right.clone(), right.clone());
            dense.solve(by_dense.as_mut_slice());
            banded.solve(by_band.as_mut_slice());
            let mut answers = vec![("dense", by_dense), ("banded", by_band)];
            if unknowns == Unknowns::Six {
                let mut blocks = BlockTridiagonal::new(beam.elements().len());
                assemble(&beam, unknowns, |row, column, value| blocks.add(row, column, value));
                prop_assert_eq!(blocks.factorise(), Definiteness::Positive);
                let mut nodes: Vec<[f64; 6]> = right.as_slice().chunks_exact(6)
                    .map(|node| std::array::from_fn(|index| node[index])).collect();
                if let Some(mut method) = ForceMethod::new(&beam) {
                    let mut nodes = nodes.clone();
                    method.solve(&mut nodes);
                    answers.push(("force", DVector::from_iterator(size, nodes.into_iter().flatten())));
                }
                blocks.solve(&mut nodes);
                answers.push(("block", DVector::from_iterator(size, nodes.into_iter().flatten())));
            }
            let weigh = |vector: &DVector<f64>| {
                DVector::from_fn(size, |row, _| vector[row] * matrix[(row, row)].sqrt())
            };
            let scale = weigh(&truth).amax();
            for (method, own) in answers {
                let apart = weigh(&(own - &truth)).amax() / scale;
                prop_assert!(apart < 1e-9, "{method}: {apart:e}");
            }
        }
    }
}

/// 45 × 45 = 2025 and 45 × 19 = 855 numbers of the paper's tool are nine free nodes; ten elements have ten.
#[test]
fn the_matrices_are_as_large_as_the_papers() {
    use pliant_beam::{BeamSpec, Division, tool};
    for (elements, full, band) in [(9, 2025, 855), (10, 2500, 950)] {
        let beam = Beam::new(BeamSpec {
            division: Division::Equal(elements),
            ..tool("steel-rod").unwrap()
        });
        let beam = beam.unwrap();
        let dense = DenseLu::of(&beam, Unknowns::WithoutTwist);
        let banded = BandedLu::of(&beam, Unknowns::WithoutTwist);
        assert_eq!((dense.stiffness().len(), banded.stored()), (full, band));
    }
}

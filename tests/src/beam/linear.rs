//! Small deflections, by every method.

use anyhow::{Context, Result};
use glam::{DMat3, DVec3};
use pliant_beam::{
    BandedLu, Beam, ClosedForm, DenseLu, Displacement, ForceMethod, Loading, StiffnessMethod,
    Unknowns, consistent_loads,
};

use super::reference::LinearCase;
use super::report::{Finding, Report};

/// Largest error asked, relative to the largest displacement or rotation of the case.
pub const LINEAR: f64 = 1e-8;

/// Enters the errors of all methods on a case.
///
/// # Errors
/// When the case makes no beam.
pub fn judge(case: &LinearCase, report: &mut Report) -> Result<()> {
    let beam = case.beam()?;
    let loads = case.loads();
    let frame = case.world_from_root();
    let loading = Loading {
        points: &loads,
        line: frame.transpose() * case.line_load,
    };
    let mut enter = |method: &str, error: f64| {
        report.add(Finding {
            kind: format!("linear_random, {method}"),
            case: case.id.clone(),
            error,
            allowed: LINEAR,
        });
    };
    let closed_form = ClosedForm::new(&beam).context("straight")?;
    let at = |s: f64| closed_form.displacement(&closed_form.station(s), &loading);
    let starts = beam.elements().iter().map(|element| element.start);
    let nodes: Vec<_> = starts.chain([beam.length()]).map(at).collect();
    enter(
        "closed form, nodes",
        error(&nodes, &case.nodes_disp, &frame),
    );
    let stations: Vec<_> = case.stations_s.iter().copied().map(at).collect();
    enter(
        "closed form, between nodes",
        error(&stations, &case.stations_disp, &frame),
    );
    let mut method = StiffnessMethod::new(beam.clone());
    method.solve(&loading);
    let nodes: Vec<_> = (0..nodes.len()).map(|node| method.node(node)).collect();
    enter(
        "stiffness, six unknowns",
        error(&nodes, &case.nodes_disp, &frame),
    );
    let nodes = by_forces(&beam, &loading).context("straight")?;
    enter("force method", error(&nodes, &case.nodes_disp, &frame));
    if case.no_torque {
        let nodes = without_twist(&beam, &loading);
        enter(
            "stiffness, five unknowns",
            error(&nodes, &case.nodes_disp, &frame),
        );
    }
    let forces = loading.section_forces(0.0, beam.length());
    let reaction = Displacement {
        translation: -forces.force,
        rotation: -forces.moment,
    };
    enter(
        "reaction",
        error(&[reaction], &[case.root_reaction], &frame),
    );
    Ok(())
}

/// Two sweeps, no matrix.
fn by_forces(beam: &Beam, loading: &Loading<'_>) -> Option<Vec<Displacement>> {
    let mut method = ForceMethod::new(beam)?;
    let mut nodes = vec![[0.0; 6]; beam.elements().len()];
    consistent_loads(beam, loading, |node, load| {
        if let Some(free) = node.checked_sub(1) {
            for (sum, value) in nodes[free].iter_mut().zip(load) {
                *sum += value;
            }
        }
    });
    method.solve(&mut nodes);
    let free = nodes.iter().map(|node| Displacement {
        translation: DVec3::from_slice(&node[..3]),
        rotation: DVec3::from_slice(&node[3..]),
    });
    Some(
        std::iter::once(Displacement::default())
            .chain(free)
            .collect(),
    )
}

/// The paper's way: five unknowns a node, dense and banded LU, which must agree.
fn without_twist(beam: &Beam, loading: &Loading<'_>) -> Vec<Displacement> {
    let mut dense = DenseLu::of(beam, Unknowns::WithoutTwist);
    let mut right = vec![0.0; dense.size()];
    consistent_loads(beam, loading, |node, [u, v, w, _, ry, rz]| {
        if let Some(free) = node.checked_sub(1) {
            for (sum, value) in right[5 * free..].iter_mut().zip([u, v, w, ry, rz]) {
                *sum += value;
            }
        }
    });
    let mut banded = BandedLu::of(beam, Unknowns::WithoutTwist);
    let factorised = dense.factorise() && banded.factorise();
    let mut by_band = right.clone();
    dense.solve(&mut right);
    banded.solve(&mut by_band);
    let largest = right
        .iter()
        .fold(0.0_f64, |most, value| most.max(value.abs()));
    let apart = right
        .iter()
        .zip(&by_band)
        .map(|(dense, band)| (dense - band).abs());
    let apart = apart.fold(0.0, f64::max);
    // Where the two solvers part, so does the answer judged.
    let spoilt = if factorised && apart <= 1e-6 * largest {
        0.0
    } else {
        f64::NAN
    };
    let mut nodes = vec![Displacement::default()];
    nodes.extend(by_band.chunks_exact(5).map(|node| Displacement {
        translation: DVec3::new(node[0], node[1], node[2]) + spoilt,
        rotation: DVec3::new(0.0, node[3], node[4]),
    }));
    nodes
}

/// Largest difference relative to the largest translation and the largest rotation.
fn error(own: &[Displacement], truth: &[[f64; 6]], world_from_root: &DMat3) -> f64 {
    let vectors = |row: &[f64; 6]| [0, 3].map(|first| DVec3::from_slice(&row[first..]));
    let mut most = [0.0_f64; 2];
    let mut apart = [0.0_f64; 2];
    if own.len() != truth.len() {
        return f64::NAN;
    }
    for (own, truth) in own.iter().zip(truth) {
        let own = [own.translation, own.rotation].map(|vector| *world_from_root * vector);
        for (part, truth) in vectors(truth).into_iter().enumerate() {
            most[part] = most[part].max(truth.length());
            let difference = (own[part] - truth).length();
            if difference.is_nan() {
                return f64::NAN;
            }
            apart[part] = apart[part].max(difference);
        }
    }
    let relative = |part: usize| apart[part] / most[part].max(f64::MIN_POSITIVE);
    relative(0).max(relative(1))
}

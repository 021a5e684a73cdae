//! Solvers of the beam crate beside `nalgebra` and `faer`, on a conical tool.

use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

use anyhow::Result;
use faer::linalg::solvers::Solve;
use glam::DVec3;
use nalgebra::{DMatrix, DVector};
use pliant_beam::{
    AnchoredLoads, BandedLu, Beam, BeamSpec, BlockTridiagonal, ClosedForm, Corotational, DenseLu,
    Division, ForceMethod, Load, Loading, Material, Profile, Rest, Settings, Shape, Shear,
    StiffnessMethod, Unknowns, assemble,
};
use serde::Serialize;

/// Numbers of elements.
const ELEMENTS: [usize; 4] = [10, 20, 50, 200];

/// Numbers of contacts of a compliance.
const CONTACTS: [usize; 3] = [1, 4, 8];

/// Batches of each measurement.
const BATCHES: usize = 200;

/// A batch lasts at least this long [ns], so that the clock does not count.
const BATCH_NS: u128 = 20_000;

/// Longest time for one measurement [s].
const PATIENCE_S: f64 = 1.0;

/// One measurement.
#[derive(Serialize)]
struct Row {
    method: String,
    elements: usize,
    /// Per call [ns].
    least: f64,
    p50: f64,
    p99: f64,
    /// Largest median asked [ns].
    target: Option<f64>,
}

/// Measures, prints and writes all rows.
pub(crate) fn run(json: &Path) -> Result<()> {
    println!(
        "{:<44} {:>8} {:>12} {:>12} {:>12} {:>10}",
        "method", "elements", "least ns", "median ns", "99 % ns", "asked ns"
    );
    let mut rows = Vec::new();
    for elements in ELEMENTS {
        let beam = conical(elements)?;
        matrices(&beam, &mut rows);
        linear(&beam, &mut rows);
        large(&beam, &mut rows);
    }
    crate::write_json(json, &rows)
}

/// 50 mm of steel, 0.8 mm thick at the root and 0.3 mm at the tip.
fn conical(elements: usize) -> Result<Beam> {
    Ok(Beam::new(BeamSpec {
        length: 0.05,
        profile: Profile::Linear {
            root: Shape::Circle { diameter: 0.8e-3 },
            tip: Shape::Circle { diameter: 0.3e-3 },
        },
        material: Material::isotropic(200e9, 0.3),
        division: Division::Equal(elements),
        rest: Rest::Straight,
        shear: Shear::Rigid,
    })?)
}

/// Factorisation and solution of the paper's matrix, five unknowns a node.
fn matrices(beam: &Beam, rows: &mut Vec<Row>) {
    let mut dense = DenseLu::of(beam, Unknowns::WithoutTwist);
    let mut banded = BandedLu::of(beam, Unknowns::WithoutTwist);
    let size = dense.size();
    let right: Vec<f64> = (0..size).map(|index| (index % 5) as f64 * 1e-3).collect();
    let mut vector = right.clone();
    let mut add = |method: &str, call: &mut dyn FnMut()| {
        rows.push(measure(method, beam.elements().len(), None, call));
    };
    add("dense LU, factor and solve", &mut || {
        vector.copy_from_slice(&right);
        black_box(dense.factorise());
        dense.solve(&mut vector);
    });
    add("banded LU, factor and solve", &mut || {
        vector.copy_from_slice(&right);
        black_box(banded.factorise());
        banded.solve(&mut vector);
    });
    add("banded LU, solve", &mut || {
        vector.copy_from_slice(&right);
        banded.solve(&mut vector);
    });
    let matrix = DMatrix::from_row_slice(size, size, dense.stiffness());
    let column = DVector::from_row_slice(&right);
    add("nalgebra LU, factor and solve", &mut || {
        black_box(matrix.clone().lu().solve(&column));
    });
    add("nalgebra Cholesky, factor and solve", &mut || {
        black_box(
            matrix
                .clone()
                .cholesky()
                .map(|factor| factor.solve(&column)),
        );
    });
    let matrix = faer::Mat::from_fn(size, size, |i, j| dense.stiffness()[i * size + j]);
    let column = faer::Mat::from_fn(size, 1, |i, _| right[i]);
    add("faer LU, factor and solve", &mut || {
        black_box(matrix.partial_piv_lu().solve(&column));
    });
    add("faer Cholesky, factor and solve", &mut || {
        if let Ok(factor) = matrix.llt(faer::Side::Lower) {
            black_box(factor.solve(&column));
        }
    });
}

/// Small deflections, six unknowns a node.
fn linear(beam: &Beam, rows: &mut Vec<Row>) {
    let count = beam.elements().len();
    let load = [1e-3, 0.2, -0.1, 1e-5, 0.0, 2e-5];
    let mut nodes = vec![load; count];
    let mut factor = BlockTridiagonal::new(count);
    let mut add = |method: &str, target: Option<f64>, call: &mut dyn FnMut()| {
        rows.push(measure(method, count, target, call));
    };
    assemble(beam, Unknowns::Six, |row, column, value| {
        factor.add(row, column, value);
    });
    add("block-tridiagonal, factor and solve", None, &mut || {
        nodes.fill(load);
        black_box(factor.factorise());
        factor.solve(&mut nodes);
    });
    add("block-tridiagonal, solve", None, &mut || {
        nodes.fill(load);
        factor.solve(&mut nodes);
    });
    let mut method = StiffnessMethod::new(beam.clone());
    let points = [tip_force(beam, 0.1), inner_force(beam)];
    add("block-tridiagonal, two loads inside", None, &mut || {
        method.solve(&Loading {
            points: &points,
            line: DVec3::ZERO,
        });
    });
    if let Some(mut method) = ForceMethod::new(beam) {
        add("force method", (count == 10).then_some(100.0), &mut || {
            nodes.fill(load);
            method.solve(&mut nodes);
        });
    }
    if let Some(closed_form) = ClosedForm::new(beam) {
        for contacts in CONTACTS {
            let places: Vec<f64> = (0..contacts)
                .map(|contact| beam.length() * (contact as f64 + 0.7) / contacts as f64)
                .collect();
            let stations: Vec<_> = places.iter().map(|s| closed_form.station(*s)).collect();
            let arm = DVec3::Y * 2e-4;
            add(
                &format!("closed-form W, {contacts} contacts, 3 x 3 each"),
                None,
                &mut || {
                    for (index, one) in stations.iter().enumerate() {
                        for other in &stations[..=index] {
                            black_box(one.compliance(other).between_points(arm, arm));
                        }
                    }
                },
            );
        }
    }
}

/// Large deflections.
fn large(beam: &Beam, rows: &mut Vec<Row>) {
    let count = beam.elements().len();
    let mut method = Corotational::new(beam.clone());
    let settings = Settings {
        tolerance: 1e-6,
        most_iterations: 6,
    };
    let one = Settings {
        tolerance: 0.0,
        most_iterations: 1,
    };
    let mut loads = turning(beam, 0.0);
    let mut tick = 0.0;
    let mut iterations = (0_u64, 0_u64);
    let _ = method.solve(&loads, &Settings::default());
    rows.push(measure(
        "co-rotational, one Newton iteration",
        count,
        None,
        &mut || {
            let _ = black_box(method.iterate(&loads, &one));
        },
    ));
    rows.push(measure(
        "co-rotational, warm tick",
        count,
        match count {
            10 => Some(20_000.0),
            20 => Some(40_000.0),
            _ => None,
        },
        &mut || {
            tick += 1.0;
            loads = turning(beam, tick);
            let outcome = method.iterate(&loads, &settings);
            iterations.0 += 1;
            iterations.1 += u64::from(outcome.iterations);
        },
    ));
    println!(
        "{:<44} {count:>8} {:>12.2} iterations a tick",
        "",
        iterations.1 as f64 / iterations.0 as f64
    );
}

/// A force on the tip that turns by 1.5 % of a radian a tick and grows and shrinks to 2.5 EI/L².
fn turning(beam: &Beam, tick: f64) -> AnchoredLoads {
    let angle = 0.015 * tick;
    let size = 0.12 * (1.0 + 0.5 * (0.4 * angle).sin());
    let force = DVec3::new(0.3 * angle.sin(), angle.cos(), angle.sin()) * size;
    let points = [Load {
        s: beam.length(),
        force,
        moment: DVec3::ZERO,
    }];
    AnchoredLoads::new(
        beam,
        &Loading {
            points: &points,
            line: DVec3::ZERO,
        },
        &[],
    )
}

fn tip_force(beam: &Beam, force: f64) -> Load {
    Load {
        s: beam.length(),
        force: DVec3::Y * force,
        moment: DVec3::ZERO,
    }
}

fn inner_force(beam: &Beam) -> Load {
    Load {
        s: 0.613 * beam.length(),
        ..tip_force(beam, -0.2)
    }
}

/// Times of a call in batches.
fn measure(method: &str, elements: usize, target: Option<f64>, call: &mut dyn FnMut()) -> Row {
    let began = Instant::now();
    call();
    let once = began.elapsed().as_nanos().max(1);
    let per_batch = u32::try_from(BATCH_NS / once).unwrap_or(u32::MAX).max(1);
    let mut times = Vec::with_capacity(BATCHES);
    while times.len() < BATCHES && (times.len() < 3 || began.elapsed().as_secs_f64() < PATIENCE_S) {
        let start = Instant::now();
        for _ in 0..per_batch {
            call();
        }
        times.push(start.elapsed().as_secs_f64() * 1e9 / f64::from(per_batch));
    }
    times.sort_by(f64::total_cmp);
    let at = |percent: usize| times[(times.len() - 1) * percent / 100];
    let row = Row {
        method: method.to_owned(),
        elements,
        least: times[0],
        p50: at(50),
        p99: at(99),
        target,
    };
    println!(
        "{method:<44} {elements:>8} {:>12.0} {:>12.0} {:>12.0} {:>10}",
        row.least,
        row.p50,
        row.p99,
        target.map_or_else(String::new, |target| format!("{target:.0}"))
    );
    row
}

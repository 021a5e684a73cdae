//! The table: times of both libraries, and targets scaled to the machine of the day.
//!
//! Targets were set on a 2.6 GHz Xeon. There the other library's medians were listed for the same rows; the median over rows of
//! what it takes now by what it took then is the machine's factor.

use serde::Serialize;

use super::clock::Times;
use super::duel::Mode;
use super::mesh;
use super::placements::State;
use super::rows::{Bodies, Ellipsoids};

/// Coherent cost on 998,000 faces may be so many times that on 12,672.
const SCALING_LIMIT: f64 = 1.5;

/// One cell of the table as it is asked for.
struct Cell {
    bodies: Bodies,
    state: State,
    mode: Mode,
    /// Median asked for on the Xeon [ns].
    target: Option<f64>,
    /// The other library's median there [ns].
    listed: Option<f64>,
}

/// One cell of the table as measured.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Shapes.
    pub bodies: String,
    /// Gap or depth.
    pub state: String,
    /// Cold or coherent.
    pub mode: String,
    /// Queries timed.
    pub queries: usize,
    /// Of this project's crate [ns].
    pub own: Times,
    /// Of `parry3d-f64` [ns].
    pub parry: Option<Times>,
    /// Its median on the Xeon [ns].
    pub parry_listed: Option<f64>,
    /// Median asked for on the Xeon [ns].
    pub target: Option<f64>,
    /// 99th percentile asked for there [ns].
    pub p99_target: Option<f64>,
    /// Median asked for today [ns].
    pub target_today: Option<f64>,
    /// Whether the median meets it.
    pub met: Option<bool>,
}

/// All of it.
#[derive(Clone, Debug, Serialize)]
pub struct Table {
    /// How much slower this machine is today than the Xeon was.
    pub machine_factor: f64,
    /// In the order of the table.
    pub rows: Vec<Row>,
}

/// Measures everything; `each` sees a row as soon as it is there.
pub fn run(mut each: impl FnMut(&Row)) -> Table {
    let ellipsoids = Ellipsoids::new();
    let mut rows = Vec::new();
    for cell in cells() {
        let sample = cell.bodies.run(cell.state, cell.mode, &ellipsoids);
        let queries = sample.own.len();
        let Some(own) = Times::of(sample.own) else {
            continue;
        };
        let row = Row {
            bodies: format!("{:?}", cell.bodies),
            state: format!("{:?}", cell.state),
            mode: format!("{:?}", cell.mode),
            queries,
            own,
            parry: Times::of(sample.parry),
            parry_listed: cell.listed,
            target: cell.target,
            p99_target: None,
            target_today: None,
            met: None,
        };
        each(&row);
        rows.push(row);
    }
    drop(ellipsoids);
    rows.extend(mesh::run(&mut each));
    let machine_factor = factor(&rows);
    let mut table = Table {
        machine_factor,
        rows,
    };
    table.judge();
    table
}

impl Table {
    /// Sets the targets of the day and compares.
    fn judge(&mut self) {
        let medians: Vec<(String, String, f64)> = self
            .rows
            .iter()
            .filter(|row| row.mode == "Coherent")
            .map(|row| (row.bodies.clone(), row.state.clone(), row.own.p50))
            .collect();
        for row in &mut self.rows {
            // Figures on a million faces are judged by those on 12,672.
            let small = row.bodies.replace("Million", "Ellipsoid");
            let same = medians
                .iter()
                .find(|(bodies, state, _)| *bodies == small && *state == row.state)
                .filter(|_| small != row.bodies);
            row.target_today = match same {
                Some((_, _, median)) => Some(SCALING_LIMIT * median),
                None => row.target.map(|target| target * self.machine_factor),
            };
            let slowest = row.p99_target.map(|target| target * self.machine_factor);
            let in_time = slowest.is_none_or(|target| row.own.p99 <= target);
            row.met = row
                .target_today
                .map(|target| row.own.p50 <= target && in_time);
        }
    }
}

fn factor(rows: &[Row]) -> f64 {
    let mut factors: Vec<f64> = rows
        .iter()
        .filter_map(|row| Some(row.parry?.p50 / row.parry_listed?))
        .collect();
    factors.sort_by(f64::total_cmp);
    factors.get(factors.len() / 2).copied().unwrap_or(1.0)
}

/// Target cold, target coherent, listed cold, listed coherent; all in ns, 0 where there is none.
type Figures = [f64; 4];

const SEPARATED: State = State::Separated;
const SHALLOW: State = State::Deep(0.001);
const DEEP: State = State::Deep(0.01);
const DEEPEST: State = State::Deep(0.1);

const FIGURES: [(Bodies, State, Figures); 18] = [
    (Bodies::Boxes, SEPARATED, [300.0, 150.0, 351.0, 286.0]),
    (Bodies::Boxes, SHALLOW, [0.0, 0.0, 703.0, 605.0]),
    (Bodies::Boxes, DEEP, [650.0, 400.0, 929.0, 669.0]),
    (Bodies::Boxes, DEEPEST, [0.0, 0.0, 1648.0, 1249.0]),
    (
        Bodies::CapsuleHull32,
        SEPARATED,
        [370.0, 200.0, 2018.0, 1444.0],
    ),
    (
        Bodies::CapsuleHull32,
        DEEP,
        [800.0, 300.0, 13_447.0, 9000.0],
    ),
    (Bodies::CapsuleHull32, DEEPEST, [0.0, 0.0, 13_872.0, 6422.0]),
    (Bodies::Hulls64, SEPARATED, [0.0, 0.0, 1872.0, 1842.0]),
    (Bodies::Hulls64, DEEP, [0.0, 0.0, 3887.0, 3345.0]),
    (
        Bodies::PrismEllipsoid,
        SEPARATED,
        [2000.0, 500.0, 94e3, 55e3],
    ),
    (
        Bodies::PrismEllipsoid,
        SHALLOW,
        [3500.0, 1000.0, 127e3, 103e3],
    ),
    (Bodies::PrismEllipsoid, DEEP, [4000.0, 1000.0, 128e3, 115e3]),
    (
        Bodies::PrismEllipsoid,
        DEEPEST,
        [5000.0, 1000.0, 152e3, 143e3],
    ),
    (
        Bodies::CapsuleEllipsoid,
        SEPARATED,
        [0.0, 400.0, 149e3, 86e3],
    ),
    (Bodies::CapsuleEllipsoid, DEEP, [0.0, 400.0, 242e3, 226e3]),
    (Bodies::PrismMillion, SEPARATED, [0.0; 4]),
    (Bodies::PrismMillion, DEEP, [0.0; 4]),
    (Bodies::CapsuleMillion, DEEP, [0.0; 4]),
];

fn cells() -> Vec<Cell> {
    let some = |figure: f64| (figure > 0.0).then_some(figure);
    FIGURES
        .into_iter()
        .flat_map(|(bodies, state, figures)| {
            let modes = [Mode::Cold, Mode::Coherent];
            modes
                .into_iter()
                .zip([0, 1])
                .map(move |(mode, column)| Cell {
                    bodies,
                    state,
                    mode,
                    target: some(figures[column]),
                    listed: some(figures[column + 2]),
                })
        })
        .filter(|cell| {
            let million = matches!(cell.bodies, Bodies::PrismMillion | Bodies::CapsuleMillion);
            !million || cell.mode == Mode::Coherent
        })
        .collect()
}

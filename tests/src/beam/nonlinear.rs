//! Large deflections at 10, 20 and 40 elements.

use std::f64::consts::TAU;

use anyhow::{Context, Result};
use glam::{DMat3, DVec3};
use pliant_beam::{
    AnchoredLoads, Beam, BeamSpec, Corotational, Division, Load, Loading, Material, MaterialPoint,
    Profile, Rest, Section, Settings, Shape, Shear,
};

use super::reference::{Helix, SpaceCase, TableCase};
use super::report::{Finding, Report};

/// Numbers of elements judged.
const ELEMENTS: [usize; 3] = [10, 20, 40];

/// Largest errors by the length at these numbers, of elements of the kind used here, as measured by an independent
/// implementation; 1.2 times as much is allowed.
const SPACE: [f64; 3] = [1.3e-3, 3.5e-4, 1.3e-4];

/// Errors of the elastica's deflection, likewise, at α = 1, 5, 10.
const ELASTICA: [(f64, [f64; 3]); 3] = [
    (1.0, [2.6e-4, 6.5e-5, 1.7e-5]),
    (5.0, [1.1e-3, 2.8e-4, 7.4e-5]),
    (10.0, [1.5e-3, 3.6e-4, 9.8e-5]),
];

/// Errors of the tip of the 45° arc at 600 N, likewise, by its length.
const ARC: [f64; 3] = [5.01e-4, 1.21e-4, 4.8e-5];

/// Margin over those errors.
const MARGIN: f64 = 1.2;

/// Largest distance of a rolled-up tip from where it belongs, by the length.
const ROLL_UP: f64 = 1e-12;

/// Stretching stiffness by bending stiffness over length squared of beams meant not to stretch.
const INEXTENSIBLE: f64 = 1e8;

/// Rows in which the sections of a conical beam that does not stretch are given.
const ROWS: u32 = 2000;

/// Loads on a beam, as the cases have them.
struct Setup {
    spec: BeamSpec,
    loads: Vec<Load>,
    followers: Vec<Load>,
}

/// Enters the errors of a case of the tables.
///
/// # Errors
/// When the case makes no beam.
pub fn judge_table(case: &TableCase, report: &mut Report) -> Result<()> {
    for (level, elements) in ELEMENTS.into_iter().enumerate() {
        let (name, error, allowed) = table_error(case, (level, elements))?;
        report.add(Finding {
            kind: format!("{name}, {elements} elements"),
            case: format!("{case:?}").chars().take(110).collect(),
            error,
            allowed,
        });
    }
    Ok(())
}

fn table_error(
    case: &TableCase,
    (level, elements): (usize, usize),
) -> Result<(&'static str, f64, f64)> {
    let space = MARGIN * SPACE[level];
    let across = |force: f64| tip_load(1.0, DVec3::Y * force, DVec3::ZERO);
    Ok(match case {
        TableCase::ElasticaTipDead {
            alpha,
            w_over_L,
            u_over_L,
        } => {
            let mut setup = slender(1.0, DVec3::ONE, Rest::Straight);
            setup.loads.push(across(*alpha));
            let tip = solve(setup, elements, &[1.0])?[0];
            let off = (tip - DVec3::new(1.0 - u_over_L, *w_over_L, 0.0)).abs();
            ("elastica", off.y, MARGIN * elastica(*alpha, level))
        }
        TableCase::FollowerTip { alpha, mid, tip } => {
            let mut setup = slender(1.0, DVec3::ONE, Rest::Straight);
            setup.followers.push(across(*alpha));
            let places = solve(setup, elements, &[0.5, 1.0])?;
            ("follower_tip", furthest(&places, &[*mid, *tip]), space)
        }
        TableCase::RollupEndMoment {
            fraction_of_2pi,
            tip,
        } => {
            let mut setup = slender(1.0, DVec3::ONE, Rest::Straight);
            let moment = DVec3::Z * (TAU * fraction_of_2pi);
            setup.loads.push(tip_load(1.0, DVec3::ZERO, moment));
            let places = solve(setup, elements, &[1.0])?;
            ("rollup_end_moment", furthest(&places, &[*tip]), ROLL_UP)
        }
        TableCase::ArcTipForce { tip, .. } => {
            let (setup, length) = arc(case).context("an arc")?;
            let places = solve(setup, elements, &[length])?;
            let error = furthest(&places, &[*tip]) / length;
            ("arc_tip_force", error, MARGIN * ARC[level])
        }
        TableCase::HelixDeadTipForce { helix, force } => {
            let mut setup = helical(helix);
            setup.loads.push(tip_load(helix.L, *force, DVec3::ZERO));
            (
                "helix_dead_tip_force",
                helix_error(helix, setup, elements)?,
                space,
            )
        }
        TableCase::HelixFollowerTipWrench {
            helix,
            body_force,
            body_moment,
        } => {
            let mut setup = helical(helix);
            setup
                .followers
                .push(tip_load(helix.L, *body_force, *body_moment));
            let error = helix_error(helix, setup, elements)?;
            ("helix_follower_tip_wrench", error, space)
        }
    })
}

/// Enters the errors of a case in space.
///
/// # Errors
/// When the case makes no beam.
pub fn judge_space(case: &SpaceCase, report: &mut Report) -> Result<()> {
    let world_from_root = DMat3::from_cols_array(&case.root_frame_columns);
    let root_from_world = world_from_root.transpose();
    for (level, elements) in ELEMENTS.into_iter().enumerate() {
        let turned = |load: &super::reference::ReferenceLoad| Load {
            s: load.s,
            force: root_from_world * load.force,
            moment: root_from_world * load.moment,
        };
        let setup = Setup {
            spec: case.spec(),
            loads: case.loads.iter().map(turned).collect(),
            followers: Vec::new(),
        };
        let places = solve(setup, elements, &case.stations_s).with_context(|| case.id.clone())?;
        let places: Vec<_> = places
            .into_iter()
            .map(|place| world_from_root * place)
            .collect();
        report.add(Finding {
            kind: format!("nonlinear_random, {elements} elements"),
            case: case.id.clone(),
            error: furthest(&places, &case.positions) / case.L,
            allowed: MARGIN * SPACE[level],
        });
    }
    Ok(())
}

impl SpaceCase {
    fn spec(&self) -> BeamSpec {
        let circle = |diameter: f64| Shape::Circle { diameter };
        let [root, tip] = [self.d_root, self.d_tip].map(circle);
        let profile = if self.extensible {
            Profile::Linear { root, tip }
        } else {
            let rows = (0..=ROWS).map(|row| {
                let part = f64::from(row) / f64::from(ROWS);
                let diameter = self.d_root + (self.d_tip - self.d_root) * part;
                let section = circle(diameter).section(self.nu);
                let area = INEXTENSIBLE * section.second_moment_y / self.L.powi(2);
                let general = Shape::General {
                    section: Section { area, ..section },
                    reach_y: diameter,
                    reach_z: diameter,
                };
                (part * self.L, general)
            });
            Profile::Table(rows.collect())
        };
        BeamSpec {
            length: self.L,
            profile,
            material: Material::isotropic(self.E, self.nu),
            division: Division::Equal(1),
            rest: Rest::Curved(self.initial_body_curvature),
            shear: if self.shear_flexible {
                Shear::Flexible
            } else {
                Shear::Rigid
            },
        }
    }
}

/// A thin beam that does not stretch, of torsional and bending stiffnesses about x, y and z [N·m²].
fn slender(length: f64, stiffness: DVec3, rest: Rest) -> Setup {
    let area = INEXTENSIBLE / length.powi(2);
    Setup {
        spec: BeamSpec {
            length,
            profile: Profile::Uniform(Shape::General {
                section: Section {
                    area,
                    second_moment_y: stiffness.y,
                    second_moment_z: stiffness.z,
                    torsion_constant: stiffness.x,
                    shear_area_y: area,
                    shear_area_z: area,
                },
                reach_y: 1.0,
                reach_z: 1.0,
            }),
            material: Material {
                shear_modulus: 1.0,
                ..Material::isotropic(1.0, 0.0)
            },
            division: Division::Equal(1),
            rest,
            shear: Shear::Rigid,
        },
        loads: Vec::new(),
        followers: Vec::new(),
    }
}

fn helical(helix: &Helix) -> Setup {
    let stiffness = DVec3::new(helix.GJ, helix.EI, helix.EI);
    let curvature = DVec3::new(helix.tau, 0.0, helix.kappa);
    slender(helix.L, stiffness, Rest::Curved(curvature))
}

fn helix_error(helix: &Helix, setup: Setup, elements: usize) -> Result<f64> {
    let places = solve(setup, elements, &[0.5 * helix.L, helix.L])?;
    Ok(furthest(&places, &[helix.mid, helix.tip]) / helix.L)
}

fn arc(case: &TableCase) -> Option<(Setup, f64)> {
    let TableCase::ArcTipForce {
        radius,
        degrees,
        E,
        G,
        width_z,
        height_y,
        J,
        shear_factor,
        P,
        ..
    } = case
    else {
        return None;
    };
    let length = radius * degrees.to_radians();
    let section = Shape::Rectangle {
        width_y: *height_y,
        width_z: *width_z,
    }
    .section(0.0);
    let shear_area = shear_factor * section.area;
    let setup = Setup {
        spec: BeamSpec {
            length,
            profile: Profile::Uniform(Shape::General {
                section: Section {
                    torsion_constant: *J,
                    shear_area_y: shear_area,
                    shear_area_z: shear_area,
                    ..section
                },
                reach_y: 0.5 * height_y,
                reach_z: 0.5 * width_z,
            }),
            material: Material {
                shear_modulus: *G,
                ..Material::isotropic(*E, 0.0)
            },
            division: Division::Equal(1),
            rest: Rest::Curved(DVec3::Z / *radius),
            shear: Shear::Flexible,
        },
        loads: vec![tip_load(length, DVec3::Z * *P, DVec3::ZERO)],
        followers: Vec::new(),
    };
    Some((setup, length))
}

fn tip_load(s: f64, force: DVec3, moment: DVec3) -> Load {
    Load { s, force, moment }
}

/// Allowed at this α: between the table's rows linear, before the first as there.
fn elastica(alpha: f64, level: usize) -> f64 {
    let mut before = ELASTICA[0];
    for row in ELASTICA {
        if alpha <= row.0 {
            let part = if row.0 > before.0 {
                (alpha - before.0) / (row.0 - before.0)
            } else {
                1.0
            };
            return before.1[level] + (row.1[level] - before.1[level]) * part;
        }
        before = row;
    }
    before.1[level]
}

/// Where points of the centre line go; not a number where the solution fails.
fn solve(setup: Setup, elements: usize, stations: &[f64]) -> Result<Vec<DVec3>> {
    let beam = Beam::new(BeamSpec {
        division: Division::Equal(elements),
        ..setup.spec
    })?;
    let loading = Loading {
        points: &setup.loads,
        line: DVec3::ZERO,
    };
    let loads = AnchoredLoads::new(&beam, &loading, &setup.followers);
    let points: Vec<_> = stations
        .iter()
        .map(|s| MaterialPoint::new(&beam, *s, DVec3::ZERO))
        .collect();
    let mut method = Corotational::new(beam);
    let outcome = method.solve(&loads, &Settings::default());
    let spoilt = if outcome.converged { 0.0 } else { f64::NAN };
    let place = |point: &MaterialPoint| method.pose(point).translation + spoilt;
    Ok(points.iter().map(place).collect())
}

fn furthest(own: &[DVec3], truth: &[DVec3]) -> f64 {
    own.iter()
        .zip(truth)
        .fold(0.0, |most, (own, truth)| match (*own - *truth).length() {
            distance if distance <= most => most,
            distance => distance,
        })
}

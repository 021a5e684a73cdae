//! Random campaigns: a random hand pushes a tool against objects for seconds at 1 kHz, judges watch every tick.

use glam::DVec3;
use pliant_contact::SKIN;
use pliant_mesh::{ConvexMesh, Feature};
use pliant_sim::{Method, State, TickInput, TickOutput, World, tick, visual_penetration};
use pliant_spatial::Pose;

use crate::bodies::{Setting, ToolKind, world};
use crate::hand::RandomHand;
use crate::judge::{ParryJudge, cone_residual, fresh_planes};

/// Servo period of all campaigns [s].
pub const PERIOD: f64 = 1e-3;

/// One campaign run.
#[derive(Clone, Copy, Debug)]
pub struct Run {
    /// Where.
    pub setting: Setting,
    /// With what.
    pub tool: ToolKind,
    /// Cut into so many segments.
    pub segments: u32,
    /// Seed of the hand.
    pub seed: u64,
    /// Length of the run.
    pub ticks: u32,
    /// The independent library judges every so many ticks.
    pub judge_interval: u32,
}

/// What the judges saw.
#[derive(Clone, Copy, Debug, Default)]
pub struct Verdict {
    /// Ticks run.
    pub ticks: u32,
    /// Ticks with contact.
    pub contact_ticks: u32,
    /// Times the reported feature or its object changed between contact ticks.
    pub feature_changes: u32,
    /// Ticks whose orientation was held.
    pub held_ticks: u32,
    /// Ticks that reached the solver's cap.
    pub capped_ticks: u32,
    /// Deepest overlap of the visual tool [m].
    pub penetration: f64,
    /// Smallest certified gap over all pairs and ticks [m].
    pub smallest_certificate: f64,
    /// Largest distance of the nearest object on contact ticks that were not capped [m].
    pub largest_contact_gap: f64,
    /// Largest cone residual on ticks neither capped nor held [m].
    pub residual: f64,
    /// Pairs for which the independent library saw overlap 1 µm out along the separating direction.
    pub overlaps: u32,
    /// Pairs it judged.
    pub judged: u32,
    /// Largest force [N].
    pub max_force: f64,
    /// Largest difference between the rendered force and the spring's, k (x − h) [N].
    pub force_error: f64,
}

impl Verdict {
    /// The demands every run must meet; each failure in words.
    pub fn failures(&self, run: &Run) -> Vec<String> {
        let mut failures = Vec::new();
        let mut demand = |holds: bool, what: String| {
            if !holds {
                failures.push(what);
            }
        };
        demand(
            3 * self.contact_ticks >= self.ticks,
            format!(
                "contact in {} of {} ticks, a third asked",
                self.contact_ticks, self.ticks
            ),
        );
        demand(
            self.feature_changes >= 50,
            format!("{} feature changes, 50 asked", self.feature_changes),
        );
        demand(
            self.penetration <= 1e-9,
            format!("penetration {:.2e} m, 1e-9 allowed", self.penetration),
        );
        demand(
            self.smallest_certificate >= 0.25 * SKIN,
            format!(
                "certified gap {:.2e} m, ε/4 asked",
                self.smallest_certificate
            ),
        );
        demand(
            self.largest_contact_gap <= 2.0 * SKIN,
            format!(
                "gap in contact {:.2e} m, 2ε allowed",
                self.largest_contact_gap
            ),
        );
        demand(
            self.residual <= 1e-8,
            format!("cone residual {:.2e} m, 1e-8 allowed", self.residual),
        );
        demand(
            self.overlaps == 0,
            format!(
                "{} of {} pairs overlap for parry3d-f64",
                self.overlaps, self.judged
            ),
        );
        demand(
            self.force_error <= 1e-9,
            format!("force {:.2e} N off the coupling spring's", self.force_error),
        );
        demand(
            self.held_ticks == 0 || run.setting == Setting::Slot,
            format!("{} held ticks outside a slot", self.held_ticks),
        );
        failures
    }
}

/// Runs one campaign.
pub fn campaign(run: &Run) -> Verdict {
    let world = world(
        run.setting,
        run.tool.tool(run.segments),
        Method::Constrained,
    );
    let whole = run.tool.tool(1).segments.remove(0);
    let judge = ParryJudge::new(&world);
    let mut hand = RandomHand::new(run.seed, reach(run.setting));
    let mut state = State::new(&world, hand.pose());
    let mut verdict = Verdict {
        ticks: run.ticks,
        smallest_certificate: f64::INFINITY,
        ..Verdict::default()
    };
    let mut last: Option<(u32, Feature)> = None;
    let mut force = DVec3::ZERO;
    for index in 0..run.ticks {
        let input = TickInput {
            world_from_haptic: hand.advance(force, PERIOD),
        };
        let output = tick(&world, &mut state, &input, PERIOD);
        force = output.wrench.force;
        let feature = output.contact.map(|c| (c.object, c.feature));
        if let (Some(now), Some(before)) = (feature, last) {
            verdict.feature_changes += u32::from(now != before);
        }
        last = feature.or(last);
        verdict.count(&output);
        verdict.watch(&world, &state, &whole, &output);
        if index % run.judge_interval == 0 {
            verdict.judge(&world, &state, &judge);
        }
    }
    verdict
}

impl Verdict {
    fn count(&mut self, output: &TickOutput) {
        self.contact_ticks += u32::from(output.contacts > 0);
        self.held_ticks += u32::from(output.held);
        self.capped_ticks += u32::from(output.capped);
        self.max_force = self.max_force.max(output.wrench.force.length());
    }

    fn watch(&mut self, world: &World, state: &State, whole: &ConvexMesh, output: &TickOutput) {
        self.penetration = self.penetration.max(visual_penetration(world, state));
        let offset = output.world_from_visual.translation - output.world_from_haptic.translation;
        let spring = offset * world.coupling().linear_stiffness;
        self.force_error = self
            .force_error
            .max((output.wrench.force - spring).length());
        let tracker = state
            .constrained()
            .expect("campaigns use the constrained method");
        self.smallest_certificate = self.smallest_certificate.min(tracker.certified_gap());
        if output.contacts == 0 || output.capped {
            return;
        }
        let visual: Pose = output.world_from_visual;
        let planes = fresh_planes(world.obstacles(), whole, &visual);
        let nearest = planes
            .iter()
            .map(|p| p.separation)
            .fold(f64::INFINITY, f64::min);
        self.largest_contact_gap = self.largest_contact_gap.max(nearest);
        if !output.held {
            let push = visual.translation - output.world_from_haptic.translation;
            self.residual = self.residual.max(cone_residual(&planes, push));
        }
    }

    fn judge(&mut self, world: &World, state: &State, judge: &ParryJudge) {
        let tracker = state
            .constrained()
            .expect("campaigns use the constrained method");
        let visual = state.world_from_visual();
        for object in 0..world.obstacles().len() {
            for segment in 0..world.tool().segments.len() {
                let id = |index: usize| u32::try_from(index).expect("few bodies");
                let (normal, _) = tracker.separating_plane(id(object), id(segment));
                self.judged += 1;
                self.overlaps += u32::from(judge.overlaps(object, segment, &visual, normal * 1e-6));
            }
        }
    }
}

fn reach(setting: Setting) -> DVec3 {
    match setting {
        Setting::Box => DVec3::new(0.055, 0.055, 0.03),
        Setting::Plate => DVec3::new(0.055, 0.055, 0.025),
        Setting::Hull => DVec3::splat(0.045),
        Setting::LatitudeLongitude | Setting::Fibonacci => DVec3::new(0.055, 0.045, 0.035),
        Setting::Corner => DVec3::new(0.1, 0.11, 0.05),
        Setting::Slot => DVec3::new(0.06, 0.02, 0.03),
    }
}

/// All runs of the full campaign: every setting, four tools, one and ten segments, three seeds of 15 s.
pub fn full_runs() -> Vec<Run> {
    let tools = [
        (ToolKind::Rod, 1),
        (ToolKind::Rod, 10),
        (ToolKind::ThinRod, 1),
        (ToolKind::Pin, 1),
        (ToolKind::Cone, 1),
        (ToolKind::Cone, 10),
    ];
    let mut runs = Vec::new();
    for setting in Setting::ALL {
        for (tool, segments) in tools {
            for seed in 0..3 {
                runs.push(Run {
                    setting,
                    tool,
                    segments,
                    seed,
                    ticks: 15_000,
                    judge_interval: 4,
                });
            }
        }
    }
    runs
}

/// The fixed-seed subset of every CI run: 10⁵ ticks and a few more.
pub fn short_runs() -> Vec<Run> {
    let mut runs = Vec::new();
    for setting in Setting::ALL {
        for (tool, segments) in [(ToolKind::Rod, 1), (ToolKind::Rod, 10), (ToolKind::Cone, 1)] {
            runs.push(Run {
                setting,
                tool,
                segments,
                seed: 7,
                ticks: 10_000,
                judge_interval: 50,
            });
        }
    }
    runs
}

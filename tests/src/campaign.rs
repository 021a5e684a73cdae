//! Random campaigns: a random hand pushes a tool against objects for seconds at 1 kHz, judges watch every tick.

use glam::DVec3;
use pliant_contact::SKIN;
use pliant_mesh::{ConvexMesh, Feature};
use pliant_sim::{Method, State, TickInput, TickOutput, World, tick, visual_penetration};
use pliant_spatial::Pose;

use crate::bodies::{Setting, TOOL_LENGTH, ToolKind, world};
use crate::hand::RandomHand;
use crate::judge::{cone_residual, fresh_planes, gap_along, height_above};
use crate::parry::ParryJudge;

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
    /// The judges that are too slow for every tick see every so many.
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
    /// Smallest gap along the kept normals over all pairs of judged ticks, over all vertices and not by the solver's own word [m].
    pub smallest_gap: f64,
    /// Largest distance of the nearest object on contact ticks that were not capped [m].
    pub largest_contact_gap: f64,
    /// Smallest and largest distance of the nearest object by the independent library, on judged contact ticks that were not capped [m].
    pub parry_gap: [f64; 2],
    /// Largest cone residual on ticks neither capped nor held [m]; without contact the distance of visual and haptic tool, which is
    /// what a missed contact leaves.
    pub residual: f64,
    /// Farthest a reported contact point of a judged tick lies from the supporting plane of the object it names, or above that of the segment
    /// it names [m].
    pub contact_off_bodies: f64,
    /// Largest |torque| / |force| on contact ticks [m]: the lever of the force about the handle.
    pub largest_lever: f64,
    /// Pairs for which the independent library saw overlap 1 µm out along the separating direction.
    pub overlaps: u32,
    /// Pairs it judged.
    pub judged: u32,
    /// Largest force [N].
    pub max_force: f64,
    /// Largest difference between the rendered force and the spring's, k (x − h) [N].
    pub force_error: f64,
}

/// Lengths beyond which a verdict fails [m].
const LARGEST_PENETRATION: f64 = 1e-9;
const LARGEST_RESIDUAL: f64 = 1e-8;
/// A contact point lies in the supporting plane of its object and at most a skin under that of its segment, which touches within the ten
/// skins that make a patch.
const LARGEST_CONTACT_OFFSET: f64 = 1e-6;
/// What the distances of `parry3d-f64` may be off: over the 276,410 contact ticks judged in the full campaign they differ from the skin by at most
/// 9.2e-16 m.
const PARRY_TOLERANCE: f64 = 1e-12;
/// Bound of the lever of the force about the handle [m]. A single plane gives at most the tool's length, 0.1 m; between nearly opposite planes
/// shares exceed the force itself, and the full campaign measures up to 0.256 m. Exact multipliers gave 4 m (285 N·m at 72 N).
const LARGEST_LEVER: f64 = 3.0 * (TOOL_LENGTH + 0.05);
/// Parts of all ticks.
const LARGEST_CAPPED_PART: f64 = 0.003;
const LARGEST_HELD_PART: f64 = 0.06;

impl Verdict {
    /// The demands every run must meet; each failure in words.
    pub fn failures(&self, run: &Run) -> Vec<String> {
        let mut demands = self.demands_on_counts(run);
        demands.extend(self.demands_on_lengths());
        demands
            .into_iter()
            .filter_map(|(holds, what)| (!holds).then_some(what))
            .collect()
    }

    fn demands_on_counts(&self, run: &Run) -> Vec<(bool, String)> {
        let part = |count: u32| f64::from(count) / f64::from(self.ticks);
        vec![
            (
                3 * self.contact_ticks >= self.ticks,
                format!(
                    "contact in {} of {} ticks, a third asked",
                    self.contact_ticks, self.ticks
                ),
            ),
            (
                self.feature_changes >= 50,
                format!("{} feature changes, 50 asked", self.feature_changes),
            ),
            (
                self.overlaps == 0 && self.judged > 0,
                format!(
                    "{} of {} pairs overlap for parry3d-f64",
                    self.overlaps, self.judged
                ),
            ),
            (
                part(self.capped_ticks) < LARGEST_CAPPED_PART,
                format!("{} capped ticks of {}", self.capped_ticks, self.ticks),
            ),
            (
                self.held_ticks == 0 || run.setting == Setting::Slot,
                format!("{} held ticks outside a slot", self.held_ticks),
            ),
            (
                part(self.held_ticks) < LARGEST_HELD_PART,
                format!("{} held ticks of {}", self.held_ticks, self.ticks),
            ),
        ]
    }

    fn demands_on_lengths(&self) -> Vec<(bool, String)> {
        let at_least = |value: f64, least: f64, what: &str| {
            (
                value >= least,
                format!("{what} {value:.2e}, {least:.2e} asked"),
            )
        };
        let at_most = |value: f64, most: f64, what: &str| {
            (
                value <= most,
                format!("{what} {value:.2e}, {most:.2e} allowed"),
            )
        };
        let gap = 0.25 * SKIN;
        vec![
            at_most(self.penetration, LARGEST_PENETRATION, "penetration [m]"),
            at_least(self.smallest_certificate, gap, "certified gap [m]"),
            at_least(self.smallest_gap, gap, "gap over all vertices [m]"),
            at_most(self.largest_contact_gap, 2.0 * SKIN, "gap in contact [m]"),
            at_least(
                self.parry_gap[0],
                gap - PARRY_TOLERANCE,
                "smallest gap in contact for parry3d-f64 [m]",
            ),
            at_most(
                self.parry_gap[1],
                2.0 * SKIN + PARRY_TOLERANCE,
                "largest gap in contact for parry3d-f64 [m]",
            ),
            at_most(self.residual, LARGEST_RESIDUAL, "cone residual [m]"),
            at_most(
                self.contact_off_bodies,
                LARGEST_CONTACT_OFFSET,
                "contact point off its bodies [m]",
            ),
            at_most(self.largest_lever, LARGEST_LEVER, "lever of the force [m]"),
            at_most(
                self.force_error,
                1e-9,
                "force off the coupling spring's [N]",
            ),
        ]
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
    let judge = ParryJudge::new(&world, &whole);
    let mut hand = RandomHand::new(run.seed, reach(run.setting));
    let mut state = State::new(&world, hand.pose());
    let mut verdict = Verdict {
        ticks: run.ticks,
        smallest_certificate: f64::INFINITY,
        smallest_gap: f64::INFINITY,
        parry_gap: [f64::INFINITY, 0.0],
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
            verdict.judge(&world, &state, &judge, &output);
        }
    }
    verdict
}

impl Verdict {
    fn count(&mut self, output: &TickOutput) {
        self.contact_ticks += u32::from(output.contacts > 0);
        self.held_ticks += u32::from(output.held);
        self.capped_ticks += u32::from(output.capped);
        let force = output.wrench.force.length();
        self.max_force = self.max_force.max(force);
        if output.contacts > 0 {
            // Below 1e-6 N a lever is rounding.
            let lever = output.wrench.torque.length() / force.max(1e-6);
            self.largest_lever = larger(self.largest_lever, lever);
        }
    }

    fn watch(&mut self, world: &World, state: &State, whole: &ConvexMesh, output: &TickOutput) {
        self.penetration = self.penetration.max(visual_penetration(world, state));
        let offset = output.world_from_visual.translation - output.world_from_haptic.translation;
        let spring = offset * world.coupling().linear_stiffness;
        let force_error = (output.wrench.force - spring).length();
        self.force_error = larger(self.force_error, force_error);
        let tracker = state
            .constrained()
            .expect("campaigns use the constrained method");
        self.smallest_certificate = self.smallest_certificate.min(tracker.certified_gap());
        if output.capped {
            return;
        }
        if output.contacts == 0 {
            if !output.held {
                self.residual = self.residual.max(offset.length());
            }
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
            self.residual = self.residual.max(cone_residual(&planes, offset));
        }
    }

    fn judge(&mut self, world: &World, state: &State, judge: &ParryJudge, output: &TickOutput) {
        let tracker = state
            .constrained()
            .expect("campaigns use the constrained method");
        let visual = state.world_from_visual();
        for (object, obstacle) in world.obstacles().iter().enumerate() {
            for (index, segment) in world.tool().segments.iter().enumerate() {
                let id = |index: usize| u32::try_from(index).expect("few bodies");
                let (normal, _) = tracker.separating_plane(id(object), id(index));
                let gap = gap_along(obstacle, segment, &visual, normal);
                self.smallest_gap = self.smallest_gap.min(gap);
                self.judged += 1;
                self.overlaps += u32::from(judge.overlaps(object, index, &visual, normal * 1e-6));
            }
        }
        let Some(contact) = output.contact else {
            return;
        };
        let obstacle = &world.obstacles()[contact.object as usize];
        let segment = &world.tool().segments[contact.segment as usize];
        let height = height_above(obstacle, contact.normal, contact.point);
        let gap = gap_along(obstacle, segment, &visual, contact.normal);
        self.contact_off_bodies = self.contact_off_bodies.max(height.abs()).max(gap - SKIN);
        if !output.capped {
            let nearest = judge.nearest(&visual);
            let [smallest, largest] = self.parry_gap;
            self.parry_gap = [smallest.min(nearest), largest.max(nearest)];
        }
    }
}

/// The larger of two lengths; what is not a number fails every demand.
fn larger(a: f64, b: f64) -> f64 {
    if b.is_nan() { f64::INFINITY } else { a.max(b) }
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

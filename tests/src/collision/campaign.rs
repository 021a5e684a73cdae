//! Random pairs over all families and kinds, judged on all cores of the machine: the same pairs and the same verdicts on any
//! number of them.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};

use pliant_collision::SimplexCache;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::answer::{BLUR, Fault, Question, Verdict};
use super::families::{Family, Pair, walk};
use super::kinds::Kind;
use super::snippet::snippet;

/// Every so many pairs of a cell one is followed along a walk.
const WALK_EVERY: u32 = 24;

/// How many pairs are made.
#[derive(Clone, Copy, Debug)]
pub struct Extent {
    /// Of each family and two kinds.
    pub pairs_per_cell: u32,
    /// Of each family with the ellipsoid of 12,672 faces.
    pub ellipsoid_pairs: u32,
    /// Of each family and two kinds, one a cylinder or cone.
    pub turned_pairs: u32,
}

impl Extent {
    /// More than 10⁶ pairs.
    pub const FULL: Self = Self {
        pairs_per_cell: 480,
        ellipsoid_pairs: 100,
        turned_pairs: 240,
    };

    /// Seconds.
    pub const SHORT: Self = Self {
        pairs_per_cell: 24,
        ellipsoid_pairs: 2,
        turned_pairs: 4,
    };
}

/// Kinds by what they are made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Class {
    /// Both without volume: points, segments, triangles, quadrilaterals.
    Thin,
    /// Both polytopes, one of them solid at least.
    Polytopes,
    /// One has a radius.
    OneRound,
    /// Both have.
    BothRound,
    /// One has 12,672 faces.
    Ellipsoid,
    /// One is a cylinder or cone.
    Turned,
}

/// Families that bring out what is special about 10⁴ faces.
const ELLIPSOID_FAMILIES: [Family; 10] = [
    Family::Apart,
    Family::Penetrating,
    Family::VertexOnVertex,
    Family::FacesParallel,
    Family::EdgesParallel,
    Family::AxisAligned,
    Family::Concentric,
    Family::Inside,
    Family::NearlyParallel,
    Family::Needles,
];

/// Partners of the ellipsoid.
const ELLIPSOID_PARTNERS: [Kind; 5] = [
    Kind::Prism,
    Kind::Capsule,
    Kind::Cuboid,
    Kind::Triangle,
    Kind::Hull32,
];

/// What became of one family in one class.
#[derive(Clone, Debug, Default)]
pub struct Row {
    /// Pairs made.
    pub pairs: u64,
    /// Placements judged, walks included.
    pub placements: u64,
    /// Placements the oracle could not decide.
    pub undecided: u64,
    /// Largest error, relative to the size.
    pub worst: f64,
    /// Placements with an error above [`BLUR`].
    pub blurred: u64,
    /// Placements with a fault.
    pub failed: u64,
    /// Faults by kind.
    pub faults: BTreeMap<Fault, u64>,
}

/// One failure, with what reproduces it.
#[derive(Clone, Debug)]
pub struct Failure {
    /// Which pair.
    pub item: Item,
    /// What went wrong at which step of its walk, 0 the pair itself.
    pub step: usize,
    /// Whether the answer came from the cache of the step before.
    pub how: &'static str,
    /// Faults with their measures relative to the size.
    pub faults: Vec<(Fault, f64)>,
    /// Signed distance by the oracle [m].
    pub truth: f64,
    /// Rust that makes the shapes and placements, to the bit.
    pub snippet: String,
}

/// One pair to make.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Item {
    /// How.
    pub family: Family,
    /// Of what.
    pub kinds: [Kind; 2],
    /// Number within its cell.
    pub index: u32,
}

/// What a campaign found.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// By family and class.
    pub rows: BTreeMap<(Family, Class), Row>,
    /// The first of each cell, in order.
    pub failures: Vec<Failure>,
}

impl Report {
    /// Sum over all rows.
    pub fn total(&self, of: impl Fn(&Row) -> u64) -> u64 {
        self.rows.values().map(of).sum()
    }
}

/// Runs all pairs of an extent.
///
/// # Panics
/// When a worker does.
pub fn run(extent: Extent) -> Report {
    let items = items(extent);
    let workers = std::thread::available_parallelism().map_or(1, usize::from);
    let next = AtomicUsize::new(0);
    let work = || {
        let mut report = Report::default();
        while let Some(item) = items.get(next.fetch_add(1, Ordering::Relaxed)) {
            report.judge(*item);
        }
        report
    };
    let mut report = Report::default();
    std::thread::scope(|scope| {
        let handles: Vec<_> = (0..workers).map(|_| scope.spawn(work)).collect();
        for handle in handles {
            report.merge(handle.join().expect("judging does not panic"));
        }
    });
    report
        .failures
        .sort_by_key(|failure| (failure.item, failure.step));
    report
}

fn items(extent: Extent) -> Vec<Item> {
    let mut items = Vec::new();
    let mut cell = |family, kinds, count| {
        items.extend((0..count).map(|index| Item {
            family,
            kinds,
            index,
        }));
    };
    for family in Family::ALL {
        for (number, &a) in Kind::SMALL.iter().enumerate() {
            for &b in &Kind::SMALL[number..] {
                cell(family, [a, b], extent.pairs_per_cell);
            }
        }
    }
    for family in Family::ALL {
        for turned in [Kind::Cylinder, Kind::Cone] {
            for partner in Kind::SMALL {
                cell(family, [turned, partner], extent.turned_pairs);
            }
        }
        for kinds in [
            [Kind::Cylinder, Kind::Cylinder],
            [Kind::Cylinder, Kind::Cone],
            [Kind::Cone, Kind::Cone],
        ] {
            cell(family, kinds, extent.turned_pairs);
        }
    }
    let partners = u32::try_from(ELLIPSOID_PARTNERS.len()).unwrap_or(1);
    for family in ELLIPSOID_FAMILIES {
        for partner in ELLIPSOID_PARTNERS {
            let count = extent.ellipsoid_pairs.div_ceil(partners);
            cell(family, [partner, Kind::Ellipsoid], count);
        }
    }
    items
}

impl Item {
    fn seed(self) -> u64 {
        let parts = [
            self.family as u64,
            self.kinds[0] as u64,
            self.kinds[1] as u64,
            u64::from(self.index),
        ];
        parts.into_iter().fold(0x9e37_79b9_7f4a_7c15, |hash, part| {
            (hash ^ part)
                .wrapping_mul(0x0000_0100_0000_01b3)
                .rotate_left(29)
        })
    }

    /// The pair, the same every time.
    pub fn pair(self) -> Pair {
        self.family.pair(self.kinds, self.seed())
    }

    fn class(self) -> Class {
        let round = |kind| matches!(kind, Kind::Sphere | Kind::Capsule | Kind::RoundedCuboid);
        let thin = |kind| {
            matches!(
                kind,
                Kind::Point | Kind::Segment | Kind::Triangle | Kind::Quad
            )
        };
        let [a, b] = self.kinds;
        if b == Kind::Ellipsoid {
            return Class::Ellipsoid;
        }
        if a.is_turned() || b.is_turned() {
            return Class::Turned;
        }
        match (round(a), round(b)) {
            (true, true) => Class::BothRound,
            (false, false) if thin(a) && thin(b) => Class::Thin,
            (false, false) => Class::Polytopes,
            _ => Class::OneRound,
        }
    }
}

impl Report {
    fn judge(&mut self, item: Item) {
        let pair = item.pair();
        self.rows
            .entry((item.family, item.class()))
            .or_default()
            .pairs += 1;
        // Left by whatever was there before, as far as the crate knows.
        let mut foreign = SimplexCache::default();
        let mut cache = SimplexCache::default();
        let mut poses = vec![pair.a_from_b];
        let question = Question::new(&pair, &pair.a_from_b);
        let cold = question.closest(&mut cache);
        let undecided = question.undecided;
        self.enter(
            item,
            &pair,
            &poses,
            ("cold", question.separation(), undecided),
            cold,
        );
        fill(&mut foreign);
        let others = question.others(&foreign);
        self.enter(
            item,
            &pair,
            &poses,
            ("other queries", question.separation(), undecided),
            others,
        );
        if !item.index.is_multiple_of(WALK_EVERY) {
            return;
        }
        let mut random = ChaCha8Rng::seed_from_u64(item.seed() ^ 1);
        let middle = pair.shapes[1].core.vertices[0];
        for pose in walk(&pair.a_from_b, pair.size, middle, &mut random) {
            poses.push(pose);
            let question = Question::new(&pair, &pose);
            let warm = question.closest(&mut cache);
            let truth = ("warm", question.separation(), question.undecided);
            self.enter(item, &pair, &poses, truth, warm);
        }
    }

    fn enter(
        &mut self,
        item: Item,
        pair: &Pair,
        poses: &[pliant_spatial::Pose],
        (how, truth, undecided): (&'static str, f64, bool),
        verdict: Verdict,
    ) {
        let row = self.rows.entry((item.family, item.class())).or_default();
        row.placements += 1;
        row.undecided += u64::from(undecided);
        if !undecided {
            row.worst = row.worst.max(verdict.error);
            row.blurred += u64::from(verdict.error > BLUR);
        }
        if verdict.faults.is_empty() {
            return;
        }
        row.failed += 1;
        for (fault, _) in &verdict.faults {
            *row.faults.entry(*fault).or_default() += 1;
        }
        // One per cell is enough to look at; the table counts them all.
        let seen = |failure: &Failure| {
            failure.item.family == item.family && failure.item.kinds == item.kinds
        };
        if !self.failures.iter().any(seen) {
            self.failures.push(Failure {
                item,
                step: poses.len() - 1,
                how,
                faults: verdict.faults,
                truth,
                snippet: snippet(pair, poses),
            });
        }
    }

    fn merge(&mut self, other: Self) {
        for (key, row) in other.rows {
            let own = self.rows.entry(key).or_default();
            own.pairs += row.pairs;
            own.placements += row.placements;
            own.undecided += row.undecided;
            own.worst = own.worst.max(row.worst);
            own.blurred += row.blurred;
            own.failed += row.failed;
            for (fault, count) in row.faults {
                *own.faults.entry(fault).or_default() += count;
            }
        }
        self.failures.extend(other.failures);
    }
}

/// Fills a cache with vertices of another pair.
fn fill(cache: &mut SimplexCache) {
    let others = Item {
        family: Family::Penetrating,
        kinds: [Kind::Hull64, Kind::Hull32],
        index: 0,
    };
    thread_local! {
        static LEFT: std::cell::Cell<Option<SimplexCache>> = const { std::cell::Cell::new(None) };
    }
    let left = LEFT.get().unwrap_or_else(|| {
        let pair = others.pair();
        let mut left = SimplexCache::default();
        Question::new(&pair, &pair.a_from_b).closest(&mut left);
        LEFT.set(Some(left));
        left
    });
    *cache = left;
}

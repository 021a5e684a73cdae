//! Numbers that cannot be wrong once they are read.
//!
//! Each type accepts exactly the values that make sense for it, so that a bad number is refused where it stands in
//! the file and the rest of the crate needs no second look.

use std::fmt;
use std::marker::PhantomData;

use glam::DVec3;
use serde::de::{self, Deserializer, SeqAccess, Visitor};
use serde::{Deserialize, Serialize};

use crate::digits::refused;

/// Lengths above this are taken for a unit mistake: no hand-held scene is a kilometre wide [m].
const LONGEST: f64 = 1000.0;

/// Positions beyond this are a slip, and motions that reach there are refused as well [m].
const FARTHEST: f64 = 1e6;

/// Tools are cut into ten or twenty; a number far above that is a slip, paid for in every tick.
const MOST_SEGMENTS: u32 = 100;

macro_rules! number {
    ($(#[$doc:meta])* $name:ident, $accepts:expr, $expected:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize, Deserialize)]
        #[serde(try_from = "f64", into = "f64")]
        pub struct $name(f64);

        impl $name {
            /// The number.
            pub const fn get(self) -> f64 {
                self.0
            }
        }

        impl TryFrom<f64> for $name {
            type Error = String;

            fn try_from(value: f64) -> Result<Self, String> {
                let accepts: fn(f64) -> bool = $accepts;
                if accepts(value) {
                    Ok(Self(value))
                } else {
                    let value = refused(value, accepts);
                    Err(format!(concat!("{} is out of range; expected ", $expected), value))
                }
            }
        }

        impl From<$name> for f64 {
            fn from(number: $name) -> f64 {
                number.0
            }
        }
    };
}

number!(
    /// A size [m]: positive, at most 1000 m.
    Length,
    |v| v > 0.0 && v <= LONGEST,
    "a length above 0 and up to 1000 m"
);
number!(
    /// A radius that may shrink to a point [m]: 0 to 1000 m.
    RadiusOrPoint,
    |v| (0.0..=LONGEST).contains(&v),
    "a radius from 0 to 1000 m"
);
number!(
    /// A factor: positive and finite.
    Factor,
    |v| v > 0.0 && v.is_finite(),
    "a positive finite number"
);
number!(
    /// A stiffness [N/m] or [N·m/rad]: positive, `inf` allowed.
    Stiffness,
    |v| v > 0.0,
    "a positive stiffness, or inf"
);
number!(
    /// A damping [N·s/m] or [N·m·s/rad]: 0 or more, finite.
    Damping,
    |v| v >= 0.0 && v.is_finite(),
    "a finite damping of 0 or more"
);
number!(
    /// A time span [s]: positive, at most one day.
    Duration,
    |v| v > 0.0 && v <= 86_400.0,
    "a duration above 0 and up to 86400 s"
);
number!(
    /// An angle [degrees]: finite.
    Degrees,
    f64::is_finite,
    "a finite angle in degrees"
);
number!(
    /// One component of a direction: finite.
    Coordinate,
    f64::is_finite,
    "a finite number"
);
number!(
    /// One component of a position [m]: at most 1000 km from the origin, where a double still resolves 0.1 nm.
    Offset,
    |v| v.abs() <= FARTHEST,
    "a coordinate from -1000000 to 1000000 m"
);
number!(
    /// A dihedral threshold [degrees]: above 0, up to 180.
    ThresholdDegrees,
    |v| v > 0.0 && v <= 180.0,
    "an angle above 0 and up to 180 degrees"
);

/// A number of parts, from `MIN` to `MAX`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "f64", into = "f64")]
pub struct Count<const MIN: u32, const MAX: u32>(u32);

impl<const MIN: u32, const MAX: u32> Count<MIN, MAX> {
    /// The number.
    pub const fn get(self) -> u32 {
        self.0
    }

    /// Known when the program is compiled; out of range does not compile when used in a constant.
    ///
    /// # Panics
    /// When `value` is out of range.
    pub const fn new(value: u32) -> Self {
        assert!(MIN <= value && value <= MAX, "the count is out of range");
        Self(value)
    }
}

/// From a float, so that `1.5` is refused as a number out of place and not as a lack of a comma.
impl<const MIN: u32, const MAX: u32> TryFrom<f64> for Count<MIN, MAX> {
    type Error = String;

    fn try_from(value: f64) -> Result<Self, String> {
        let accepts = |v: f64| v.fract() == 0.0 && (f64::from(MIN)..=f64::from(MAX)).contains(&v);
        if accepts(value) {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "whole and between two u32"
            )]
            return Ok(Self(value as u32));
        }
        Err(format!(
            "{} is out of range; expected a whole number from {MIN} to {MAX}",
            refused(value, accepts)
        ))
    }
}

impl<const MIN: u32, const MAX: u32> From<Count<MIN, MAX>> for f64 {
    fn from(count: Count<MIN, MAX>) -> f64 {
        f64::from(count.0)
    }
}

/// Segments of a tool, 1 to 100.
///
/// Each is tested against each object in every tick, so their number is the price of a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "f64", into = "f64")]
pub struct Segments(Count<1, MOST_SEGMENTS>);

impl Segments {
    /// A tool in one piece.
    pub(crate) const ONE: Self = Self(Count::new(1));

    /// The number.
    pub const fn get(self) -> u32 {
        self.0.get()
    }
}

impl TryFrom<f64> for Segments {
    type Error = String;

    fn try_from(value: f64) -> Result<Self, String> {
        let count = Count::try_from(value).map_err(|error: String| {
            if value > f64::from(MOST_SEGMENTS) {
                format!("{error}; each segment is tested against every object in every tick")
            } else {
                error
            }
        })?;
        Ok(Self(count))
    }
}

impl From<Segments> for f64 {
    fn from(segments: Segments) -> f64 {
        segments.0.into()
    }
}

/// A position [m], `(x, y, z)` or `[x, y, z]`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Vector(pub DVec3);

/// Three sizes [m], `(x, y, z)`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Sizes(pub DVec3);

/// A direction of any length but zero, stored at unit length.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Direction(DVec3);

impl Direction {
    /// Unit vector.
    pub const fn unit(self) -> DVec3 {
        self.0
    }
}

/// Reads three numbers, each checked where it stands.
struct TripleVisitor<N>(PhantomData<N>);

impl<'de, N: Deserialize<'de> + Into<f64>> Visitor<'de> for TripleVisitor<N> {
    type Value = DVec3;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("three numbers (x, y, z)")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut numbers: A) -> Result<DVec3, A::Error> {
        let mut triple = [0.0; 3];
        for (found, slot) in triple.iter_mut().enumerate() {
            *slot = numbers
                .next_element::<N>()?
                .ok_or_else(|| de::Error::invalid_length(found, &self))?
                .into();
        }
        match numbers.next_element::<de::IgnoredAny>()? {
            None => Ok(DVec3::from(triple)),
            Some(_) => Err(de::Error::invalid_length(4, &self)),
        }
    }
}

/// `any`, not `tuple`: a list in square brackets is as good as RON's tuple, for those who come from JSON.
fn triple<'de, N, D>(deserializer: D) -> Result<DVec3, D::Error>
where
    N: Deserialize<'de> + Into<f64>,
    D: Deserializer<'de>,
{
    deserializer.deserialize_any(TripleVisitor::<N>(PhantomData))
}

impl<'de> Deserialize<'de> for Vector {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        triple::<Offset, D>(deserializer).map(Self)
    }
}

impl<'de> Deserialize<'de> for Sizes {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        triple::<Length, D>(deserializer).map(Self)
    }
}

impl<'de> Deserialize<'de> for Direction {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let vector = triple::<Coordinate, D>(deserializer)?;
        // Scaled by the largest component first: squares of 1e-200 or 1e200 would vanish or overflow.
        let largest = vector.abs().max_element();
        (vector / largest)
            .try_normalize()
            .filter(|_| largest > 0.0)
            .map(Self)
            .ok_or_else(|| {
                de::Error::custom("(0, 0, 0) is no direction; expected a vector that is not zero")
            })
    }
}

// Defaults of the schema. They sit here because only this module may skip the range check.

impl Length {
    /// Edge strips of the published method.
    pub(crate) const EDGE_WIDTH: Self = Self(1e-4);
}

impl Factor {
    /// The coupling's linear stiffness [N/m].
    pub(crate) const LINEAR_STIFFNESS: Self = Self(1000.0);
}

impl Stiffness {
    /// Orientation follows the hand.
    pub(crate) const RIGID: Self = Self(f64::INFINITY);
}

impl Default for Factor {
    fn default() -> Self {
        Self(1.0)
    }
}

impl Default for Damping {
    fn default() -> Self {
        Self(0.0)
    }
}

impl Default for Degrees {
    fn default() -> Self {
        Self(0.0)
    }
}

impl Default for Vector {
    fn default() -> Self {
        Self(DVec3::ZERO)
    }
}

impl Default for Direction {
    /// About z, for rotations by no angle.
    fn default() -> Self {
        Self(DVec3::Z)
    }
}

impl Direction {
    /// Along x: how the generated tools point.
    pub(crate) const X: Self = Self(DVec3::X);
}

impl Default for RadiusOrPoint {
    fn default() -> Self {
        Self(0.0)
    }
}

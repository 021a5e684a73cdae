//! How the section changes along a beam.

use crate::error::{BeamError, demand};
use crate::section::Shape;

/// Most rows of a table: each element looks through them.
pub(crate) const MOST_ROWS: usize = 10_000;

/// Sections along the length, from the root (s = 0) to the tip.
#[derive(Clone, Debug, PartialEq)]
pub enum Profile {
    /// The same everywhere.
    Uniform(Shape),
    /// From root to tip, the measures linear in between: both of one kind.
    Linear {
        /// At s = 0.
        root: Shape,
        /// At s = length.
        tip: Shape,
    },
    /// At given stations s [m], ascending, the measures linear in between. Two rows at one station are a step there. Before
    /// the first station and after the last one the section stays.
    Table(Vec<(f64, Shape)>),
}

impl Profile {
    /// The section at `s` of `length` [m]; at a step the one towards the tip.
    pub fn at(&self, s: f64, length: f64) -> Shape {
        match self {
            Self::Uniform(shape) => *shape,
            Self::Linear { root, tip } => root.between(tip, s / length),
            Self::Table(rows) => {
                let next = rows.partition_point(|(station, _)| *station <= s);
                let Some((after, shape_after)) = rows.get(next) else {
                    return rows[rows.len() - 1].1;
                };
                let Some((before, shape_before)) = next.checked_sub(1).map(|index| &rows[index])
                else {
                    return *shape_after;
                };
                shape_before.between(shape_after, (s - before) / (after - before))
            }
        }
    }

    /// Stations strictly between 0 and `length` at which the section bends or steps, ascending.
    pub(crate) fn stations(&self, length: f64) -> impl Iterator<Item = f64> {
        let rows: &[(f64, Shape)] = match self {
            Self::Table(rows) => rows,
            _ => &[],
        };
        rows.iter()
            .map(|(station, _)| *station)
            .filter(move |station| *station > 0.0 && *station < length)
    }

    /// The first station beyond an arc position [m].
    pub(crate) fn station_after(&self, s: f64) -> Option<f64> {
        let Self::Table(rows) = self else {
            return None;
        };
        let next = rows.partition_point(|(station, _)| *station <= s);
        rows.get(next).map(|(station, _)| *station)
    }

    pub(crate) fn check(&self) -> Result<(), BeamError> {
        match self {
            Self::Uniform(shape) => shape.check("profile"),
            Self::Linear { root, tip } => {
                root.check("profile.root")?;
                tip.check("profile.tip")?;
                same_kind("profile.tip", root, tip)
            }
            Self::Table(rows) => check_table(rows),
        }
    }
}

fn check_table(rows: &[(f64, Shape)]) -> Result<(), BeamError> {
    if rows.is_empty() || rows.len() > MOST_ROWS {
        return Err(BeamError::Count {
            field: "profile",
            value: rows.len(),
            least: 1,
            most: MOST_ROWS,
        });
    }
    for (index, (station, shape)) in rows.iter().enumerate() {
        let field = format!("profile[{index}]");
        shape.check(&field)?;
        let before = index.checked_sub(1).map(|before| &rows[before]);
        let ascends = before.is_none_or(|(before, _)| station >= before);
        demand(
            format!("{field}.station"),
            *station,
            ascends,
            "finite and not before the row above",
        )?;
        if let Some((before, other)) = before
            && before < station
        {
            same_kind(&field, other, shape)?;
        }
    }
    Ok(())
}

fn same_kind(field: &str, from: &Shape, to: &Shape) -> Result<(), BeamError> {
    if from.kind() == to.kind() {
        return Ok(());
    }
    Err(BeamError::Mixed {
        field: field.to_owned(),
        from: from.kind(),
        to: to.kind(),
    })
}

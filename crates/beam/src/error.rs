//! What can be wrong with a beam, and where.

/// A beam that cannot be built, or a question that it cannot answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BeamError {
    /// A number outside its range, or not a number.
    #[error("{field} is {value:e}; it must be {demand}")]
    Value {
        /// Name of the field as in [`crate::BeamSpec`], with the index of a table's row.
        field: String,
        /// What was given.
        value: f64,
        /// What is asked.
        demand: &'static str,
    },
    /// Too few or too many of something.
    #[error("{field} has {value} entries; between {least} and {most} are possible")]
    Count {
        /// Name of the field as in [`crate::BeamSpec`].
        field: &'static str,
        /// How many were given.
        value: usize,
        /// The fewest possible.
        least: usize,
        /// The most possible.
        most: usize,
    },
    /// Two neighbouring sections of different kinds, between which nothing can be interpolated.
    #[error(
        "{field} changes from {from} to {to} without a step; give both at the same station to make one"
    )]
    Mixed {
        /// Name of the field as in [`crate::BeamSpec`], with the row where the change ends.
        field: String,
        /// Kind of section before.
        from: &'static str,
        /// Kind of section after.
        to: &'static str,
    },
    /// A name that the catalogue does not have.
    #[error(
        "there is no tool named '{name}'; most like it are {nearest}; the catalogue has {names}"
    )]
    UnknownTool {
        /// What was asked for.
        name: String,
        /// The names most like it, with commas.
        nearest: String,
        /// All names there are, with commas.
        names: String,
    },
}

/// An error unless `value` is finite and above zero.
pub(crate) fn positive(field: impl Into<String>, value: f64) -> Result<(), BeamError> {
    demand(field, value, value > 0.0, "finite and above 0")
}

/// An error unless `value` is finite and not negative.
pub(crate) fn not_negative(field: impl Into<String>, value: f64) -> Result<(), BeamError> {
    demand(field, value, value >= 0.0, "finite and not negative")
}

/// An error unless `value` is a number.
pub(crate) fn finite(field: impl Into<String>, value: f64) -> Result<(), BeamError> {
    demand(field, value, true, "finite")
}

/// An error unless `value` is finite and `holds`.
pub(crate) fn demand(
    field: impl Into<String>,
    value: f64,
    holds: bool,
    demand: &'static str,
) -> Result<(), BeamError> {
    if holds && value.is_finite() {
        return Ok(());
    }
    Err(BeamError::Value {
        field: field.into(),
        value,
        demand,
    })
}

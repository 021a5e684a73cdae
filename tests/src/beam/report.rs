//! Errors by kind of case.

use std::collections::BTreeMap;

/// One comparison.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// Kind of case, with the method that answered.
    pub kind: String,
    /// Which case.
    pub case: String,
    /// Relative error.
    pub error: f64,
    /// Largest error allowed.
    pub allowed: f64,
}

/// All comparisons of one kind.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Row {
    /// How many there are.
    pub count: u32,
    /// The largest error.
    pub worst: f64,
    /// The largest share of what is allowed.
    pub worst_share: f64,
    /// Those above what is allowed.
    pub failures: Vec<Finding>,
}

/// Rows by kind.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    /// In the order of their names.
    pub rows: BTreeMap<String, Row>,
}

impl Report {
    /// Enters a comparison. An error that is not a number fails.
    pub fn add(&mut self, finding: Finding) {
        let row = self.rows.entry(finding.kind.clone()).or_default();
        row.count += 1;
        let share = finding.error / finding.allowed;
        row.worst = row.worst.max(finding.error);
        row.worst_share = row.worst_share.max(share);
        if finding.error.is_nan() || finding.error > finding.allowed {
            row.failures.push(finding);
        }
    }

    /// How many comparisons failed.
    pub fn failed(&self) -> usize {
        self.rows.values().map(|row| row.failures.len()).sum()
    }
}

//! What a check found: one type and one way to report it.

use anyhow::{Result, bail};
use std::fmt;

/// One breach of a rule.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Finding {
    /// File or crate it is about.
    pub(crate) subject: String,
    /// Line, counted from one; zero when the subject as a whole is meant.
    pub(crate) line: usize,
    /// What is wrong and what would be right.
    pub(crate) message: String,
}

impl Finding {
    /// About a subject as a whole.
    pub(crate) fn whole(subject: &str, message: impl Into<String>) -> Self {
        Self {
            subject: subject.to_owned(),
            line: 0,
            message: message.into(),
        }
    }

    /// About one line, counted from one.
    pub(crate) fn at(subject: &str, line: usize, message: impl Into<String>) -> Self {
        Self {
            subject: subject.to_owned(),
            line,
            message: message.into(),
        }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.line == 0 {
            write!(formatter, "{}: {}", self.subject, self.message)
        } else {
            write!(
                formatter,
                "{}:{}: {}",
                self.subject, self.line, self.message
            )
        }
    }
}

/// Prints findings in order of subject and line.
///
/// # Errors
/// When there is any, with their number and the name of the check.
pub(crate) fn report(check: &str, mut findings: Vec<Finding>) -> Result<()> {
    findings.sort();
    findings.dedup();
    for finding in &findings {
        eprintln!("{finding}");
    }
    match findings.len() {
        0 => Ok(()),
        1 => bail!("{check}: one finding, see above"),
        count => bail!("{check}: {count} findings, see above"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn line_is_shown_only_when_known() {
        assert_eq!(Finding::at("a.rs", 3, "tab").to_string(), "a.rs:3: tab");
        assert_eq!(
            Finding::whole("a.rs", "too long").to_string(),
            "a.rs: too long"
        );
    }

    #[test]
    fn any_finding_is_an_error() {
        assert!(report("tidy", Vec::new()).is_ok());
        let error = report("tidy", vec![Finding::whole("a.rs", "x")]).unwrap_err();
        assert_eq!(error.to_string(), "tidy: one finding, see above");
    }
}

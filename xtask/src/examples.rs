//! Every example of every library crate runs to its end.

use crate::process;
use crate::workspace::Workspace;
use anyhow::{Result, bail};
use std::collections::BTreeMap;
use std::process::Command;

/// Builds the examples as `cargo test` does, then runs them one by one; what they print is shown only on failure.
///
/// # Errors
/// When two crates have an example of the same name, an example does not build, or one ends with a code other than zero.
pub(crate) fn check() -> Result<()> {
    let workspace = Workspace::load()?;
    let mut owner_of: BTreeMap<&str, &str> = BTreeMap::new();
    for member in workspace.libraries() {
        for example in &member.examples {
            if let Some(other) = owner_of.insert(example, &member.name) {
                bail!(
                    "{other} and {} both have an example `{example}`; they share one file when built",
                    member.name
                );
            }
        }
    }
    process::run(&mut process::cargo(&["build", "--workspace", "--examples"]))?;
    for (example, owner) in owner_of {
        let program = workspace.target.join("debug/examples").join(example);
        println!("    {owner}: {example}");
        process::output(Command::new(program).current_dir(&workspace.root))?;
    }
    Ok(())
}

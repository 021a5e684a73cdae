//! Packs every library crate and builds each from its tarball, as a user of the published crate would.
//!
//! `cargo package` can verify by itself, through a temporary registry in the target folder. Cargo takes packages of a registry
//! for immutable, so on a second run a crate is verified against the *first* run's copy of the crates it depends on (seen with
//! cargo 1.95: `fresh` added to one crate and used by the next was "not found"). Therefore cargo only packs here; the tarballs
//! are unpacked side by side into a workspace of their own that patches them together, and checked there: each library
//! alone, with the features it asks for itself, then all examples. Third-party artefacts are those of the other steps.

use crate::process;
use crate::workspace::{Member, Workspace};
use anyhow::{Context, Result};
use std::fs;
use std::path::Path;
use std::process::Command;
use toml::{Table, Value};

/// Packs and verifies all library crates.
///
/// # Errors
/// When a crate cannot be packed, its tarball misses a file it needs, or it does not build alone.
pub(crate) fn check() -> Result<()> {
    let workspace = Workspace::load()?;
    let libraries: Vec<&Member> = workspace.libraries().collect();
    let packed = workspace.target.join("package");
    let unpacked = workspace.target.join("package-verified");
    // Left-overs of an earlier run confuse cargo's temporary registry, and would hide a file that is no longer packed.
    remove_folder(&packed)?;
    remove_folder(&unpacked)?;
    fs::create_dir_all(&unpacked)
        .with_context(|| format!("{} cannot be made", unpacked.display()))?;

    // A change is checked before it is committed; what git does not know is left out of the tarball all the same.
    let mut pack = process::cargo(&["package", "--quiet", "--no-verify", "--allow-dirty"]);
    pack.args(
        libraries
            .iter()
            .flat_map(|library| ["--package", library.name.as_str()]),
    );
    process::run(pack.current_dir(&workspace.root))?;
    for library in &libraries {
        unpack(&packed.join(tarball(library)), &unpacked)?;
    }
    let manifest = toml::to_string(&verifying_manifest(&workspace)?)
        .context("the verifying manifest cannot be written")?;
    write(&unpacked.join("Cargo.toml"), &manifest)?;
    fs::copy(
        workspace.root.join("Cargo.lock"),
        unpacked.join("Cargo.lock"),
    )
    .context("Cargo.lock cannot be copied")?;

    for library in &libraries {
        process::run(&mut in_unpacked(
            &["check", "--quiet", "--package", &library.name],
            &workspace,
            &unpacked,
        ))?;
    }
    process::run(&mut in_unpacked(
        &["check", "--quiet", "--workspace", "--examples"],
        &workspace,
        &unpacked,
    ))?;
    println!(
        "    {} library crates build from their tarballs",
        libraries.len()
    );
    Ok(())
}

fn in_unpacked(arguments: &[&str], workspace: &Workspace, unpacked: &Path) -> Command {
    let mut command = process::cargo(arguments);
    command
        .current_dir(unpacked)
        .arg("--target-dir")
        .arg(&workspace.target);
    command
}

fn tarball(library: &Member) -> String {
    format!("{}.crate", folder_name(library))
}

fn folder_name(library: &Member) -> String {
    format!("{}-{}", library.name, library.version)
}

/// Unpacks with today's time stamps: the packed ones are always the same, and cargo judges by them what to rebuild.
fn unpack(tarball: &Path, folder: &Path) -> Result<()> {
    let mut tar = Command::new("tar");
    tar.args(["--extract", "--gzip", "--touch", "--file"])
        .arg(tarball)
        .arg("--directory")
        .arg(folder);
    process::output(&mut tar)
        .map(drop)
        .context("unpacking needs the program tar (Debian: apt-get install tar)")
}

/// A workspace of the unpacked crates that builds with the profiles of the real one and takes the crates from each other.
fn verifying_manifest(workspace: &Workspace) -> Result<Table> {
    let root = workspace
        .manifest
        .get("workspace")
        .context("the root manifest has no [workspace]")?;
    let names: Vec<Value> = workspace
        .libraries()
        .map(|library| Value::from(folder_name(library)))
        .collect();
    let mut inner = Table::new();
    inner.insert("members".into(), Value::Array(names));
    inner.insert(
        "resolver".into(),
        root.get("resolver")
            .context("the root manifest names no resolver")?
            .clone(),
    );
    let patched = workspace.libraries().map(|library| {
        let place = Table::from_iter([("path".to_owned(), Value::from(folder_name(library)))]);
        (library.name.clone(), Value::Table(place))
    });
    let patch = Table::from_iter([("crates-io".to_owned(), Value::Table(patched.collect()))]);
    let mut manifest = Table::new();
    manifest.insert("workspace".into(), Value::Table(inner));
    manifest.insert("patch".into(), Value::Table(patch));
    if let Some(profile) = workspace.manifest.get("profile") {
        manifest.insert("profile".into(), profile.clone());
    }
    Ok(manifest)
}

fn remove_folder(folder: &Path) -> Result<()> {
    if folder.exists() {
        fs::remove_dir_all(folder)
            .with_context(|| format!("{} cannot be removed", folder.display()))?;
    }
    Ok(())
}

fn write(path: &Path, text: &str) -> Result<()> {
    fs::write(path, text).with_context(|| format!("{} cannot be written", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verifying_workspace_patches_every_library() {
        let workspace = Workspace::load().unwrap();
        let manifest = verifying_manifest(&workspace).unwrap();
        let members = manifest["workspace"]["members"].as_array().unwrap();
        assert_eq!(members.len(), workspace.libraries().count());
        assert!(
            members
                .iter()
                .all(|member| member.as_str().unwrap().starts_with("pliant-"))
        );
        let place = manifest["patch"]["crates-io"]["pliant-spatial"]["path"]
            .as_str()
            .unwrap();
        assert!(members.iter().any(|member| member.as_str() == Some(place)));
        assert_eq!(manifest["profile"], workspace.manifest["profile"]);
    }
}

//! The workspace as cargo sees it: members, their declared dependencies and their manifests.

use anyhow::{Context, Result};
use cargo_metadata::{DependencyKind, MetadataCommand, Package, TargetKind};
use std::path::{Path, PathBuf};
use toml::Table;

/// The workspace and all its members.
#[derive(Debug)]
pub(crate) struct Workspace {
    /// Folder of the root manifest.
    pub(crate) root: PathBuf,
    /// Folder of build artefacts.
    pub(crate) target: PathBuf,
    /// Root manifest.
    pub(crate) manifest: Table,
    /// Members in order of name.
    pub(crate) members: Vec<Member>,
}

/// One member.
#[derive(Debug)]
pub(crate) struct Member {
    /// Package name.
    pub(crate) name: String,
    /// Package version.
    pub(crate) version: String,
    /// Folder of its manifest.
    pub(crate) folder: PathBuf,
    /// Lives under `crates/`: published, documented, useful alone.
    pub(crate) is_library: bool,
    /// Its manifest as written, inheritance unresolved.
    pub(crate) manifest: Table,
    /// Names of its example programs.
    pub(crate) examples: Vec<String>,
    /// Everything under its dependency tables, of any kind and target.
    pub(crate) dependencies: Vec<Dependency>,
}

/// One declared dependency.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Dependency {
    /// Package name.
    pub(crate) package: String,
    /// Name its sources use, with underscores.
    pub(crate) import: String,
    /// Under `[dev-dependencies]`.
    pub(crate) dev: bool,
}

impl Workspace {
    /// Asks cargo about the workspace that holds the current folder.
    ///
    /// # Errors
    /// When cargo fails or a manifest cannot be read.
    pub(crate) fn load() -> Result<Self> {
        let metadata = MetadataCommand::new()
            .no_deps()
            .exec()
            .context("cargo metadata failed")?;
        let root = metadata.workspace_root.clone().into_std_path_buf();
        let mut members = metadata
            .workspace_packages()
            .into_iter()
            .map(|package| Member::new(&root, package))
            .collect::<Result<Vec<_>>>()?;
        members.sort_by(|a, b| a.name.cmp(&b.name));
        Ok(Self {
            manifest: read_manifest(&root.join("Cargo.toml"))?,
            target: metadata.target_directory.into_std_path_buf(),
            root,
            members,
        })
    }

    /// The library crates.
    pub(crate) fn libraries(&self) -> impl Iterator<Item = &Member> {
        self.members.iter().filter(|member| member.is_library)
    }
}

impl Member {
    fn new(root: &Path, package: &Package) -> Result<Self> {
        let path = package.manifest_path.as_std_path();
        let folder = path
            .parent()
            .context("a manifest lies in a folder")?
            .to_path_buf();
        let examples = package
            .targets
            .iter()
            .filter(|target| target.kind.contains(&TargetKind::Example));
        Ok(Self {
            name: package.name.to_string(),
            version: package.version.to_string(),
            is_library: folder.starts_with(root.join("crates")),
            manifest: read_manifest(path)?,
            examples: examples.map(|target| target.name.clone()).collect(),
            dependencies: package.dependencies.iter().map(Dependency::new).collect(),
            folder,
        })
    }
}

impl Dependency {
    fn new(declared: &cargo_metadata::Dependency) -> Self {
        let import = declared.rename.as_deref().unwrap_or(&declared.name);
        Self {
            package: declared.name.clone(),
            import: import.replace('-', "_"),
            dev: declared.kind == DependencyKind::Development,
        }
    }
}

fn read_manifest(path: &Path) -> Result<Table> {
    let text = std::fs::read_to_string(path)
        .with_context(|| format!("{} cannot be read", path.display()))?;
    text.parse()
        .with_context(|| format!("{} is no valid manifest", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn own_workspace_is_seen_as_it_is() {
        let workspace = Workspace::load().unwrap();
        let member = |name: &str| {
            workspace
                .members
                .iter()
                .find(|member| member.name == name)
                .unwrap()
        };
        assert!(
            member("pliant-spatial").is_library
                && !member("xtask").is_library
                && !member("pliant").is_library
        );
        let glam = Dependency {
            package: "glam".into(),
            import: "glam".into(),
            dev: false,
        };
        assert!(member("pliant-spatial").dependencies.contains(&glam));
        let collision = member("pliant-tests")
            .dependencies
            .iter()
            .find(|d| d.package == "pliant-collision");
        assert_eq!(collision.unwrap().import, "pliant_collision");
        assert!(workspace.manifest.contains_key("profile"));
        assert!(workspace.root.join("xtask").is_dir());
    }
}

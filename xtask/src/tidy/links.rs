//! Links between files: every local target in Markdown exists in the project.

use super::{Tree, has_extension};
use crate::finding::Finding;

/// Each local link of each Markdown file names a file or folder of the project.
pub(super) fn resolve(tree: &Tree) -> Vec<Finding> {
    let pages = tree.iter().filter(|(path, _)| has_extension(path, &["md"]));
    pages
        .flat_map(|(path, text)| check_page(path, text.as_deref().unwrap_or(""), tree))
        .collect()
}

fn check_page(path: &str, text: &str, tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    let mut in_code = false;
    for (at, line) in text.lines().enumerate() {
        if line.trim_start().starts_with("```") {
            in_code = !in_code;
        } else if !in_code {
            let broken = targets(line)
                .into_iter()
                .filter(|target| is_broken(path, target, tree));
            findings.extend(broken.map(|target| {
                Finding::at(
                    path,
                    at + 1,
                    format!("link to {target}, which is not there"),
                )
            }));
        }
    }
    findings
}

/// Targets of inline links and pictures, of reference definitions and of HTML attributes, code spans left out.
fn targets(line: &str) -> Vec<String> {
    let line: String = line.split('`').step_by(2).collect::<Vec<_>>().join("`");
    let mut found = Vec::new();
    for (opening, closing) in [("](", ")"), ("src=\"", "\""), ("href=\"", "\"")] {
        let parts = line
            .split(opening)
            .skip(1)
            .filter_map(|rest| rest.split(closing).next());
        found.extend(parts.filter_map(first_word));
    }
    if line.starts_with('[') && !line.starts_with("[^") {
        found.extend(
            line.split_once("]: ")
                .and_then(|(_, target)| first_word(target)),
        );
    }
    found
}

/// The target without its title and angle brackets.
fn first_word(target: &str) -> Option<String> {
    let word = target.split_whitespace().next()?;
    Some(
        word.trim_start_matches('<')
            .trim_end_matches('>')
            .to_owned(),
    )
}

fn is_broken(page: &str, target: &str, tree: &Tree) -> bool {
    let target = target.split('#').next().unwrap_or("");
    if target.is_empty() || target.contains("://") || target.starts_with("mailto:") {
        return false;
    }
    let folder = page.rsplit_once('/').map_or("", |(folder, _)| folder);
    let Some(path) = normalise(folder, target) else {
        return true;
    };
    let inside = format!("{path}/");
    !path.is_empty()
        && !tree.contains_key(&path)
        && !tree.keys().any(|file| file.starts_with(&inside))
}

/// The target's path from the root; none when it leaves the project.
fn normalise(folder: &str, target: &str) -> Option<String> {
    if target.starts_with('/') {
        return None;
    }
    let mut parts: Vec<&str> = Vec::new();
    for part in folder.split('/').chain(target.split('/')) {
        match part {
            "" | "." => {}
            ".." => drop(parts.pop()?),
            name => parts.push(name),
        }
    }
    Some(parts.join("/"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn broken(page: &str, text: &str) -> Vec<usize> {
        let names = [
            "README.md",
            "docs/paper.md",
            "docs/force.png",
            "crates/mesh/README.md",
        ];
        let tree: Tree = names
            .iter()
            .map(|name| ((*name).to_owned(), None))
            .collect();
        check_page(page, text, &tree)
            .iter()
            .map(|finding| finding.line)
            .collect()
    }

    #[test]
    fn links_that_resolve_pass() {
        let text = "[p](docs/paper.md#limits) ![f](docs/force.png \"Force\") [crates](crates/) [here](#units)\n\
                    <img src=\"docs/force.png\">\n[web](https://example.org/x)\n[p]: docs/paper.md\n";
        assert_eq!(broken("README.md", text), Vec::<usize>::new());
        assert_eq!(
            broken(
                "crates/mesh/README.md",
                "[up](../../README.md) [root](../..)\n"
            ),
            Vec::<usize>::new()
        );
    }

    #[test]
    fn each_kind_of_broken_link_is_found() {
        let text = "[p](docs/papers.md)\n<img src=\"force.png\">\n[x]: nowhere.md\n[out](../elsewhere.md)\n[abs](/docs/paper.md)\n";
        assert_eq!(broken("README.md", text), [1, 2, 3, 4, 5]);
        assert_eq!(broken("docs/paper.md", "[p](docs/paper.md)\n"), [1]);
    }

    #[test]
    fn code_is_no_link() {
        assert_eq!(
            broken(
                "README.md",
                "```rust\nlet a = b[0](c);\n```\nand `x[0](d)` too\n"
            ),
            Vec::<usize>::new()
        );
    }
}

//! Numbered equations: theory and code cite each other.
//!
//! An equation of `docs/theory/contact.md` ends with its tag in bold and the items that compute it, by path and in
//! backticks: `**(contact.7)** — ` and the path. The documentation of each of these items holds `(contact.7)`. Checked: numbers are
//! unique, every tag names an item, every item named cites the tag, every citation has its equation.

use super::{Tree, has_extension, is_rust};
use crate::finding::Finding;
use std::collections::BTreeMap;

const THEORY: &str = "docs/theory/";

/// Subjects of the theory; in other words `(name.3)` in a comment is just text.
const SUBJECTS: [&str; 5] = ["mesh", "collision", "contact", "beam", "servo"];

/// A numbered equation.
struct Equation {
    tag: String,
    /// Items that compute it, as `pliant_contact::module::function`.
    items: Vec<String>,
    path: String,
    line: usize,
}

/// A tag in the documentation of an item.
struct Citation {
    tag: String,
    item: String,
    path: String,
    line: usize,
}

/// Checks both directions.
pub(super) fn tie(tree: &Tree) -> Vec<Finding> {
    let texts = || {
        tree.iter()
            .filter_map(|(path, text)| Some((path.as_str(), text.as_deref()?)))
    };
    let pages =
        texts().filter(|(path, _)| path.starts_with(THEORY) && has_extension(path, &["md"]));
    let equations: Vec<Equation> = pages
        .flat_map(|(path, text)| equations_of(path, text))
        .collect();
    let sources = texts().filter(|(path, _)| path.starts_with("crates/") && is_rust(path));
    let citations: Vec<Citation> = sources
        .flat_map(|(path, text)| citations_of(path, text))
        .collect();

    let mut findings = Vec::new();
    let mut first_of: BTreeMap<&str, &Equation> = BTreeMap::new();
    for equation in &equations {
        if let Some(first) = first_of.insert(&equation.tag, equation) {
            let message = format!(
                "{} is already the equation of {}:{}",
                equation.tag, first.path, first.line
            );
            findings.push(Finding::at(&equation.path, equation.line, message));
        }
        findings.extend(check_equation(equation, &citations));
    }
    for citation in citations
        .iter()
        .filter(|citation| !first_of.contains_key(citation.tag.as_str()))
    {
        let message = format!("cites {}, which is no equation of {THEORY}", citation.tag);
        findings.push(Finding::at(&citation.path, citation.line, message));
    }
    findings
}

fn check_equation(equation: &Equation, citations: &[Citation]) -> Vec<Finding> {
    let found = |message: String| Finding::at(&equation.path, equation.line, message);
    let file = equation.path.rsplit('/').next().unwrap_or("");
    let subject = equation
        .tag
        .trim_start_matches('(')
        .split('.')
        .next()
        .unwrap_or("");
    let mut findings = Vec::new();
    if file != format!("{subject}.md") {
        findings.push(found(format!(
            "{} belongs into {THEORY}{subject}.md",
            equation.tag
        )));
    }
    if equation.items.is_empty() {
        findings.push(found(format!(
            "{} names no function: write its path in backticks behind the tag",
            equation.tag
        )));
    }
    let uncited = equation.items.iter().filter(|item| {
        !citations
            .iter()
            .any(|it| it.tag == equation.tag && is_item(it, item))
    });
    findings.extend(uncited.map(|item| {
        found(format!(
            "{item} does not exist or its documentation lacks {}",
            equation.tag
        ))
    }));
    findings
}

/// Whether the citation stands in the documentation of the item with this path: same crate, same last name.
fn is_item(citation: &Citation, item: &str) -> bool {
    let mut parts = item.split("::");
    let package = parts
        .next()
        .and_then(|name| name.strip_prefix("pliant_"))
        .unwrap_or("");
    let folder = format!("crates/{package}/src/");
    citation.path.starts_with(&folder) && item.rsplit("::").next() == Some(citation.item.as_str())
}

fn equations_of(path: &str, text: &str) -> Vec<Equation> {
    let mut equations: Vec<Equation> = Vec::new();
    let mut open = false;
    for (at, line) in text.lines().enumerate() {
        let mut rest = line;
        if line.trim().is_empty() {
            open = false;
        }
        while let Some((before, tag, after)) = bold_tag(rest) {
            collect_items(&mut equations, open, before);
            equations.push(Equation {
                tag,
                items: Vec::new(),
                path: path.to_owned(),
                line: at + 1,
            });
            open = true;
            rest = after;
        }
        collect_items(&mut equations, open, rest);
    }
    equations
}

/// Adds the paths in `text` to the last equation, if its paragraph is still going on.
fn collect_items(equations: &mut [Equation], open: bool, text: &str) {
    if let Some(equation) = equations.last_mut().filter(|_| open) {
        let spans = text.split('`').skip(1).step_by(2);
        let paths = spans.filter(|span| span.starts_with("pliant_") && span.contains("::"));
        equation
            .items
            .extend(paths.map(|path| path.trim_end_matches("()").to_owned()));
    }
}

/// The first bold tag: text before it, the tag, text behind it.
fn bold_tag(text: &str) -> Option<(&str, String, &str)> {
    let (at, tag) = tags(text).into_iter().find(|(at, tag)| {
        text[..*at].ends_with("**") && text[at + tag.len()..].starts_with("**")
    })?;
    Some((&text[..at], tag.to_owned(), &text[at + tag.len()..]))
}

/// All `(subject.number)` in a text, with their places.
fn tags(text: &str) -> Vec<(usize, &str)> {
    let openings = text.match_indices('(');
    let bracketed =
        openings.filter_map(|(at, _)| Some((at, &text[at..=at + text[at..].find(')')?])));
    bracketed
        .filter(|(_, tag)| is_tag(&tag[1..tag.len() - 1]))
        .collect()
}

fn is_tag(inner: &str) -> bool {
    inner.split_once('.').is_some_and(|(subject, number)| {
        SUBJECTS.contains(&subject)
            && !number.is_empty()
            && number.bytes().all(|byte| byte.is_ascii_digit())
    })
}

/// Tags in doc comments, each with the item that follows; those of a module's own documentation with the module's name.
fn citations_of(path: &str, text: &str) -> Vec<Citation> {
    let mut citations = Vec::new();
    let mut waiting: Vec<(usize, String)> = Vec::new();
    let mut attribute_depth = 0;
    for (at, line) in text.lines().enumerate() {
        let code = line.trim();
        let found = || {
            tags(code)
                .into_iter()
                .map(|(_, tag)| (at + 1, tag.to_owned()))
        };
        if code.starts_with("//!") {
            citations
                .extend(found().map(|(line, tag)| citation(path, line, tag, module_name(path))));
        } else if code.starts_with("///") {
            waiting.extend(found());
        } else if attribute_depth > 0 || code.starts_with("#[") {
            // An attribute between documentation and item may span lines.
            attribute_depth += code.matches(['[', '(']).count();
            attribute_depth -= code.matches([']', ')']).count().min(attribute_depth);
        } else if !code.is_empty() && !code.starts_with("//") {
            citations.extend(
                waiting
                    .drain(..)
                    .map(|(line, tag)| citation(path, line, tag, item_name(code))),
            );
        }
    }
    citations
}

fn citation(path: &str, line: usize, tag: String, item: &str) -> Citation {
    Citation {
        tag,
        item: item.to_owned(),
        path: path.to_owned(),
        line,
    }
}

fn module_name(path: &str) -> &str {
    path.rsplit('/')
        .next()
        .and_then(|name| name.strip_suffix(".rs"))
        .unwrap_or("")
}

/// Name of the item a line declares; of a field or variant, its name.
fn item_name(code: &str) -> &str {
    const KEYWORDS: [&str; 8] = [
        "fn", "struct", "enum", "trait", "const", "static", "type", "mod",
    ];
    let words = code
        .split(|c: char| !c.is_alphanumeric() && c != '_')
        .filter(|word| !word.is_empty());
    let mut name = "";
    let mut after_keyword = false;
    for word in words {
        let qualifies = matches!(word, "pub" | "crate" | "super" | "async" | "unsafe");
        if KEYWORDS.contains(&word) {
            after_keyword = true;
        } else if after_keyword {
            return word;
        } else if name.is_empty() && !qualifies {
            name = word;
        }
    }
    name
}

#[cfg(test)]
mod tests {
    use super::*;

    const THEORY_TEXT: &str =
        "# Contact\n\n    x = y    **(contact.7)** — `pliant_contact::constrained::solve`\n";
    const CODE: &str = "/// Solves (contact.7).\n#[expect(\n    clippy::too_many_lines,\n    reason = \"kernel\"\n)]\n\
                        pub(crate) const fn solve<T>(a: T) {}\n";

    fn messages(files: &[(&str, &str)]) -> Vec<String> {
        let tree = files
            .iter()
            .map(|(path, text)| ((*path).to_owned(), Some((*text).to_owned())))
            .collect();
        tie(&tree).iter().map(Finding::to_string).collect()
    }

    #[test]
    fn tied_equation_passes() {
        let files = [
            ("docs/theory/contact.md", THEORY_TEXT),
            ("crates/contact/src/constrained.rs", CODE),
        ];
        assert_eq!(messages(&files), Vec::<String>::new());
    }

    #[test]
    fn module_documentation_cites_too() {
        let theory = "**(contact.7)**\n`pliant_contact::constrained`\n";
        let code = "//! Planes, (contact.7).\n";
        let files = [
            ("docs/theory/contact.md", theory),
            ("crates/contact/src/constrained.rs", code),
        ];
        assert_eq!(messages(&files), Vec::<String>::new());
    }

    #[test]
    fn equation_that_no_item_cites_is_found() {
        let uncited = messages(&[("docs/theory/contact.md", THEORY_TEXT)]);
        assert!(
            uncited[0].starts_with("docs/theory/contact.md:3: pliant_contact::constrained::solve"),
            "{uncited:?}"
        );
        let wrong_item = CODE.replace("fn solve", "fn other");
        let files = [
            ("docs/theory/contact.md", THEORY_TEXT),
            ("crates/contact/src/constrained.rs", &wrong_item),
        ];
        assert_eq!(messages(&files).len(), 1);
        let files = [
            ("docs/theory/contact.md", THEORY_TEXT),
            ("crates/mesh/src/constrained.rs", CODE),
        ];
        assert_eq!(
            messages(&files).len(),
            1,
            "the right name in the wrong crate"
        );
    }

    #[test]
    fn citation_without_equation_is_found() {
        let found = messages(&[("crates/contact/src/constrained.rs", CODE)]);
        assert_eq!(
            found,
            [
                "crates/contact/src/constrained.rs:1: cites (contact.7), which is no equation of docs/theory/"
            ]
        );
        assert!(
            messages(&[(
                "crates/contact/src/a.rs",
                "/// f(value.0), (fig. 4)\n// (contact.9)\nfn a() {}\n"
            )])
            .is_empty()
        );
    }

    #[test]
    fn number_used_twice_is_found() {
        let twice =
            format!("{THEORY_TEXT}\n**(contact.7)** `pliant_contact::constrained::solve`\n");
        let files = [
            ("docs/theory/contact.md", twice.as_str()),
            ("crates/contact/src/constrained.rs", CODE),
        ];
        assert_eq!(
            messages(&files),
            [
                "docs/theory/contact.md:5: (contact.7) is already the equation of docs/theory/contact.md:3"
            ]
        );
    }

    #[test]
    fn tag_without_function_or_in_the_wrong_file_is_found() {
        let files = [
            ("docs/theory/contact.md", "**(contact.7)** is known\n"),
            ("crates/contact/src/constrained.rs", CODE),
        ];
        assert!(messages(&files)[0].contains("names no function"));
        let files = [
            ("docs/theory/beam.md", THEORY_TEXT),
            ("crates/contact/src/constrained.rs", CODE),
        ];
        assert!(messages(&files)[0].contains("belongs into docs/theory/contact.md"));
    }

    #[test]
    fn items_are_named_by_their_declaration() {
        for (code, name) in [
            ("pub fn a(b: C) -> D {", "a"),
            ("pub(crate) const fn a() {", "a"),
            ("pub struct A<T> {", "A"),
            ("pub stiffness: f64,", "stiffness"),
            ("Constrained,", "Constrained"),
        ] {
            assert_eq!(item_name(code), name, "{code}");
        }
    }
}

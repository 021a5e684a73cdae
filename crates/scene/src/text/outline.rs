//! Where each field, list item and literal of a RON text stands.
//!
//! The reader proper is the `ron` crate; its errors carry a position only while it reads. Faults found later (a
//! mesh that is missing, an object that is not convex) and overrides need the span of a value by its path, which
//! this outline holds. It accepts a superset of RON's values and judges nothing.

use std::ops::Range;

/// Nesting beyond this is left to the reader, which refuses it at the same depth.
const MAX_DEPTH: usize = 128;

/// A value of the text.
#[derive(Debug)]
pub(crate) struct Node {
    /// Bytes of the value, a variant's name included.
    pub(crate) span: Range<usize>,
    /// Offset just behind the opening bracket; the start of the span where there is none.
    pub(crate) open: usize,
    /// What is inside it.
    pub(crate) inside: Inside,
}

/// The parts of a value.
#[derive(Debug)]
pub(crate) enum Inside {
    /// A number, string or bare name.
    Leaf,
    /// `(name: value, …)`, with or without a variant's name before it.
    Fields(Vec<Field>),
    /// `[…]` or `(…)` without names.
    Items(Vec<Node>),
}

/// One `name: value`.
#[derive(Debug)]
pub(crate) struct Field {
    /// Bytes of the name.
    pub(crate) key: Range<usize>,
    /// The value.
    pub(crate) value: Node,
}

/// The outline of a whole text; `None` where the text is not even balanced (the reader says why).
pub(crate) fn outline(text: &str) -> Option<Node> {
    let mut cursor = Cursor { text, at: 0 };
    cursor.skip_blank()?;
    while cursor.rest().starts_with("#!") {
        cursor.at += cursor.rest().find(']')? + 1;
        cursor.skip_blank()?;
    }
    let node = cursor.value(0)?;
    cursor.skip_blank()?;
    cursor.rest().is_empty().then_some(node)
}

impl Node {
    /// The smallest value or field name whose bytes hold offset `at`.
    pub(crate) fn innermost(&self, at: usize) -> Range<usize> {
        let holds = |span: &Range<usize>| span.contains(&at);
        match &self.inside {
            Inside::Leaf => {}
            Inside::Fields(fields) => {
                for field in fields {
                    if holds(&field.key) {
                        return field.key.clone();
                    }
                    if holds(&field.value.span) {
                        return field.value.innermost(at);
                    }
                }
            }
            Inside::Items(items) => {
                if let Some(item) = items.iter().find(|item| holds(&item.span)) {
                    return item.innermost(at);
                }
            }
        }
        self.span.clone()
    }

    /// The name of the innermost field whose value holds offset `at`.
    pub(crate) fn field_around(&self, at: usize) -> Option<Range<usize>> {
        match &self.inside {
            Inside::Leaf => None,
            Inside::Fields(fields) => fields
                .iter()
                .find(|field| field.value.span.contains(&at))
                .map(|field| field.value.field_around(at).unwrap_or(field.key.clone())),
            Inside::Items(items) => items.iter().find_map(|item| item.field_around(at)),
        }
    }
}

struct Cursor<'a> {
    text: &'a str,
    at: usize,
}

impl<'a> Cursor<'a> {
    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn eat(&mut self, token: char) -> bool {
        let found = self.rest().starts_with(token);
        if found {
            self.at += token.len_utf8();
        }
        found
    }

    /// Whitespace, line comments and nested block comments.
    fn skip_blank(&mut self) -> Option<()> {
        loop {
            let rest = self.rest();
            let trimmed = rest.trim_start();
            self.at += rest.len() - trimmed.len();
            if trimmed.starts_with("//") {
                self.at += trimmed.find('\n').unwrap_or(trimmed.len());
            } else if trimmed.starts_with("/*") {
                self.skip_block_comment()?;
            } else {
                return Some(());
            }
        }
    }

    fn skip_block_comment(&mut self) -> Option<()> {
        let mut depth = 0_usize;
        loop {
            if self.rest().starts_with("/*") {
                depth += 1;
                self.at += 2;
            } else if self.rest().starts_with("*/") {
                depth -= 1;
                self.at += 2;
                if depth == 0 {
                    return Some(());
                }
            } else {
                self.at += self.rest().chars().next()?.len_utf8();
            }
        }
    }

    fn value(&mut self, depth: usize) -> Option<Node> {
        if depth > MAX_DEPTH {
            return None;
        }
        let start = self.at;
        let (open, inside) = match self.rest().chars().next()? {
            '[' => self.group(']', depth)?,
            '(' => self.group(')', depth)?,
            '"' => (start, self.string()?),
            _ if self.raw_string_fence().is_some() => (start, self.raw_string()?),
            _ => self.word(depth)?,
        };
        Some(Node {
            span: start..self.at,
            open,
            inside,
        })
    }

    /// A number or a name, with the `(…)` of a variant.
    fn word(&mut self, depth: usize) -> Option<(usize, Inside)> {
        let start = self.at;
        let is_part = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.' | '+' | '-' | '#');
        let length = self
            .rest()
            .find(|c| !is_part(c))
            .unwrap_or(self.rest().len());
        if length == 0 {
            return None;
        }
        self.at += length;
        let after_word = self.at;
        self.skip_blank()?;
        if self.rest().starts_with('(') {
            return self.group(')', depth);
        }
        self.at = after_word;
        Some((start, Inside::Leaf))
    }

    fn group(&mut self, close: char, depth: usize) -> Option<(usize, Inside)> {
        self.at += 1;
        let open = self.at;
        let mut fields = Vec::new();
        let mut items = Vec::new();
        loop {
            self.skip_blank()?;
            if self.eat(close) {
                break;
            }
            if close == ')'
                && let Some(key) = self.field_name()
            {
                let value = self.value(depth + 1)?;
                fields.push(Field { key, value });
            } else {
                items.push(self.value(depth + 1)?);
            }
            self.skip_blank()?;
            if !self.eat(',') && !self.rest().starts_with(close) {
                return None;
            }
        }
        let inside = if fields.is_empty() && (close == ']' || !items.is_empty()) {
            Inside::Items(items)
        } else {
            Inside::Fields(fields)
        };
        Some((open, inside))
    }

    /// `name:` and the blank after it; nothing is consumed where there is none.
    fn field_name(&mut self) -> Option<Range<usize>> {
        let start = self.at;
        let is_part = |c: char| c.is_alphanumeric() || c == '_' || c == '#';
        let length = self.rest().find(|c| !is_part(c)).unwrap_or(0);
        self.at += length;
        let key = start..self.at;
        let found = length > 0 && self.skip_blank().is_some() && self.eat(':');
        if found && self.skip_blank().is_some() {
            return Some(key);
        }
        self.at = start;
        None
    }

    fn string(&mut self) -> Option<Inside> {
        self.at += 1;
        loop {
            let c = self.rest().chars().next()?;
            self.at += c.len_utf8();
            match c {
                '"' => return Some(Inside::Leaf),
                '\\' => self.at += self.rest().chars().next()?.len_utf8(),
                _ => {}
            }
        }
    }

    /// How many `#` open a raw string here.
    fn raw_string_fence(&self) -> Option<usize> {
        let after_r = self.rest().strip_prefix('r')?;
        let fence = after_r.len() - after_r.trim_start_matches('#').len();
        after_r[fence..].starts_with('"').then_some(fence)
    }

    fn raw_string(&mut self) -> Option<Inside> {
        let fence = self.raw_string_fence()?;
        self.at += fence + 2;
        let end = format!("\"{}", "#".repeat(fence));
        self.at += self.rest().find(&end)? + end.len();
        Some(Inside::Leaf)
    }
}

#[cfg(test)]
mod tests {
    use super::{Inside, Node, outline};

    fn field<'a>(text: &'a str, node: &'a Node, name: &str) -> &'a Node {
        let Inside::Fields(fields) = &node.inside else {
            panic!("{node:?} has no fields");
        };
        &fields
            .iter()
            .find(|f| &text[f.key.clone()] == name)
            .unwrap()
            .value
    }

    #[test]
    fn spans_cover_the_values_as_written() {
        let text = "// head, ( [\n#![enable(implicit_some)]\n( /* a /* b */ ( */ tool : rod( n: 3 ),\n s: \"a\\\",)\",\n\
                    raw: r#\"x\",)\"#, list: [ (1.5e-3, -2), inf ], unit: mm )";
        let root = outline(text).unwrap();
        let of = |name| &text[field(text, &root, name).span.clone()];
        assert_eq!(of("tool"), "rod( n: 3 )");
        assert_eq!(of("s"), "\"a\\\",)\"");
        assert_eq!(of("raw"), "r#\"x\",)\"#");
        assert_eq!(of("list"), "[ (1.5e-3, -2), inf ]");
        assert_eq!(of("unit"), "mm");
        let tool = field(text, &root, "tool");
        assert_eq!(&text[field(text, tool, "n").span.clone()], "3");
        let at = text.find("-2").unwrap();
        assert_eq!(&text[root.innermost(at)], "-2");
        let key = text.find("tool").unwrap();
        assert_eq!(&text[root.innermost(key + 1)], "tool");
    }

    #[test]
    fn unbalanced_and_endless_texts_have_no_outline() {
        for text in [
            "",
            "(",
            "(a: 1",
            "[1 2]",
            "\"x",
            "(a: /* )",
            "(a: 1) b",
            "r##\"x\"#",
        ] {
            assert!(outline(text).is_none(), "{text}");
        }
        assert!(outline(&"[".repeat(100_000)).is_none());
        let deep = format!("{}{}", "[".repeat(400), "]".repeat(400));
        assert!(outline(&deep).is_none());
    }
}

//! The text of a scene with its overrides written in, and the place where each byte came from.
//!
//! An override is *spliced into the text* and the whole is read again by the one reader: it obeys the same types,
//! ranges and error messages as the file, and a list of pieces leads an error back to the file or to the argument.

mod outline;

use std::ops::Range;

use self::outline::{Inside, Node, outline};
use crate::error::{Fault, Place, SceneError, line_and_column};

/// One setting laid over a scene file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Override {
    /// How errors cite it, for instance `--set rate_hz=500`.
    pub argument: String,
    /// Which field, for instance `objects[0].pose.position`.
    pub path: String,
    /// The value in RON; a bare word may stand for a string.
    pub value: String,
}

impl Override {
    /// From the `path=value` of `--set`.
    ///
    /// # Errors
    /// When there is no `=` or nothing before it.
    pub fn parse(setting: &str) -> Result<Self, SceneError> {
        let argument = format!("--set {setting}");
        match setting.split_once('=') {
            Some((path, value)) if !path.trim().is_empty() && !value.trim().is_empty() => {
                Ok(Self {
                    argument,
                    path: path.trim().to_owned(),
                    value: value.trim().to_owned(),
                })
            }
            _ => Err(SceneError::new(
                Place::Argument(argument),
                Fault::Override(
                    "expected path.to.field=value, for instance coupling.linear_stiffness=500"
                        .to_owned(),
                ),
            )),
        }
    }

    /// A path on this machine as the value of a string field, whatever characters it has.
    pub fn string(argument: String, path: &str, value: &str) -> Self {
        Self {
            argument,
            path: path.to_owned(),
            value: quoted(value),
        }
    }
}

/// `text` as a RON string literal.
pub(crate) fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}

/// Where a run of bytes of the current text came from.
#[derive(Clone, Debug)]
struct Piece {
    /// Bytes of the current text.
    span: Range<usize>,
    origin: Origin,
}

#[derive(Clone, Copy, Debug)]
enum Origin {
    /// The file, from this offset on.
    File(usize),
    /// An override by its number.
    Argument(usize),
}

/// Text, origins and the file's name.
#[derive(Clone, Debug)]
pub(crate) struct SceneText {
    file: String,
    original: String,
    current: String,
    pieces: Vec<Piece>,
    arguments: Vec<String>,
}

/// One step of a path.
#[derive(Debug)]
enum Step<'a> {
    Field(&'a str),
    Index(usize),
}

impl SceneText {
    pub(crate) fn new(text: &str, file: &str) -> Self {
        Self {
            file: file.to_owned(),
            original: text.to_owned(),
            current: text.to_owned(),
            pieces: vec![Piece {
                span: 0..text.len(),
                origin: Origin::File(0),
            }],
            arguments: Vec::new(),
        }
    }

    pub(crate) fn current(&self) -> &str {
        &self.current
    }

    pub(crate) fn file(&self) -> &str {
        &self.file
    }

    /// The place of byte `offset` of the current text.
    pub(crate) fn place(&self, offset: usize) -> Place {
        let piece = self
            .pieces
            .iter()
            .find(|piece| piece.span.contains(&offset))
            .or(self.pieces.last());
        match piece {
            Some(Piece {
                origin: Origin::Argument(number),
                ..
            }) => Place::Argument(self.arguments[*number].clone()),
            Some(Piece {
                span,
                origin: Origin::File(start),
            }) => self.place_in_file(start + offset.saturating_sub(span.start)),
            None => self.place_in_file(0),
        }
    }

    fn place_in_file(&self, offset: usize) -> Place {
        let (line, column) = line_and_column(&self.original, offset);
        Place::File {
            file: self.file.clone(),
            line,
            column,
        }
    }

    /// The place of the value at `path`, or of the nearest value around it that the text spells out.
    pub(crate) fn place_of(&self, path: &str) -> Place {
        let offset = outline(&self.current).map_or(0, |root| {
            let steps = steps(path).unwrap_or_default();
            let (node, _) = descend(&self.current, &root, &steps);
            node.span.start
        });
        self.place(offset)
    }

    /// Where the reader meant when it stood between bytes `start` and `end`: at the literal or name it had read,
    /// else at the one it was about to read, else at the start of what encloses both.
    pub(crate) fn offset_between(&self, start: usize, end: usize) -> usize {
        let Some(root) = outline(&self.current) else {
            // Not balanced: the reader may stand before the blank in front of what it could not read.
            let ahead = self.current.get(start..end).unwrap_or_default();
            return start + ahead.len() - ahead.trim_start().len();
        };
        // The reader may have stood before the blank in front of what it then read.
        let read = self.current.get(start..end).unwrap_or_default();
        let blank = read.len() - read.trim_start().len();
        let begin = if blank < read.len() {
            start + blank
        } else {
            start
        };
        let at_start = root.innermost(begin);
        let at_end = root.innermost(end);
        if at_start == root.span && at_end == root.span {
            // A field of the scene itself is missing: its first byte says no more than the reader's position.
            start
        } else if at_end.len() < at_start.len() {
            at_end.start
        } else {
            at_start.start
        }
    }

    /// The number, name or text in quotes at byte `offset`; `None` at brackets and in an unbalanced text.
    pub(crate) fn word_at(&self, offset: usize) -> Option<Range<usize>> {
        let span = outline(&self.current)?.innermost(offset);
        let word = self.current.get(span.clone())?;
        let is_plain = !word.contains(['(', '[', ':']) || word.starts_with('"');
        is_plain.then_some(span)
    }

    /// The name of the field whose value should begin at byte `offset`.
    pub(crate) fn field_before(&self, offset: usize) -> Option<&str> {
        let before = self.current.get(..offset)?.trim_end().strip_suffix(':')?;
        let before = before.trim_end();
        let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let name = &before[before.trim_end_matches(is_part).len()..];
        (!name.is_empty()).then_some(name)
    }

    /// Whether the text is one value with all its brackets, quotes and comments closed.
    pub(crate) fn is_balanced(&self) -> bool {
        outline(&self.current).is_some()
    }

    /// The name of the innermost field whose value holds byte `offset`.
    pub(crate) fn field_around(&self, offset: usize) -> Option<&str> {
        let key = outline(&self.current)?.field_around(offset)?;
        self.current.get(key)
    }

    /// Writes `value` at `path`; fields that were left at their defaults are added.
    pub(crate) fn with_override(
        &self,
        setting: &Override,
        value: &str,
    ) -> Result<Self, SceneError> {
        let refuse = |message: String| {
            SceneError::new(
                Place::Argument(setting.argument.clone()),
                Fault::Override(message),
            )
        };
        let steps = steps(&setting.path).ok_or_else(|| {
            refuse(format!(
                "`{}` is not a path; write fields and list items like objects[0].pose.position",
                setting.path
            ))
        })?;
        let root = outline(&self.current)
            .ok_or_else(|| refuse("the scene file is not valid RON".to_owned()))?;
        let (node, reached) = descend(&self.current, &root, &steps);
        let (span, replacement) = match (&node.inside, &steps[reached..]) {
            (_, []) => (node.span.clone(), value.to_owned()),
            (Inside::Fields(_), missing @ [Step::Field(_), ..]) => {
                let text = missing_fields(missing, value).ok_or_else(|| {
                    refuse("this list is not in the scene file; set it as a whole".to_owned())
                })?;
                (node.open..node.open, format!("{text}, "))
            }
            (inside, [step, ..]) => {
                let parent = written(&steps[..reached]);
                return Err(refuse(dead_end(inside, step, &parent)));
            }
        };
        Ok(self.spliced(&span, &replacement, &setting.argument))
    }

    fn spliced(&self, span: &Range<usize>, replacement: &str, argument: &str) -> Self {
        let mut next = self.clone();
        next.current.replace_range(span.clone(), replacement);
        next.arguments.push(argument.to_owned());
        next.pieces.clear();
        let mut push = |span: Range<usize>, origin| {
            if !span.is_empty() {
                next.pieces.push(Piece { span, origin });
            }
        };
        let shifted = |origin, by| match origin {
            Origin::File(start) => Origin::File(start + by),
            Origin::Argument(_) => origin,
        };
        for piece in &self.pieces {
            push(
                piece.span.start..piece.span.end.min(span.start),
                piece.origin,
            );
        }
        let end = span.start + replacement.len();
        push(span.start..end, Origin::Argument(self.arguments.len()));
        for piece in &self.pieces {
            let start = piece.span.start.max(span.end);
            if start < piece.span.end {
                let origin = shifted(piece.origin, start - piece.span.start);
                push(
                    start - span.end + end..piece.span.end - span.end + end,
                    origin,
                );
            }
        }
        next
    }
}

/// `a.b[2].c` as steps; `None` where it is none.
fn steps(path: &str) -> Option<Vec<Step<'_>>> {
    let mut steps = Vec::new();
    for part in path.split('.') {
        let (name, indices) = part.split_at(part.find('[').unwrap_or(part.len()));
        let is_name = |c: char| c.is_ascii_alphanumeric() || c == '_';
        if name.is_empty() || !name.chars().all(is_name) {
            return None;
        }
        steps.push(Step::Field(name));
        let mut rest = indices;
        while !rest.is_empty() {
            let (index, after) = rest.strip_prefix('[')?.split_once(']')?;
            steps.push(Step::Index(index.trim().parse().ok()?));
            rest = after;
        }
    }
    Some(steps)
}

/// As far along `steps` as the text goes: the node, and how many steps were taken.
fn descend<'a>(text: &str, root: &'a Node, steps: &[Step<'_>]) -> (&'a Node, usize) {
    let mut node = root;
    for (taken, step) in steps.iter().enumerate() {
        let next = match (step, &node.inside) {
            (Step::Field(name), Inside::Fields(fields)) => fields
                .iter()
                .find(|field| &text[field.key.clone()] == *name)
                .map(|field| &field.value),
            (Step::Index(index), Inside::Items(items)) => items.get(*index),
            _ => None,
        };
        match next {
            Some(next) => node = next,
            None => return (node, taken),
        }
    }
    (node, steps.len())
}

/// `a: (b: value)` for the steps `a`, `b`.
fn missing_fields(steps: &[Step<'_>], value: &str) -> Option<String> {
    match steps {
        [] => Some(value.to_owned()),
        [Step::Field(name), rest @ ..] => {
            let inner = missing_fields(rest, value)?;
            Some(if rest.is_empty() {
                format!("{name}: {inner}")
            } else {
                format!("{name}: ({inner})")
            })
        }
        [Step::Index(_), ..] => None,
    }
}

fn written(steps: &[Step<'_>]) -> String {
    let mut path = String::new();
    for step in steps {
        match step {
            Step::Field(name) if path.is_empty() => path.push_str(name),
            Step::Field(name) => path.extend([".", name]),
            Step::Index(index) => path.extend(["[", &index.to_string(), "]"]),
        }
    }
    if path.is_empty() {
        "the scene".to_owned()
    } else {
        format!("`{path}`")
    }
}

fn dead_end(inside: &Inside, step: &Step<'_>, parent: &str) -> String {
    match (inside, step) {
        (Inside::Items(items), Step::Index(_)) if items.is_empty() => {
            format!("{parent} is empty; there is no item to set")
        }
        (Inside::Items(items), Step::Index(index)) => format!(
            "{parent} has items 0 to {}, there is no item {index}",
            items.len() - 1
        ),
        (Inside::Items(_), Step::Field(name)) => {
            format!("{parent} is a list; write the item's number before `{name}`, like [0]")
        }
        (Inside::Leaf, Step::Field(name)) => {
            format!("{parent} is a plain value and has no field `{name}`; set {parent} itself")
        }
        (Inside::Leaf | Inside::Fields(_), Step::Index(_)) => {
            format!("{parent} is not a list; write a field's name instead of a number")
        }
        (Inside::Fields(_), Step::Field(name)) => format!("{parent} has no field `{name}`"),
    }
}

/// The one RON value that `text` is, without comments around it: written into a scene, a comment would hide what follows.
pub(crate) fn one_value(text: &str) -> Option<&str> {
    text.get(outline(text)?.span)
}

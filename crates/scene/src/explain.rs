//! The reader's errors in words of scene files.

use ron::error::{Error as RonError, Position, SpannedError};

use crate::error::{Fault, SceneError, offset_of, shortened};
use crate::scene::parsed;
use crate::text::SceneText;

/// The reader's error at the place of the value it is about.
pub(crate) fn explained(error: &SpannedError, text: &SceneText) -> SceneError {
    let offset = |at: Position| offset_of(text.current(), at.line, at.col);
    let (start, end) = (offset(error.span.start), offset(error.span.end));
    if ends_early(&error.code, text, end) {
        let missing = match &error.code {
            RonError::Eof | RonError::ExpectedComma => NOT_CLOSED.to_owned(),
            code => forms(code, text, end).unwrap_or_else(|| syntax(code)),
        };
        let message = format!("the text ends too early; {missing}");
        return SceneError::new(text.place(end), Fault::Syntax(message));
    }
    // A bare name such as `nan` is found to be of the wrong type only after it was read.
    let name = match error.code {
        RonError::InvalidValueForType { .. } if end > 0 => text.word_at(end - 1),
        _ => None,
    };
    let at = name.map_or_else(|| text.offset_between(start, end), |span| span.start);
    let place = text.place(at);
    if let Some(fault) = no_number(error, text, at) {
        return SceneError::new(place, fault);
    }
    if let RonError::Message(message) = &error.code {
        return SceneError::new(place, Fault::Value(message.clone()));
    }
    let message = wrong_kind(&error.code, text, at)
        .or_else(|| names(&error.code))
        .or_else(|| forms(&error.code, text, at))
        .unwrap_or_else(|| syntax(&error.code));
    SceneError::new(place, Fault::Syntax(message))
}

const NOT_CLOSED: &str = "a bracket or a quote is not closed";

/// Whether the reader, which stands at byte `end`, lacks what should follow there and the text is over.
fn ends_early(code: &RonError, text: &SceneText, end: usize) -> bool {
    let lacks_what_follows = matches!(
        code,
        RonError::Eof
            | RonError::ExpectedArray
            | RonError::ExpectedBoolean
            | RonError::ExpectedComma
            | RonError::ExpectedFloat
            | RonError::ExpectedIdentifier
            | RonError::ExpectedMapColon
            | RonError::ExpectedNamedStructLike(_)
            | RonError::ExpectedString
            | RonError::ExpectedStructLike
    );
    let rest = text.current().get(end..).unwrap_or_default();
    lacks_what_follows && rest.trim().is_empty() && !text.is_balanced()
}

/// A word such as `2cm` or `nan` where a number belongs: what kind of number is known once the word is exchanged for
/// one that every kind refuses.
fn no_number(error: &SpannedError, text: &SceneText, at: usize) -> Option<Fault> {
    const REFUSED: &str = "NaN";
    if !matches!(
        error.code,
        RonError::ExpectedFloat
            | RonError::ExpectedComma
            | RonError::FloatUnderscore
            | RonError::Message(_)
            | RonError::UnderscoreAtBeginning
            | RonError::InvalidValueForType { .. }
    ) {
        return None;
    }
    let span = text.word_at(at)?;
    let word = &text.current()[span.clone()];
    // Of `2cm` the reader takes the 2, and may find that out of range.
    if matches!(error.code, RonError::Message(_)) && word.parse::<f64>().is_ok() {
        return None;
    }
    let mut exchanged = text.current().to_owned();
    exchanged.replace_range(span, REFUSED);
    let Err(RonError::Message(message)) = parsed(&exchanged).map_err(|error| error.code) else {
        return None;
    };
    let expected = message.strip_prefix("NaN is out of range; expected ")?;
    if word.eq_ignore_ascii_case(REFUSED) {
        return Some(Fault::Value(message));
    }
    Some(Fault::Syntax(format!(
        "expected a number, not `{}`: {expected}",
        shortened(word)
    )))
}

/// A value of another kind, such as a number where three belong.
fn wrong_kind(code: &RonError, text: &SceneText, at: usize) -> Option<String> {
    let RonError::InvalidValueForType { expected, .. } = code else {
        return None;
    };
    let word = text.word_at(at)?;
    let word = text.current().get(word)?;
    Some(format!("expected {expected}, not `{}`", shortened(word)))
}

/// Fields and variants that are unknown, missing or doubled.
fn names(code: &RonError) -> Option<String> {
    Some(match code {
        RonError::NoSuchStructField {
            expected,
            found,
            outer,
        } => format!(
            "unknown field `{}`{}; expected {}",
            shortened(found),
            inside(outer.as_deref()),
            one_of(expected)
        ),
        RonError::MissingStructField { field, outer } => format!(
            "field `{field}` is missing{}; add it",
            inside(outer.as_deref())
        ),
        RonError::DuplicateStructField { field, outer } => format!(
            "field `{field}` is given twice{}; remove one",
            inside(outer.as_deref())
        ),
        RonError::NoSuchEnumVariant {
            expected,
            found,
            outer,
        } => format!(
            "unknown {} `{}`; expected {}",
            outer.as_deref().unwrap_or("name"),
            shortened(found),
            one_of(expected)
        ),
        _ => return None,
    })
}

/// Values in brackets of the wrong form, with the right one spelled out.
fn forms(code: &RonError, text: &SceneText, at: usize) -> Option<String> {
    Some(match code {
        RonError::ExpectedNamedStructLike(name) => {
            format!(
                "expected the fields of `{name}` in parentheses: {}",
                form(name)
            )
        }
        RonError::ExpectedDifferentStructName { expected, found } => format!(
            "`{}` stands where the fields of `{expected}` belong: {}",
            shortened(found),
            form(expected)
        ),
        // The reader takes anything in front of a missing colon for a name.
        RonError::SuggestRawIdentifier(found) | RonError::InvalidIdentifier(found) => {
            let found = shortened(found);
            if let Some(name) = text.field_before(at) {
                return Some(format!(
                    "expected a value for `{name}`, not `{found}`: {}",
                    form(name)
                ));
            }
            match text.field_around(at).filter(|name| form(name) != ANY_FORM) {
                Some(name) => format!("`{found}` is no field of `{name}`; expected {}", form(name)),
                None => format!("expected a field's name and a colon before `{found}`: {ANY_FORM}"),
            }
        }
        RonError::ExpectedIdentifier if text.field_before(at).is_some() => {
            let name = text.field_before(at)?;
            format!("expected a value for `{name}`: {}", form(name))
        }
        RonError::ExpectedIdentifier => match text.field_around(at) {
            Some(name) if form(name) != ANY_FORM => {
                format!("expected a field's name in `{name}`: {}", form(name))
            }
            _ => format!("expected a field's name or a closing `)`: {ANY_FORM}"),
        },
        RonError::ExpectedStructLike => format!("expected the fields in parentheses: {ANY_FORM}"),
        _ => return None,
    })
}

/// What remains: brackets, quotes and plain values.
fn syntax(code: &RonError) -> String {
    let message = match code {
        RonError::ExpectedArray => "expected a list in square brackets: [item, …]",
        RonError::ExpectedString => "expected a text in double quotes",
        RonError::ExpectedFloat | RonError::ExpectedInteger => "expected a number",
        RonError::ExpectedBoolean => "expected true or false",
        RonError::ExpectedComma => "expected a comma or a closing bracket",
        RonError::ExpectedMapColon => "expected a colon and a value behind the field's name",
        RonError::ExpectedStringEnd => "the text in double quotes is not closed; add the quote",
        RonError::UnclosedBlockComment => "a comment that begins with `/*` is not closed by `*/`",
        RonError::ExpectedArrayEnd => "expected a closing `]`",
        RonError::ExpectedStructLikeEnd | RonError::ExpectedOptionEnd => "expected a closing `)`",
        RonError::FloatUnderscore | RonError::UnderscoreAtBeginning => {
            "expected a number without underscores"
        }
        RonError::InvalidEscape(_) => {
            r#"unknown escape in a text; write `\\` for a backslash, `\"` for a quote"#
        }
        RonError::ExpectedAttributeEnd => "expected `)]`, with which an attribute ends",
        RonError::NoSuchExtension(_) => {
            "unknown extension of the notation; a scene needs none: remove the line"
        }
        RonError::ExpectedAttribute => "expected `(`, with which a scene begins",
        RonError::TrailingCharacters => {
            "the scene has ended here; remove what follows or the bracket that closes too early"
        }
        RonError::ExceededRecursionLimit => "the brackets are nested too deep",
        RonError::Eof => NOT_CLOSED,
        RonError::ExpectedDifferentLength { expected, found } => {
            return format!("expected {expected}, not {found} of them");
        }
        RonError::UnexpectedChar(character) => {
            return format!("{character:?} has no place here; remove it");
        }
        code => return format!("this cannot be read: {code}; expected {ANY_FORM}"),
    };
    message.to_owned()
}

const ANY_FORM: &str = "(name: value, …)";

/// How the value of a field is written.
fn form(name: &str) -> &'static str {
    match name {
        "shape" => {
            "a shape such as cuboid(size: (x, y, z)), or for tools rod(length: …, width: …, height: …)"
        }
        "method" => "constrained or paper",
        "unit" => "m, mm, cm or inch",
        "device" => "scripted",
        "rotation" => "rotation: (axis: (x, y, z), angle_deg: a)",
        "pose" => "pose: (position: (x, y, z), rotation: (axis: (x, y, z), angle_deg: a))",
        "tool" => "tool: (shape: rod(length: …, width: …, height: …))",
        "object" | "objects" => "objects: [(name: \"…\", shape: …, pose: (…)), …]",
        "file" | "mesh" => "(path: \"…\", unit: mm)",
        "trajectory" => "trajectory: (path: \"motion.csv\")",
        "coupling" => "coupling: (linear_stiffness: k, linear_damping: b)",
        "workspace" => "workspace: (pose: (…), position_scale: s, force_scale: f)",
        "paper" => "paper: (edge_width: w, detection_interval: n)",
        _ => ANY_FORM,
    }
}

fn one_of(names: &[&str]) -> String {
    match names {
        [] => "nothing here".to_owned(),
        [name] => format!("`{name}`"),
        _ => format!("one of {}", names.join(", ")),
    }
}

fn inside(outer: Option<&str>) -> String {
    outer.map_or_else(String::new, |name| format!(" in `{name}`"))
}

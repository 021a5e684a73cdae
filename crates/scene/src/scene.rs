//! From text and overrides to a scene description.

use ron::Options;
use ron::error::{Error as RonError, Position, SpannedError};
use ron::extensions::Extensions;

use crate::error::{Fault, SceneError, offset_of};
use crate::schema::SceneDescription;
use crate::text::{Override, SceneText, is_one_value, quoted};

/// A scene that was read and is well formed; [`Scene::build`] makes it ready to run.
#[derive(Clone, Debug)]
pub struct Scene {
    description: SceneDescription,
    text: SceneText,
}

impl Scene {
    /// Reads the RON text of a scene. `file_name` is cited in errors, and paths in the scene are relative to its
    /// folder.
    ///
    /// # Errors
    /// With line and column, when the text is not RON, or a field is unknown, missing or out of its range.
    pub fn from_str(text: &str, file_name: &str) -> Result<Self, SceneError> {
        Self::read(SceneText::new(text, file_name))
    }

    /// [`Self::from_str`] for the bytes of a file.
    ///
    /// # Errors
    /// As [`Self::from_str`], and when the bytes are not UTF-8, at the first that is not.
    pub fn from_bytes(bytes: &[u8], file_name: &str) -> Result<Self, SceneError> {
        let text = str::from_utf8(bytes).map_err(|error| {
            let readable = str::from_utf8(&bytes[..error.valid_up_to()]).unwrap_or_default();
            let place = SceneText::new(readable, file_name).place(readable.len());
            let message = "not UTF-8 text; save the scene as UTF-8";
            SceneError::new(place, Fault::Syntax(message.to_owned()))
        })?;
        Self::from_str(text, file_name)
    }

    /// With fields set from outside, in order.
    ///
    /// # Errors
    /// Citing the override, when its path or value is not accepted.
    pub fn with_overrides(self, overrides: &[Override]) -> Result<Self, SceneError> {
        overrides.iter().try_fold(self, |scene, setting| {
            // A bare word may stand for a string: `trajectory.path=other.csv`. What reads as RON is taken as RON.
            let as_string = quoted(&setting.value);
            if !is_one_value(&setting.value) {
                return Self::read(scene.text.with_override(setting, &as_string)?);
            }
            Self::read(scene.text.with_override(setting, &setting.value)?).or_else(|error| {
                let text = scene.text.with_override(setting, &as_string)?;
                Self::read(text).map_err(|_| error)
            })
        })
    }

    fn read(text: SceneText) -> Result<Self, SceneError> {
        let extensions = Extensions::IMPLICIT_SOME | Extensions::UNWRAP_VARIANT_NEWTYPES;
        match Options::default()
            .with_default_extension(extensions)
            .from_str(text.current())
        {
            Ok(description) => Ok(Self { description, text }),
            Err(error) => Err(explained(&error, &text)),
        }
    }

    /// What the scene says.
    pub const fn description(&self) -> &SceneDescription {
        &self.description
    }

    /// The name the scene was read under.
    pub fn file_name(&self) -> &str {
        self.text.file()
    }

    /// A fault of the value at `path`, at its place in the file or in the override that set it.
    pub(crate) fn fault_at(&self, path: &str, fault: Fault) -> SceneError {
        SceneError::new(self.text.place_of(path), fault)
    }
}

/// The reader's error at the place of the value it is about, in words of scene files.
fn explained(error: &SpannedError, text: &SceneText) -> SceneError {
    let offset = |at: Position| offset_of(text.current(), at.line, at.col);
    let place = text.place_between(offset(error.span.start), offset(error.span.end));
    let one_of = |names: &[&str]| match names {
        [] => "nothing here".to_owned(),
        [name] => format!("`{name}`"),
        _ => format!("one of {}", names.join(", ")),
    };
    let message = match &error.code {
        RonError::Message(message) => return SceneError::new(place, Fault::Value(message.clone())),
        RonError::NoSuchStructField {
            expected,
            found,
            outer,
        } => format!(
            "unknown field `{found}`{}; expected {}",
            inside(outer.as_deref()),
            one_of(expected)
        ),
        RonError::MissingStructField { field, outer } => {
            format!(
                "field `{field}` is missing{}; add it",
                inside(outer.as_deref())
            )
        }
        RonError::DuplicateStructField { field, outer } => format!(
            "field `{field}` is given twice{}; remove one",
            inside(outer.as_deref())
        ),
        RonError::NoSuchEnumVariant {
            expected,
            found,
            outer,
        } => format!(
            "unknown {} `{found}`; expected {}",
            outer.as_deref().unwrap_or("name"),
            one_of(expected)
        ),
        RonError::ExpectedNamedStructLike(name) => {
            format!("expected the fields of `{name}` in parentheses: (name: value, …)")
        }
        RonError::ExpectedStructLike => {
            "expected the fields in parentheses: (name: value, …)".to_owned()
        }
        RonError::ExpectedArray => "expected a list in square brackets: [item, …]".to_owned(),
        RonError::ExpectedString => "expected a text in double quotes".to_owned(),
        RonError::ExpectedFloat => "expected a number".to_owned(),
        RonError::ExpectedBoolean => "expected true or false".to_owned(),
        RonError::ExpectedComma => "expected a comma".to_owned(),
        RonError::ExpectedIdentifier => "expected a name".to_owned(),
        RonError::Eof => "the text ends too early; a bracket or a quote is not closed".to_owned(),
        code => code.to_string(),
    };
    SceneError::new(place, Fault::Syntax(message))
}

fn inside(outer: Option<&str>) -> String {
    outer.map_or_else(String::new, |name| format!(" in `{name}`"))
}

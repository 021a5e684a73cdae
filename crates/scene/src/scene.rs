//! From text and overrides to a scene description.

use std::collections::HashMap;

use ron::Options;
use ron::error::SpannedResult;
use ron::extensions::Extensions;

use crate::error::{Fault, SceneError, shortened};
use crate::explain::explained;
use crate::recognise::not_a_scene;
use crate::schema::SceneDescription;
use crate::text::{Override, SceneText, one_value, quoted};

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
        // Some editors put a byte order mark before the text.
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        if let Some((at, message)) = not_a_scene(text.as_bytes()) {
            let place = SceneText::new(text, file_name).place(at);
            return Err(SceneError::new(place, Fault::Syntax(message)));
        }
        Self::read(SceneText::new(text, file_name))?.with_names_checked()
    }

    /// [`Self::from_str`] for the bytes of a file.
    ///
    /// # Errors
    /// As [`Self::from_str`], and when the bytes are not UTF-8, at the first that is not.
    pub fn from_bytes(bytes: &[u8], file_name: &str) -> Result<Self, SceneError> {
        let text = str::from_utf8(bytes).map_err(|error| {
            let readable = str::from_utf8(&bytes[..error.valid_up_to()]).unwrap_or_default();
            let text = SceneText::new(readable, file_name);
            let (offset, message) = not_a_scene(bytes).unwrap_or_else(|| {
                let message = "not UTF-8 text; save the scene as UTF-8";
                (readable.len(), message.to_owned())
            });
            SceneError::new(text.place(offset), Fault::Syntax(message))
        })?;
        Self::from_str(text, file_name)
    }

    /// With fields set from outside, in order.
    ///
    /// # Errors
    /// Citing the override, when its path or value is not accepted.
    pub fn with_overrides(self, overrides: &[Override]) -> Result<Self, SceneError> {
        let scene = overrides.iter().try_fold(self, |scene, setting| {
            // A bare word may stand for a string: `trajectory.path=other.csv`. What reads as RON is taken as RON.
            let as_string = quoted(&setting.value);
            let Some(value) = one_value(&setting.value) else {
                return Self::read(scene.text.with_override(setting, &as_string)?);
            };
            Self::read(scene.text.with_override(setting, value)?).or_else(|error| {
                let text = scene.text.with_override(setting, &as_string)?;
                Self::read(text).map_err(|_| error)
            })
        })?;
        scene.with_names_checked()
    }

    fn read(text: SceneText) -> Result<Self, SceneError> {
        match parsed(text.current()) {
            Ok(description) => Ok(Self { description, text }),
            Err(error) => Err(explained(&error, &text)),
        }
    }

    /// Results tell objects apart by their names. Checked after all overrides, so that two can swap names.
    fn with_names_checked(self) -> Result<Self, SceneError> {
        let objects = &self.description.objects;
        let path = |index: usize| format!("objects[{index}].name");
        let mut seen = HashMap::with_capacity(objects.len());
        for (index, object) in objects.iter().enumerate() {
            let name = &object.name;
            let message = if name.trim().is_empty() {
                "the name is empty; expected a text that tells the object apart from others"
                    .to_owned()
            } else if let Some(first) = seen.insert(name.as_str(), index) {
                let first = self.text.place_of(&path(first));
                let name = shortened(name);
                format!("another object is named {name:?} too, at {first}; give each its own name")
            } else {
                continue;
            };
            return Err(self.fault_at(&path(index), Fault::Value(message)));
        }
        Ok(self)
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

    /// An error inside the file that the value at `path` names, with the place of that value.
    pub(crate) fn naming(&self, path: &str, error: SceneError) -> SceneError {
        let place = self.text.place_of(path);
        SceneError {
            named: Some(Box::new(place)),
            ..error
        }
    }
}

/// The reader proper.
pub(crate) fn parsed(text: &str) -> SpannedResult<SceneDescription> {
    let extensions = Extensions::IMPLICIT_SOME | Extensions::UNWRAP_VARIANT_NEWTYPES;
    Options::default()
        .with_default_extension(extensions)
        .from_str(text)
}

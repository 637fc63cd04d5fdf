//! Reading and writing of project files as TOML.
//!
//! The keys at the top level belong to two structs: the project and its transition options. Serde's
//! `flatten` would accept unknown keys and lose the line numbers of errors. Instead, each top-level
//! key is first assigned to the struct that has a field of that name, and each struct is then read
//! from a separate table.

use super::document::{FORMAT_VERSION, Project};
use super::error::ProjectError;
use super::segment_settings::SegmentRecord;
use crate::io::atomic_file;
use crate::io::atomic_file::write_error_message;
use crate::io::read;
use crate::transition::{PartTime, TransitionOptions};
use serde::de::value::Error as NoValue;
use serde::de::{Deserialize, Deserializer, Error, Visitor};
use serde::forward_to_deserialize_any;
use std::hash::{DefaultHasher, Hasher};
use std::io::{self, ErrorKind};
use std::path::Path;
use toml::Spanned;
use toml::de::DeTable;

impl Project {
    /// Parses and checks the text of a project file.
    ///
    /// # Errors
    /// [`ProjectError`] names the invalid line or value.
    pub fn parse(text: &str) -> Result<Self, ProjectError> {
        let mut project = read(text)?;
        project.check()?;
        project.assign_top_level_match()?;
        // Equal contents compare equal, regardless of the version in which they were written.
        project.version = project.needed_version();
        Ok(project)
    }

    /// Moves match settings and part timing at the top level to the first segment if there are more
    /// than two designs.
    ///
    /// # Errors
    /// [`ProjectError`] if there are too many segment settings, or if they exist both at the top
    /// level and in segments.
    fn assign_top_level_match(&mut self) -> Result<(), ProjectError> {
        let (has, pair_count) = (self.legs.len(), self.pair_count());
        let may_have = if self.is_sequence() { pair_count } else { 0 };
        if has > may_have {
            return Err(ProjectError::TooManySegments { has, may_have });
        }
        if self.is_sequence() {
            let at_top = self.take_pair_record();
            match self.legs.as_slice() {
                [] => self.set_segment_records(vec![at_top]),
                _ if at_top == SegmentRecord::default() => {}
                _ => return Err(ProjectError::AmbiguousMatch),
            }
        }
        Ok(())
    }

    /// Checks everything that serde cannot check.
    fn check(&self) -> Result<(), ProjectError> {
        if self.version == 0 {
            return Err(ProjectError::VersionZero);
        }
        if self.designs.len() < 2 {
            return Err(ProjectError::TooFewDesigns(self.designs.len()));
        }
        for entry in &self.designs {
            entry.placement.checked()?;
        }
        self.options.field.blend.check()?;
        self.options.colours.check()?;
        self.options.matching.check()?;
        PartTime::check(&self.options.parts)?;
        for record in &self.legs {
            record.matching.check()?;
            PartTime::check(&record.parts)?;
        }
        self.options.coats.check()?;
        self.options.arap.check()?;
        self.map.check(self.designs.len())?;
        self.timing.check(&self.stops)?;
        Ok(())
    }

    /// Reads a project file, without its designs.
    ///
    /// # Errors
    /// [`ProjectError`] names the file and, where there is one, the line.
    pub fn read(path: &Path) -> Result<Self, ProjectError> {
        Ok(Self::read_with_hash(path)?.0)
    }

    /// Reads a project file, without its designs, and returns its [`Self::file_hash`] too.
    pub(super) fn read_with_hash(path: &Path) -> Result<(Self, u64), ProjectError> {
        let in_file = |error: ProjectError| error.in_file(path);
        let bytes = read::read(path).map_err(|error| in_file(error.into()))?;
        let hash = Self::file_hash(&bytes);
        let text = String::from_utf8(bytes).map_err(|_| in_file(ProjectError::NotText))?;
        Ok((Self::parse(&text).map_err(in_file)?, hash))
    }

    /// Returns a hash of the bytes of a project file, by which changes of the file are recognised.
    ///
    /// Not cryptographic, and different versions of the program may return different hashes.
    #[must_use]
    pub fn file_hash(bytes: &[u8]) -> u64 {
        let mut hasher = DefaultHasher::new();
        hasher.write(bytes);
        hasher.finish()
    }

    /// Returns the project as TOML text.
    ///
    /// # Errors
    /// [`ProjectError::NotSerializable`] if TOML cannot represent a number, such as a count beyond
    /// the range of its integers.
    pub fn to_toml(&self) -> Result<String, ProjectError> {
        let project = Self {
            version: self.needed_version(),
            ..self.clone()
        };
        toml::to_string_pretty(&project)
            .map_err(|error| ProjectError::NotSerializable(error.to_string()))
    }

    /// Writes the project atomically: the old file stays intact until the new one is complete.
    /// Returns the [`Self::file_hash`] of the written file.
    ///
    /// # Errors
    /// [`ProjectError`] names the file; the old file is untouched.
    pub fn save_atomically(&self, path: &Path) -> Result<u64, ProjectError> {
        let text = self.to_toml()?;
        atomic_file::write(path, text.as_bytes()).map_err(|error| unwritable(path, &error))?;
        Ok(Self::file_hash(text.as_bytes()))
    }

    /// Like [`Self::save_atomically`], but never replaces a file, even one that another process
    /// writes at the same moment.
    ///
    /// # Errors
    /// [`ProjectError`] names the file; [`ProjectError::AlreadyExists`] if it exists.
    pub fn save_new(&self, path: &Path) -> Result<(), ProjectError> {
        let text = self.to_toml()?;
        atomic_file::write_new(path, text.as_bytes()).map_err(|error| match error.kind() {
            ErrorKind::AlreadyExists => ProjectError::AlreadyExists(path.to_owned()),
            _ => unwritable(path, &error),
        })
    }
}

/// Returns the error for a project file that could not be written.
fn unwritable(path: &Path, error: &io::Error) -> ProjectError {
    ProjectError::Unwritable(write_error_message(error)).in_file(path)
}

/// Deserialises the text of a project file, without checking values.
///
/// # Errors
/// [`ProjectError::NewerVersion`], or [`ProjectError::Syntax`] with the line of the error.
fn read(text: &str) -> Result<Project, ProjectError> {
    let syntax_error = |error: toml::de::Error| ProjectError::syntax(text, &error);
    let document = DeTable::parse(text).map_err(syntax_error)?;
    // The version is checked first: a newer file may have unknown keys, and the user needs to know
    // that it is newer.
    if let Some(version) = document.get_ref().get("version")
        && let Some(number) = version.get_ref().as_integer()
        && let Ok(number) = u64::from_str_radix(number.as_str(), number.radix())
        && number > FORMAT_VERSION.into()
    {
        return Err(ProjectError::newer(text, version.span().start, number));
    }
    let span = document.span();
    // The valid keys of both structs come from serde, so that no separate list has to be updated
    // when an option is added.
    let (project_keys, option_keys) = (keys_of::<Project>(), keys_of::<TransitionOptions>());
    let (mut project, mut options) = (DeTable::new(), DeTable::new());
    for (key, value) in document.into_inner() {
        let name = key.get_ref().as_ref();
        // Values keep their spans, so that errors still have line numbers.
        let table = if option_keys.contains(&name) {
            &mut options
        } else if project_keys.contains(&name) {
            &mut project
        } else {
            return Err(ProjectError::unknown_key(
                text,
                &key,
                [project_keys, option_keys],
            ));
        };
        table.insert(key, value);
    }
    let from = |table| toml::Deserializer::from(Spanned::new(span.clone(), table));
    let mut project = Project::deserialize(from(project)).map_err(syntax_error)?;
    project.options = TransitionOptions::deserialize(from(options)).map_err(syntax_error)?;
    Ok(project)
}

/// Returns the names of the fields that a struct deserialises.
fn keys_of<'de, T: Deserialize<'de>>() -> &'static [&'static str] {
    let mut keys: &[&str] = &[];
    // Always fails, because the deserialiser provides no values.
    if T::deserialize(DocumentKeys(&mut keys)).is_ok() {
        keys = &[];
    }
    keys
}

/// Deserialiser that only records the field names requested by a struct.
struct DocumentKeys<'a>(&'a mut &'static [&'static str]);

impl<'de> Deserializer<'de> for DocumentKeys<'_> {
    type Error = NoValue;

    fn deserialize_any<V: Visitor<'de>>(self, _visitor: V) -> Result<V::Value, NoValue> {
        Err(NoValue::custom("there are no values"))
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, NoValue> {
        *self.0 = fields;
        self.deserialize_any(visitor)
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string
        bytes byte_buf option unit unit_struct newtype_struct seq tuple
        tuple_struct map enum identifier ignored_any
    }
}

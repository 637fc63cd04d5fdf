//! Reading a document, and writing it.
//!
//! Its keys belong to two structs: the project, and the options that it shares
//! with a specification. Serde's `flatten` reads through a buffer: unknown keys would pass in
//! silence and errors would lose their line. So the keys at the top are dealt
//! out to the struct that has them, and each is read from its own.

use super::document::{FORMAT_VERSION, Project};
use super::error::ProjectError;
use super::segment_settings::SegmentRecord;
use crate::io::atomic_file;
use crate::io::atomic_file::refusal;
use crate::io::read;
use crate::transition::{PartTime, TransitionOptions};
use serde::de::value::Error as NoValue;
use serde::de::{Deserialize, Deserializer, Error, Visitor};
use serde::forward_to_deserialize_any;
use std::path::Path;
use toml::Spanned;
use toml::de::DeTable;

impl Project {
    /// Reads a document from its text.
    ///
    /// # Errors
    /// [`ProjectError`] names the line of what is wrong.
    pub fn parse(text: &str) -> Result<Self, ProjectError> {
        let mut project = read(text)?;
        project.check()?;
        project.deal_out()?;
        // Two that say the same are the same, whatever version they were written in.
        project.version = project.needed_version();
        Ok(project)
    }

    /// What stands at the top belongs to a pair: where there are more designs it is the
    /// first leg's, unless the document has legs.
    fn deal_out(&mut self) -> Result<(), ProjectError> {
        let (has, may_have) = (self.legs.len(), self.pair_count());
        let of_sequences = if self.is_sequence() { may_have } else { 0 };
        if has > of_sequences {
            return Err(ProjectError::TooManyLegs {
                has,
                may_have: of_sequences,
            });
        }
        if self.is_sequence() {
            let at_top = self.let_go();
            match self.legs.as_slice() {
                [] => self.put_legs(vec![at_top]),
                _ if at_top == SegmentRecord::default() => {}
                _ => return Err(ProjectError::MatchOfNoLeg),
            }
        }
        Ok(())
    }

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
        // What Serde cannot see: single numbers and pairs of them that go together.
        self.options.field.blend.check()?;
        self.options.colours.check()?;
        self.options.matching.check()?;
        PartTime::check(&self.options.parts)?;
        for leg in &self.legs {
            leg.matching.check()?;
            PartTime::check(&leg.parts)?;
        }
        self.options.coats.check()?;
        self.options.arap.check()?;
        self.map.check(self.designs.len())?;
        self.timing.check(&self.stops)?;
        Ok(())
    }

    /// Reads a document from a file.
    ///
    /// # Errors
    /// [`ProjectError`] names the file and, where there is one, the line.
    pub fn read(path: &Path) -> Result<Self, ProjectError> {
        let in_file = |error: ProjectError| error.in_file(path);
        let bytes = read::read(path).map_err(|error| in_file(error.into()))?;
        let text = String::from_utf8(bytes).map_err(|_| in_file(ProjectError::NotText))?;
        Self::parse(&text).map_err(in_file)
    }

    /// The document as text.
    ///
    /// # Errors
    /// [`ProjectError::Write`] if a number cannot be written, such as a count
    /// beyond the range of TOML.
    pub fn to_toml(&self) -> Result<String, ProjectError> {
        let project = Self {
            version: self.needed_version(),
            ..self.clone()
        };
        toml::to_string_pretty(&project).map_err(|error| ProjectError::Write(error.to_string()))
    }

    /// Writes the document beside its final place and moves it there, so that
    /// the old one stays whole until the new one is.
    ///
    /// # Errors
    /// [`ProjectError`] names the file; the old document is untouched.
    pub fn save_atomically(&self, path: &Path) -> Result<(), ProjectError> {
        let text = self.to_toml()?;
        let written = atomic_file::write(path, text.as_bytes());
        written.map_err(|error| ProjectError::Unwritable(refusal(&error)).in_file(path))
    }
}

/// Reads a document of the version of this program.
///
/// # Errors
/// [`ProjectError::NewerVersion`], or [`ProjectError::Syntax`] with the line of
/// what is wrong.
fn read(text: &str) -> Result<Project, ProjectError> {
    let wrong = |error: toml::de::Error| ProjectError::syntax(text, &error);
    let document = DeTable::parse(text).map_err(wrong)?;
    // Before all else, for a newer version may well have keys that are unknown
    // here; that it is newer is what its reader needs to hear.
    if let Some(version) = document.get_ref().get("version")
        && let Some(number) = version.get_ref().as_integer()
        && let Ok(number) = u64::from_str_radix(number.as_str(), number.radix())
        && number > FORMAT_VERSION.into()
    {
        return Err(ProjectError::newer(text, version.span().start, number));
    }
    let span = document.span();
    // Asked of the structs themselves, so that a new option needs no second list.
    let (own, shared) = (keys_of::<Project>(), keys_of::<TransitionOptions>());
    let (mut project, mut options) = (DeTable::new(), DeTable::new());
    for (key, value) in document.into_inner() {
        let name = key.get_ref().as_ref();
        // Spans stay with the values, so that errors still have their lines.
        let table = if shared.contains(&name) {
            &mut options
        } else if own.contains(&name) {
            &mut project
        } else {
            return Err(ProjectError::unknown_key(text, &key, [own, shared]));
        };
        table.insert(key, value);
    }
    let from = |table| toml::Deserializer::from(Spanned::new(span.clone(), table));
    let mut project = Project::deserialize(from(project)).map_err(wrong)?;
    project.options = TransitionOptions::deserialize(from(options)).map_err(wrong)?;
    Ok(project)
}

/// The keys that a struct is read from.
fn keys_of<'de, T: Deserialize<'de>>() -> &'static [&'static str] {
    let mut keys: &[&str] = &[];
    // Fails always: it has no values to give.
    if T::deserialize(DocumentKeys(&mut keys)).is_ok() {
        keys = &[];
    }
    keys
}

/// A deserialiser that only listens to what a struct asks for.
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

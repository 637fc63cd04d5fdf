//! Names of the values of enumerated options, defined once for project files, the command line,
//! reports and the window.
//!
//! Each option enum has a table with one row per variant: key, title, sentence.
//!
//! ```text
//! named! { VertexPath {
//!     Straight: "straight", "Straight", "Points move on straight lines";
//!     Intrinsic: "intrinsic", "Intrinsic", "Edges turn and change their lengths evenly";
//! } }
//! ```
//!
//! The macro implements [`Choice`], `ALL`, `Display` (the key), and serde's traits, which read
//! and write the key. A variant without a row does not compile. The compiler does not check that
//! keys are unique; a test checks all tables.

use std::fmt;
use std::marker::PhantomData;

use serde::de::{Deserializer, Error, Visitor};

/// Key, title and help sentence of one value of an option.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChoiceName {
    /// Name of the value in files and on the command line.
    pub key: &'static str,
    /// Label of the value in the window, one to three words.
    pub title: &'static str,
    /// Sentence that explains the effect of the value, shown in tooltips and `--help`.
    pub sentence: &'static str,
}

/// An option with a fixed list of named values.
///
/// ```
/// use morphospace::warp::homotopy::Homotopy;
/// use morphospace::settings::Choice;
/// assert_eq!(Homotopy::LinearAfterPolar.name().key, "linear-after-polar");
/// assert_eq!(Homotopy::of_key("polar"), Ok(Homotopy::Polar));
/// assert!(Homotopy::of_key("cubic").is_err());
/// ```
pub trait Choice: Copy + PartialEq + 'static {
    /// All values in the order in which they are offered.
    const CHOICES: &'static [Self];

    /// Returns key, title and help sentence of this value.
    fn name(self) -> &'static ChoiceName;

    /// Returns the value with the given key.
    ///
    /// # Errors
    /// [`UnknownKey`] lists the keys that exist.
    fn of_key(key: &str) -> Result<Self, UnknownKey> {
        let mut all = Self::CHOICES.iter().copied();
        all.find(|choice| choice.name().key == key)
            .ok_or_else(|| UnknownKey {
                given: key.to_owned(),
                valid: choice_keys::<Self>().collect(),
            })
    }
}

/// A key that does not name any value of an option.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("unknown value `{}`; use one of {}", given.escape_debug(), valid.join(", "))]
pub struct UnknownKey {
    given: String,
    valid: Vec<&'static str>,
}

/// Returns the keys of all values of an option, in the order in which they are offered.
pub fn choice_keys<T: Choice>() -> impl Iterator<Item = &'static str> {
    T::CHOICES.iter().map(|choice| choice.name().key)
}

/// Deserializes a value from its key.
pub(crate) fn deserialize_choice<'de, T: Choice, D: Deserializer<'de>>(
    from: D,
) -> Result<T, D::Error> {
    /// Visitor that accepts the key of a value.
    struct ChoiceKeyVisitor<T>(PhantomData<T>);

    impl<T: Choice> Visitor<'_> for ChoiceKeyVisitor<T> {
        type Value = T;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            let keys: Vec<_> = choice_keys::<T>().collect();
            write!(f, "one of {}", keys.join(", "))
        }

        fn visit_str<E: Error>(self, key: &str) -> Result<T, E> {
            T::of_key(key).map_err(E::custom)
        }
    }

    // Parsing inside the visitor lets the deserializer add the line number to an error.
    from.deserialize_str(ChoiceKeyVisitor(PhantomData))
}

/// Implements [`Choice`] and serde's traits for an enum; see the module documentation.
macro_rules! named {
    ($kind:ident { $($variant:ident: $key:literal, $title:literal, $sentence:literal;)+ }) => {
        impl $kind {
            /// All values in the order in which they are offered.
            pub const ALL: [Self; [$($key),+].len()] = [$(Self::$variant),+];
        }

        impl $crate::settings::Choice for $kind {
            const CHOICES: &'static [Self] = &Self::ALL;

            fn name(self) -> &'static $crate::settings::ChoiceName {
                match self {
                    $(Self::$variant => &$crate::settings::ChoiceName {
                        key: $key,
                        title: $title,
                        sentence: $sentence,
                    },)+
                }
            }
        }

        impl std::fmt::Display for $kind {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.pad($crate::settings::Choice::name(*self).key)
            }
        }

        impl serde::Serialize for $kind {
            fn serialize<S: serde::Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
                to.serialize_str($crate::settings::Choice::name(*self).key)
            }
        }

        impl<'de> serde::Deserialize<'de> for $kind {
            fn deserialize<D: serde::Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
                $crate::settings::deserialize_choice(from)
            }
        }
    };
}

pub(crate) use named;

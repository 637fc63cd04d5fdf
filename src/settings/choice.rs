//! What the values of an option are called: once, for files, the command line,
//! reports and the window.
//!
//! A table stands beside each enum of options, a row for each variant:
//!
//! ```text
//! named! { Course {
//!     Straight: "straight", "Straight", "On straight lines: what turns shrinks on the way";
//!     Intrinsic: "intrinsic", "Intrinsic", "Edges turn and change their lengths evenly";
//! } }
//! ```
//!
//! From it come [`Choice`], `ALL`, `Display` (the key) and the way in and out
//! of files. Guaranteed: a variant without a row does not compile, and files
//! hold keys and nothing else. Not guaranteed by the compiler: that two rows
//! have two keys; a test goes over all tables.

use std::fmt;
use std::marker::PhantomData;

use serde::de::{Deserializer, Error, Visitor};

/// What one value of an option is called.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChoiceName {
    /// In files and on the command line.
    pub key: &'static str,
    /// For people, in a word or two.
    pub title: &'static str,
    /// What it does, in a sentence.
    pub sentence: &'static str,
}

/// An option that is one of a few values.
///
/// ```
/// use morphospace::warp::homotopy::Homotopy;
/// use morphospace::settings::choice::Choice;
/// assert_eq!(Homotopy::LinearAfterPolar.name().key, "linear-after-polar");
/// assert_eq!(Homotopy::of_key("polar"), Ok(Homotopy::Polar));
/// assert!(Homotopy::of_key("cubic").is_err());
/// ```
pub trait Choice: Copy + PartialEq + 'static {
    /// All of them, in the order in which they are offered.
    const CHOICES: &'static [Self];

    /// What it is called.
    fn name(self) -> &'static ChoiceName;

    /// The one of that key.
    ///
    /// # Errors
    /// [`UnknownKey`], which lists those that there are.
    fn of_key(key: &str) -> Result<Self, UnknownKey> {
        let mut all = Self::CHOICES.iter().copied();
        all.find(|choice| choice.name().key == key)
            .ok_or_else(|| UnknownKey {
                found: key.to_owned(),
                known: keys::<Self>().collect(),
            })
    }
}

/// A key that is in no row of an option's table.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no `{}`; write {}", found.escape_debug(), known.join(", "))]
pub struct UnknownKey {
    found: String,
    known: Vec<&'static str>,
}

/// The keys of an option, in the order in which they are offered.
pub fn keys<T: Choice>() -> impl Iterator<Item = &'static str> {
    T::CHOICES.iter().map(|choice| choice.name().key)
}

/// Reads a key out of a file.
pub(crate) fn read<'de, T: Choice, D: Deserializer<'de>>(from: D) -> Result<T, D::Error> {
    struct ChoiceKeyVisitor<T>(PhantomData<T>);

    impl<T: Choice> Visitor<'_> for ChoiceKeyVisitor<T> {
        type Value = T;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            let keys: Vec<_> = keys::<T>().collect();
            write!(f, "one of {}", keys.join(", "))
        }

        fn visit_str<E: Error>(self, key: &str) -> Result<T, E> {
            T::of_key(key).map_err(E::custom)
        }
    }

    // Asked of the deserializer and not of a string, so that what is wrong has its line.
    from.deserialize_str(ChoiceKeyVisitor(PhantomData))
}

/// Gives the variants of an enum their names; see the head of this file.
macro_rules! named {
    ($kind:ident { $($variant:ident: $key:literal, $title:literal, $sentence:literal;)+ }) => {
        impl $kind {
            /// All of them, in the order in which they are offered.
            pub const ALL: [Self; [$($key),+].len()] = [$(Self::$variant),+];
        }

        impl $crate::settings::choice::Choice for $kind {
            const CHOICES: &'static [Self] = &Self::ALL;

            fn name(self) -> &'static $crate::settings::choice::ChoiceName {
                match self {
                    $(Self::$variant => &$crate::settings::choice::ChoiceName {
                        key: $key,
                        title: $title,
                        sentence: $sentence,
                    },)+
                }
            }
        }

        impl std::fmt::Display for $kind {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.pad($crate::settings::choice::Choice::name(*self).key)
            }
        }

        impl serde::Serialize for $kind {
            fn serialize<S: serde::Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
                to.serialize_str($crate::settings::choice::Choice::name(*self).key)
            }
        }

        impl<'de> serde::Deserialize<'de> for $kind {
            fn deserialize<D: serde::Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
                $crate::settings::choice::read(from)
            }
        }
    };
}

pub(crate) use named;

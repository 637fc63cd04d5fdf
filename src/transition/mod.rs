//! Transitions: a warp and a content, built from two designs, and the frames
//! between them.
//!
//! Everything that can fail fails in [`Transition::build`]; a [`Frame`] then
//! moves to any t without allocating. A frame is unevaluated: a placement and
//! how the contents mix at t. The stage evaluates it on the GPU, export and
//! tests on the CPU through [`Frame::figure`], so that there is one way to a
//! frame and the two can be held against each other.
//!
//! - `options`, `spec`: what a transition is built from; `arrange`: how the
//!   designs are laid into one frame
//! - `build`: from a specification to a transition, by way of `solids`
//!   (rigid parts, and in `lone` how those of one design are drawn, or `boundaries`
//!   alone) and `plane` (warps of the plane, from the `features` that they go by);
//!   `rigid`: a mesh that is not too large
//! - `candidate`: a matched piece and what is seen of its film; `group`: the pieces
//!   of some parts, matched in several ways; `choice`: of several the one with the
//!   least trouble; `parted`: all pieces out of each other's way, by the `conflicts`
//!   that they have; `settled`: with the places of `births`, and `holes` in them that
//!   come and go, all in their times by one `timetable` of their `growth`, by where
//!   their `walks` and `outline`s are at some `steps`; `unfolded`: films with fewer
//!   folds; `guarded`: films that keep out of their own way at every t
//! - `found`, `kept`: what was found, as a document keeps it
//! - `part_time`: parts that make their way in their own time
//! - `note`: what was done otherwise than asked; `mirrored`: what might have been
//!   meant
//! - `ready`, `frame`: the transition and its moments; `lazy`: placed when they are
//!   read; `recorded`: those that are played from memory; `proved`: what holds of them at every t
//! - `sequence`: several, one after the other; `blended`: between blends of many designs
//! - `timing`, `style`: how it is played and painted

mod arrange;
mod births;
mod blended;
mod boundaries;
mod build;
mod candidate;
mod cells;
mod choice;
mod coat_options;
mod coating;
mod conflicts;
mod drawings;
mod error;
mod features;
mod found;
mod frame;
mod group;
mod growth;
mod guarded;
mod holes;
mod kept;
mod lazy;
mod levels;
mod lone;
mod measured;
mod mirrored;
mod moved;
mod note;
mod options;
mod outline;
mod part_time;
mod parted;
mod plane;
mod proved;
mod ready;
mod recorded;
mod rigid;
mod sequence;
mod settled;
mod solids;
mod spec;
mod staggered;
mod steps;
mod style;
mod timetable;
mod timing;
mod unfolded;
mod walks;

#[cfg(test)]
mod tests;

pub use crate::easing::{Curve, Ease, Easing};

pub use arrange::{Fit, arranged, arrangement};
pub(crate) use blended::Ends;
pub(crate) use build::field_frame;
pub use cells::{Cell, NoSuchCell};
pub use coat_options::{CoatOptions, CoatOptionsError};
pub use error::BuildError;
pub use found::Found;
pub use frame::{Coated, Figure, Frame};
pub(crate) use measured::field as measured;
pub use note::Note;
pub use options::{Boundary, FieldOptions, Guarding, Options, PaintRule, Quality};
pub use part_time::{PartTime, PartTimeError};
pub use proved::Proved;
pub use ready::{Transition, TransitionId};
pub use sequence::{Sequence, SequenceFrame, place, style_of, tint};
pub use spec::TransitionSpec;
pub(crate) use spec::{bar_width, outline};
pub use style::Style;
pub use timing::{PlayMode, Stop, Timing, TimingError};

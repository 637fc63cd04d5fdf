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

mod any_warp;
mod arap_build;
mod blend_path;
mod boundary_paths;
mod build;
mod cached_match;
mod collision_guard;
mod collisions;
mod common_frame;
mod distance_fields;
mod drawing_pair;
mod error;
mod frame;
mod lazy_placement;
mod method;
mod note;
mod options;
mod paint_layer_options;
mod part_clocks;
mod part_time;
mod piece_coating;
mod plane;
mod plane_features;
mod proof;
mod recording;
mod rigid_solution;
mod search;
mod separation;
mod sequence;
mod solids;
mod solution_cache;
mod spec;
mod stiffening;
mod style;
mod transients;
mod transition;

#[cfg(test)]
mod tests;

pub use crate::time::easing::{EasingBezier, EasingFunction, NamedEasing};

pub use crate::time::timing::{PlayMode, Timing, TimingError, TransitionStop};
pub(crate) use blend_path::BlendEnds;
pub(crate) use build::field_frame;
pub use cached_match::CachedMatch;
pub use common_frame::{DesignFit, frame_similarity, place_in_frame};
pub(crate) use distance_fields::distance_field as measured;
pub use error::BuildError;
pub use frame::{FigureLayer, Frame, VectorFigure};
pub use method::{TransitionMethod, UnsupportedMethod};
pub use note::TransitionNote;
pub use options::{
    BuildQuality, CollisionAvoidance, FieldBoundary, FieldOptions, PaintRule, TransitionOptions,
};
pub use paint_layer_options::{PaintLayerOptions, PaintLayerOptionsError};
pub use part_time::{PartTime, PartTimeError};
pub use proof::TransitionProof;
pub use sequence::{Sequence, SequenceFrame, colour_fraction, segment_at, style_of};
pub use spec::TransitionSpec;
pub(crate) use spec::{bar_width, outline};
pub use style::TransitionStyle;
pub use transition::{Transition, TransitionId};

//! Transitions between two designs, and a [`Frame`] that shows a transition at any t.
//!
//! A transition consists of a warp, which moves points, and a content: solid shapes, distance
//! fields or pictures. All errors occur in [`Transition::build`]; a [`Frame`] then moves to any t
//! without allocating. A frame holds only the placement of the vertices and the t at which the
//! contents of both designs are mixed. The stage, a Bevy plugin, draws frames on the GPU; export
//! and tests evaluate them on the CPU through [`Frame::figure`].
//!
//! A *piece* moves as a whole. Usually it is a part of the source matched with a part of the
//! target, or an unmatched part. A part that is split belongs to several pieces.
//!
//! - `options`, `spec`: the inputs of a transition; `common_frame`: places designs in one
//!   coordinate system
//! - `build`: from a specification to a transition, through `solids` (rigid parts),
//!   `boundary_paths`, or `plane` (warps of the plane, which follow `plane_features`)
//! - `drawing_pair`: outlines and paint of both designs; `piece_coating`: paint layers of the
//!   pieces; `distance_fields`: fields of whole designs and of their layers
//! - `search`: tries several matches of each piece and rates them by their motion
//! - `separation`: unpairs pieces that would collide, as found by `collisions`
//! - `rigid_solution`: the solved motion of rigid parts; `transients`: positions and time windows
//!   of unmatched parts and holes
//! - `stiffening`: removes folds; `collision_guard`: moves shapes aside that would collide;
//!   `arap_build`: limits the size of meshes
//! - `cached_match`, `solution_cache`: solved matches stored in documents
//! - `part_time`, `part_clocks`: time windows of parts
//! - `note`: deviations from the request, and suggestions
//! - `transition`, `any_warp`, `method`: the transition, its warp and its method
//! - `frame`, `lazy_placement`: frames, whose vertices are placed only when they are read;
//!   `recording`, `proof`: recordings and checks at every t
//! - `sequence`: several transitions in a row; `blend_path`: paths between blends of many designs
//! - `style`: colours; `paint_layer_options`: fading and stacking order

mod any_warp;
mod arap_build;
mod blend_path;
mod boundary_paths;
mod build;
pub(crate) mod cached_match;
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
pub(crate) mod solution_cache;
mod spec;
mod stiffening;
mod style;
mod transients;
#[expect(clippy::module_inception, reason = "the file is named after its type")]
mod transition;

#[cfg(test)]
mod tests;

pub use crate::time::{EasingBezier, EasingFunction, NamedEasing};

pub use crate::time::{PlayMode, Timing, TimingError, TransitionStop};
pub(crate) use blend_path::BlendEnds;
pub(crate) use build::field_frame;
pub use cached_match::CachedMatch;
pub use common_frame::{DesignFit, FittedPage, frame_similarity, place_in_frame};
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
pub use sequence::{
    Sequence, SequenceFrame, SequenceLayout, colour_fraction, segment_at, style_of,
};
pub use spec::TransitionSpec;
pub(crate) use spec::{bar_width, outline};
pub use style::TransitionStyle;
pub use transition::{Transition, TransitionId};

//! What stands on the stage: the components a program spawns and those that
//! the plugin adds.
//!
//! Guarantees: removing or replacing any of them never leaves stale pictures
//! behind. Does not guarantee a picture while a build is running: until then
//! the entity shows what it showed before, or nothing.

use bevy::prelude::*;

use crate::mesh::TriangleMesh;
use crate::transition::{BuildError, Frame, Transition, TransitionStyle};
use crate::warp::ArapOptions;

/// The design at t = 0, as triangles. Together with a [`TargetMesh`] of the
/// same faces it is all that a morphing entity needs.
///
/// Changing it (or the target, or the options) builds the transition anew.
#[derive(Component, Clone, Debug, Reflect)]
#[reflect(opaque)]
#[reflect(Component, Clone, Debug)]
#[require(Blend, MorphOptions, StageStyle, Transform, Visibility)]
pub struct SourceMesh(pub TriangleMesh);

/// The design at t = 1: the same faces as the [`SourceMesh`], in the same
/// order, other positions.
#[derive(Component, Clone, Debug, Reflect)]
#[reflect(opaque)]
#[reflect(Component, Clone, Debug)]
#[require(Blend, MorphOptions, StageStyle, Transform, Visibility)]
pub struct TargetMesh(pub TriangleMesh);

/// Where the entity is in its transition: 0 is the source, 1 the target,
/// values outside extrapolate. NaN and infinity leave the picture as it was.
///
/// ```
/// use morphospace::stage::Blend;
/// assert_eq!(Blend::default().t, 0.0);
/// ```
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[reflect(Component, Clone, Debug, Default, PartialEq)]
pub struct Blend {
    /// The blend parameter.
    pub t: f64,
}

/// How two meshes are interpolated.
#[derive(Component, Clone, Debug, Default, Reflect)]
#[reflect(opaque)]
#[reflect(Component, Clone, Debug, Default)]
pub struct MorphOptions(pub ArapOptions);

/// A transition that is built, and the frame it is at: added by the plugin,
/// sought to [`Blend`] whenever that changes. Its content says how it is drawn.
///
/// Reflection sees that it is there, not the frame: that owns the memory that
/// it is evaluated in and has no copies.
#[derive(Component, Debug, Reflect)]
#[reflect(Component, Debug, from_reflect = false)]
pub struct Morph(#[reflect(ignore)] pub(super) Frame);

impl Morph {
    /// The frame that is on the stage. Where the graphics card plays it, its vertices are
    /// placed when somebody asks for them, once for each t: ask where you need them.
    pub fn frame(&self) -> &Frame {
        &self.0
    }
}

/// A transition that is built already, of any cell of the table.
///
/// The plugin answers with a [`Morph`], and with a [`SourceMesh`] and a
/// [`TargetMesh`] where it has triangles. Replacing it replaces the picture.
#[derive(Component, Clone, Debug, Reflect)]
#[reflect(opaque)]
#[reflect(Component, Clone, Debug)]
#[require(Blend, StageStyle, Transform, Visibility)]
pub struct StageTransition(pub Transition);

/// Colours of an entity on the stage, and what of it is shown.
#[derive(Component, Clone, Debug, Default, Reflect)]
#[reflect(Component, Clone, Debug, Default)]
pub struct StageStyle {
    /// Colours, shared with the exporters.
    #[reflect(ignore, clone)]
    pub style: TransitionStyle,
    /// What is shown.
    pub show: StageVisibility,
}

/// What of a transition is shown; what does not apply to it is ignored.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Reflect)]
#[reflect(Clone, Debug, Default, PartialEq)]
pub struct StageVisibility {
    /// The filled form (solids and fields).
    pub fill: bool,
    /// The edges of the triangulation.
    pub wireframe: bool,
    /// The bars and joints of a truss.
    pub bars: bool,
    /// Thin outlines of source and target.
    pub ghosts: bool,
    /// Lines of equal blended distance (fields only).
    pub iso_lines: bool,
    /// The blended field in two hues, warm inside and cool outside (fields only).
    pub signed_colours: bool,
    /// A square grid of the source, where the warp carries it (wherever
    /// there are faces).
    pub grid: bool,
}

impl Default for StageVisibility {
    fn default() -> Self {
        Self {
            fill: true,
            wireframe: false,
            bars: true,
            ghosts: false,
            iso_lines: false,
            signed_colours: false,
            grid: false,
        }
    }
}

/// Two meshes could not be made into a transition. Triggered on the entity,
/// which keeps what it showed before.
#[derive(EntityEvent, Debug)]
pub struct BuildFailed {
    /// The entity whose meshes they are.
    pub entity: Entity,
    /// Why, in words for a user.
    pub error: BuildError,
}

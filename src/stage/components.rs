//! Components of a transition on the stage: those that a program spawns and those that the plugin
//! adds.
//!
//! Guaranteed: removing or replacing any of them never leaves a stale picture. Not guaranteed: a
//! picture while a build is running. Until it finishes, the entity keeps its previous picture, or
//! shows nothing.

use bevy::prelude::*;

use crate::mesh::TriangleMesh;
use crate::transition::{BuildError, Frame, Transition, TransitionStyle};
use crate::warp::ArapOptions;

/// Design at t = 0, as triangles. It must have the same faces as the [`TargetMesh`]; together the
/// two are all that a morphing entity needs.
///
/// Changing it, the target or the options rebuilds the transition.
#[derive(Component, Clone, Debug, Reflect)]
#[reflect(opaque)]
#[reflect(Component, Clone, Debug)]
#[require(Blend, MorphOptions, StageStyle, Transform, Visibility)]
pub struct SourceMesh(pub TriangleMesh);

/// Design at t = 1: the same faces as the [`SourceMesh`], in the same order, at other positions.
#[derive(Component, Clone, Debug, Reflect)]
#[reflect(opaque)]
#[reflect(Component, Clone, Debug)]
#[require(Blend, MorphOptions, StageStyle, Transform, Visibility)]
pub struct TargetMesh(pub TriangleMesh);

/// Blend parameter of an entity: 0 is the source, 1 the target, values outside extrapolate. NaN and
/// infinity leave the picture unchanged.
///
/// ```
/// use morphospace::stage::Blend;
/// assert_eq!(Blend::default().t, 0.0);
/// ```
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[reflect(Component, Clone, Debug, Default, PartialEq)]
pub struct Blend {
    /// Blend parameter.
    pub t: f64,
}

/// Options of the interpolation between two meshes.
#[derive(Component, Clone, Debug, Default, Reflect)]
#[reflect(opaque)]
#[reflect(Component, Clone, Debug, Default)]
pub struct MorphOptions(pub ArapOptions);

/// A built transition with its current frame. The plugin adds it and moves it to [`Blend`] whenever
/// that changes. Its content determines how it is drawn.
///
/// Reflection shows the component but not the frame, which owns its memory and cannot be cloned.
#[derive(Component, Debug, Reflect)]
#[reflect(Component, Debug, from_reflect = false)]
pub struct Morph(#[reflect(ignore)] pub(super) Frame);

impl Morph {
    /// Returns the current frame. If the graphics card plays it, its vertices are placed on the
    /// first read at each t, so read them only where needed.
    pub fn frame(&self) -> &Frame {
        &self.0
    }
}

/// A transition that was built elsewhere, of any kind.
///
/// The plugin adds a [`Morph`] and, if the transition has triangles, a [`SourceMesh`] and a
/// [`TargetMesh`]. Replacing the component replaces the picture.
#[derive(Component, Clone, Debug, Reflect)]
#[reflect(opaque)]
#[reflect(Component, Clone, Debug)]
#[require(Blend, StageStyle, Transform, Visibility)]
pub struct StageTransition(pub Transition);

/// Colours of an entity on the stage, and which of its elements are visible.
#[derive(Component, Clone, Debug, Default, Reflect)]
#[reflect(Component, Clone, Debug, Default)]
pub struct StageStyle {
    /// Colours, shared with the exporters.
    #[reflect(ignore, clone)]
    pub style: TransitionStyle,
    /// Visible elements.
    pub show: StageVisibility,
}

/// Visible elements of a transition. Elements that do not apply to it are ignored.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Reflect)]
#[reflect(Clone, Debug, Default, PartialEq)]
pub struct StageVisibility {
    /// Filled shape (solids and fields) or picture.
    pub fill: bool,
    /// Edges of the triangulation.
    pub wireframe: bool,
    /// Bars and joints of a truss.
    pub bars: bool,
    /// Thin outlines of source and target.
    pub ghosts: bool,
    /// Lines of equal blended distance (fields only).
    pub iso_lines: bool,
    /// Blended field in two hues, warm inside and cool outside (fields only).
    pub signed_colours: bool,
    /// Square grid of the source, deformed by the warp (any transition with faces).
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

/// Triggered on an entity whose transition could not be built. The entity keeps its previous
/// picture.
#[derive(EntityEvent, Debug)]
pub struct BuildFailed {
    /// Entity whose build failed.
    pub entity: Entity,
    /// Reason, readable by a user.
    pub error: BuildError,
}

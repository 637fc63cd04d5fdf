//! Components of a transition on the stage: those that a program spawns and those that the plugin
//! adds.
//!
//! Guaranteed: removing the [`Morph`] removes everything that is drawn for the entity. Removing
//! only the meshes or the [`StageTransition`] removes nothing, because the [`Morph`] stays. While a
//! new transition is being built, the entity shows its previous transition, or nothing.

use bevy::prelude::*;

use crate::mesh::TriangleMesh;
use crate::transition::{BuildError, Frame, Transition, TransitionStyle};
use crate::warp::ArapOptions;

/// Triangle mesh at t = 0. It must have the same faces as the [`TargetMesh`]; an entity with both
/// meshes is morphed by the plugin.
///
/// Changing this mesh, the target or the [`MorphOptions`] rebuilds the transition.
#[derive(Component, Clone, Debug, Reflect)]
#[reflect(opaque)]
#[reflect(Component, Clone, Debug)]
#[require(Blend, MorphOptions, StageStyle, Transform, Visibility)]
pub struct SourceMesh(pub TriangleMesh);

/// Triangle mesh at t = 1. It must have the faces of the [`SourceMesh`], in the same order; only
/// the positions differ.
#[derive(Component, Clone, Debug, Reflect)]
#[reflect(opaque)]
#[reflect(Component, Clone, Debug)]
#[require(Blend, MorphOptions, StageStyle, Transform, Visibility)]
pub struct TargetMesh(pub TriangleMesh);

/// Blend parameter of an entity: 0 is the source, 1 the target, values outside [0, 1] extrapolate.
/// NaN and infinity are ignored.
///
/// ```
/// use morphospace::stage::Blend;
/// assert_eq!(Blend::default().t, 0.0);
/// ```
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[reflect(Component, Clone, Debug, Default, PartialEq)]
pub struct Blend {
    /// Blend parameter; see [`Blend`].
    pub t: f64,
}

/// Options of the as-rigid-as-possible interpolation between a [`SourceMesh`] and a [`TargetMesh`].
#[derive(Component, Clone, Debug, Default, Reflect)]
#[reflect(opaque)]
#[reflect(Component, Clone, Debug, Default)]
pub struct MorphOptions(pub ArapOptions);

/// A built transition with its current frame. The plugin adds the component to an entity and moves
/// the frame whenever the [`Blend`] changes. The content of the transition determines how it is
/// drawn.
///
/// Reflection lists the component without its frame, which cannot be cloned.
#[derive(Component, Debug, Reflect)]
#[reflect(Component, Debug, from_reflect = false)]
pub struct Morph(#[reflect(ignore)] pub(super) Frame);

impl Morph {
    /// Returns the current frame. If the graphics card evaluates the morph from a recording, the
    /// first read of the vertices at each t computes them on the CPU, so read them only where
    /// needed.
    pub fn frame(&self) -> &Frame {
        &self.0
    }
}

/// A transition of any kind that the program has built itself.
///
/// The plugin adds a [`Morph`] and, if the transition has faces, a [`SourceMesh`] and a
/// [`TargetMesh`] to the entity. Replacing the component replaces the transition that is shown.
#[derive(Component, Clone, Debug, Reflect)]
#[reflect(opaque)]
#[reflect(Component, Clone, Debug)]
#[require(Blend, StageStyle, Transform, Visibility)]
pub struct StageTransition(pub Transition);

/// Colours of an entity on the stage, and the elements of it that are visible.
#[derive(Component, Clone, Debug, Default, Reflect)]
#[reflect(Component, Clone, Debug, Default)]
pub struct StageStyle {
    /// Colours and background, and whether joints are drawn, as in exported files.
    #[reflect(ignore, clone)]
    pub style: TransitionStyle,
    /// Elements that are visible.
    pub visibility: StageVisibility,
}

/// Elements of a transition that are visible. Elements that a transition does not have are ignored.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Reflect)]
#[reflect(Clone, Debug, Default, PartialEq)]
pub struct StageVisibility {
    /// Filled shapes of solids and distance fields, and pictures.
    pub fill: bool,
    /// Edges of the triangulation.
    pub wireframe: bool,
    /// Bars and joints of a truss.
    pub bars: bool,
    /// Thin outlines of source and target.
    pub ghosts: bool,
    /// Lines of equal blended distance (distance fields only).
    pub iso_lines: bool,
    /// Blended distance in two colours, orange inside and violet outside (distance fields only).
    pub signed_colours: bool,
    /// Square grid in the source, deformed by the warp (transitions with faces only).
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

/// Event on an entity whose transition could not be built. The entity still shows its previous
/// transition, if it had one.
#[derive(EntityEvent, Debug)]
pub struct BuildFailed {
    /// Entity whose build failed.
    pub entity: Entity,
    /// Reason of the failure; its text is suitable for users.
    pub error: BuildError,
}

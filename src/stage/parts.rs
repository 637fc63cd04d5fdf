//! Render parts of an entity on the stage: child entities that draw its faces, distance fields,
//! pictures, bars, joints, wireframe, warp grid and outlines. Defines their kinds, their drawing
//! order, and when and how their vertices are written.

use bevy::prelude::*;
use glam::DVec2;
use std::fmt;

use crate::colour::Rgb;
use crate::export::joint_core;
use crate::transition::Frame;
use crate::warp::WarpKind;

use super::carried_mesh;
use super::components::StageStyle;
use super::ink_material::InkKind;
use super::paint::StagePaint;
use super::paint_layers::LayerMesh;
use super::ring_fill;
use super::stage_view::StageView;
use super::uploaded_recording::UploadState;
use super::vertices::{BarShapes, positions, write_corners, write_points};

/// A render part: a child entity that draws one element of a transition.
#[derive(Component, Debug)]
pub(super) struct StagePart {
    /// Element of the transition that the render part draws.
    pub(super) kind: PartKind,
    /// Material of the render part.
    pub(super) paint: StagePaint,
    /// Point of the plane to which the vertex positions are relative.
    pub(super) origin: DVec2,
    /// Constructor of the mesh; `None` once the render part has been shown.
    pub(super) deferred_mesh: Option<DeferredMesh>,
    /// Whether the vertices must be rewritten, because the frame or the style changed after they
    /// were written.
    pub(super) is_stale: bool,
}

/// Constructor of a mesh that is called when a render part is shown for the first time.
pub(super) struct DeferredMesh(pub(super) Box<dyn FnOnce(&Frame) -> Mesh + Send + Sync>);

impl fmt::Debug for DeferredMesh {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Unmade")
    }
}

/// Element of a transition that a render part draws.
#[derive(Clone, Debug)]
pub(super) enum PartKind {
    /// Filled faces in one colour.
    Faces,
    /// Filled boundaries in one colour, if the transition has no faces or has transient parts or
    /// holes that faces cannot represent.
    Rings,
    /// Faces or boundary loops in several paint layers.
    PaintLayers(LayerMesh),
    /// Blend of distance fields.
    Field,
    /// Cross-dissolved pictures.
    Picture,
    /// All bars of a truss that have the same paints, with the discs at their ends.
    Bars(BarShapes),
    /// Lighter cores of the joints of all bars that have the same paints.
    JointCores(BarShapes),
    /// Edges of the triangulation.
    Wire {
        /// Whether the edges are drawn on filled faces; otherwise they lie on the background.
        on_faces: bool,
    },
    /// Grid deformed by the warp.
    Grid,
    /// Outline of the source.
    SourceGhost,
    /// Outline of the target.
    TargetGhost,
}

impl PartKind {
    /// Returns the height of the render part in the drawing order. Render parts with larger values
    /// cover those with smaller values.
    pub(super) fn z(&self) -> f32 {
        match self {
            Self::Faces | Self::Rings | Self::PaintLayers(_) | Self::Picture => 0.0,
            // Fields draw lines of equal distance, which lie above the paint layers.
            Self::Field => 0.05,
            Self::Bars(bars) => 0.1 + 0.05 * bars.z_fraction,
            Self::JointCores(bars) => 0.2 + 0.05 * bars.z_fraction,
            Self::Wire { .. } => 0.3,
            Self::Grid => 0.35,
            Self::SourceGhost => 0.4,
            Self::TargetGhost => 0.5,
        }
    }

    /// Returns the kind of shape that the material of the render part draws. This kind selects the
    /// shader variant.
    pub(super) fn ink_kind(&self) -> InkKind {
        match self {
            Self::Bars(_) | Self::JointCores(_) => InkKind::Round,
            Self::Wire { .. } => InkKind::Wire,
            Self::SourceGhost | Self::TargetGhost => InkKind::Line,
            Self::PaintLayers(_) => InkKind::PaintLayers,
            _ => InkKind::Faces,
        }
    }

    /// Returns whether the render part is visible in a style.
    pub(super) fn is_shown(
        &self,
        StageStyle {
            style,
            visibility: show,
        }: &StageStyle,
    ) -> bool {
        match self {
            Self::Faces | Self::Rings | Self::Picture => show.fill,
            Self::PaintLayers(layers) => {
                show.fill && !(layers.is_of_fields() && show.signed_colours)
            }
            // One material draws the fill, the lines and the signed colours, whichever are on.
            Self::Field => show.fill || show.iso_lines || show.signed_colours,
            Self::Bars(_) => show.bars,
            Self::JointCores(_) => show.bars && style.joints,
            Self::Wire { .. } => show.wireframe,
            Self::Grid => show.grid,
            Self::SourceGhost | Self::TargetGhost => show.ghosts,
        }
    }

    /// Returns the colour of the render part at `t` in a style. Applies to render parts in one
    /// colour.
    pub(super) fn colour(
        &self,
        t: f64,
        StageStyle {
            style,
            visibility: show,
        }: &StageStyle,
    ) -> Rgb {
        match self {
            Self::Bars(bars) => style.paint_at(bars.paints, t).colour,
            Self::JointCores(bars) => joint_core(style.paint_at(bars.paints, t).colour),
            Self::SourceGhost => style.source,
            Self::TargetGhost => style.target,
            // On filled faces, a wireframe has the colour of the background.
            Self::Wire { on_faces: true } if show.fill => style.ground,
            _ => style.fill_at(t),
        }
    }

    /// Returns whether the vertices of the render part must be rewritten because the frame has
    /// moved (`has_moved`) or the style has changed (`is_restyled`).
    pub(super) fn is_outdated(&self, has_moved: bool, is_restyled: bool, frame: &Frame) -> bool {
        match self {
            Self::SourceGhost | Self::TargetGhost => false,
            // Without a warp only the material changes. A new render part counts as outdated, so
            // its vertices are written once.
            Self::Field | Self::Picture => {
                has_moved && frame.transition().method().warp() != WarpKind::None
            }
            // The style determines the radius of joints, and the colours of layers that have no
            // paints.
            Self::Bars(_) | Self::PaintLayers(_) => has_moved || is_restyled,
            _ => has_moved,
        }
    }
}

impl StagePart {
    /// Returns whether the graphics card evaluates the vertices of the render part at `t` from a
    /// recording.
    pub(super) fn is_gpu_played(&self, upload: Option<&UploadState>, t: f64) -> bool {
        let is_uploaded = upload.is_some_and(|upload| upload.covers(t));
        is_uploaded && matches!(self.paint, StagePaint::Recorded(_))
    }

    /// Returns whether the render part is shown and the CPU must compute vertex positions for it at
    /// `t`.
    pub(super) fn needs_positions(
        &self,
        frame: &Frame,
        t: f64,
        style: &StageStyle,
        upload: Option<&UploadState>,
    ) -> bool {
        let is_outdated = self.kind.is_outdated(true, false, frame);
        self.kind.is_shown(style) && is_outdated && !self.is_gpu_played(upload, t)
    }

    /// Writes the vertices of the render part for a frame and a style into its mesh.
    pub(super) fn write(&mut self, frame: &Frame, style: &StageStyle, mesh: &mut Mesh) {
        let placement = frame.placement();
        let (points, faces, origin) = (&placement.in_frame, &placement.faces, self.origin);
        let joints = style.style.joints;
        match &mut self.kind {
            PartKind::PaintLayers(layers) => {
                layers.write(frame, &style.style, origin, mesh);
            }
            PartKind::Rings => ring_fill::write(frame, origin, mesh),
            PartKind::Field | PartKind::Picture => {
                let content = frame.transition().content();
                carried_mesh::write(frame, origin, Some(content), mesh);
            }
            PartKind::Grid => carried_mesh::write(frame, origin, None, mesh),
            PartKind::SourceGhost | PartKind::TargetGhost => {}
            PartKind::Faces => write_points(points, origin, positions(mesh)),
            PartKind::Wire { .. } => write_corners(points, faces, origin, positions(mesh)),
            PartKind::Bars(bars) => bars.write(points, joints, origin, positions(mesh)),
            PartKind::JointCores(bars) => bars.write_cores(points, origin, positions(mesh)),
        }
        self.is_stale = false;
    }
}

/// Moves render parts to their place in Bevy's world, whose origin is the point
/// [`StageView::anchor`] of the plane.
pub(super) fn place_parts(view: Res<StageView>, mut parts: Query<(&StagePart, &mut Transform)>) {
    for (part, transform) in &mut parts {
        // The difference is taken in double precision: the design and the point of the plane at
        // Bevy's origin may lie far from zero, but near each other.
        let offset = (part.origin - view.anchor()).as_vec2();
        let translation = offset.extend(part.kind.z());
        let mut current = transform.map_unchanged(|transform| &mut transform.translation);
        current.set_if_neq(translation);
    }
}

//! The render entities below an entity on the stage: faces or field, bars,
//! joints, wires and ghosts.

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

/// A render entity of a transition.
#[derive(Component, Debug)]
pub(super) struct StagePart {
    pub(super) kind: PartKind,
    pub(super) paint: StagePaint,
    /// The point of the plane that the vertices are relative to.
    pub(super) origin: DVec2,
    /// How its mesh is made, once it is shown.
    pub(super) unmade: Option<MissingParts>,
    /// The vertices are not those of the frame: they have not been written
    /// since the frame moved.
    pub(super) stale: bool,
}

/// A mesh that has not been wanted yet.
pub(super) struct MissingParts(pub(super) Box<dyn FnOnce(&Frame) -> Mesh + Send + Sync>);

impl fmt::Debug for MissingParts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Unmade")
    }
}

/// What a part shows.
#[derive(Clone, Debug)]
pub(super) enum PartKind {
    Faces,
    /// Boundaries that bring no faces, or more holes than those.
    Rings,
    /// Faces or boundaries in several paints.
    Coats(LayerMesh),
    Field,
    Picture,
    Bars(BarShapes),
    JointCores(BarShapes),
    Wire {
        /// It is seen on the faces, not on the ground.
        on_faces: bool,
    },
    /// The grids that show the warp.
    Grid,
    SourceGhost,
    TargetGhost,
}

impl PartKind {
    /// What is drawn over what.
    pub(super) fn layer(&self) -> f32 {
        match self {
            Self::Faces | Self::Rings | Self::Coats(_) | Self::Picture => 0.0,
            // Lines of equal distance lie over the paints.
            Self::Field => 0.05,
            Self::Bars(bars) => 0.1 + 0.05 * bars.height,
            Self::JointCores(bars) => 0.2 + 0.05 * bars.height,
            Self::Wire { .. } => 0.3,
            Self::Grid => 0.35,
            Self::SourceGhost => 0.4,
            Self::TargetGhost => 0.5,
        }
    }

    pub(super) fn ink(&self) -> InkKind {
        match self {
            Self::Bars(_) | Self::JointCores(_) => InkKind::Round,
            Self::Wire { .. } => InkKind::Wire,
            Self::SourceGhost | Self::TargetGhost => InkKind::Line,
            Self::Coats(_) => InkKind::Coats,
            _ => InkKind::Faces,
        }
    }

    pub(super) fn is_shown(&self, StageStyle { style, show }: &StageStyle) -> bool {
        match self {
            Self::Faces | Self::Rings | Self::Picture => show.fill,
            Self::Coats(coats) => show.fill && !(coats.is_of_fields() && show.signed_colours),
            // One shader draws all three, and leaves out what is not asked for.
            Self::Field => show.fill || show.iso_lines || show.signed_colours,
            Self::Bars(_) => show.bars,
            Self::JointCores(_) => show.bars && style.joints,
            Self::Wire { .. } => show.wireframe,
            Self::Grid => show.grid,
            Self::SourceGhost | Self::TargetGhost => show.ghosts,
        }
    }

    pub(super) fn colour(&self, t: f64, StageStyle { style, show }: &StageStyle) -> Rgb {
        match self {
            Self::Bars(bars) => style.paint_at(bars.paints, t).colour,
            Self::JointCores(bars) => joint_core(style.paint_at(bars.paints, t).colour),
            Self::SourceGhost => style.source,
            Self::TargetGhost => style.target,
            // Wires are cut into the fill where there is one.
            Self::Wire { on_faces: true } if show.fill => style.ground,
            _ => style.fill_at(t),
        }
    }

    /// Whether its vertices are others once the frame, or how it looks, is.
    pub(super) fn outdated(&self, has_moved: bool, is_restyled: bool, frame: &Frame) -> bool {
        match self {
            Self::SourceGhost | Self::TargetGhost => false,
            // Where nothing is warped only the material changes, and the first
            // write is due to `stale`.
            Self::Field | Self::Picture => {
                has_moved && frame.transition().cell().warp() != WarpKind::None
            }
            // Bars are as wide as their joints are drawn, and what has no paint of its
            // own has the style's.
            Self::Bars(_) | Self::Coats(_) => has_moved || is_restyled,
            _ => has_moved,
        }
    }
}

impl StagePart {
    /// Whether the graphics card knows where its vertices are at `t`.
    pub(super) fn is_played(&self, sent: Option<&UploadState>, t: f64) -> bool {
        let is_there = sent.is_some_and(|sent| sent.shows(t));
        is_there && matches!(self.paint, StagePaint::Played(_))
    }

    /// Whether it is shown and wants to know where its vertices are as the frame moves
    /// to `t`.
    pub(super) fn reads(
        &self,
        frame: &Frame,
        t: f64,
        style: &StageStyle,
        sent: Option<&UploadState>,
    ) -> bool {
        let is_outdated = self.kind.outdated(true, false, frame);
        self.kind.is_shown(style) && is_outdated && !self.is_played(sent, t)
    }

    /// Brings the vertices up to where the frame is.
    pub(super) fn write(&mut self, frame: &Frame, style: &StageStyle, mesh: &mut Mesh) {
        let placement = frame.placement();
        let (points, faces, origin) = (&placement.in_frame, &placement.faces, self.origin);
        let joints = style.style.joints;
        match &mut self.kind {
            PartKind::Coats(coats) => {
                coats.write(frame, &style.style, origin, mesh);
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
        self.stale = false;
    }
}

/// Puts parts where they are in Bevy's world.
pub(super) fn place_parts(view: Res<StageView>, mut parts: Query<(&StagePart, &mut Transform)>) {
    for (part, transform) in &mut parts {
        // Subtracted in double precision: designs may lie far from zero, and
        // the view follows them.
        let at = (part.origin - view.anchor()).as_vec2();
        let translation = at.extend(part.kind.layer());
        let mut place = transform.map_unchanged(|transform| &mut transform.translation);
        place.set_if_neq(translation);
    }
}

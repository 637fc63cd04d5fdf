//! One system writes the render mesh: wherever the frame moved.
//!
//! Guarantees: only vertices that are seen are written, in place, and only then
//! is the mesh marked as changed; hidden parts are written when they are shown.

use std::time::Instant;

use bevy::mesh::VertexAttributeValues;
use bevy::prelude::*;

use crate::content::Content;
use crate::export::joint_core;
use crate::transition::{Frame, Rgb};
use crate::warp::WarpKind;

use super::carried::{self, Lookups};
use super::colours::{ColourLook, ColourMaterial};
use super::components::{ArapSolver, FieldSprite, PictureSprite, StageStyle};
use super::field::{FieldLook, FieldMaterial};
use super::fill;
use super::grid::{GridLook, GridMaterial};
use super::ink::{InkMaterial, linear};
use super::parts::{Part, PartKind};
use super::shapes::{Positions, write_corners, write_points};
use super::times::FrameTimes;

type PartQuery<'w, 's> = Query<
    'w,
    's,
    (
        &'static mut Part,
        &'static mut Visibility,
        &'static Mesh2d,
        Option<&'static MeshMaterial2d<InkMaterial>>,
        Option<&'static MeshMaterial2d<FieldMaterial>>,
        Option<&'static MeshMaterial2d<ColourMaterial>>,
    ),
>;

/// A frame, or how it looks, or what shows it, is new.
type Moved<C> = Or<(Changed<C>, Changed<StageStyle>, Changed<Children>)>;

type Solids = (
    Ref<'static, ArapSolver>,
    Ref<'static, StageStyle>,
    &'static Children,
);

/// Writes vertices and colours of solids.
pub(super) fn draw_solids(
    roots: Query<Solids, Moved<ArapSolver>>,
    mut parts: PartQuery,
    mut meshes: ResMut<Assets<Mesh>>,
    mut inks: ResMut<Assets<InkMaterial>>,
    mut times: ResMut<FrameTimes>,
) {
    let start = Instant::now();
    for (solver, style, children) in &roots {
        let frame = solver.frame();
        let moved = solver.is_changed() || style.is_changed();
        let mut parts = parts.iter_many_mut(children);
        while let Some((mut part, mut visibility, mesh, ink, ..)) = parts.fetch_next() {
            let shown = part.kind.is_shown(&style);
            visibility.set_if_neq(visible(shown));
            part.stale |= moved && !part.kind.is_still();
            if !shown {
                continue;
            }
            if let Some(ink) = ink {
                set_colour(&mut inks, ink, part.kind.colour(frame.t(), &style));
            }
            if part.stale && matches!(part.kind, PartKind::Rings) {
                if let Some(mut mesh) = meshes.get_mut(mesh) {
                    fill::write(frame, part.origin, &mut mesh);
                    part.stale = false;
                }
            } else if part.stale && !matches!(part.kind, PartKind::Grid) {
                part.stale = !rewrite(&mut meshes, mesh, |positions| {
                    part.kind.write(frame, &style, part.origin, positions);
                });
            }
        }
    }
    if !roots.is_empty() {
        times.draw.record(start.elapsed());
    }
}

/// Writes the uniforms of fields.
pub(super) fn draw_fields(
    roots: Query<(Ref<FieldSprite>, &StageStyle, &Children), Moved<FieldSprite>>,
    mut parts: PartQuery,
    mut meshes: ResMut<Assets<Mesh>>,
    mut inks: ResMut<Assets<InkMaterial>>,
    mut fields: ResMut<Assets<FieldMaterial>>,
    mut times: ResMut<FrameTimes>,
) {
    let start = Instant::now();
    for (sprite, style, children) in &roots {
        let frame = sprite.frame();
        let mut parts = parts.iter_many_mut(children);
        while let Some((mut part, mut visibility, mesh, ink, field, _)) = parts.fetch_next() {
            visibility.set_if_neq(visible(part.kind.is_shown(style)));
            carry(&mut part, sprite.is_changed(), frame, &mut meshes, mesh);
            if let Some(ink) = ink {
                set_colour(&mut inks, ink, part.kind.colour(frame.t(), style));
            }
            if let (Some(field), Content::Field(pair)) = (field, frame.transition().content()) {
                let look = FieldLook::new(pair, frame.t(), style);
                if fields.get(field).is_some_and(|old| old.look != look)
                    && let Some(mut material) = fields.get_mut(field)
                {
                    material.look = look;
                }
            }
        }
    }
    if !roots.is_empty() {
        times.draw.record(start.elapsed());
    }
}

/// Writes the uniforms of pictures, and where a warp has put them.
pub(super) fn draw_pictures(
    roots: Query<(Ref<PictureSprite>, &StageStyle, &Children), Moved<PictureSprite>>,
    mut parts: PartQuery,
    mut meshes: ResMut<Assets<Mesh>>,
    mut inks: ResMut<Assets<InkMaterial>>,
    mut pictures: ResMut<Assets<ColourMaterial>>,
    mut times: ResMut<FrameTimes>,
) {
    let start = Instant::now();
    for (sprite, style, children) in &roots {
        let frame = sprite.frame();
        let mut parts = parts.iter_many_mut(children);
        while let Some((mut part, mut visibility, mesh, ink, _, picture)) = parts.fetch_next() {
            let shown = part.kind.is_shown(style);
            visibility.set_if_neq(visible(shown));
            carry(&mut part, sprite.is_changed(), frame, &mut meshes, mesh);
            if let Some(ink) = ink {
                set_colour(&mut inks, ink, part.kind.colour(frame.t(), style));
            }
            if let (Some(picture), Content::Colours(pair)) = (picture, frame.transition().content())
            {
                let look = ColourLook::new(pair, frame.t(), part.origin, shown);
                if pictures.get(picture).is_some_and(|old| old.look != look)
                    && let Some(mut material) = pictures.get_mut(picture)
                {
                    material.look = look;
                }
            }
        }
    }
    if !roots.is_empty() {
        times.draw.record(start.elapsed());
    }
}

/// A transition of any content that moved, or whose look did.
type Roots = (
    Option<Ref<'static, ArapSolver>>,
    Option<Ref<'static, FieldSprite>>,
    Option<Ref<'static, PictureSprite>>,
    &'static StageStyle,
    &'static Children,
);

/// A frame of any content moved, or its look did.
type AnyMoved = Or<(Moved<ArapSolver>, Moved<FieldSprite>, Moved<PictureSprite>)>;

/// Writes the grids that show warps, of whatever is seen.
pub(super) fn draw_grids(
    roots: Query<Roots, AnyMoved>,
    mut parts: Query<(&mut Part, &Mesh2d, &MeshMaterial2d<GridMaterial>)>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut grids: ResMut<Assets<GridMaterial>>,
) {
    for (solid, field, picture, style, children) in &roots {
        let moved = [
            solid.as_ref().map(DetectChanges::is_changed),
            field.as_ref().map(DetectChanges::is_changed),
            picture.as_ref().map(DetectChanges::is_changed),
        ];
        let frame = (solid.as_deref().map(ArapSolver::frame))
            .or(field.as_deref().map(FieldSprite::frame))
            .or(picture.as_deref().map(PictureSprite::frame));
        let Some(frame) = frame else { continue };
        let mut parts = parts.iter_many_mut(children);
        while let Some((mut part, mesh, grid)) = parts.fetch_next() {
            part.stale |= moved.contains(&Some(true));
            if !style.show.grid {
                continue;
            }
            if part.stale
                && let Some(mut mesh) = meshes.get_mut(mesh)
            {
                carried::write(frame, part.origin, Lookups::OfPlane, &mut mesh);
                part.stale = false;
            }
            let look = GridLook::new(frame, part.origin, style);
            if grids.get(grid).is_some_and(|old| old.look != look)
                && let Some(mut material) = grids.get_mut(grid)
            {
                material.look = look;
            }
        }
    }
}

/// Writes where a warp has put the vertices of a field or a picture. Where
/// nothing moves that is done once.
fn carry(part: &mut Part, moved: bool, frame: &Frame, meshes: &mut Assets<Mesh>, mesh: &Mesh2d) {
    if !matches!(part.kind, PartKind::Field | PartKind::Picture) {
        return;
    }
    part.stale |= moved && frame.transition().cell().warp() != WarpKind::None;
    if part.stale
        && let Some(mut mesh) = meshes.get_mut(mesh)
    {
        carried::write(frame, part.origin, Lookups::OfContent, &mut mesh);
        part.stale = false;
    }
}

fn visible(shown: bool) -> Visibility {
    if shown {
        Visibility::Inherited
    } else {
        Visibility::Hidden
    }
}

fn set_colour(inks: &mut Assets<InkMaterial>, ink: &MeshMaterial2d<InkMaterial>, colour: Rgb) {
    let colour = linear(colour);
    if inks.get(ink).is_some_and(|old| old.colour != colour)
        && let Some(mut material) = inks.get_mut(ink)
    {
        material.colour = colour;
    }
}

/// Lets `write` change the mesh's positions; `false` if there are none.
fn rewrite(meshes: &mut Assets<Mesh>, mesh: &Mesh2d, write: impl FnOnce(&mut Positions)) -> bool {
    let Some(mut mesh) = meshes.get_mut(mesh) else {
        return false;
    };
    match mesh.attribute_mut(Mesh::ATTRIBUTE_POSITION) {
        Some(VertexAttributeValues::Float32x3(positions)) => {
            write(positions);
            true
        }
        _ => false,
    }
}

impl PartKind {
    fn is_shown(&self, StageStyle { style, show }: &StageStyle) -> bool {
        match self {
            Self::Faces | Self::Rings | Self::Picture => show.fill,
            Self::Field => show.fill || show.iso_lines || show.signed_colours,
            Self::Bars(_) => show.bars,
            Self::JointCores(_) => show.bars && style.joints,
            Self::Wire { .. } => show.wireframe,
            Self::Grid => show.grid,
            Self::SourceGhost | Self::TargetGhost => show.ghosts,
        }
    }

    fn colour(&self, t: f64, StageStyle { style, show }: &StageStyle) -> Rgb {
        match self {
            Self::JointCores(_) => joint_core(style.fill_at(t)),
            Self::SourceGhost => style.source,
            Self::TargetGhost => style.target,
            // Wires are cut into the fill where there is one.
            Self::Wire { on_faces: true } if show.fill => style.ground,
            _ => style.fill_at(t),
        }
    }

    fn write(
        &self,
        frame: &Frame,
        style: &StageStyle,
        origin: glam::DVec2,
        positions: &mut Positions,
    ) {
        let placement = frame.placement();
        let points = &placement.in_frame;
        match self {
            Self::Faces => write_points(points, origin, positions),
            Self::Wire { .. } => write_corners(points, &placement.faces, origin, positions),
            Self::Bars(bars) => bars.write(points, style.style.joints, origin, positions),
            Self::JointCores(bars) => bars.write_cores(points, origin, positions),
            Self::Rings
            | Self::Field
            | Self::Picture
            | Self::Grid
            | Self::SourceGhost
            | Self::TargetGhost => {}
        }
    }
}

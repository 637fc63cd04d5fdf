//! The render entities below an entity on the stage: faces or field, bars,
//! joints, wires and ghosts.
//!
//! Guarantees: an entity has parts of one transition only, however quickly
//! transitions are replaced; when its solver or sprite is removed, its parts go.

use bevy::camera::visibility::NoFrustumCulling;
use bevy::ecs::system::SystemParam;
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;
use glam::DVec2;

use crate::content::{Content, FieldPair, PicturePair, Solid};
use crate::transition::{Figure, Frame};

use super::colours::{ColourLook, ColourMaterial};
use super::components::{ArapSolver, FieldSprite, PictureSprite, StageStyle};
use super::field::{FieldLook, FieldMaterial};
use super::fill;
use super::grid::{GridLook, GridMaterial};
use super::ink::{InkKind, InkMaterial};
use super::shapes::{BarShapes, Segments, corner_coordinates, quad_indices};
use super::view::StageView;

/// Marks an entity whose transition is new and has no parts yet.
#[derive(Component)]
pub(super) struct Undressed;

/// A render entity of a transition.
#[derive(Component, Debug)]
pub(super) struct Part {
    pub(super) kind: PartKind,
    /// The point of the plane that the vertices are relative to.
    pub(super) origin: DVec2,
    /// The vertices are not those of the frame: they have not been written
    /// since the frame moved.
    pub(super) stale: bool,
}

/// What a part shows.
#[derive(Clone, Debug)]
pub(super) enum PartKind {
    Faces,
    /// Boundaries that bring no faces.
    Rings,
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
    /// Its vertices never move.
    pub(super) fn is_still(&self) -> bool {
        matches!(self, Self::SourceGhost | Self::TargetGhost)
    }

    /// What is drawn over what.
    fn layer(&self) -> f32 {
        match self {
            Self::Faces | Self::Rings | Self::Field | Self::Picture => 0.0,
            Self::Bars(_) => 0.1,
            Self::JointCores(_) => 0.2,
            Self::Wire { .. } => 0.3,
            Self::Grid => 0.35,
            Self::SourceGhost => 0.4,
            Self::TargetGhost => 0.5,
        }
    }

    fn ink(&self) -> InkKind {
        match self {
            Self::Faces | Self::Rings | Self::Field | Self::Picture | Self::Grid => InkKind::Faces,
            Self::Bars(_) | Self::JointCores(_) => InkKind::Round,
            Self::Wire { .. } => InkKind::Wire,
            Self::SourceGhost | Self::TargetGhost => InkKind::Line,
        }
    }
}

/// Vertices and faces of a render mesh that is yet to be made.
#[derive(Default)]
struct Shape {
    positions: Vec<[f32; 3]>,
    offsets: Option<Vec<[f32; 3]>>,
    coordinates: Option<Vec<[f32; 2]>>,
    lookups: Option<Vec<[f32; 4]>>,
    indices: Option<Vec<u32>>,
}

impl Shape {
    fn quads(positions: Vec<[f32; 3]>, coordinates: Vec<[f32; 2]>) -> Self {
        Self {
            indices: Some(quad_indices(positions.len() / 4)),
            positions,
            coordinates: Some(coordinates),
            ..default()
        }
    }

    /// The faces of a placement, with room for where each vertex looks.
    fn carried(frame: &Frame) -> Self {
        let placement = frame.placement();
        let count = placement.in_frame.len();
        Self {
            positions: vec![[0.0; 3]; count],
            coordinates: Some(vec![[0.0; 2]; count]),
            lookups: Some(vec![[0.0; 4]; count]),
            indices: Some(placement.faces.as_flattened().to_vec()),
            ..default()
        }
    }

    /// The mesh stays in main memory too, to be rewritten.
    fn mesh(self) -> Mesh {
        let mut mesh = Mesh::new(PrimitiveTopology::TriangleList, default());
        mesh.insert_attribute(Mesh::ATTRIBUTE_POSITION, self.positions);
        if let Some(offsets) = self.offsets {
            mesh.insert_attribute(Mesh::ATTRIBUTE_NORMAL, offsets);
        }
        if let Some(coordinates) = self.coordinates {
            mesh.insert_attribute(Mesh::ATTRIBUTE_UV_0, coordinates);
        }
        if let Some(lookups) = self.lookups {
            mesh.insert_attribute(Mesh::ATTRIBUTE_COLOR, lookups);
        }
        if let Some(indices) = self.indices {
            mesh.insert_indices(Indices::U32(indices));
        }
        mesh
    }
}

/// Everything that parts are made with.
#[derive(SystemParam)]
pub(super) struct Wardrobe<'w, 's> {
    commands: Commands<'w, 's>,
    meshes: ResMut<'w, Assets<Mesh>>,
    images: ResMut<'w, Assets<Image>>,
    inks: ResMut<'w, Assets<InkMaterial>>,
    fields: ResMut<'w, Assets<FieldMaterial>>,
    colours: ResMut<'w, Assets<ColourMaterial>>,
    grids: ResMut<'w, Assets<GridMaterial>>,
    parts: Query<'w, 's, (), With<Part>>,
}

impl Wardrobe<'_, '_> {
    fn undress(&mut self, children: Option<&Children>) {
        for &child in children.into_iter().flatten() {
            if self.parts.contains(child) {
                self.commands.entity(child).try_despawn();
            }
        }
    }

    fn add(&mut self, of: Entity, kind: PartKind, origin: DVec2, shape: Shape) -> Entity {
        let mesh = Mesh2d(self.meshes.add(shape.mesh()));
        let transform = Transform::from_xyz(0.0, 0.0, kind.layer());
        let part = Part {
            stale: !kind.is_still(),
            kind,
            origin,
        };
        let part = (part, mesh, transform, Visibility::Hidden, NoFrustumCulling);
        self.commands.spawn((part, ChildOf(of))).id()
    }

    fn add_inked(&mut self, of: Entity, kind: PartKind, origin: DVec2, shape: Shape) {
        let material = self.inks.add(InkMaterial {
            colour: LinearRgba::NONE,
            kind: kind.ink(),
        });
        let part = self.add(of, kind, origin, shape);
        self.commands.entity(part).insert(MeshMaterial2d(material));
    }

    fn add_solid(&mut self, of: Entity, frame: &Frame, solid: &Solid, origin: DVec2) {
        let placement = frame.placement();
        let faces = &*placement.faces;
        if !solid.loops.is_empty() && faces.is_empty() {
            let (positions, indices) = fill::nothing();
            let shape = Shape {
                positions,
                indices: Some(indices),
                ..default()
            };
            self.add_inked(of, PartKind::Rings, origin, shape);
        } else if !solid.loops.is_empty() {
            let shape = Shape {
                positions: vec![[0.0; 3]; placement.in_frame.len()],
                indices: Some(faces.as_flattened().to_vec()),
                ..default()
            };
            self.add_inked(of, PartKind::Faces, origin, shape);
        }
        if !solid.bars.is_empty() {
            self.add_bars(of, BarShapes::new(solid), origin);
        }
        if !faces.is_empty() {
            let shape = Shape {
                positions: vec![[0.0; 3]; 3 * faces.len()],
                coordinates: Some(corner_coordinates(faces.len())),
                ..default()
            };
            let on_faces = !solid.loops.is_empty();
            self.add_inked(of, PartKind::Wire { on_faces }, origin, shape);
        }
    }

    fn add_bars(&mut self, of: Entity, bars: BarShapes, origin: DVec2) {
        let positions = |quads: usize| vec![[0.0; 3]; 4 * quads];
        let shape = Shape::quads(positions(bars.quads()), bars.coordinates());
        let cores = Shape::quads(positions(bars.core_quads()), bars.core_coordinates());
        self.add_inked(of, PartKind::Bars(bars.clone()), origin, shape);
        self.add_inked(of, PartKind::JointCores(bars), origin, cores);
    }

    fn add_field(
        &mut self,
        of: Entity,
        frame: &Frame,
        pair: &FieldPair,
        origin: DVec2,
        style: &StageStyle,
    ) {
        let shape = Shape::carried(frame);
        let look = FieldLook::new(pair, frame.t(), style);
        let material = FieldMaterial::new(pair, look, &mut self.images);
        let material = self.fields.add(material);
        let part = self.add(of, PartKind::Field, origin, shape);
        self.commands.entity(part).insert(MeshMaterial2d(material));
    }

    fn add_picture(&mut self, of: Entity, frame: &Frame, pair: &PicturePair, origin: DVec2) {
        let shape = Shape::carried(frame);
        let look = ColourLook::new(pair, frame.t(), origin, true);
        let material = ColourMaterial::new(pair, look, &mut self.images);
        let material = self.colours.add(material);
        let part = self.add(of, PartKind::Picture, origin, shape);
        self.commands.entity(part).insert(MeshMaterial2d(material));
    }

    fn add_grid(&mut self, of: Entity, frame: &Frame, origin: DVec2, style: &StageStyle) {
        if frame.placement().faces.is_empty() {
            return;
        }
        let look = GridLook::new(frame, origin, style);
        let material = self.grids.add(GridMaterial { look });
        let part = self.add(of, PartKind::Grid, origin, Shape::carried(frame));
        self.commands.entity(part).insert(MeshMaterial2d(material));
    }

    fn add_ghost(&mut self, of: Entity, kind: PartKind, figure: &Figure, origin: DVec2) {
        let segments = Segments::of(figure, origin);
        if segments.quads() == 0 {
            return;
        }
        let shape = Shape {
            indices: Some(quad_indices(segments.quads())),
            positions: segments.positions,
            offsets: Some(segments.offsets),
            ..default()
        };
        self.add_inked(of, kind, origin, shape);
    }
}

/// An entity, what is to be shown of it, how, and the parts it has.
type Staged = (
    Entity,
    Option<&'static ArapSolver>,
    Option<&'static FieldSprite>,
    Option<&'static PictureSprite>,
    &'static StageStyle,
    Option<&'static Children>,
);

/// Gives new transitions their parts.
pub(super) fn dress(undressed: Query<Staged, With<Undressed>>, mut wardrobe: Wardrobe) {
    for (entity, solver, sprite, picture, style, children) in &undressed {
        wardrobe.undress(children);
        wardrobe.commands.entity(entity).remove::<Undressed>();
        let frame = solver.map(ArapSolver::frame);
        let frame = frame.or(sprite.map(FieldSprite::frame));
        let Some(frame) = frame.or(picture.map(PictureSprite::frame)) else {
            continue;
        };
        let transition = frame.transition();
        let origin = transition.bounds().centre();
        match transition.content() {
            Content::Solid(solid) => wardrobe.add_solid(entity, frame, solid, origin),
            Content::Field(pair) => wardrobe.add_field(entity, frame, pair, origin, style),
            Content::Colours(pair) => wardrobe.add_picture(entity, frame, pair, origin),
        }
        wardrobe.add_grid(entity, frame, origin, style);
        let ghosts = [
            (PartKind::SourceGhost, transition.source_outline()),
            (PartKind::TargetGhost, transition.target_outline()),
        ];
        for (kind, figure) in ghosts {
            wardrobe.add_ghost(entity, kind, &figure, origin);
        }
    }
}

/// Takes the parts away with the solver or sprite that they showed.
pub(super) fn undress<C: Component>(
    removed: On<Remove, C>,
    children: Query<&Children>,
    mut wardrobe: Wardrobe,
) {
    wardrobe.undress(children.get(removed.entity).ok());
}

/// Puts parts where they are in Bevy's world.
pub(super) fn place_parts(view: Res<StageView>, mut parts: Query<(&Part, &mut Transform)>) {
    for (part, mut transform) in &mut parts {
        let at = (part.origin - view.anchor()).as_vec2();
        let translation = at.extend(part.kind.layer());
        if transform.translation != translation {
            transform.translation = translation;
        }
    }
}

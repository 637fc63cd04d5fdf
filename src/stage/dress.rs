//! How a transition gets its parts, and loses them.
//!
//! Guarantees: an entity has parts of one transition only, however quickly
//! transitions are replaced; when its [`Morph`] is removed, its parts go.

use bevy::camera::visibility::NoFrustumCulling;
use bevy::ecs::system::SystemParam;
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;
use bevy::sprite_render::Material2d;
use glam::DVec2;

use crate::content::{Content, Solid};
use crate::transition::{Figure, Frame};

use super::colours::{ColourLook, ColourMaterial};
use super::components::{Morph, StageStyle};
use super::field::{FieldLook, FieldMaterial};
use super::fill;
use super::grid::{GridLook, GridMaterial};
use super::ink::InkMaterial;
use super::paint::{Paint, Paints};
use super::parts::{Part, PartKind};
use super::shapes::{BarShapes, Segments, corner_coordinates, quad_indices};

/// Marks an entity whose transition is new and has no parts yet.
#[derive(Component)]
pub(super) struct Undressed;

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
    fn quads(coordinates: Vec<[f32; 2]>) -> Self {
        Self {
            indices: Some(quad_indices(coordinates.len() / 4)),
            positions: vec![[0.0; 3]; coordinates.len()],
            coordinates: Some(coordinates),
            ..default()
        }
    }

    /// The faces of a placement.
    fn faces(frame: &Frame) -> Self {
        let placement = frame.placement();
        Self {
            positions: vec![[0.0; 3]; placement.in_frame.len()],
            indices: Some(placement.faces.as_flattened().to_vec()),
            ..default()
        }
    }

    /// The same, with room for where each vertex looks.
    fn carried(frame: &Frame) -> Self {
        let count = frame.placement().in_frame.len();
        Self {
            coordinates: Some(vec![[0.0; 2]; count]),
            lookups: Some(vec![[0.0; 4]; count]),
            ..Self::faces(frame)
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
    paints: Paints<'w>,
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

    fn dress(&mut self, of: Entity, frame: &Frame, style: &StageStyle) {
        let transition = frame.transition();
        let origin = transition.bounds().centre();
        let mut fitting = Fitting {
            wardrobe: self,
            of,
            frame,
            origin,
        };
        match transition.content() {
            Content::Solid(solid) => fitting.add_solid(solid),
            Content::Field(pair) => {
                let look = FieldLook::new(pair, frame.t(), style);
                let paints = &mut fitting.wardrobe.paints;
                let material = FieldMaterial::new(pair, look, &mut paints.images);
                let material = paints.fields.add(material);
                fitting.add(
                    PartKind::Field,
                    Shape::carried(frame),
                    material,
                    Paint::Field,
                );
            }
            Content::Colours(pair) => {
                let look = ColourLook::new(pair, frame.t(), origin);
                let paints = &mut fitting.wardrobe.paints;
                let material = ColourMaterial::new(pair, look, &mut paints.images);
                let material = paints.colours.add(material);
                let shape = Shape::carried(frame);
                fitting.add(PartKind::Picture, shape, material, Paint::Picture);
            }
        }
        if !frame.placement().faces.is_empty() {
            let look = GridLook::new(frame, origin, style);
            let material = fitting.wardrobe.paints.grids.add(GridMaterial { look });
            fitting.add(PartKind::Grid, Shape::carried(frame), material, Paint::Grid);
        }
        let [source, target] = transition.outlines();
        fitting.add_ghost(PartKind::SourceGhost, &source);
        fitting.add_ghost(PartKind::TargetGhost, &target);
    }
}

/// One transition that is being dressed.
struct Fitting<'a, 'w, 's> {
    wardrobe: &'a mut Wardrobe<'w, 's>,
    of: Entity,
    frame: &'a Frame,
    origin: DVec2,
}

impl Fitting<'_, '_, '_> {
    fn add<M: Material2d>(
        &mut self,
        kind: PartKind,
        shape: Shape,
        material: Handle<M>,
        paint: fn(Handle<M>) -> Paint,
    ) {
        let mesh = Mesh2d(self.wardrobe.paints.meshes.add(shape.mesh()));
        let transform = Transform::from_xyz(0.0, 0.0, kind.layer());
        let part = Part {
            stale: !kind.is_still(),
            kind,
            paint: paint(material.clone()),
            origin: self.origin,
        };
        let drawn = (mesh, MeshMaterial2d(material), transform);
        let hidden = (Visibility::Hidden, NoFrustumCulling);
        let parent = ChildOf(self.of);
        self.wardrobe.commands.spawn((part, drawn, hidden, parent));
    }

    fn add_inked(&mut self, kind: PartKind, shape: Shape) {
        let material = self.wardrobe.paints.inks.add(InkMaterial {
            colour: LinearRgba::NONE,
            kind: kind.ink(),
        });
        self.add(kind, shape, material, Paint::Ink);
    }

    fn add_solid(&mut self, solid: &Solid) {
        let faces = self.frame.placement().faces.len();
        let has_loops = !solid.loops.is_empty();
        if has_loops && faces == 0 {
            let (positions, indices) = fill::nothing();
            let shape = Shape {
                positions,
                indices: Some(indices),
                ..default()
            };
            self.add_inked(PartKind::Rings, shape);
        } else if has_loops {
            self.add_inked(PartKind::Faces, Shape::faces(self.frame));
        }
        if !solid.bars.is_empty() {
            let bars = BarShapes::new(solid);
            let cores = Shape::quads(bars.core_coordinates());
            self.add_inked(
                PartKind::Bars(bars.clone()),
                Shape::quads(bars.coordinates()),
            );
            self.add_inked(PartKind::JointCores(bars), cores);
        }
        if faces > 0 {
            let shape = Shape {
                positions: vec![[0.0; 3]; 3 * faces],
                coordinates: Some(corner_coordinates(faces)),
                ..default()
            };
            let on_faces = has_loops;
            self.add_inked(PartKind::Wire { on_faces }, shape);
        }
    }

    fn add_ghost(&mut self, kind: PartKind, figure: &Figure) {
        let segments = Segments::of(figure, self.origin);
        if segments.quads() == 0 {
            return;
        }
        let shape = Shape {
            indices: Some(quad_indices(segments.quads())),
            positions: segments.positions,
            offsets: Some(segments.offsets),
            ..default()
        };
        self.add_inked(kind, shape);
    }
}

/// An entity, what is to be shown of it, how, and the parts it has.
type Staged = (
    Entity,
    &'static Morph,
    &'static StageStyle,
    Option<&'static Children>,
);

/// Gives new transitions their parts.
pub(super) fn dress(undressed: Query<Staged, With<Undressed>>, mut wardrobe: Wardrobe) {
    for (entity, morph, style, children) in &undressed {
        wardrobe.undress(children);
        wardrobe.commands.entity(entity).remove::<Undressed>();
        wardrobe.dress(entity, morph.frame(), style);
    }
}

/// Takes the parts away with the frame that they showed.
pub(super) fn undress(
    removed: On<Remove, Morph>,
    children: Query<&Children>,
    mut wardrobe: Wardrobe,
) {
    wardrobe.undress(children.get(removed.entity).ok());
}

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

use crate::content::{Content, SolidContent};
use crate::transition::{Frame, VectorFigure};

use super::components::Morph;
use super::field_material::FieldMaterial;
use super::gradients::GradientTextures;
use super::ink_material::InkMaterial;
use super::paint::{StagePaint, StagePaints};
use super::paint_layers::LayerMesh;
use super::parts::{MissingParts, PartKind, StagePart};
use super::picture_material::ColourMaterial;
use super::recorded_material::{PlayedMaterial, RecordedSum, VERTEX};
use super::recording_upload::CardRecording;
use super::ring_fill;
use super::uploaded_recording::UploadState;
use super::vertices::{BarShapes, OutlineSegments, corner_coordinates, quad_indices};
use super::warp_grid::GridMaterial;

/// Marks an entity whose transition is new and has no parts yet.
#[derive(Component)]
pub(super) struct WithoutParts;

/// A render mesh of triangles.
fn mesh(positions: Vec<[f32; 3]>) -> Mesh {
    // The default usage keeps it in main memory too, to be rewritten.
    Mesh::new(PrimitiveTopology::TriangleList, default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
}

/// One that is yet to be written, with texture coordinates that stay.
fn unplaced(coordinates: Vec<[f32; 2]>) -> Mesh {
    mesh(vec![[0.0; 3]; coordinates.len()])
        .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, coordinates)
}

fn quads(coordinates: Vec<[f32; 2]>) -> Mesh {
    let indices = quad_indices(coordinates.len() / 4);
    unplaced(coordinates).with_inserted_indices(Indices::U32(indices))
}

/// Rings: how many vertices they will need is not known before a frame is filled.
fn nothing() -> Mesh {
    let (positions, indices) = ring_fill::nothing();
    mesh(positions).with_inserted_indices(Indices::U32(indices))
}

/// The faces of a placement.
fn faces(frame: &Frame) -> Mesh {
    let placement = frame.placement();
    let indices = placement.faces.as_flattened().to_vec();
    mesh(vec![[0.0; 3]; placement.in_frame.len()]).with_inserted_indices(Indices::U32(indices))
}

/// The same, with room for where each vertex looks.
fn carried(frame: &Frame) -> Mesh {
    let count = frame.placement().in_frame.len();
    faces(frame)
        .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, vec![[0.0; 2]; count])
        .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, vec![[0.0; 4]; count])
}

/// The corners of faces, each for itself.
fn corners(frame: &Frame) -> Mesh {
    unplaced(corner_coordinates(frame.placement().faces.len()))
}

/// The outlines of a figure.
fn lines(figure: &VectorFigure, origin: DVec2) -> Mesh {
    let mut segments = OutlineSegments::of(figure, origin);
    if segments.quads() == 0 {
        // An empty mesh would not be taken by the GPU.
        segments.push_nothing();
    }
    let indices = Indices::U32(quad_indices(segments.quads()));
    mesh(segments.positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, segments.offsets)
        .with_inserted_indices(indices)
}

/// Faces whose vertices know which they are.
fn numbered_faces(frame: &Frame) -> Mesh {
    let numbers: Vec<u32> = (0..frame.placement().in_frame.len() as u32).collect();
    faces(frame).with_inserted_attribute(VERTEX, numbers)
}

fn numbered_corners(frame: &Frame) -> Mesh {
    let numbers = frame.placement().faces.as_flattened().to_vec();
    corners(frame).with_inserted_attribute(VERTEX, numbers)
}

/// Everything that parts are made with.
#[derive(SystemParam)]
pub(super) struct PartAssets<'w, 's> {
    commands: Commands<'w, 's>,
    paints: StagePaints<'w>,
    parts: Query<'w, 's, (), With<StagePart>>,
    card: Option<Res<'w, CardRecording>>,
}

impl PartAssets<'_, '_> {
    fn undress(&mut self, children: Option<&Children>) {
        for &child in children.into_iter().flatten() {
            // A program may have hung children of its own below the entity.
            if self.parts.contains(child) {
                self.commands.entity(child).try_despawn();
            }
        }
    }

    fn dress(&mut self, of: Entity, frame: &Frame) {
        let transition = frame.transition();
        // In the midst of the vertices, where single precision is finest.
        let origin = transition.bounds().centre();
        let mut fitting = PartFactory {
            wardrobe: self,
            of,
            frame,
            origin,
        };
        match transition.content() {
            Content::Solid(solid) => fitting.add_solid(solid),
            Content::Field(fields) => {
                if fields.painted().is_some() {
                    fitting.add_coats(LayerMesh::of_fields());
                }
                let paints = &mut fitting.wardrobe.paints;
                let material = FieldMaterial::new(fields.pairs(), &mut paints.images);
                let material = paints.fields.add(material);
                fitting.add(PartKind::Field, carried, material, StagePaint::Field);
            }
            Content::Colours(pair) => {
                let paints = &mut fitting.wardrobe.paints;
                let material = ColourMaterial::new(pair, &mut paints.images);
                let material = paints.colours.add(material);
                fitting.add(PartKind::Picture, carried, material, StagePaint::Picture);
            }
        }
        if !frame.placement().faces.is_empty() {
            let grids = &mut fitting.wardrobe.paints.grids;
            let material = grids.add(GridMaterial::default());
            fitting.add(PartKind::Grid, carried, material, StagePaint::Grid);
        }
        let [source, target] = [0, 1]
            .map(|end| move |frame: &Frame| lines(&frame.transition().outlines()[end], origin));
        fitting.add_inked(PartKind::SourceGhost, source);
        fitting.add_inked(PartKind::TargetGhost, target);
    }
}

/// One transition that is being dressed.
struct PartFactory<'a, 'w, 's> {
    wardrobe: &'a mut PartAssets<'w, 's>,
    of: Entity,
    frame: &'a Frame,
    origin: DVec2,
}

impl PartFactory<'_, '_, '_> {
    fn add<M: Material2d>(
        &mut self,
        kind: PartKind,
        mesh: impl FnOnce(&Frame) -> Mesh + Send + Sync + 'static,
        material: Handle<M>,
        paint: fn(Handle<M>) -> StagePaint,
    ) {
        // What is never shown takes no memory.
        let place = self.wardrobe.paints.meshes.reserve_handle();
        let part = StagePart {
            kind,
            paint: paint(material.clone()),
            origin: self.origin,
            unmade: Some(MissingParts(Box::new(mesh))),
            stale: true,
        };
        let mesh = Mesh2d(place);
        // A box to cull by would be measured again after each write, and would
        // not know how far the shader widens lines.
        let drawn = (mesh, MeshMaterial2d(material), NoFrustumCulling);
        let hidden = Visibility::Hidden;
        let parent = ChildOf(self.of);
        self.wardrobe.commands.spawn((part, drawn, hidden, parent));
    }

    /// Faces or wires: played from the graphics card, where there is one.
    fn add_triangles(&mut self, kind: PartKind, mesh: [fn(&Frame) -> Mesh; 2]) {
        let [plain, numbered] = mesh;
        let Some(card) = &self.wardrobe.card else {
            return self.add_inked(kind, plain);
        };
        let material = self.wardrobe.paints.played.add(PlayedMaterial {
            colour: LinearRgba::NONE,
            sum: RecordedSum::default(),
            reel: card.nothing().clone(),
            kind: kind.ink(),
        });
        self.add(kind, numbered, material, StagePaint::Played);
    }

    fn add_inked(
        &mut self,
        kind: PartKind,
        mesh: impl FnOnce(&Frame) -> Mesh + Send + Sync + 'static,
    ) {
        let material = self.wardrobe.paints.inks.add(InkMaterial {
            colour: LinearRgba::NONE,
            gradients: GradientTextures::default(),
            kind: kind.ink(),
        });
        self.add(kind, mesh, material, StagePaint::Ink);
    }

    fn add_coats(&mut self, coats: LayerMesh) {
        let mesh = match coats.has_faces() {
            true => faces(self.frame),
            false => nothing(),
        };
        let count = mesh.count_vertices();
        let mesh = mesh
            .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, vec![[0.0_f32; 4]; count])
            .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, vec![[0.0_f32; 2]; count]);
        self.add_inked(PartKind::Coats(coats), |_| mesh);
    }

    fn add_solid(&mut self, solid: &SolidContent) {
        let count = self.frame.placement().faces.len();
        let has_loops = !solid.loops.is_empty();
        // Faces know nothing of that.
        let comes_and_goes = !solid.holes.is_empty() || !solid.swells.is_empty();
        if let Some(coating) = &solid.coating {
            self.add_coats(LayerMesh::of_solid(self.frame, solid, coating));
        } else if has_loops && (count == 0 || comes_and_goes) {
            self.add_inked(PartKind::Rings, |_| nothing());
        } else if has_loops {
            self.add_triangles(PartKind::Faces, [faces, numbered_faces]);
        }
        for bars in BarShapes::all(solid) {
            let (shapes, cores) = (quads(bars.coordinates()), quads(bars.core_coordinates()));
            self.add_inked(PartKind::Bars(bars.clone()), |_| shapes);
            self.add_inked(PartKind::JointCores(bars), |_| cores);
        }
        if count > 0 {
            // A truss has panels but no loops: its wires lie on the ground.
            let wire = PartKind::Wire {
                on_faces: has_loops,
            };
            self.add_triangles(wire, [corners, numbered_corners]);
        }
    }
}

/// Gives new transitions their parts; how they look is for drawing to say.
pub(super) fn dress(
    undressed: Query<(Entity, &Morph, Option<&Children>), With<WithoutParts>>,
    mut wardrobe: PartAssets,
) {
    for (entity, morph, children) in &undressed {
        // Of an earlier transition, where this one replaces it.
        wardrobe.undress(children);
        let mut commands = wardrobe.commands.entity(entity);
        commands.remove::<(WithoutParts, UploadState)>();
        wardrobe.dress(entity, morph.frame());
    }
}

/// Takes the parts away with the frame that they showed.
pub(super) fn undress(
    removed: On<Remove, Morph>,
    children: Query<&Children>,
    mut wardrobe: PartAssets,
) {
    wardrobe.undress(children.get(removed.entity).ok());
    wardrobe
        .commands
        .entity(removed.entity)
        .try_remove::<UploadState>();
}

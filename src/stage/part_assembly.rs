//! Spawns the render parts of new transitions, and despawns those of removed transitions.
//!
//! Guaranteed: an entity has render parts of one transition only, however quickly transitions are
//! replaced; when its [`Morph`] is removed, its render parts are despawned.

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
use super::gradients::GradientUniform;
use super::ink_material::InkMaterial;
use super::paint::{StagePaint, StagePaints};
use super::paint_layers::LayerMesh;
use super::parts::{DeferredMesh, PartKind, StagePart};
use super::picture_material::PictureMaterial;
use super::recorded_material::{RecordedMaterial, RecordedSum, VERTEX_INDEX};
use super::recording_upload::RecordingGpu;
use super::ring_fill;
use super::uploaded_recording::UploadState;
use super::vertices::{BarShapes, OutlineSegments, corner_coordinates, quad_indices};
use super::warp_grid::GridMaterial;

/// Marks an entity whose transition is new and whose render parts have not been spawned yet.
#[derive(Component)]
pub(super) struct WithoutParts;

/// Returns a triangle mesh with the given vertex positions.
fn mesh(positions: Vec<[f32; 3]>) -> Mesh {
    // The default usage keeps a copy of the mesh in main memory, which later frames rewrite.
    Mesh::new(PrimitiveTopology::TriangleList, default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
}

/// Returns a mesh with the given texture coordinates, whose positions are written later.
fn unwritten_mesh(coordinates: Vec<[f32; 2]>) -> Mesh {
    mesh(vec![[0.0; 3]; coordinates.len()])
        .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, coordinates)
}

/// Returns a mesh of quads of four vertices each, with the given texture coordinates, whose
/// positions are written later.
fn quads(coordinates: Vec<[f32; 2]>) -> Mesh {
    let indices = quad_indices(coordinates.len() / 4);
    unwritten_mesh(coordinates).with_inserted_indices(Indices::U32(indices))
}

/// Returns a mesh that shows nothing. It is a placeholder for filled boundary loops, whose number
/// of vertices is known only after they are triangulated.
fn nothing() -> Mesh {
    let (positions, indices) = ring_fill::degenerate_triangle();
    mesh(positions).with_inserted_indices(Indices::U32(indices))
}

/// Returns a mesh with the faces and vertices of the placement; faces share vertices.
fn faces(frame: &Frame) -> Mesh {
    let placement = frame.placement();
    let indices = placement.faces.as_flattened().to_vec();
    mesh(vec![[0.0; 3]; placement.in_frame.len()]).with_inserted_indices(Indices::U32(indices))
}

/// Returns a mesh with the faces of the placement and with attributes for the positions at which
/// the shader looks up source and target.
fn carried(frame: &Frame) -> Mesh {
    let count = frame.placement().in_frame.len();
    faces(frame)
        .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, vec![[0.0; 2]; count])
        .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, vec![[0.0; 4]; count])
}

/// Returns a mesh for wireframes with the faces of the placement; faces do not share vertices.
fn corners(frame: &Frame) -> Mesh {
    unwritten_mesh(corner_coordinates(frame.placement().faces.len()))
}

/// Returns a mesh of the outlines of a figure, as lines of constant width on the screen.
fn lines(figure: &VectorFigure, origin: DVec2) -> Mesh {
    let mut segments = OutlineSegments::of(figure, origin);
    if segments.quads() == 0 {
        // The GPU does not accept an empty mesh.
        segments.push_nothing();
    }
    let indices = Indices::U32(quad_indices(segments.quads()));
    mesh(segments.positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, segments.offsets)
        .with_inserted_indices(indices)
}

/// Returns a mesh like [`faces`], in which each vertex also stores its index in the placement.
fn numbered_faces(frame: &Frame) -> Mesh {
    let numbers: Vec<u32> = (0..frame.placement().in_frame.len() as u32).collect();
    faces(frame).with_inserted_attribute(VERTEX_INDEX, numbers)
}

/// Returns a mesh like [`corners`], in which each vertex also stores its index in the placement.
fn numbered_corners(frame: &Frame) -> Mesh {
    let numbers = frame.placement().faces.as_flattened().to_vec();
    corners(frame).with_inserted_attribute(VERTEX_INDEX, numbers)
}

/// Commands and resources needed to spawn and despawn render parts.
#[derive(SystemParam)]
pub(super) struct PartAssets<'w, 's> {
    commands: Commands<'w, 's>,
    paints: StagePaints<'w>,
    parts: Query<'w, 's, (), With<StagePart>>,
    gpu: Option<Res<'w, RecordingGpu>>,
}

impl PartAssets<'_, '_> {
    /// Despawns those of the given children that are render parts.
    fn remove_parts(&mut self, children: Option<&Children>) {
        for &child in children.into_iter().flatten() {
            // The program may have added other children to the entity.
            if self.parts.contains(child) {
                self.commands.entity(child).try_despawn();
            }
        }
    }

    /// Spawns all render parts of a frame's transition as children of `entity`.
    fn add_parts(&mut self, entity: Entity, frame: &Frame) {
        let transition = frame.transition();
        // Vertices are stored relative to the centre, where single precision is finest.
        let origin = transition.bounds().centre();
        let mut factory = PartFactory {
            assets: self,
            entity,
            frame,
            origin,
        };
        match transition.content() {
            Content::Solid(solid) => factory.add_solid(solid),
            Content::Field(fields) => {
                if fields.painted_fields().is_some() {
                    factory.add_paint_layers(LayerMesh::of_fields());
                }
                let paints = &mut factory.assets.paints;
                let material = FieldMaterial::new(fields.pairs(), &mut paints.images);
                let material = paints.fields.add(material);
                factory.add(PartKind::Field, carried, material, StagePaint::Field);
            }
            Content::Colours(pair) => {
                let paints = &mut factory.assets.paints;
                let material = PictureMaterial::new(pair, &mut paints.images);
                let material = paints.colours.add(material);
                factory.add(PartKind::Picture, carried, material, StagePaint::Picture);
            }
        }
        if !frame.placement().faces.is_empty() {
            let grids = &mut factory.assets.paints.grids;
            let material = grids.add(GridMaterial::default());
            factory.add(PartKind::Grid, carried, material, StagePaint::Grid);
        }
        let [source, target] = [0, 1]
            .map(|end| move |frame: &Frame| lines(&frame.transition().outlines()[end], origin));
        factory.add_inked(PartKind::SourceGhost, source);
        factory.add_inked(PartKind::TargetGhost, target);
    }
}

/// Spawner of the render parts of one transition as children of `entity`.
struct PartFactory<'a, 'w, 's> {
    assets: &'a mut PartAssets<'w, 's>,
    entity: Entity,
    frame: &'a Frame,
    origin: DVec2,
}

impl PartFactory<'_, '_, '_> {
    /// Spawns a render part with a material. `mesh` creates its mesh when the render part is shown
    /// for the first time.
    fn add<M: Material2d>(
        &mut self,
        kind: PartKind,
        mesh: impl FnOnce(&Frame) -> Mesh + Send + Sync + 'static,
        material: Handle<M>,
        paint: fn(Handle<M>) -> StagePaint,
    ) {
        // Only a handle is reserved, so that render parts that are never shown take no memory.
        let handle = self.assets.paints.meshes.reserve_handle();
        let part = StagePart {
            kind,
            paint: paint(material.clone()),
            origin: self.origin,
            deferred_mesh: Some(DeferredMesh(Box::new(mesh))),
            is_stale: true,
        };
        let mesh = Mesh2d(handle);
        // Culling needs a bounding box, which would have to be recomputed after each write and
        // would not include lines widened by the shader.
        let drawn = (mesh, MeshMaterial2d(material), NoFrustumCulling);
        let hidden = Visibility::Hidden;
        let parent = ChildOf(self.entity);
        self.assets.commands.spawn((part, drawn, hidden, parent));
    }

    /// Adds a render part with faces or a wireframe. `mesh` holds two constructors: of a mesh
    /// without vertex indices, and of a mesh with the vertex indices that the graphics card needs
    /// to evaluate a recording.
    fn add_triangles(&mut self, kind: PartKind, mesh: [fn(&Frame) -> Mesh; 2]) {
        let [plain, numbered] = mesh;
        let Some(gpu) = &self.assets.gpu else {
            return self.add_inked(kind, plain);
        };
        let material = self.assets.paints.played.add(RecordedMaterial {
            colour: LinearRgba::NONE,
            sum: RecordedSum::default(),
            reel: gpu.placeholder().clone(),
            kind: kind.ink_kind(),
        });
        self.add(kind, numbered, material, StagePaint::Recorded);
    }

    /// Adds a render part in one colour or with paint layers, whose vertices the CPU writes.
    fn add_inked(
        &mut self,
        kind: PartKind,
        mesh: impl FnOnce(&Frame) -> Mesh + Send + Sync + 'static,
    ) {
        let material = self.assets.paints.inks.add(InkMaterial {
            colour: LinearRgba::NONE,
            gradients: GradientUniform::default(),
            kind: kind.ink_kind(),
        });
        self.add(kind, mesh, material, StagePaint::Ink);
    }

    /// Adds a render part with paint layers.
    fn add_paint_layers(&mut self, layers: LayerMesh) {
        let mesh = match layers.has_faces() {
            true => faces(self.frame),
            false => nothing(),
        };
        let count = mesh.count_vertices();
        let mesh = mesh
            .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, vec![[0.0_f32; 4]; count])
            .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, vec![[0.0_f32; 2]; count]);
        self.add_inked(PartKind::PaintLayers(layers), |_| mesh);
    }

    /// Adds the render parts of a solid content: fill, bars, joints and wireframe.
    fn add_solid(&mut self, solid: &SolidContent) {
        let count = self.frame.placement().faces.len();
        let has_loops = !solid.loops.is_empty();
        // Faces cannot represent transient parts and holes, so boundary loops are drawn instead.
        let has_transients = !solid.holes.is_empty() || !solid.swelling_shapes.is_empty();
        if let Some(stack) = &solid.paint_layers {
            self.add_paint_layers(LayerMesh::of_solid(self.frame, solid, stack));
        } else if has_loops && (count == 0 || has_transients) {
            self.add_inked(PartKind::Rings, |_| nothing());
        } else if has_loops {
            self.add_triangles(PartKind::Faces, [faces, numbered_faces]);
        }
        for bars in BarShapes::grouped_by_paint(solid) {
            let (shapes, cores) = (quads(bars.coordinates()), quads(bars.core_coordinates()));
            self.add_inked(PartKind::Bars(bars.clone()), |_| shapes);
            self.add_inked(PartKind::JointCores(bars), |_| cores);
        }
        if count > 0 {
            // A truss has panels but no filled loops, so its wireframe lies on the background.
            let wire = PartKind::Wire {
                on_faces: has_loops,
            };
            self.add_triangles(wire, [corners, numbered_corners]);
        }
    }
}

/// Spawns the render parts of new transitions, hidden and without a mesh; `draw_morphs` then shows
/// them.
pub(super) fn spawn_parts(
    new_morphs: Query<(Entity, &Morph, Option<&Children>), With<WithoutParts>>,
    mut assets: PartAssets,
) {
    for (entity, morph, children) in &new_morphs {
        // The children may contain render parts of the previous transition.
        assets.remove_parts(children);
        let mut commands = assets.commands.entity(entity);
        commands.remove::<(WithoutParts, UploadState)>();
        assets.add_parts(entity, morph.frame());
    }
}

/// Observer that despawns the render parts of a removed morph.
pub(super) fn despawn_parts(
    removed: On<Remove, Morph>,
    children: Query<&Children>,
    mut assets: PartAssets,
) {
    assets.remove_parts(children.get(removed.entity).ok());
    assets
        .commands
        .entity(removed.entity)
        .try_remove::<UploadState>();
}

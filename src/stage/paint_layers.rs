//! The render mesh of what is in several paints: coat by coat, the lowest first, a
//! line over what it goes around. Within one mesh the graphics card draws in this
//! order.

use bevy::mesh::{Indices, Mesh};
use glam::DVec2;

use crate::colour::{Paint, StrokeStyle};
use crate::content::{InkedLayer, PaintLayerStack, SolidContent};
use crate::transition::{Frame, TransitionStyle};

use super::gradients::{GradientTable, GradientTextures, ShadedFaces};
use super::line_mesh;
use super::ring_fill::filled;
use super::vertices::write_points;

/// A solid or fields in coats, as they are written.
#[derive(Clone, Debug)]
pub(super) struct LayerMesh {
    /// Its faces, which stay the same. None where its rings are triangulated anew:
    /// faces know nothing of what comes and goes.
    faces: Option<LayerFaces>,
    /// The gradients of the last frame.
    gradients: Box<GradientTextures>,
    is_of_fields: bool,
}

/// Which faces and which vertices are in which coat.
#[derive(Clone, Debug)]
struct LayerFaces {
    /// For each coat the corners of its faces.
    corners: Vec<Vec<u32>>,
    /// For each vertex its coat.
    of_vertices: Vec<usize>,
}

/// What a coat is filled with.
#[derive(Clone, Copy)]
enum LayerInkSlot {
    /// A colour in linear light, alpha straight.
    Flat([f32; 4]),
    Shaded(ShadedFaces),
}

impl LayerMesh {
    /// Of fields with paints.
    pub(super) fn of_fields() -> Self {
        Self {
            faces: None,
            gradients: Box::default(),
            is_of_fields: true,
        }
    }

    /// Of a frame's solid, which has a coating.
    pub(super) fn of_solid(frame: &Frame, solid: &SolidContent, coating: &PaintLayerStack) -> Self {
        // Faces know nothing of that, nor of coats that are in several inks.
        let comes_and_goes = !solid.holes.is_empty()
            || !solid.swells.is_empty()
            || solid.clocks.is_some()
            || coating.fades;
        let arap = frame.transition().arap().filter(|_| !comes_and_goes);
        let faces = arap.map(|arap| {
            let parts = arap.mesh().components();
            LayerFaces::new(frame, solid, coating, &parts)
        });
        Self {
            faces,
            gradients: Box::default(),
            is_of_fields: false,
        }
    }

    /// Whether they are contours of fields.
    pub(super) fn is_of_fields(&self) -> bool {
        self.is_of_fields
    }

    /// Whether the faces of the frame are drawn.
    pub(super) fn has_faces(&self) -> bool {
        self.faces.is_some()
    }

    /// The gradients of the frame that was written last.
    pub(super) fn gradients(&self) -> &GradientTextures {
        &self.gradients
    }

    /// Brings a mesh up to a frame and a style.
    pub(super) fn write(
        &mut self,
        frame: &Frame,
        style: &TransitionStyle,
        origin: DVec2,
        mesh: &mut Mesh,
    ) {
        let placement = frame.placement();
        let coated = frame.transition().content().coated_at(placement, frame.t());
        let mut table = GradientTable::default();
        let mut ink = |inked: &InkedLayer| {
            let gradients = inked.gradients.each_ref().map(Option::as_ref);
            let gradient = style.gradient_at(gradients, inked.paints, inked.t);
            let shaded = gradient.and_then(|gradient| table.put(&gradient));
            let flat = || LayerInkSlot::Flat(flat(style.paint_at(inked.paints, inked.t)));
            shaded.map_or_else(flat, LayerInkSlot::Shaded)
        };
        let inks: Vec<LayerInkSlot> = coated.iter().map(&mut ink).collect();
        let mut layers = LayerMeshes::of(origin);
        if let Some(faces) = &self.faces {
            let places = &placement.in_frame;
            layers.positions.resize(places.len(), [0.0; 3]);
            write_points(places, origin, &mut layers.positions);
            // Each coat is there once.
            let mut of_coats = vec![LayerInkSlot::Flat([0.0; 4]); coated.len()];
            for (inked, &ink) in coated.iter().zip(&inks) {
                of_coats[inked.coat] = ink;
            }
            for (&coat, &place) in faces.of_vertices.iter().zip(places) {
                layers.ink(of_coats[coat], place);
            }
        }
        for (inked, ink) in coated.iter().zip(inks) {
            match &self.faces {
                Some(faces) => layers.indices.extend(&faces.corners[inked.coat]),
                None => layers.fill(&inked.rings, ink),
            }
            if let Some(line) = StrokeStyle::between(inked.lines, inked.t) {
                layers.draw(&inked.rings, &line);
            }
        }
        layers.put_into(mesh);
        *self.gradients = table.gradients;
    }
}

impl LayerFaces {
    /// `parts` is the connected part that each vertex is in.
    fn new(frame: &Frame, solid: &SolidContent, coating: &PaintLayerStack, parts: &[u32]) -> Self {
        let count = parts.iter().max().map_or(0, |&most| most as usize + 1);
        let mut of_parts = vec![0; count];
        for (walk, &coat) in solid.loops.iter().zip(&coating.of_walks) {
            if let Some(&vertex) = walk.first() {
                of_parts[parts[vertex as usize] as usize] = coat;
            }
        }
        let of_vertices: Vec<usize> = parts.iter().map(|&part| of_parts[part as usize]).collect();
        let mut corners = vec![Vec::new(); coating.coats.len()];
        for face in frame.placement().faces.iter() {
            corners[of_vertices[face[0] as usize]].extend(face);
        }
        Self {
            corners,
            of_vertices,
        }
    }
}

/// Triangles in the order in which they are drawn.
struct LayerMeshes {
    /// What positions are relative to.
    origin: DVec2,
    positions: Vec<[f32; 3]>,
    colours: Vec<[f32; 4]>,
    /// Where vertices are in their gradients.
    places: Vec<[f32; 2]>,
    indices: Vec<u32>,
}

impl LayerMeshes {
    fn of(origin: DVec2) -> Self {
        Self {
            origin,
            positions: Vec::new(),
            colours: Vec::new(),
            places: Vec::new(),
            indices: Vec::new(),
        }
    }

    /// Adds the ink of the next vertex, which is there.
    fn ink(&mut self, ink: LayerInkSlot, at: DVec2) {
        let (colour, place) = match ink {
            LayerInkSlot::Flat(colour) => (colour, [0.0; 2]),
            LayerInkSlot::Shaded(shaded) => (shaded.mark(), shaded.place(at)),
        };
        self.colours.push(colour);
        self.places.push(place);
    }

    fn fill(&mut self, rings: &[Vec<DVec2>], ink: LayerInkSlot) {
        let first = self.positions.len() as u32;
        let (points, corners) = filled(rings, self.origin);
        for &[x, y, _] in &points {
            self.ink(ink, self.origin + DVec2::new(x.into(), y.into()));
        }
        self.positions.extend(points);
        let corners = corners.into_iter().map(|corner| first + corner);
        self.indices.extend(corners);
    }

    fn draw(&mut self, rings: &[Vec<DVec2>], line: &StrokeStyle) {
        let triangles = (&mut self.positions, &mut self.indices);
        line_mesh::push(rings, line, self.origin, triangles);
        self.colours.resize(self.positions.len(), flat(line.paint));
        self.places.resize(self.positions.len(), [0.0; 2]);
    }

    /// Other frames have other triangles: there is little to be written in place.
    fn put_into(self, mesh: &mut Mesh) {
        mesh.insert_attribute(Mesh::ATTRIBUTE_POSITION, self.positions);
        mesh.insert_attribute(Mesh::ATTRIBUTE_COLOR, self.colours);
        mesh.insert_attribute(Mesh::ATTRIBUTE_UV_0, self.places);
        mesh.insert_indices(Indices::U32(self.indices));
    }
}

fn flat(paint: Paint) -> [f32; 4] {
    let [red, green, blue] = paint.colour.to_linear();
    [red, green, blue, paint.opacity as f32]
}

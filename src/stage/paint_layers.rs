//! Builds the render mesh of a content with several paint layers. All layers are in one mesh,
//! lowest first and each stroke above its fill, because the graphics card draws the triangles of a
//! mesh in order.

use bevy::mesh::{Indices, Mesh};
use glam::DVec2;

use crate::colour::{Paint, StrokeStyle};
use crate::content::{InkedLayer, PaintLayerStack, SolidContent};
use crate::transition::{Frame, TransitionStyle};

use super::gradients::{GradientSlot, GradientTable, GradientUniform};
use super::line_mesh;
use super::ring_fill::triangulate;
use super::vertices::write_points;

/// Writes the render mesh of a content with paint layers, anew for each frame. The content is
/// either a solid or a set of distance fields.
#[derive(Clone, Debug)]
pub(super) struct LayerMesh {
    /// Faces of the placement, by layer; they do not change from frame to frame. `None` for
    /// distance fields, and for solids whose faces cannot represent the layers (for example with
    /// transient parts or holes). The boundary loops of the layers are then triangulated anew in
    /// each frame.
    faces: Option<LayerFaces>,
    /// Gradients of the frame that was written last.
    gradients: Box<GradientUniform>,
    is_of_fields: bool,
}

/// Assignment of the faces and vertices of a placement to layers.
#[derive(Clone, Debug)]
struct LayerFaces {
    /// For each layer: the corners of its faces, as vertex indices.
    corners: Vec<Vec<u32>>,
    /// For each vertex: the index of its layer.
    of_vertices: Vec<usize>,
}

/// Colour or gradient that fills a layer.
#[derive(Clone, Copy)]
enum LayerInkSlot {
    /// Colour in linear light with straight alpha.
    Flat([f32; 4]),
    /// Gradient in the gradient table.
    Shaded(GradientSlot),
}

impl LayerMesh {
    /// Creates the writer for distance fields with paint layers.
    pub(super) fn of_fields() -> Self {
        Self {
            faces: None,
            gradients: Box::default(),
            is_of_fields: true,
        }
    }

    /// Creates the writer for a solid whose paint layers are those of `stack`.
    pub(super) fn of_solid(frame: &Frame, solid: &SolidContent, stack: &PaintLayerStack) -> Self {
        // The faces of the mesh can be drawn instead of the boundary loops only if they cover
        // exactly the filled area and each layer has one paint. Holes and swelling parts that exist
        // in only one design violate the first condition. Parts with clocks of their own, and parts
        // that fade in or out, violate the second.
        let has_transients = !solid.holes.is_empty()
            || !solid.swelling_shapes.is_empty()
            || solid.part_clocks.is_some()
            || stack.fades_unmatched;
        let arap = frame.transition().arap().filter(|_| !has_transients);
        let faces = arap.map(|arap| {
            let components = arap.mesh().components();
            LayerFaces::new(frame, solid, stack, &components)
        });
        Self {
            faces,
            gradients: Box::default(),
            is_of_fields: false,
        }
    }

    /// Returns whether the layers are contours of distance fields.
    pub(super) fn is_of_fields(&self) -> bool {
        self.is_of_fields
    }

    /// Returns whether the layers consist of the faces of the placement.
    pub(super) fn has_faces(&self) -> bool {
        self.faces.is_some()
    }

    /// Returns the gradients of the frame that was written last.
    pub(super) fn gradients(&self) -> &GradientUniform {
        &self.gradients
    }

    /// Writes all layers of a frame into `mesh`, with the colours of a style. Positions are
    /// relative to `origin`.
    pub(super) fn write(
        &mut self,
        frame: &Frame,
        style: &TransitionStyle,
        origin: DVec2,
        mesh: &mut Mesh,
    ) {
        let placement = frame.placement();
        let groups = frame.transition().content().layers_at(placement, frame.t());
        let mut table = GradientTable::default();
        let mut ink = |inked: &InkedLayer| {
            let gradients = inked.gradients.each_ref().map(Option::as_ref);
            let gradient = style.gradient_at(gradients, inked.paints, inked.t);
            let shaded = gradient.and_then(|gradient| table.insert(&gradient));
            let flat = || LayerInkSlot::Flat(linear_rgba(style.paint_at(inked.paints, inked.t)));
            shaded.map_or_else(flat, LayerInkSlot::Shaded)
        };
        let inks: Vec<LayerInkSlot> = groups.iter().map(&mut ink).collect();
        let mut layers = LayerMeshBuilder::of(origin);
        if let Some(faces) = &self.faces {
            let places = &placement.in_frame;
            layers.positions.resize(places.len(), [0.0; 3]);
            write_points(places, origin, &mut layers.positions);
            // If faces are drawn, `groups` has exactly one entry per paint layer.
            let mut ink_of_layer = vec![LayerInkSlot::Flat([0.0; 4]); groups.len()];
            for (inked, &ink) in groups.iter().zip(&inks) {
                ink_of_layer[inked.layer] = ink;
            }
            for (&layer, &place) in faces.of_vertices.iter().zip(places) {
                layers.ink(ink_of_layer[layer], place);
            }
        }
        for (inked, ink) in groups.iter().zip(inks) {
            let line = StrokeStyle::interpolated(inked.strokes, inked.t);
            if let Some(line) = line.filter(|line| line.is_below_fill) {
                layers.draw(&inked.rings, &line);
            }
            match &self.faces {
                Some(faces) => layers.indices.extend(&faces.corners[inked.layer]),
                None => layers.fill(&inked.rings, ink),
            }
            if let Some(line) = line.filter(|line| !line.is_below_fill) {
                layers.draw(&inked.rings, &line);
            }
        }
        layers.put_into(mesh);
        *self.gradients = table.gradients;
    }
}

impl LayerFaces {
    /// Assigns the faces and vertices of the placement to layers. `components` contains, for each
    /// vertex, the index of the connected component of the mesh to which the vertex belongs. All
    /// faces and vertices of a component belong to the layer of the component's boundary loops.
    fn new(
        frame: &Frame,
        solid: &SolidContent,
        stack: &PaintLayerStack,
        components: &[u32],
    ) -> Self {
        let count = components.iter().max().map_or(0, |&last| last as usize + 1);
        let mut layer_of_component = vec![0; count];
        for (boundary, &layer) in solid.loops.iter().zip(&stack.of_loops) {
            if let Some(&vertex) = boundary.first() {
                layer_of_component[components[vertex as usize] as usize] = layer;
            }
        }
        let of_vertices: Vec<usize> = components
            .iter()
            .map(|&component| layer_of_component[component as usize])
            .collect();
        let mut corners = vec![Vec::new(); stack.layers.len()];
        for face in frame.placement().faces.iter() {
            corners[of_vertices[face[0] as usize]].extend(face);
        }
        Self {
            corners,
            of_vertices,
        }
    }
}

/// Builder of a mesh with paint layers; triangles are added in drawing order.
struct LayerMeshBuilder {
    /// Point of the plane to which positions are relative.
    origin: DVec2,
    positions: Vec<[f32; 3]>,
    colours: Vec<[f32; 4]>,
    /// For each vertex: its position in the space of its gradient; zero if it has a plain colour.
    places: Vec<[f32; 2]>,
    indices: Vec<u32>,
}

impl LayerMeshBuilder {
    fn of(origin: DVec2) -> Self {
        Self {
            origin,
            positions: Vec::new(),
            colours: Vec::new(),
            places: Vec::new(),
            indices: Vec::new(),
        }
    }

    /// Adds the colour and the gradient coordinates of the next vertex; `at` is its position in the
    /// plane.
    fn ink(&mut self, ink: LayerInkSlot, at: DVec2) {
        let (colour, place) = match ink {
            LayerInkSlot::Flat(colour) => (colour, [0.0; 2]),
            LayerInkSlot::Shaded(shaded) => {
                (shaded.vertex_colour(), shaded.gradient_coordinates(at))
            }
        };
        self.colours.push(colour);
        self.places.push(place);
    }

    /// Adds the triangles of the area that boundary loops enclose.
    fn fill(&mut self, rings: &[Vec<DVec2>], ink: LayerInkSlot) {
        let first = self.positions.len() as u32;
        let (points, corners) = triangulate(rings, self.origin);
        for &[x, y, _] in &points {
            self.ink(ink, self.origin + DVec2::new(x.into(), y.into()));
        }
        self.positions.extend(points);
        let corners = corners.into_iter().map(|corner| first + corner);
        self.indices.extend(corners);
    }

    /// Adds the triangles of a stroke along boundary loops.
    fn draw(&mut self, rings: &[Vec<DVec2>], line: &StrokeStyle) {
        line_mesh::push_stroke(
            rings,
            line,
            self.origin,
            &mut self.positions,
            &mut self.indices,
        );
        self.colours
            .resize(self.positions.len(), linear_rgba(line.paint));
        self.places.resize(self.positions.len(), [0.0; 2]);
    }

    /// Replaces all vertices and triangles of `mesh`, because their number changes from frame to
    /// frame.
    fn put_into(self, mesh: &mut Mesh) {
        mesh.insert_attribute(Mesh::ATTRIBUTE_POSITION, self.positions);
        mesh.insert_attribute(Mesh::ATTRIBUTE_COLOR, self.colours);
        mesh.insert_attribute(Mesh::ATTRIBUTE_UV_0, self.places);
        mesh.insert_indices(Indices::U32(self.indices));
    }
}

/// Converts a paint to linear light with straight alpha.
fn linear_rgba(paint: Paint) -> [f32; 4] {
    let [red, green, blue] = paint.colour.to_linear();
    [red, green, blue, paint.opacity as f32]
}

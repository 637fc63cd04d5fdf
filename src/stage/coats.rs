//! The render mesh of a solid in several paints: coat by coat, the lowest first, a
//! line over what it goes around. Within one mesh the graphics card draws in this
//! order.

use bevy::mesh::{Indices, Mesh};
use glam::DVec2;

use crate::colour::{Line, Paint};
use crate::content::{Coating, Solid};
use crate::transition::{Frame, Style};

use super::fill::filled;
use super::ribbon;
use super::shapes::write_points;

/// How a coated solid is written.
#[derive(Clone, Debug)]
pub(super) enum Coats {
    /// As its faces, which stay the same, with lines along them.
    Faces(CoatFaces),
    /// As its rings, triangulated anew: faces know nothing of what comes and
    /// goes.
    Rings,
}

/// Which faces and which vertices are in which coat.
#[derive(Clone, Debug)]
pub(super) struct CoatFaces {
    /// For each coat the corners of its faces.
    corners: Vec<Vec<u32>>,
    /// For each vertex its coat.
    of_vertices: Vec<usize>,
}

/// A colour in linear light, alpha straight.
type Ink = [f32; 4];

impl Coats {
    /// Of a frame's solid, which has a coating.
    pub(super) fn new(frame: &Frame, solid: &Solid, coating: &Coating) -> Self {
        let comes_and_goes = !solid.holes.is_empty() || !solid.swells.is_empty();
        match frame.transition().arap().filter(|_| !comes_and_goes) {
            Some(arap) => {
                let parts = arap.mesh().components();
                Self::Faces(CoatFaces::new(frame, solid, coating, &parts))
            }
            None => Self::Rings,
        }
    }

    /// Brings a mesh up to a frame and a style.
    pub(super) fn write(
        &self,
        frame: &Frame,
        (solid, coating): (&Solid, &Coating),
        style: &Style,
        origin: DVec2,
        mesh: &mut Mesh,
    ) {
        let (t, places) = (frame.t(), &frame.placement().in_frame);
        let paint = |coat: usize| ink(style.paint_at(coating.coats[coat].paints, t));
        let mut layers = Layers::default();
        if let Self::Faces(faces) = self {
            layers.positions.resize(places.len(), [0.0; 3]);
            write_points(places, origin, &mut layers.positions);
            let paints: Vec<Ink> = (0..coating.coats.len()).map(paint).collect();
            let inks = faces.of_vertices.iter().map(|&coat| paints[coat]);
            layers.colours.extend(inks);
        }
        for (coat, rings) in solid.coated_at(places, t) {
            match self {
                Self::Faces(faces) => layers.indices.extend(&faces.corners[coat]),
                Self::Rings => layers.fill(&rings, paint(coat), origin),
            }
            if let Some(line) = Line::between(coating.coats[coat].lines, t) {
                layers.draw(&rings, &line, origin);
            }
        }
        layers.put_into(mesh);
    }
}

impl CoatFaces {
    /// `parts` is the connected part that each vertex is in.
    fn new(frame: &Frame, solid: &Solid, coating: &Coating, parts: &[u32]) -> Self {
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
#[derive(Default)]
struct Layers {
    positions: Vec<[f32; 3]>,
    colours: Vec<Ink>,
    indices: Vec<u32>,
}

impl Layers {
    fn fill(&mut self, rings: &[Vec<DVec2>], ink: Ink, origin: DVec2) {
        let first = self.positions.len() as u32;
        let (points, corners) = filled(rings, origin);
        self.positions.extend(points);
        self.colours.resize(self.positions.len(), ink);
        let corners = corners.into_iter().map(|corner| first + corner);
        self.indices.extend(corners);
    }

    fn draw(&mut self, rings: &[Vec<DVec2>], line: &Line, origin: DVec2) {
        let triangles = (&mut self.positions, &mut self.indices);
        ribbon::push(rings, line, origin, triangles);
        self.colours.resize(self.positions.len(), ink(line.paint));
    }

    /// Other frames have other triangles: there is little to be written in place.
    fn put_into(self, mesh: &mut Mesh) {
        mesh.insert_attribute(Mesh::ATTRIBUTE_POSITION, self.positions);
        mesh.insert_attribute(Mesh::ATTRIBUTE_COLOR, self.colours);
        mesh.insert_indices(Indices::U32(self.indices));
    }
}

fn ink(paint: Paint) -> Ink {
    let [red, green, blue] = paint.colour.to_linear();
    [red, green, blue, paint.opacity as f32]
}

//! All numbers of an analysis at one t, by bar and by node.

use super::solver::StructureSolver;
use crate::geometry::DVec2;
use serde::Serialize;

/// All results at one t, in SI units.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct StructureTables {
    /// Blend parameter.
    pub t: f64,
    /// Whether the structure is a mechanism; then all forces and displacements are zero.
    pub is_mechanism: bool,
    /// Results of each bar.
    pub bars: Vec<BarResults>,
    /// Results of each node.
    pub nodes: Vec<NodeResults>,
}

/// Results of a bar, in SI units.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct BarResults {
    /// Index of the bar.
    pub bar: usize,
    /// Index of its first node.
    pub first_node: u32,
    /// Index of its second node.
    pub second_node: u32,
    /// Length in m.
    pub length_m: f64,
    /// Area in m².
    pub area_m2: f64,
    /// Axial force of the largest magnitude in N; tension is positive.
    pub axial_n: f64,
    /// Axial force in the middle of the bar in N; tension is positive.
    pub mean_axial_n: f64,
    /// Largest absolute shear force in N.
    pub shear_n: f64,
    /// Largest absolute bending moment in N m.
    pub moment_nm: f64,
    /// Largest absolute stress in Pa.
    pub stress_pa: f64,
    /// Stress divided by strength.
    pub utilisation: f64,
    /// Compression divided by Euler's load; `None` for bars that are not pinned at both ends.
    pub euler_utilisation: Option<f64>,
    /// Length divided by radius of gyration; `None` for bars without force or area.
    pub slenderness: Option<f64>,
}

/// Results of a node, in SI units.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct NodeResults {
    /// Index of the node.
    pub node: u32,
    /// Position along x in m.
    pub x_m: f64,
    /// Position along y in m.
    pub y_m: f64,
    /// Displacement along x in m.
    pub displacement_x_m: f64,
    /// Displacement along y in m.
    pub displacement_y_m: f64,
    /// Rotation in radians.
    pub rotation_rad: f64,
    /// Reaction along x in N.
    pub reaction_x_n: f64,
    /// Reaction along y in N.
    pub reaction_y_n: f64,
    /// Reaction moment in N m.
    pub reaction_moment_nm: f64,
}

impl StructureTables {
    /// Returns all numbers of the last analysis of `solver`, which was that at `t`.
    #[must_use]
    pub fn of(solver: &StructureSolver, t: f64) -> Self {
        let state = solver.state();
        let bar = |(bar, &[first_node, second_node]): (usize, &[u32; 2])| {
            let forces = &state.forces[bar];
            let own = &state.properties[bar];
            BarResults {
                bar,
                first_node,
                second_node,
                length_m: forces.length,
                area_m2: own.area,
                axial_n: forces.governing_axial(),
                mean_axial_n: forces.axial,
                shear_n: forces.largest_shear(),
                moment_nm: forces.largest_moment(),
                stress_pa: forces.largest_stress(own),
                utilisation: state.utilisation(bar),
                euler_utilisation: state.euler_utilisation(bar),
                slenderness: state.slenderness(bar),
            }
        };
        let node = |(node, place): (usize, &DVec2)| {
            let [displacement_x_m, displacement_y_m, rotation_rad] = state.displacements[node];
            let [reaction_x_n, reaction_y_n, reaction_moment_nm] = state.reactions[node];
            NodeResults {
                node: node as u32,
                x_m: place.x,
                y_m: place.y,
                displacement_x_m,
                displacement_y_m,
                rotation_rad,
                reaction_x_n,
                reaction_y_n,
                reaction_moment_nm,
            }
        };
        Self {
            t,
            is_mechanism: state.is_mechanism,
            bars: solver.blend().bars().iter().enumerate().map(bar).collect(),
            nodes: solver.places().iter().enumerate().map(node).collect(),
        }
    }
}

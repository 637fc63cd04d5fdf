//! Results of the analysis at one t, and what governs there.

use super::solver::{StructuralState, StructureSolver};
use crate::geometry::DVec2;
use serde::Serialize;

/// Results of the analysis at one t, in SI units.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct StructureSample {
    /// Blend parameter.
    pub t: f64,
    /// Whether the structure is a mechanism. If so, all results apart from the mass and the moving
    /// nodes are zero or `None`.
    pub is_mechanism: bool,
    /// Nodes that nothing holds in a mechanism; empty if the structure stands.
    pub moving_nodes: Vec<u32>,
    /// Mass of all bars in kg.
    pub mass: f64,
    /// Largest displacement of a node in m, and the node.
    pub deflection: f64,
    /// Node with the largest displacement.
    pub deflected_node: Option<u32>,
    /// Twice the largest distance of a node from its nearest support in m: the span of a girder,
    /// and twice the length of a cantilever. 0 without supports.
    pub span: f64,
    /// Largest ratio of the stress to the strength, and its bar.
    pub strength: Option<BarValue>,
    /// Largest ratio of the compression to Euler's load of all bars that are pinned at both ends.
    pub euler: Option<BarValue>,
    /// Load factor at which a frame buckles; `None` for a structure of pinned bars and for a frame
    /// without compression.
    pub critical_load_factor: Option<f64>,
    /// Largest slenderness L/i of a compressed bar.
    pub compressed_slenderness: Option<BarValue>,
    /// Largest slenderness L/i of a bar in tension.
    pub tension_slenderness: Option<BarValue>,
    /// Work of the loads on the displacements in J.
    pub compliance: f64,
    /// First natural frequency in Hz; `None` if no node can move.
    pub frequency: Option<f64>,
}

/// Value of a measure at the bar where it is largest.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct BarValue {
    /// Index of the bar.
    pub bar: usize,
    /// Value of the measure.
    pub value: f64,
}

impl StructureSample {
    /// Returns the measures of the last analysis of `solver`, which was that at `t`.
    /// `last_factor` is the buckling factor at a t nearby, where the search begins.
    #[must_use]
    pub fn of(solver: &StructureSolver, t: f64, last_factor: Option<f64>) -> Self {
        let critical = match solver.blend().is_frame() {
            true => Some(solver.critical_load_factor(last_factor)).filter(|f| f.is_finite()),
            false => None,
        };
        let state = solver.state();
        let mut sample = Self {
            t,
            is_mechanism: state.is_mechanism,
            moving_nodes: Vec::new(),
            mass: state.mass,
            deflection: 0.0,
            deflected_node: None,
            span: span(solver),
            strength: None,
            euler: None,
            critical_load_factor: None,
            compressed_slenderness: None,
            tension_slenderness: None,
            compliance: 0.0,
            frequency: None,
        };
        if state.is_mechanism {
            sample.moving_nodes = state.moving_nodes();
            return sample;
        }
        let deflections = state.displacements.iter().map(|u| u[0].hypot(u[1]));
        let largest = deflections.enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((node, deflection)) = largest.filter(|(_, deflection)| *deflection > 0.0) {
            (sample.deflection, sample.deflected_node) = (deflection, Some(node as u32));
        }
        sample.critical_load_factor = critical;
        sample.compliance = state.compliance;
        sample.frequency = Some(state.frequency).filter(|f| f.is_finite());
        sample.strength = state.largest_of_bars(|bar| Some(state.utilisation(bar)));
        sample.euler = state.largest_of_bars(|bar| state.euler_utilisation(bar));
        sample.compressed_slenderness = state.largest_of_bars(|bar| {
            let slenderness = state.slenderness(bar)?;
            (state.forces[bar].governing_axial() < 0.0).then_some(slenderness)
        });
        sample.tension_slenderness = state.largest_of_bars(|bar| {
            let slenderness = state.slenderness(bar)?;
            (state.forces[bar].governing_axial() >= 0.0).then_some(slenderness)
        });
        sample
    }

    /// Returns whether the structure stands.
    #[must_use]
    pub fn stands(&self) -> bool {
        !self.is_mechanism
    }
}

/// Returns twice the largest distance of a node from its nearest support in m.
fn span(solver: &StructureSolver) -> f64 {
    let supported = solver.supported_places();
    let reach = |place: &DVec2| {
        let distances = supported.iter().map(|support| support.distance(*place));
        distances.fold(f64::INFINITY, f64::min)
    };
    let largest = solver.places().iter().map(reach).fold(0.0, f64::max);
    if largest.is_finite() {
        2.0 * largest
    } else {
        0.0
    }
}

impl StructuralState {
    /// Returns the ratio of the largest stress in a bar to its strength: |N|/(A f) + |M|/(W f).
    ///
    /// # Panics
    /// If the bar does not exist.
    #[must_use]
    pub fn utilisation(&self, bar: usize) -> f64 {
        let own = &self.properties[bar];
        self.forces[bar].largest_stress(own) / own.strength
    }

    /// Returns the ratio of the compression in a bar to Euler's load; `None` for a bar that is not
    /// pinned at both ends.
    ///
    /// # Panics
    /// If the bar does not exist.
    #[must_use]
    pub fn euler_utilisation(&self, bar: usize) -> Option<f64> {
        let own = &self.properties[bar];
        let forces = &self.forces[bar];
        let compression = (-forces.axial).max(0.0);
        // A bar without area carries nothing.
        let is_pinned = own.fixity == [0.0; 2];
        (is_pinned && own.area > 0.0).then(|| compression / own.euler_load(forces.length))
    }

    /// Returns the length of a bar divided by its radius of gyration; `None` for a bar without area
    /// or without force.
    ///
    /// # Panics
    /// If the bar does not exist.
    #[must_use]
    pub fn slenderness(&self, bar: usize) -> Option<f64> {
        let (own, forces) = (&self.properties[bar], &self.forces[bar]);
        let largest = self
            .forces
            .iter()
            .map(|all| all.axial.abs())
            .fold(0.0, f64::max);
        // Rounding does not make a bar without force a compressed one.
        let has_force = forces.axial.abs() > 1e-9 * largest;
        (own.area > 0.0 && has_force).then(|| forces.length / own.radius)
    }

    /// Returns the largest value of a measure of bars, and its bar.
    fn largest_of_bars(&self, measure: impl Fn(usize) -> Option<f64>) -> Option<BarValue> {
        let bars = 0..self.forces.len();
        let values = bars.filter_map(|bar| {
            Some(BarValue {
                bar,
                value: measure(bar)?,
            })
        });
        values.max_by(|a, b| a.value.total_cmp(&b.value))
    }
}

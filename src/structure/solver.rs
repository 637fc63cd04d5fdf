//! Linear statics of a blended structure, its first natural frequency, and whether it stands.
//!
//! The unknowns are two displacements and a rotation of each node. Fixed displacements, and
//! rotations that no member resists, keep their place in the system with an equation of their own,
//! so that the elimination order is computed once for all weights and all places of the nodes.
//!
//! A structure is a mechanism if the least eigenvalue λ₁ of M^(−1/2) K M^(−1/2) is less than 1e-10
//! of the largest, where K is the stiffness and M holds the masses of the members, lumped at the
//! nodes. λ₁ is found by inverse iteration. Where K cannot be factored, K + σM is, which has the
//! same eigenvectors. The largest eigenvalue is bounded by that of the members (Fried 1972).
//!
//! Guaranteed: [`StructureSolver::solve`] allocates nothing and cannot fail; its results depend only
//! on the weights, the places and the selected loads.

use super::blend::{LoadSelection, LoadsAt, StructuralBlend};
use super::element::{Element, MemberForces, MemberProperties, rotary_inertia};
use super::error::StructureError;
use super::node_axes::{GroundSpring, NodeAxes};
use super::pattern::NodeMatrix;
use super::restraints::RestraintAt;
use crate::geometry::DVec2;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Ratio of the least eigenvalue to the largest below which a structure is a mechanism (numerical
/// tolerance: a beam of 100 members whose length is 1,000 times its radius of gyration has 3e-10;
/// mechanisms have about 1e-16).
pub(super) const MECHANISM_RATIO: f64 = 1e-10;

/// Maximum number of inverse iterations (resource limit).
const MAX_ITERATIONS: usize = 200;

/// Relative change of the eigenvalue at which inverse iteration ends (numerical tolerance).
const EIGENVALUE_TOLERANCE: f64 = 1e-13;

/// Displacement of a node along x and y in m, and its rotation in radians.
pub type NodeDisplacement = [f64; 3];

/// State of a structure under load.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct StructuralState {
    /// Whether the structure is a mechanism. If so, all forces, displacements and reactions are
    /// zero, and `mode` is a motion that meets no resistance.
    pub is_mechanism: bool,
    /// Displacement of each node.
    pub displacements: Vec<NodeDisplacement>,
    /// Internal forces of each bar.
    pub forces: Vec<MemberForces>,
    /// Properties of each bar.
    pub properties: Vec<MemberProperties>,
    /// Force of the supports on each node along x and y in N, and their moment in N m.
    pub reactions: Vec<[f64; 3]>,
    /// Sum of all loads in N.
    pub total_load: DVec2,
    /// Mass of all bars in kg.
    pub mass: f64,
    /// Work of the loads on the displacements in J: twice the strain energy, apart from that of
    /// loads on members between fixed ends.
    pub compliance: f64,
    /// First natural frequency in Hz; 0 for a mechanism, infinite if no node can move.
    pub frequency: f64,
    /// Shape of the first natural vibration; the largest displacement of a node is 1 m.
    pub mode: Vec<NodeDisplacement>,
}

/// Displacement in a mode, as a fraction of the largest one, from which a node moves (numerical
/// tolerance: nodes at rest have about 1e-9).
const MOVES_FROM: f64 = 1e-3;

impl StructuralState {
    /// Returns the nodes that move in `mode`. For a mechanism, these are the nodes that nothing
    /// holds. A node that only rotates counts if no node is displaced.
    #[must_use]
    pub fn moving_nodes(&self) -> Vec<u32> {
        let moves = |measure: fn(&NodeDisplacement) -> f64| {
            let nodes = self.mode.iter().enumerate();
            let moving = nodes.filter(|(_, mode)| measure(mode) >= MOVES_FROM);
            moving.map(|(node, _)| node as u32).collect::<Vec<_>>()
        };
        let displaced = moves(|mode| mode[0].hypot(mode[1]));
        match displaced.is_empty() {
            true => moves(|mode| mode[2].abs()),
            false => displaced,
        }
    }
}

/// Solver for a blended structure at any weights and places of its nodes.
///
/// ```
/// use morphospace::design::Truss;
/// use morphospace::structure::{LoadSelection, StructuralBlend, StructureSolver};
/// use std::sync::Arc;
/// // A bar that hangs from a support, and a weight of 1 kN at its end.
/// let text = r#"{"units": {"length": "m", "force": "kN"}, "nodes": [[0, 0], [0, -2]],
///     "bars": [[0, 1]], "fixity": 1, "areas": [0.001], "loads": [{"node": 1, "force": [0, -1]}],
///     "supports": [{"node": 0, "fixed": [true, true, true]}]}"#;
/// let truss = Truss::from_json(text)?;
/// let blend = Arc::new(StructuralBlend::of(&[&truss])?);
/// let mut solver = StructureSolver::new(blend)?;
/// let state = solver.solve(truss.nodes(), &[1.0], LoadSelection::All);
/// assert!((state.forces[0].axial - 1000.0).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct StructureSolver {
    blend: Arc<StructuralBlend>,
    stiffness: NodeMatrix,
    /// Places of the nodes in m.
    places: Vec<DVec2>,
    axes: Vec<NodeAxes>,
    springs: Vec<GroundSpring>,
    /// Areas that replace those of the designs; empty if none do.
    areas: Vec<f64>,
    elements: Vec<Element>,
    loads: LoadsAt,
    /// Lumped mass of each unknown; 0 for fixed unknowns.
    masses: Vec<f64>,
    forces: Vec<f64>,
    unknowns: Vec<f64>,
    image: Vec<f64>,
    state: StructuralState,
}

impl StructureSolver {
    /// Computes the elimination order for a blended structure.
    ///
    /// # Errors
    /// [`StructureError::TooLarge`] if the system does not fit into memory.
    pub fn new(blend: Arc<StructuralBlend>) -> Result<Self, StructureError> {
        let nodes = blend.node_count();
        let members = blend.bars().len();
        Ok(Self {
            stiffness: NodeMatrix::new(nodes, blend.bars())?,
            places: vec![DVec2::ZERO; nodes],
            axes: vec![NodeAxes::FREE; nodes],
            springs: Vec::with_capacity(blend.restraints.len()),
            areas: Vec::with_capacity(members),
            elements: Vec::with_capacity(members),
            loads: LoadsAt {
                nodes: Vec::with_capacity(nodes),
                members: Vec::with_capacity(members),
            },
            masses: vec![0.0; 3 * nodes],
            forces: vec![0.0; 3 * nodes],
            unknowns: vec![0.0; 3 * nodes],
            image: vec![0.0; 3 * nodes],
            state: StructuralState {
                displacements: vec![[0.0; 3]; nodes],
                forces: vec![MemberForces::default(); members],
                properties: vec![MemberProperties::default(); members],
                reactions: vec![[0.0; 3]; nodes],
                mode: vec![[0.0; 3]; nodes],
                ..StructuralState::default()
            },
            blend,
        })
    }

    /// Returns the blended structure.
    #[must_use]
    pub fn blend(&self) -> &Arc<StructuralBlend> {
        &self.blend
    }

    /// Returns the results of the last [`Self::solve`].
    #[must_use]
    pub fn state(&self) -> &StructuralState {
        &self.state
    }

    /// Returns the places of the nodes in m at the last [`Self::solve`].
    pub(super) fn places(&self) -> &[DVec2] {
        &self.places
    }

    /// Returns the springs between nodes and the ground at the last [`Self::solve`].
    pub(super) fn springs(&self) -> &[GroundSpring] {
        &self.springs
    }

    /// Returns the places in m of the nodes that any design supports.
    pub(super) fn supported_places(&self) -> Vec<DVec2> {
        let nodes = self
            .blend
            .restraints
            .iter()
            .map(|restraint| restraint.node as usize);
        nodes.map(|node| self.places[node]).collect()
    }

    /// Returns the nodes with a moment that no bar and no support resists.
    pub(super) fn unresisted_moments(&self) -> Vec<u32> {
        let is_resisted = |node: u32| {
            let has_stiffness = self.stiffness.diagonal(3 * node as usize + 2) > 0.0;
            let restraints = self.blend.restraints.iter();
            has_stiffness || restraints.into_iter().any(|all| all.is_rotation_of(node))
        };
        let loads = (0_u32..).zip(&self.loads.nodes);
        let moments = loads.filter(|&(node, (_, moment))| *moment != 0.0 && !is_resisted(node));
        moments.map(|(node, _)| node).collect()
    }

    /// Returns the axes and fixed displacements of the nodes at the last [`Self::solve`].
    pub(super) fn axes(&self) -> &[NodeAxes] {
        &self.axes
    }

    /// Analyses the structure with other areas of its members, in m². The shapes of the sections
    /// stay, so that radii of gyration and depths grow with the square root of the area. Without
    /// areas, those of the designs are used.
    ///
    /// # Panics
    /// As [`Self::solve`].
    pub fn solve_with_areas(
        &mut self,
        areas: &[f64],
        places: &[DVec2],
        weights: &[f64],
        selection: LoadSelection,
    ) -> &StructuralState {
        self.areas.clear();
        self.areas.extend_from_slice(areas);
        self.analyse(places, weights, selection);
        &self.state
    }

    /// Analyses the structure with its nodes at `places`, in units of the common frame, and with
    /// the given weights of the designs.
    ///
    /// # Panics
    /// If there are fewer places than nodes, or fewer weights than designs.
    pub fn solve(
        &mut self,
        places: &[DVec2],
        weights: &[f64],
        selection: LoadSelection,
    ) -> &StructuralState {
        self.areas.clear();
        self.analyse(places, weights, selection);
        &self.state
    }

    fn analyse(&mut self, places: &[DVec2], weights: &[f64], selection: LoadSelection) {
        assert!(
            weights.len() >= self.blend.design_count(),
            "a weight for each design"
        );
        self.place(places, weights);
        self.restrain(weights);
        let largest = self.assemble();
        self.blend.write_loads(
            selection,
            weights,
            &self.places,
            &self.state.properties,
            &mut self.loads,
        );
        self.load();
        let eigenvalue = self.first_mode(largest);
        // Both are zero if no member has an area.
        self.state.is_mechanism = eigenvalue <= MECHANISM_RATIO * largest;
        self.state.frequency = match self.state.is_mechanism {
            true => 0.0,
            false => eigenvalue.sqrt() / TAU,
        };
        self.solve_statics();
    }

    /// Writes the places of the nodes in m and the properties of the members.
    fn place(&mut self, places: &[DVec2], weights: &[f64]) {
        let metres = self.blend.metres(weights);
        for (own, place) in self.places.iter_mut().zip(places) {
            *own = metres * *place;
        }
        for (bar, properties) in self.state.properties.iter_mut().enumerate() {
            *properties = self.blend.properties(bar, weights);
            if let Some(&area) = self.areas.get(bar) {
                *properties = properties.with_area(area);
            }
        }
    }

    /// Fixes the supported displacements and adds springs for supports that not all designs have.
    fn restrain(&mut self, weights: &[f64]) {
        self.axes.fill(NodeAxes::FREE);
        self.springs.clear();
        let blend = &self.blend;
        for restraint in blend.restraints.iter().map(|all| all.at(weights)) {
            self.axes[restraint.node as usize].fix(&restraint);
        }
        let count = blend.bars().len() as f64;
        let mean = |stiffness: fn(&MemberProperties, f64) -> f64| {
            let bars = blend.bars().iter().zip(&self.state.properties);
            let stiffnesses = bars.map(|(bar, own)| {
                let [a, b] = bar.map(|node| self.places[node as usize]);
                stiffness(own, a.distance(b))
            });
            stiffnesses.sum::<f64>() / count
        };
        let k0 = [
            mean(|own, length| own.modulus * own.area / length),
            mean(|own, length| own.modulus * own.second_moment() / length),
        ];
        let is_spring = |restraint: &RestraintAt| !restraint.is_rigid() && restraint.presence > 0.0;
        let springs = blend.restraints.iter().map(|all| all.at(weights));
        let axes = &self.axes;
        let of_supports = springs
            .filter(is_spring)
            .map(|one| one.spring(&axes[one.node as usize], k0));
        let own = blend.springs(weights).map(|spring| GroundSpring {
            node: spring.node,
            mode: spring.along.map_or([0.0, 0.0, 1.0], |along| {
                axes[spring.node as usize].local(along, 0.0)
            }),
            stiffness: spring.stiffness,
        });
        self.springs.extend(of_supports.chain(own));
    }

    /// Assembles stiffnesses and masses. Returns a bound on the largest eigenvalue.
    fn assemble(&mut self) -> f64 {
        self.stiffness.values.fill(0.0);
        self.masses.fill(0.0);
        self.elements.clear();
        self.state.mass = 0.0;
        let mut largest: f64 = 0.0;
        for (bar, own) in self.blend.bars().iter().zip(&self.state.properties) {
            let ends = bar.map(|node| self.places[node as usize]);
            let element = Element::new(ends, own, bar.map(|node| self.axes[node as usize].x));
            let mass = own.density * own.area * element.length;
            if mass > 0.0 {
                largest = largest.max(element.largest_eigenvalue(mass));
            }
            self.state.mass += mass;
            for (end, &node) in bar.iter().enumerate() {
                let masses = &mut self.masses[3 * node as usize..][..3];
                masses[0] += 0.5 * mass;
                masses[1] += 0.5 * mass;
                if own.fixity[end] > 0.0 {
                    masses[2] += mass * rotary_inertia(element.length);
                }
            }
            let member = self.elements.len();
            self.stiffness
                .add_element(member, |i, j| element.stiffness(i, j));
            self.elements.push(element);
        }
        for spring in &self.springs {
            let entry = |i: usize, j: usize| spring.stiffness * spring.mode[i] * spring.mode[j];
            self.stiffness.add_node(spring.node, entry);
        }
        self.fix_idle_unknowns();
        largest
    }

    /// Fixes rotations without stiffness, and gives nodes whose bars have no area the mean mass, so
    /// that they count as mechanisms.
    fn fix_idle_unknowns(&mut self) {
        let mean = self.state.mass / self.axes.len() as f64;
        let mean = if mean > 0.0 { mean } else { 1.0 };
        for (node, axes) in self.axes.iter_mut().enumerate() {
            let masses = &mut self.masses[3 * node..][..3];
            if masses[0] == 0.0 {
                masses[..2].fill(mean);
            }
            let is_idle = self.stiffness.diagonal(3 * node + 2) == 0.0;
            axes.is_fixed[2] |= is_idle;
            if masses[2] == 0.0 {
                // A rotation that only a spring resists.
                masses[2] = mean;
            }
            for (mass, is_fixed) in masses.iter_mut().zip(axes.is_fixed) {
                if is_fixed {
                    *mass = 0.0;
                }
            }
        }
    }

    /// Writes the right-hand side: forces on the nodes, and the equivalent of loads on members.
    fn load(&mut self) {
        self.forces.fill(0.0);
        self.state.total_load = DVec2::ZERO;
        for (node, &(force, moment)) in self.loads.nodes.iter().enumerate() {
            let local = self.axes[node].local(force, moment);
            self.forces[3 * node..][..3].copy_from_slice(&local);
            self.state.total_load += force;
        }
        for ((bar, element), load) in
            (self.blend.bars().iter().zip(&self.elements)).zip(&self.loads.members)
        {
            let axes = bar.map(|node| self.axes[node as usize].x);
            let equivalent = element.equivalent_forces(element.local(*load), axes);
            for (i, force) in equivalent.into_iter().enumerate() {
                self.forces[3 * bar[i / 3] as usize + i % 3] += force;
            }
            self.state.total_load += element.length * *load;
        }
    }

    /// Returns whether an unknown is fixed.
    fn is_fixed(&self, unknown: usize) -> bool {
        self.axes[unknown / 3].is_fixed[unknown % 3]
    }

    /// Factors K + `shift` M. Returns whether it is positive definite.
    fn factor(&mut self, shift: f64) -> bool {
        let axes = &self.axes;
        let is_fixed = |unknown: usize| axes[unknown / 3].is_fixed[unknown % 3];
        let masses = &self.masses;
        self.stiffness
            .factor(is_fixed, |unknown| shift * masses[unknown])
    }

    /// Finds the least eigenvalue and its mode by inverse iteration. Afterwards the memory holds
    /// the factors of K if that is positive definite.
    fn first_mode(&mut self, largest: f64) -> f64 {
        if self.masses.iter().all(|&mass| mass == 0.0) {
            // Every displacement is fixed.
            self.factor(0.0);
            self.state.mode.fill([0.0; 3]);
            return f64::INFINITY;
        }
        let shift = match self.factor(0.0) {
            true => 0.0,
            false => {
                let shift = MECHANISM_RATIO * largest;
                if !self.factor(shift) {
                    // Not a single member resists anything.
                    self.start();
                    self.write_mode();
                    return 0.0;
                }
                shift
            }
        };
        let shifted = self.iterate();
        let mut eigenvalue = shifted - shift;
        if shift == 0.0 && eigenvalue < MECHANISM_RATIO * largest {
            // The factors are those of a matrix that is singular but for rounding, so the mode is
            // inaccurate.
            self.factor(MECHANISM_RATIO * largest);
            self.iterate();
            eigenvalue = 0.0;
        }
        self.write_mode();
        eigenvalue.max(0.0)
    }

    /// Sets the free unknowns to numbers without a pattern, so that iterations from there miss no
    /// mode. The numbers are always the same.
    fn start(&mut self) {
        for unknown in 0..self.unknowns.len() {
            let golden = 0.618_033_988_749_894_9 * (unknown + 1) as f64;
            self.unknowns[unknown] = match self.is_fixed(unknown) {
                true => 0.0,
                false => 0.5 + golden.fract(),
            };
        }
    }

    /// Iterates x ← K⁻¹ M x with the factors in the memory. Returns the Rayleigh quotient.
    fn iterate(&mut self) -> f64 {
        self.start();
        let mut eigenvalue = f64::INFINITY;
        for _ in 0..MAX_ITERATIONS {
            for ((image, x), mass) in (self.image.iter_mut().zip(&self.unknowns)).zip(&self.masses)
            {
                *image = mass * x;
            }
            self.unknowns.copy_from_slice(&self.image);
            self.stiffness.back_substitute(&mut self.unknowns);
            let mut work = 0.0;
            let mut norm = 0.0;
            for ((image, x), mass) in (self.image.iter().zip(&self.unknowns)).zip(&self.masses) {
                work += image * x;
                norm += mass * x * x;
            }
            let last = eigenvalue;
            eigenvalue = work / norm;
            let scale = norm.sqrt().recip();
            self.unknowns.iter_mut().for_each(|x| *x *= scale);
            if (last - eigenvalue).abs() <= EIGENVALUE_TOLERANCE * eigenvalue {
                break;
            }
        }
        eigenvalue
    }

    /// Writes the mode to the state, scaled so that the largest displacement of a node is 1.
    fn write_mode(&mut self) {
        let length = |mode: &[f64]| mode[0].hypot(mode[1]);
        let largest = self
            .unknowns
            .chunks_exact(3)
            .map(length)
            .fold(0.0, f64::max);
        // A mode can consist of rotations alone.
        let rotation = self
            .unknowns
            .chunks_exact(3)
            .map(|m| m[2].abs())
            .fold(0.0, f64::max);
        let largest = if largest > 0.0 { largest } else { rotation };
        for ((mode, own), axes) in (self
            .state
            .mode
            .iter_mut()
            .zip(self.unknowns.chunks_exact(3)))
        .zip(&self.axes)
        {
            *mode = axes.global([own[0], own[1], own[2]].map(|x| x / largest));
        }
    }

    /// Solves for the displacements and writes displacements, forces and reactions.
    fn solve_statics(&mut self) {
        self.unknowns.copy_from_slice(&self.forces);
        for unknown in 0..self.unknowns.len() {
            if self.is_fixed(unknown) {
                self.unknowns[unknown] = 0.0;
            }
        }
        match self.state.is_mechanism {
            true => self.unknowns.fill(0.0),
            false => self.stiffness.back_substitute(&mut self.unknowns),
        }
        let work = self.unknowns.iter().zip(&self.forces).map(|(u, f)| u * f);
        self.state.compliance = work.sum();
        for ((displacement, own), axes) in (self
            .state
            .displacements
            .iter_mut()
            .zip(self.unknowns.chunks_exact(3)))
        .zip(&self.axes)
        {
            *displacement = axes.global([own[0], own[1], own[2]]);
        }
        self.write_forces();
    }

    /// Writes internal forces and reactions for the displacements in `unknowns`.
    fn write_forces(&mut self) {
        let state = &mut self.state;
        for (reaction, (force, moment)) in state.reactions.iter_mut().zip(&self.loads.nodes) {
            *reaction = [-force.x, -force.y, -moment];
        }
        let members = self.blend.bars().iter().zip(&self.elements);
        for (((bar, element), load), forces) in
            members.zip(&self.loads.members).zip(&mut state.forces)
        {
            let [a, b] = bar.map(|node| 3 * node as usize);
            let u = &self.unknowns;
            let displacements = [u[a], u[a + 1], u[a + 2], u[b], u[b + 1], u[b + 2]];
            *forces = element.forces(&displacements, element.local(*load));
            for (&node, (force, moment)) in bar.iter().zip(element.end_forces(forces)) {
                let reaction = &mut state.reactions[node as usize];
                reaction[0] += force.x;
                reaction[1] += force.y;
                reaction[2] += moment;
            }
        }
        let is_supported = |node: usize| {
            self.blend
                .restraints
                .iter()
                .any(|restraint| restraint.node as usize == node)
        };
        for (node, reaction) in state.reactions.iter_mut().enumerate() {
            if state.is_mechanism || !is_supported(node) {
                *reaction = [0.0; 3];
            }
        }
        if state.is_mechanism {
            for forces in &mut state.forces {
                *forces = MemberForces {
                    length: forces.length,
                    ..MemberForces::default()
                };
            }
        }
    }
}

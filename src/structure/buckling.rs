//! Linear buckling: the factor α_cr by which the loads can grow until the structure buckles.
//!
//! Solves (K + α K_G) φ = 0 for the least positive α, where K_G is the consistent geometric
//! stiffness of the axial forces (Przemieniecki 1968, section 15.3). Each member is divided into
//! [`PARTS`] elements; with these, a pinned column buckles at 1.0005 times Euler's load. The ends of
//! members have rotations of their own, joined to the nodes by rotational springs, so that pinned
//! members buckle between their nodes; only rigid ends share the rotation of their node.
//!
//! K + α K_G is positive definite exactly below α_cr. α_cr is bracketed by factoring, then refined
//! by inverse iteration.

use super::element::{Element, MemberProperties};
use super::node_axes::GroundSpring;
use super::pattern::NODE_ENTRIES;
use super::solver::StructureSolver;
use crate::geometry::DVec2;
use crate::numerics::{PatternCholesky, PatternWorkspace};

/// Number of elements into which a member is divided (derived: the error of the buckling load is
/// 0.05 %).
const PARTS: usize = 4;

/// Fixity from which a joint is rigid (numerical tolerance: a stiffer spring would cost digits).
const RIGID_FROM: f64 = 1.0 - 1e-6;

/// Largest load factor that is searched (numerical tolerance: beyond it, compression is rounding).
const MAX_FACTOR: f64 = 1e9;

/// First step of the search for a bracket: the factor changes by less from one sample of a film to
/// the next (heuristic).
const FIRST_STEP: f64 = 1.05;

/// Ratio of the ends of a bracket from which inverse iteration converges quickly, unless two
/// factors are as close to each other (heuristic).
const NARROW: f64 = 1.01;

/// Maximum number of halvings of a bracket (resource limit: enough for one of a factor of 10¹⁰).
const HALVINGS: usize = 50;

/// Maximum number of inverse iterations (resource limit: solving is much faster than factoring).
const ITERATIONS: usize = 50;

/// Relative change of the factor at which inverse iteration ends (numerical tolerance).
const FACTOR_TOLERANCE: f64 = 1e-10;

/// Number of unknowns that a member adds: rotations of both ends, and three for each inner point.
const INNER_UNKNOWNS: usize = 2 + 3 * (PARTS - 1);

/// Part of a member, or a member without bending stiffness.
struct BucklingElement {
    unknowns: [usize; 6],
    stiffness: [[f64; 6]; 6],
    geometric: [[f64; 6]; 6],
}

/// Structure whose members are divided into elements.
struct BucklingModel {
    elements: Vec<BucklingElement>,
    /// Rotational springs between members and nodes: two unknowns and a stiffness.
    springs: Vec<([usize; 2], f64)>,
    /// Springs between nodes and the ground, in the axes of the nodes.
    ground: Vec<GroundSpring>,
    is_fixed: Vec<bool>,
    pattern: PatternCholesky,
    memory: PatternWorkspace,
    slots: Vec<u32>,
}

impl StructureSolver {
    /// Returns α_cr, the factor on the loads of the last [`Self::solve`] at which the structure
    /// buckles: infinite without compression, and 0 for a mechanism. The search begins at `guess`,
    /// such as the factor at a t nearby. Allocates; it takes some milliseconds for 100 members.
    #[must_use]
    pub fn critical_load_factor(&self, guess: Option<f64>) -> f64 {
        if self.state().is_mechanism {
            return 0.0;
        }
        let Some(estimate) = self.least_euler_factor() else {
            return f64::INFINITY;
        };
        match BucklingModel::of(self) {
            Some(mut model) => model.critical_factor(guess.unwrap_or(estimate)),
            None => f64::INFINITY,
        }
    }

    /// Returns the least ratio of Euler's load to the compression of any member; `None` if no
    /// member is compressed.
    fn least_euler_factor(&self) -> Option<f64> {
        let members = self.state().forces.iter().zip(&self.state().properties);
        let factors = members.filter_map(|(forces, own)| {
            let compression = -forces.axial;
            let euler = own.euler_load(forces.length);
            (compression > 0.0 && euler > 0.0).then(|| euler / compression)
        });
        factors
            .reduce(f64::min)
            .filter(|factor| *factor < MAX_FACTOR)
    }
}

/// Members that are divided into elements one after another.
struct MemberDivision<'a> {
    solver: &'a StructureSolver,
    elements: Vec<BucklingElement>,
    springs: Vec<([usize; 2], f64)>,
    is_fixed: Vec<bool>,
}

impl<'a> MemberDivision<'a> {
    /// Fixes the supported displacements; rotations are free only where a member resists them.
    fn new(solver: &'a StructureSolver) -> Self {
        let bars = solver.blend().bars().len();
        let joints = 3 * solver.places().len();
        let mut is_fixed = vec![false; joints + INNER_UNKNOWNS * bars];
        for (node, axes) in solver.axes().iter().enumerate() {
            is_fixed[3 * node..][..2].copy_from_slice(&axes.is_fixed[..2]);
            is_fixed[3 * node + 2] = true;
        }
        Self {
            solver,
            elements: Vec::with_capacity(PARTS * bars),
            springs: Vec::new(),
            is_fixed,
        }
    }

    /// Divides a member.
    fn divide(&mut self, member: usize) {
        let bar = self.solver.blend().bars()[member];
        let state = self.solver.state();
        let (own, axial) = (state.properties[member], state.forces[member].axial);
        let first = 3 * self.solver.places().len() + INNER_UNKNOWNS * member;
        let ends = bar.map(|node| self.solver.places()[node as usize]);
        let directions = bar.map(|node| self.solver.axes()[node as usize].x);
        let joints = bar.map(|node| 3 * node as usize);
        if own.second_moment() == 0.0 {
            self.is_fixed[first..][..INNER_UNKNOWNS].fill(true);
            let unknowns = joints.map(|joint| [joint, joint + 1, joint + 2]);
            let straight = element(ends, directions, &own, axial, unknowns);
            self.elements.push(straight);
            return;
        }
        let length = ends[0].distance(ends[1]);
        let rotations = [0, 1].map(|end| self.end_rotation(&own, length, first, joints, end));
        let rigid = MemberProperties {
            fixity: [1.0; 2],
            ..own
        };
        let point = |k: usize| ends[0].lerp(ends[1], k as f64 / PARTS as f64);
        let unknowns = |k: usize| match k {
            0 => [joints[0], joints[0] + 1, rotations[0]],
            PARTS => [joints[1], joints[1] + 1, rotations[1]],
            inner => [0, 1, 2].map(|i| first + 2 + 3 * (inner - 1) + i),
        };
        let axis = |k: usize| match k {
            0 => directions[0],
            PARTS => directions[1],
            _ => DVec2::X,
        };
        for k in 0..PARTS {
            let both = [k, k + 1];
            let unknowns = both.map(unknowns);
            let part = element(both.map(point), both.map(axis), &rigid, axial, unknowns);
            self.elements.push(part);
        }
    }

    /// Returns the unknown of the rotation of an end of a member, which is joined to that of the
    /// node: its own, or the node's if the joint is rigid.
    fn end_rotation(
        &mut self,
        own: &MemberProperties,
        length: f64,
        first: usize,
        joints: [usize; 2],
        end: usize,
    ) -> usize {
        let (own_rotation, at_joint) = (first + end, joints[end] + 2);
        let fixity = own.fixity[end];
        if fixity == 0.0 {
            return own_rotation;
        }
        self.is_fixed[at_joint] = self.solver.axes()[joints[end] / 3].is_fixed[2];
        if fixity >= RIGID_FROM {
            self.is_fixed[own_rotation] = true;
            return at_joint;
        }
        let stiffness = 3.0 * own.modulus * own.second_moment() / length;
        let spring = stiffness * fixity / (1.0 - fixity);
        self.springs.push(([own_rotation, at_joint], spring));
        own_rotation
    }
}

impl BucklingModel {
    /// Divides the members of an analysed structure; `None` if the system does not fit into memory.
    fn of(solver: &StructureSolver) -> Option<Self> {
        let mut division = MemberDivision::new(solver);
        (0..solver.blend().bars().len()).for_each(|member| division.divide(member));
        let ground = solver.springs().to_vec();
        for spring in ground.iter().filter(|spring| spring.mode[2] != 0.0) {
            let node = spring.node as usize;
            division.is_fixed[3 * node + 2] = solver.axes()[node].is_fixed[2];
        }
        Self::with_pattern(
            division.elements,
            division.springs,
            ground,
            division.is_fixed,
        )
    }

    fn with_pattern(
        elements: Vec<BucklingElement>,
        springs: Vec<([usize; 2], f64)>,
        ground: Vec<GroundSpring>,
        is_fixed: Vec<bool>,
    ) -> Option<Self> {
        let diagonal = (0..is_fixed.len() as u32).map(|i| [i, i]);
        let of_elements = elements.iter().flat_map(|element| {
            lower_triangle().map(|[i, j]| [i, j].map(|k| element.unknowns[k] as u32))
        });
        let of_springs = springs.iter().map(|(pair, _)| pair.map(|k| k as u32));
        let of_ground = ground
            .iter()
            .flat_map(|spring| NODE_ENTRIES.map(|pair| pair.map(|k| 3 * spring.node + k as u32)));
        let others = of_elements.chain(of_springs).chain(of_ground);
        let places: Vec<[u32; 2]> = diagonal.chain(others).collect();
        let (pattern, slots) = PatternCholesky::new(is_fixed.len(), &places).ok()?;
        Some(Self {
            memory: pattern.memory(),
            elements,
            springs,
            ground,
            is_fixed,
            pattern,
            slots,
        })
    }

    /// Factors K + `factor` K_G. Returns whether it is positive definite.
    fn is_stable(&mut self, factor: f64) -> bool {
        let unknowns = self.is_fixed.len();
        let entries = self.memory.entries();
        entries.fill(0.0);
        let (diagonal, others) = self.slots.split_at(unknowns);
        let (of_elements, others) = others.split_at(21 * self.elements.len());
        let (of_springs, of_ground) = others.split_at(self.springs.len());
        let is_free = |pair: [usize; 2]| pair.iter().all(|&k| !self.is_fixed[k]);
        for (element, slots) in self.elements.iter().zip(of_elements.chunks_exact(21)) {
            for ([i, j], &slot) in lower_triangle().zip(slots) {
                if is_free([element.unknowns[i], element.unknowns[j]]) {
                    entries[slot as usize] +=
                        element.stiffness[i][j] + factor * element.geometric[i][j];
                }
            }
        }
        for (&(pair, stiffness), &slot) in self.springs.iter().zip(of_springs) {
            for k in pair.into_iter().filter(|&k| !self.is_fixed[k]) {
                entries[diagonal[k] as usize] += stiffness;
            }
            if is_free(pair) {
                entries[slot as usize] -= stiffness;
            }
        }
        for (spring, slots) in self.ground.iter().zip(of_ground.chunks_exact(6)) {
            for ([i, j], &slot) in NODE_ENTRIES.into_iter().zip(slots) {
                if is_free([i, j].map(|k| 3 * spring.node as usize + k)) {
                    entries[slot as usize] += spring.stiffness * spring.mode[i] * spring.mode[j];
                }
            }
        }
        for (unknown, &slot) in diagonal.iter().enumerate() {
            if self.is_fixed[unknown] {
                entries[slot as usize] = 1.0;
            }
        }
        self.pattern.factor(&mut self.memory)
    }

    /// Returns the product of −K_G with a vector.
    fn destabilised(&self, x: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; x.len()];
        for element in &self.elements {
            for (row, &i) in element.geometric.iter().zip(&element.unknowns) {
                let terms = row.iter().zip(&element.unknowns);
                product[i] -= terms.map(|(entry, &j)| entry * x[j]).sum::<f64>();
            }
        }
        for (entry, is_fixed) in product.iter_mut().zip(&self.is_fixed) {
            if *is_fixed {
                *entry = 0.0;
            }
        }
        product
    }

    /// Returns the least positive α at which K + α K_G is not positive definite.
    fn critical_factor(&mut self, guess: f64) -> f64 {
        let Some([mut stable, mut unstable]) = self.bracket(guess) else {
            return f64::INFINITY;
        };
        for _ in 0..HALVINGS {
            if unstable < NARROW * stable {
                break;
            }
            let middle = stable.midpoint(unstable);
            match self.is_stable(middle) {
                true => stable = middle,
                false => unstable = middle,
            }
        }
        self.refined(stable, unstable)
    }

    /// Returns a factor at which the structure is stable and a larger one at which it is not, found
    /// from `guess` by steps that grow; `None` if the structure is stable up to the largest factor.
    fn bracket(&mut self, guess: f64) -> Option<[f64; 2]> {
        let mut step = FIRST_STEP;
        let mut factor = guess;
        let is_first_stable = self.is_stable(factor);
        loop {
            let last = factor;
            factor = if is_first_stable {
                factor * step
            } else {
                factor / step
            };
            if factor > MAX_FACTOR {
                return None;
            }
            if factor < MAX_FACTOR.recip() {
                return Some([0.0, last]);
            }
            match (is_first_stable, self.is_stable(factor)) {
                (true, false) => return Some([last, factor]),
                (false, true) => return Some([factor, last]),
                _ => step *= step,
            }
        }
    }

    /// Refines a bracketed factor by inverse iteration.
    fn refined(&mut self, stable: f64, unstable: f64) -> f64 {
        if !self.is_stable(stable) {
            return stable;
        }
        let number = |k: usize| 0.5 + (0.618_033_988_749_894_9 * (k + 1) as f64).fract();
        let mut x: Vec<f64> = (0..self.is_fixed.len())
            .map(|k| if self.is_fixed[k] { 0.0 } else { number(k) })
            .collect();
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let mut factor = stable;
        for _ in 0..ITERATIONS {
            let image = self.destabilised(&x);
            x.copy_from_slice(&image);
            self.pattern.back_substitute(&mut self.memory, &mut x);
            // The Rayleigh quotient of K + `stable` K_G, which needs no difference of large terms.
            let last = factor;
            factor = stable + dot(&x, &image) / dot(&x, &self.destabilised(&x));
            if (factor - last).abs() <= FACTOR_TOLERANCE * factor.abs() {
                break;
            }
            let norm = dot(&x, &x).sqrt();
            x.iter_mut().for_each(|entry| *entry /= norm);
        }
        // Where rounding spoils the iteration, the bracket still holds.
        if factor >= stable && factor <= unstable {
            factor
        } else {
            stable.midpoint(unstable)
        }
    }
}

/// Returns the row and column of each entry of the lower triangle of a 6×6 matrix.
fn lower_triangle() -> impl Iterator<Item = [usize; 2]> {
    (0..6).flat_map(|i| (0..=i).map(move |j| [i, j]))
}

/// Returns the element between two points, with an axial force in N. `axes` holds the direction of
/// the first displacement at each end.
fn element(
    ends: [DVec2; 2],
    axes: [DVec2; 2],
    properties: &MemberProperties,
    axial: f64,
    unknowns: [[usize; 3]; 2],
) -> BucklingElement {
    let element = Element::new(ends, properties, axes);
    let length = element.length;
    let [first, second] = axes.map(|x| {
        let across = element.direction.perp();
        [across.dot(x), across.dot(x.perp())]
    });
    // Displacements across the element and rotations of both ends.
    let rows = [
        [first[0], first[1], 0.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 1.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, second[0], second[1], 0.0],
        [0.0, 0.0, 0.0, 0.0, 0.0, 1.0],
    ];
    let l = length;
    let local = if properties.second_moment() == 0.0 {
        // A member without bending stiffness stays straight.
        let mut string = [[0.0; 4]; 4];
        (string[0][0], string[2][2]) = (30.0, 30.0);
        (string[0][2], string[2][0]) = (-30.0, -30.0);
        string
    } else {
        [
            [36.0, 3.0 * l, -36.0, 3.0 * l],
            [3.0 * l, 4.0 * l * l, -3.0 * l, -l * l],
            [-36.0, -3.0 * l, 36.0, -3.0 * l],
            [3.0 * l, -l * l, -3.0 * l, 4.0 * l * l],
        ]
    };
    let scale = axial / (30.0 * l);
    let geometric = |i: usize, j: usize| {
        let mut sum = 0.0;
        for (a, row) in rows.iter().enumerate() {
            for (b, other) in rows.iter().enumerate() {
                sum += row[i] * local[a][b] * other[j];
            }
        }
        scale * sum
    };
    let [a, b] = unknowns;
    BucklingElement {
        unknowns: [a[0], a[1], a[2], b[0], b[1], b[2]],
        stiffness: std::array::from_fn(|i| std::array::from_fn(|j| element.stiffness(i, j))),
        geometric: std::array::from_fn(|i| std::array::from_fn(|j| geometric(i, j))),
    }
}

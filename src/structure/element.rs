//! Stiffness of a straight member with partially fixed ends: a bar in tension and compression, and
//! an Euler–Bernoulli beam in bending.
//!
//! A member deforms in three ways: its elongation e, and the rotations φ₁ and φ₂ of its ends
//! relative to the chord. All other motion is rigid and causes no forces. A joint of fixity r acts
//! as a rotational spring of stiffness (3EI/L) r/(1−r) between the node and the end of the member;
//! the springs are eliminated in closed form (Monforton and Wu 1963).

use crate::geometry::DVec2;

/// Properties of a member, in SI units. All of them are blended linearly.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct MemberProperties {
    /// Cross-sectional area in m².
    pub area: f64,
    /// Radius of gyration in m.
    pub radius: f64,
    /// Height of the section in the plane in m.
    pub depth: f64,
    /// Young's modulus in Pa.
    pub modulus: f64,
    /// Strength in tension and compression in Pa.
    pub strength: f64,
    /// Density in kg/m³.
    pub density: f64,
    /// Fixity of the joints at both ends, from 0 (pinned) to 1 (rigid).
    pub fixity: [f64; 2],
}

impl MemberProperties {
    /// Returns the sum of the properties, each multiplied by its weight. Areas and fixities are
    /// limited to their ranges, which weights outside [0, 1] would leave.
    pub(super) fn weighted(properties: &[Self], weights: &[f64]) -> Self {
        let mut sum = Self::default();
        for (own, weight) in properties.iter().zip(weights) {
            sum.area += weight * own.area;
            sum.radius += weight * own.radius;
            sum.depth += weight * own.depth;
            sum.modulus += weight * own.modulus;
            sum.strength += weight * own.strength;
            sum.density += weight * own.density;
            for (sum, own) in sum.fixity.iter_mut().zip(own.fixity) {
                *sum += weight * own;
            }
        }
        Self {
            area: sum.area.max(0.0),
            radius: sum.radius.max(0.0),
            fixity: sum.fixity.map(|fixity| fixity.clamp(0.0, 1.0)),
            ..sum
        }
    }

    /// Returns the properties with another area and a section of the same shape.
    pub(super) fn with_area(&self, area: f64) -> Self {
        let scale = if self.area > 0.0 {
            (area / self.area).sqrt()
        } else {
            0.0
        };
        Self {
            area,
            radius: scale * self.radius,
            depth: scale * self.depth,
            ..*self
        }
    }

    /// Returns the second moment of area in m⁴.
    #[must_use]
    pub fn second_moment(&self) -> f64 {
        self.area * self.radius.powi(2)
    }

    /// Returns the section modulus in m³: the second moment of area divided by half of the depth.
    #[must_use]
    pub fn section_modulus(&self) -> f64 {
        2.0 * self.second_moment() / self.depth
    }

    /// Returns the compressive force in N at which a pinned member of this length buckles
    /// (Euler 1744).
    #[must_use]
    pub fn euler_load(&self, length: f64) -> f64 {
        let slenderness = std::f64::consts::PI / length;
        self.modulus * self.second_moment() * slenderness.powi(2)
    }
}

/// Member between two points, ready to be assembled.
#[derive(Clone, Copy, Debug)]
pub(super) struct Element {
    /// Length in m.
    pub(super) length: f64,
    /// Unit vector from the first node to the second.
    pub(super) direction: DVec2,
    /// Elongation and end rotations caused by each of the displacements (x, y, rotation) of the
    /// first node, then of the second.
    modes: [[f64; 6]; 3],
    /// Axial stiffness EA/L.
    axial: f64,
    /// Rotational stiffnesses of the ends: k₁₁, k₁₂ and k₂₂.
    bending: [f64; 3],
    /// Fixities of both ends.
    fixity: [f64; 2],
}

/// Uniform load on an element, per metre of its length: along it, and across it (to the left).
pub(super) type LocalLoad = [f64; 2];

impl Element {
    /// Element between two nodes at the same place, which resists nothing. Its length is the
    /// smallest positive number, so that it can divide.
    const WITHOUT_LENGTH: Self = Self {
        length: f64::MIN_POSITIVE,
        direction: DVec2::X,
        modes: [[0.0; 6]; 3],
        axial: 0.0,
        bending: [0.0; 3],
        fixity: [0.0; 2],
    };

    /// Creates the element from `from` to `to`. `axes` holds, for each end, the direction in which
    /// the first displacement of its node is measured.
    pub(super) fn new(
        [from, to]: [DVec2; 2],
        properties: &MemberProperties,
        axes: [DVec2; 2],
    ) -> Self {
        let length = from.distance(to);
        if length == 0.0 {
            return Self::WITHOUT_LENGTH;
        }
        let direction = (to - from) / length;
        let across = direction.perp() / length;
        let [r1, r2] = properties.fixity;
        let modulus = properties.modulus;
        // Monforton and Wu 1963, equation 8, with the end rotations relative to the chord.
        let scale = modulus * properties.second_moment() / length * 3.0 / (4.0 - r1 * r2);
        let [first, second] = axes.map(|x| [x, x.perp()]);
        let elongation = |sign: f64, axes: [DVec2; 2]| axes.map(|axis| sign * direction.dot(axis));
        let turn = |sign: f64, axes: [DVec2; 2]| axes.map(|axis| sign * across.dot(axis));
        let row =
            |[a, b]: [f64; 2], [c, d]: [f64; 2], ends: [f64; 2]| [a, b, ends[0], c, d, ends[1]];
        let chord = (turn(1.0, first), turn(-1.0, second));
        Self {
            length,
            direction,
            modes: [
                row(elongation(-1.0, first), elongation(1.0, second), [0.0; 2]),
                row(chord.0, chord.1, [1.0, 0.0]),
                row(chord.0, chord.1, [0.0, 1.0]),
            ],
            axial: modulus * properties.area / length,
            bending: [4.0 * r1 * scale, 2.0 * r1 * r2 * scale, 4.0 * r2 * scale],
            fixity: properties.fixity,
        }
    }

    /// Returns the entry of the stiffness matrix at two displacements.
    pub(super) fn stiffness(&self, i: usize, j: usize) -> f64 {
        let [e, first, second] = &self.modes;
        let [k11, k12, k22] = self.bending;
        self.axial * e[i] * e[j]
            + first[i] * (k11 * first[j] + k12 * second[j])
            + second[i] * (k12 * first[j] + k22 * second[j])
    }

    /// Returns the largest eigenvalue that the element's stiffness can have relative to its lumped
    /// mass `mass` in kg: that of the axial part, or a bound for the bending part.
    pub(super) fn largest_eigenvalue(&self, mass: f64) -> f64 {
        let [k11, k12, k22] = self.bending;
        let translation = 2.0 * (k11 + 2.0 * k12 + k22) / self.length.powi(2) / (0.5 * mass);
        let rotation = (k11 + k22) / (mass * rotary_inertia(self.length));
        let bending = if k11 + k22 > 0.0 {
            translation + rotation
        } else {
            0.0
        };
        (4.0 * self.axial / mass).max(bending)
    }

    /// Returns the moments at both ends with which rigid supports at the nodes would balance a
    /// load, counter-clockwise.
    fn load_moments(&self, load: LocalLoad) -> [f64; 2] {
        let [r1, r2] = self.fixity;
        let scale = load[1] * self.length.powi(2) / 12.0 * 3.0 / (4.0 - r1 * r2);
        [scale * r1 * (2.0 - r2), -scale * r2 * (2.0 - r1)]
    }

    /// Returns the forces at the displacements of the nodes that are equivalent to a load.
    pub(super) fn equivalent_forces(&self, load: LocalLoad, axes: [DVec2; 2]) -> [f64; 6] {
        let half = 0.5 * self.length * self.vector(load);
        let [m1, m2] = self.load_moments(load);
        let direct = axes.map(|x| [half.dot(x), half.dot(x.perp()), 0.0]);
        std::array::from_fn(|i| {
            direct[i / 3][i % 3] + m1 * self.modes[1][i] + m2 * self.modes[2][i]
        })
    }

    /// Returns a load per metre as a vector.
    fn vector(&self, [along, across]: LocalLoad) -> DVec2 {
        along * self.direction + across * self.direction.perp()
    }

    /// Returns the components of a vector along and across the element.
    pub(super) fn local(&self, vector: DVec2) -> LocalLoad {
        [
            vector.dot(self.direction),
            vector.dot(self.direction.perp()),
        ]
    }

    /// Returns the internal forces for the displacements of the nodes.
    pub(super) fn forces(&self, displacements: &[f64; 6], load: LocalLoad) -> MemberForces {
        let [e, first, second] = self.modes.map(|mode| {
            let terms = mode.iter().zip(displacements);
            terms.map(|(mode, u)| mode * u).sum::<f64>()
        });
        let [k11, k12, k22] = self.bending;
        let [m1, m2] = self.load_moments(load);
        MemberForces {
            axial: self.axial * e,
            end_moments: [
                k11 * first + k12 * second - m1,
                k12 * first + k22 * second - m2,
            ],
            load,
            length: self.length,
        }
    }

    /// Returns the forces and the moment that the nodes exert on the ends of the member.
    pub(super) fn end_forces(&self, forces: &MemberForces) -> [(DVec2, f64); 2] {
        let half = -0.5 * self.length * self.vector(forces.load);
        let [m1, m2] = forces.end_moments;
        let shear = (m1 + m2) / self.length * self.direction.perp();
        let pull = forces.axial * self.direction;
        [(half - pull + shear, m1), (half + pull - shear, m2)]
    }
}

/// Rotational mass of an end of a beam, divided by the beam's mass, for a beam of this length
/// (Hinton, Rock and Zienkiewicz 1976).
pub(super) fn rotary_inertia(length: f64) -> f64 {
    length.powi(2) / 78.0
}

/// Internal forces of a member.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct MemberForces {
    /// Axial force in the middle of the member in N; tension is positive.
    pub axial: f64,
    /// Moments that the nodes exert on both ends in N m, counter-clockwise.
    pub end_moments: [f64; 2],
    /// Load per metre in N/m, along the member and across it.
    pub load: [f64; 2],
    /// Length of the member in m.
    pub length: f64,
}

impl MemberForces {
    /// Returns the axial force in N at the distance `x` from the first node.
    #[must_use]
    pub fn axial_at(&self, x: f64) -> f64 {
        self.axial + self.load[0] * (0.5 * self.length - x)
    }

    /// Returns the shear force in N at the distance `x` from the first node: the derivative of the
    /// moment.
    #[must_use]
    pub fn shear_at(&self, x: f64) -> f64 {
        (self.end_moments[0] + self.end_moments[1]) / self.length
            + self.load[1] * (x - 0.5 * self.length)
    }

    /// Returns the bending moment in N m at the distance `x` from the first node. It is positive if
    /// the right-hand side, seen from the first node, is in tension.
    #[must_use]
    pub fn moment_at(&self, x: f64) -> f64 {
        let at_start = (self.end_moments[0] + self.end_moments[1]) / self.length
            - 0.5 * self.load[1] * self.length;
        -self.end_moments[0] + x * (at_start + 0.5 * self.load[1] * x)
    }

    /// Returns the distances from the first node at which forces can be largest: both ends, the
    /// middle, and the place between them where the shear is zero, or again the middle.
    #[must_use]
    pub fn critical_places(&self) -> [f64; 4] {
        let middle = 0.5 * self.length;
        let zero = middle - self.shear_at(middle) / self.load[1];
        let inside = zero > 0.0 && zero < self.length;
        [0.0, middle, if inside { zero } else { middle }, self.length]
    }

    /// Returns the largest absolute value of a force along the member.
    fn largest(&self, force: impl Fn(f64) -> f64) -> f64 {
        let at = self.critical_places().map(|x| force(x).abs());
        at.into_iter().fold(0.0, f64::max)
    }

    /// Returns the largest absolute bending moment in N m.
    #[must_use]
    pub fn largest_moment(&self) -> f64 {
        self.largest(|x| self.moment_at(x))
    }

    /// Returns the largest absolute shear force in N.
    #[must_use]
    pub fn largest_shear(&self) -> f64 {
        self.largest(|x| self.shear_at(x))
    }

    /// Returns the axial force of the largest magnitude in N.
    #[must_use]
    pub fn governing_axial(&self) -> f64 {
        let ends = [self.axial_at(0.0), self.axial_at(self.length)];
        if ends[0].abs() >= ends[1].abs() {
            ends[0]
        } else {
            ends[1]
        }
    }

    /// Returns the largest absolute stress in Pa: |N|/A + |M|/W.
    #[must_use]
    pub fn largest_stress(&self, properties: &MemberProperties) -> f64 {
        let modulus = properties.section_modulus();
        self.largest(|x| {
            let moment = self.moment_at(x).abs();
            let bending = if moment > 0.0 { moment / modulus } else { 0.0 };
            self.axial_at(x).abs() / properties.area + bending
        })
    }
}

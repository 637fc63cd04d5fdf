//! Structure of one design in SI units: members, supports and loads of a truss.

use super::element::MemberProperties;
use super::error::{StructureError, StructureNote};
use crate::design::{
    MaterialGrade, Truss, TrussLoadCase, TrussParts, TrussSection, TrussSpring, TrussUnits,
};
use crate::geometry::{DMat2, DVec2};
use std::collections::{BTreeMap, HashMap};

/// Area of bars that give none, as a fraction of the squared diameter of the truss (heuristic:
/// 23 cm² for a span of 24 m).
const DEFAULT_AREA: f64 = 4e-6;

/// Largest ratio between the axial stiffnesses of two members (numerical tolerance: with a larger
/// ratio, fewer than six digits of the displacements are correct).
const MAX_STIFFNESS_RATIO: f64 = 1e9;

/// Largest force in N, moment in N m or load factor (resource limit: squares of results stay numbers;
/// the weight of a mountain is 1e15 N).
const MAX_LOAD: f64 = 1e30;

/// Structure of one design, in SI units and in the axes of the common frame.
#[derive(Clone, Debug)]
pub(super) struct StructuralModel {
    pub(super) node_count: usize,
    /// The two nodes of each member.
    pub(super) bars: Vec<[u32; 2]>,
    /// Properties of each member.
    pub(super) members: Vec<MemberProperties>,
    /// Supported nodes with their supports.
    /// Name of the material of each member; empty without a material.
    pub(super) materials: Vec<String>,
    pub(super) supports: BTreeMap<u32, NodeSupport>,
    pub(super) springs: Vec<ModelSpring>,
    pub(super) cases: Vec<ModelLoadCase>,
    /// Length of a unit of the common frame in m.
    pub(super) metres: f64,
    /// Direction of gravity.
    pub(super) down: DVec2,
    pub(super) notes: Vec<StructureNote>,
}

/// Spring between a node and the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ModelSpring {
    pub(super) node: u32,
    /// Direction of the spring; `None` for a spring that resists rotation.
    pub(super) along: Option<DVec2>,
    /// Stiffness in N/m or N m.
    pub(super) stiffness: f64,
}

/// Support of a node.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct NodeSupport {
    pub(super) hold: NodeHold,
    /// Whether the rotation is fixed.
    pub(super) rotation: bool,
}

/// Displacements that a support prevents.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) enum NodeHold {
    /// None.
    #[default]
    Free,
    /// The displacement along this unit vector.
    Along(DVec2),
    /// All displacements.
    Full,
}

/// Loads that act together, in N and m.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct ModelLoadCase {
    pub(super) name: String,
    pub(super) factor: f64,
    /// Loaded nodes with their force and moment.
    pub(super) nodes: BTreeMap<u32, (DVec2, f64)>,
    /// Loads along chains of members.
    pub(super) chains: Vec<ChainLoad>,
    pub(super) self_weight: bool,
}

/// Load that is spread evenly over a chain of members.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ChainLoad {
    /// Indices of the members, ascending.
    pub(super) members: Vec<usize>,
    /// Whether lengths are measured horizontally.
    pub(super) in_plan: bool,
    /// Sum of the load in N.
    pub(super) total: DVec2,
}

impl NodeHold {
    /// Returns what two supports of one node prevent together.
    fn with(self, other: Self) -> Self {
        match (self, other) {
            (Self::Free, only) | (only, Self::Free) => only,
            (Self::Along(a), Self::Along(b)) if a.perp_dot(b).abs() < 1e-9 => self,
            _ => Self::Full,
        }
    }
}

impl StructuralModel {
    /// Reads the structure of a placed truss.
    ///
    /// # Errors
    /// [`StructureError`] if the stiffnesses of two members are too different, or a number in SI
    /// units exceeds the range of numbers.
    pub(super) fn of(truss: &Truss) -> Result<Self, StructureError> {
        let parts = truss.parts();
        let units = truss.units();
        let placement = truss.placement();
        // Forces are turned and mirrored with the design but keep their magnitude.
        let turn = placement.linear() * (1.0 / placement.scale);
        let mut notes = Notes::default();
        let members = members(truss, units, &mut notes)?;
        let cases = load_cases(parts, units, turn);
        let springs = springs(parts, units, turn);
        check_springs(&springs, &members)?;
        check_loads(&cases)?;
        Ok(Self {
            node_count: parts.nodes.len(),
            bars: parts.bars.clone(),
            members,
            materials: (0..parts.bars.len())
                .map(|bar| {
                    parts
                        .material_of(bar)
                        .map_or_else(String::new, |m| m.name.clone())
                })
                .collect(),
            supports: supports(parts, turn),
            springs,
            cases,
            metres: units.metres() / placement.scale,
            down: turn * DVec2::NEG_Y,
            notes: notes.0,
        })
    }

    /// Returns the model with its members in another order: `order` holds, for each new member, the
    /// index of the old one, and whether its nodes are exchanged.
    pub(super) fn with_members_in_order(mut self, order: &[(usize, bool)]) -> Self {
        let reordered = order.iter().map(|&(old, is_reversed)| {
            let mut member = self.members[old];
            let mut bar = self.bars[old];
            if is_reversed {
                member.fixity.reverse();
                bar.reverse();
            }
            (bar, (member, self.materials[old].clone()))
        });
        let new_index: HashMap<usize, usize> =
            (order.iter().enumerate().map(|(new, &(old, _))| (old, new))).collect();
        let (bars, (members, materials)) = reordered.unzip();
        (self.bars, self.members, self.materials) = (bars, members, materials);
        for chain in self.cases.iter_mut().flat_map(|case| &mut case.chains) {
            chain.members = chain.members.iter().map(|old| new_index[old]).collect();
            chain.members.sort_unstable();
        }
        self
    }
}

/// Notes about numbers that a file does not give, each once.
#[derive(Default)]
struct Notes(Vec<StructureNote>);

impl Notes {
    fn add(&mut self, note: StructureNote) {
        if !self.0.contains(&note) {
            self.0.push(note);
        }
    }
}

/// Returns the properties of all members in SI units.
fn members(
    truss: &Truss,
    units: TrussUnits,
    notes: &mut Notes,
) -> Result<Vec<MemberProperties>, StructureError> {
    let parts = truss.parts();
    let metres = units.metres();
    let members: Vec<MemberProperties> = (0..parts.bars.len())
        .map(|bar| {
            let area = parts.area_of(bar).unwrap_or_else(|| {
                notes.add(StructureNote::DefaultArea);
                let diameter = truss.bounds().diameter() / truss.placement().scale;
                DEFAULT_AREA * diameter.powi(2)
            });
            let of_shape = TrussSection::default();
            let section = parts.section_of(bar).unwrap_or(&of_shape);
            if section.shape.is_none()
                && section.radius_of_gyration.is_none()
                && section.second_moment.is_none()
            {
                notes.add(StructureNote::DefaultSection);
            }
            let radius = section.radius(area);
            MemberProperties {
                area: area * metres.powi(2),
                radius: radius * metres,
                depth: section.height(radius) * metres,
                fixity: parts.fixity_of(bar),
                ..material(parts, bar, units, notes)
            }
        })
        .collect();
    check_stiffness(&members)?;
    Ok(members)
}

/// Returns the properties of a member's material in SI units; the others are zero.
fn material(
    parts: &TrussParts,
    bar: usize,
    units: TrussUnits,
    notes: &mut Notes,
) -> MemberProperties {
    let given = parts.material_of(bar);
    let grade = given.and_then(|given| MaterialGrade::named(&given.name));
    let standard = grade.unwrap_or(MaterialGrade::DEFAULT);
    let pascals = units.pascals();
    let modulus = given.and_then(|m| m.youngs_modulus).map(|e| e * pascals);
    let strength = given.and_then(|m| m.strength).map(|f| f * pascals);
    let density = given.and_then(|m| m.density).map(|d| d * units.density());
    if grade.is_none() && [modulus, strength, density].contains(&None) {
        notes.add(StructureNote::AssumedGrade {
            material: given.map_or_else(String::new, |given| given.name.clone()),
            grade: standard.name,
        });
    }
    MemberProperties {
        modulus: modulus.unwrap_or(standard.youngs_modulus),
        strength: strength.unwrap_or(standard.strength),
        density: density.unwrap_or(standard.density),
        ..MemberProperties::default()
    }
}

/// Checks that stiffnesses are numbers whose ratio leaves enough digits for the results.
fn check_stiffness(members: &[MemberProperties]) -> Result<(), StructureError> {
    let stiffnesses = members.iter().map(|m| m.modulus * m.area).enumerate();
    let nonzero: Vec<(usize, f64)> = stiffnesses.filter(|&(_, ea)| ea != 0.0).collect();
    if let Some(&(bar, _)) = nonzero.iter().find(|(_, ea)| !ea.is_normal()) {
        return Err(StructureError::Range { bar });
    }
    let by_stiffness = |a: &&(usize, f64), b: &&(usize, f64)| a.1.total_cmp(&b.1);
    let softest = nonzero.iter().min_by(by_stiffness);
    let stiffest = nonzero.iter().max_by(by_stiffness);
    match softest.zip(stiffest) {
        Some((softest, stiffest)) if stiffest.1 / softest.1 > MAX_STIFFNESS_RATIO => {
            Err(StructureError::StiffnessRatio {
                stiff: stiffest.0,
                soft: softest.0,
                ratio: stiffest.1 / softest.1,
            })
        }
        _ => Ok(()),
    }
}

/// Checks that no spring is so stiff that it should be a support.
fn check_springs(
    springs: &[ModelSpring],
    members: &[MemberProperties],
) -> Result<(), StructureError> {
    let stiffest = members
        .iter()
        .map(|m| m.modulus * m.area)
        .fold(0.0, f64::max);
    let is_too_stiff = |spring: &ModelSpring| spring.stiffness > MAX_STIFFNESS_RATIO * stiffest;
    match springs.iter().position(is_too_stiff) {
        Some(spring) => Err(StructureError::StiffSpring { spring }),
        None => Ok(()),
    }
}

/// Checks that no load of a case is too large to compute with.
fn check_loads(cases: &[ModelLoadCase]) -> Result<(), StructureError> {
    let is_valid = |case: &&ModelLoadCase| {
        let of_nodes = case
            .nodes
            .values()
            .map(|(force, moment)| force.length() + moment.abs());
        let of_chains = case.chains.iter().map(|chain| chain.total.length());
        // Infinite and undefined sums are not within the limit either.
        case.factor.abs() <= MAX_LOAD && of_nodes.chain(of_chains).all(|load| load <= MAX_LOAD)
    };
    match cases.iter().find(|case| !is_valid(case)) {
        Some(case) => Err(StructureError::LoadRange(case.name.clone())),
        None => Ok(()),
    }
}

/// Returns the supports of all supported nodes. `turn` is the rotation and mirror of the placement.
fn supports(parts: &TrussParts, turn: DMat2) -> BTreeMap<u32, NodeSupport> {
    let mut supports: BTreeMap<u32, NodeSupport> = BTreeMap::new();
    for support in &parts.supports {
        let across = support
            .rolls_along
            .and_then(|along| along.perp().try_normalize());
        let hold = match (support.fixed, across) {
            (_, Some(across)) => NodeHold::Along(turn * across),
            ([true, true, _], None) => NodeHold::Full,
            ([true, false, _], None) => NodeHold::Along(turn * DVec2::X),
            ([false, true, _], None) => NodeHold::Along(turn * DVec2::Y),
            ([false, false, _], None) => NodeHold::Free,
        };
        let all = supports.entry(support.node).or_default();
        all.hold = all.hold.with(hold);
        all.rotation |= support.fixed[2];
    }
    supports
}

/// Returns the springs in SI units.
fn springs(parts: &TrussParts, units: TrussUnits, turn: DMat2) -> Vec<ModelSpring> {
    let (newtons, metres) = (units.newtons(), units.metres());
    let spring = |spring: &TrussSpring| ModelSpring {
        node: spring.node,
        along: spring.along.map(|along| turn * along.normalize()),
        stiffness: spring.stiffness
            * match spring.along {
                Some(_) => newtons / metres,
                None => newtons * metres,
            },
    };
    parts.springs.iter().map(spring).collect()
}

/// Returns the load cases in SI units: the loads outside of load cases, then the named cases.
fn load_cases(parts: &TrussParts, units: TrussUnits, turn: DMat2) -> Vec<ModelLoadCase> {
    let unnamed = TrussLoadCase {
        name: String::new(),
        factor: 1.0,
        loads: parts.loads.clone(),
        line_loads: Vec::new(),
        self_weight: false,
    };
    let has_unnamed = !parts.loads.is_empty();
    let cases = has_unnamed.then_some(&unnamed).into_iter();
    let cases = cases.chain(&parts.load_cases);
    let (newtons, metres) = (units.newtons(), units.metres());
    // The mirror turns moments around.
    let moments = turn.determinant() * newtons * metres;
    let length = |bar: usize, in_plan: bool| {
        let [a, b] = parts.bars[bar].map(|node| parts.nodes[node as usize]);
        if in_plan {
            (b.x - a.x).abs()
        } else {
            a.distance(b)
        }
    };
    cases
        .map(|case| {
            let mut nodes: BTreeMap<u32, (DVec2, f64)> = BTreeMap::new();
            for load in &case.loads {
                let sum = nodes.entry(load.node).or_default();
                sum.0 += newtons * (turn * load.force);
                sum.1 += moments * load.moment;
            }
            let chains = case.line_loads.iter().map(|load| {
                let mut members: Vec<usize> = load.bars.iter().map(|&bar| bar as usize).collect();
                members.sort_unstable();
                members.dedup();
                let lengths = members.iter().map(|&bar| length(bar, load.in_plan));
                ChainLoad {
                    total: newtons * lengths.sum::<f64>() * (turn * load.force),
                    in_plan: load.in_plan,
                    members,
                }
            });
            ModelLoadCase {
                name: case.name.clone(),
                factor: case.factor,
                nodes,
                chains: chains.collect(),
                self_weight: case.self_weight,
            }
        })
        .collect()
}

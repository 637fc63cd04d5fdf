//! Structures of several designs with the same bars, blended by weights.
//!
//! Areas, radii of gyration, moduli, strengths, densities, fixities and loads are weighted means. A
//! support that not all designs have is a spring of stiffness k₀ p/(1−p), where p is the sum of the
//! weights of the designs that have it. Loads along chains of members keep their sum, not their
//! load per metre, when the chain becomes longer.

use super::element::MemberProperties;
use super::error::{StructureError, StructureNote};
use super::model::{ModelLoadCase, ModelSpring, StructuralModel};
use super::restraints::{Restraint, restraints};
use crate::design::{Design, DesignForm, Truss};
use crate::geometry::DVec2;
use crate::transition::Transition;
use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

/// Structures of several designs with the same nodes and bars.
///
/// ```
/// use morphospace::design::Truss;
/// use morphospace::structure::StructuralBlend;
/// let truss = Truss::from_json(r#"{"nodes": [[0, 0], [1, 0]], "bars": [[0, 1]]}"#)?;
/// let blend = StructuralBlend::of(&[&truss])?;
/// assert_eq!(blend.bars(), [[0, 1]]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct StructuralBlend {
    node_count: usize,
    bars: Vec<[u32; 2]>,
    /// For each member, its properties in each design.
    members: Vec<Vec<MemberProperties>>,
    pub(super) restraints: Vec<Restraint>,
    /// For each design, its springs.
    springs: Vec<Vec<ModelSpring>>,
    /// For each member, the names of its materials in the designs.
    materials: Vec<Vec<String>>,
    cases: Vec<BlendedLoadCase>,
    /// For each design, the length of a unit of the common frame in m.
    metres: Vec<f64>,
    /// For each design, the direction of gravity.
    down: Vec<DVec2>,
    notes: Vec<StructureNote>,
}

/// Load case of all designs.
#[derive(Clone, Debug)]
struct BlendedLoadCase {
    name: String,
    /// For each design, its factor.
    factors: Vec<f64>,
    /// Loaded nodes, with the force and the moment in each design.
    nodes: BTreeMap<u32, Vec<(DVec2, f64)>>,
    chains: Vec<BlendedChain>,
    /// For each design, 1 if the weight of the members acts, and otherwise 0.
    self_weight: Vec<f64>,
}

/// Load along a chain of members in all designs.
#[derive(Clone, Debug)]
struct BlendedChain {
    members: Vec<usize>,
    in_plan: bool,
    /// For each design, the sum of the load in N.
    totals: Vec<DVec2>,
}

/// Loads that act in an analysis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LoadSelection {
    /// All load cases, each multiplied by its factor.
    #[default]
    All,
    /// One load case without its factor, by its index in [`StructuralBlend::case_names`].
    Case(usize),
}

/// Loads in N and m at given weights and places.
#[derive(Clone, Debug, Default)]
pub(super) struct LoadsAt {
    /// Force and moment at each node.
    pub(super) nodes: Vec<(DVec2, f64)>,
    /// Force per metre of each member.
    pub(super) members: Vec<DVec2>,
}

impl StructuralBlend {
    /// Reads the structures of placed trusses. The order of the bars may differ.
    ///
    /// # Errors
    /// [`StructureError`] if the trusses do not have the same nodes and bars, or if their
    /// stiffnesses cannot be computed with.
    pub fn of(trusses: &[&Truss]) -> Result<Self, StructureError> {
        let models: Result<Vec<_>, _> = trusses.iter().map(|t| StructuralModel::of(t)).collect();
        Self::of_models(models?)
    }

    /// Reads the structures of the two designs of a transition.
    ///
    /// # Errors
    /// As [`Self::of`], and [`StructureError::NoTruss`] if a design is not a truss.
    pub fn of_transition(transition: &Transition) -> Result<Self, StructureError> {
        let truss = |design: &'_ Arc<Design>| match &design.form {
            DesignForm::Truss(truss) => Ok(truss.clone()),
            _ => Err(StructureError::NoTruss(design.name.clone())),
        };
        let [source, target] = transition.designs();
        Self::of(&[&truss(source)?, &truss(target)?])
    }

    fn of_models(models: Vec<StructuralModel>) -> Result<Self, StructureError> {
        let first = models.first().ok_or(StructureError::BarsDiffer)?;
        let (node_count, bars) = (first.node_count, first.bars.clone());
        let models: Result<Vec<StructuralModel>, _> = models
            .into_iter()
            .map(|model| in_order_of(&bars, node_count, model))
            .collect();
        let models = models?;
        let first_bars = bars.len();
        let material = |bar: usize| {
            let names = models.iter().map(|model| model.materials[bar].clone());
            names.collect()
        };
        let member = |bar: usize| models.iter().map(|model| model.members[bar]).collect();
        let mut notes: Vec<StructureNote> = Vec::new();
        for note in models.iter().flat_map(|model| &model.notes) {
            if !notes.contains(note) {
                notes.push(note.clone());
            }
        }
        Ok(Self {
            node_count,
            members: (0..bars.len()).map(member).collect(),
            bars,
            restraints: restraints(&models),
            springs: models.iter().map(|model| model.springs.clone()).collect(),
            materials: (0..first_bars).map(material).collect(),
            cases: load_cases(&models),
            metres: models.iter().map(|model| model.metres).collect(),
            down: models.iter().map(|model| model.down).collect(),
            notes,
        })
    }

    /// Returns the number of nodes.
    #[must_use]
    pub fn node_count(&self) -> usize {
        self.node_count
    }

    /// Returns the two nodes of each bar, in the order of the first design.
    #[must_use]
    pub fn bars(&self) -> &[[u32; 2]] {
        &self.bars
    }

    /// Returns the number of designs.
    #[must_use]
    pub fn design_count(&self) -> usize {
        self.metres.len()
    }

    /// Returns the names of the load cases. Loads that belong to no named case have an empty name.
    #[must_use]
    pub fn case_names(&self) -> Vec<&str> {
        self.cases.iter().map(|case| case.name.as_str()).collect()
    }

    /// Returns the values that the analysis uses for numbers that the designs do not give.
    #[must_use]
    pub fn notes(&self) -> &[StructureNote] {
        &self.notes
    }

    /// Returns whether any joint resists rotation in any design, so that members bend.
    #[must_use]
    pub fn is_frame(&self) -> bool {
        let fixities = self.members.iter().flatten().flat_map(|m| m.fixity);
        fixities.into_iter().any(|fixity| fixity > 0.0)
    }

    /// Returns the weights of a pair of designs at the blend parameter `t`.
    #[must_use]
    pub fn pair_weights(t: f64) -> [f64; 2] {
        [1.0 - t, t]
    }

    /// Returns the properties of a member at the given weights.
    ///
    /// # Panics
    /// If the bar does not exist.
    #[must_use]
    pub fn properties(&self, bar: usize, weights: &[f64]) -> MemberProperties {
        MemberProperties::weighted(&self.members[bar], weights)
    }

    /// Returns the properties of a member in each design.
    pub(super) fn properties_in_designs(&self, bar: usize) -> &[MemberProperties] {
        &self.members[bar]
    }

    /// Returns the springs between nodes and the ground at the given weights, each with the
    /// stiffness of its design times the weight of the design.
    pub(super) fn springs(&self, weights: &[f64]) -> impl Iterator<Item = ModelSpring> {
        let designs = self.springs.iter().zip(weights);
        designs.flat_map(|(springs, weight)| {
            springs.iter().map(move |spring| ModelSpring {
                stiffness: spring.stiffness * weight.max(0.0),
                ..*spring
            })
        })
    }

    /// Returns the names of a member's materials, joined if designs with a weight differ.
    pub(super) fn material_name(&self, bar: usize, weights: &[f64]) -> String {
        let mut names: Vec<&str> = Vec::new();
        for (name, weight) in self.materials[bar].iter().zip(weights) {
            if *weight != 0.0 && !names.contains(&name.as_str()) {
                names.push(name);
            }
        }
        names.join(" to ")
    }

    /// Returns the length in m of a unit of the common frame at the given weights.
    #[must_use]
    pub fn metres(&self, weights: &[f64]) -> f64 {
        weighted(&self.metres, weights)
    }

    /// Writes the loads at the given weights. `places` are the nodes in m; `properties` are those
    /// of the members, for their weight.
    pub(super) fn write_loads(
        &self,
        selection: LoadSelection,
        weights: &[f64],
        places: &[DVec2],
        properties: &[MemberProperties],
        loads: &mut LoadsAt,
    ) {
        loads.nodes.clear();
        loads.nodes.resize(self.node_count, (DVec2::ZERO, 0.0));
        loads.members.clear();
        loads.members.resize(self.bars.len(), DVec2::ZERO);
        for (index, case) in self.cases.iter().enumerate() {
            let factor = match selection {
                LoadSelection::All => weighted(&case.factors, weights),
                LoadSelection::Case(only) if only == index => 1.0,
                LoadSelection::Case(_) => continue,
            };
            self.add_case(case, factor, weights, places, properties, loads);
        }
    }

    /// Adds the loads of a case, multiplied by `factor`.
    fn add_case(
        &self,
        case: &BlendedLoadCase,
        factor: f64,
        weights: &[f64],
        places: &[DVec2],
        properties: &[MemberProperties],
        loads: &mut LoadsAt,
    ) {
        for (&node, designs) in &case.nodes {
            let (force, moment) = mean_load(designs, weights);
            let sum = &mut loads.nodes[node as usize];
            sum.0 += factor * force;
            sum.1 += factor * moment;
        }
        for chain in &case.chains {
            let total: DVec2 = chain.totals.iter().zip(weights).map(|(f, w)| *f * *w).sum();
            self.spread(chain, factor * total, places, &mut loads.members);
        }
        let weight = factor * weighted(&case.self_weight, weights);
        if weight != 0.0 {
            let gravity = weight * crate::design::GRAVITY * mean_down(self, weights);
            for (load, own) in loads.members.iter_mut().zip(properties) {
                *load += own.density * own.area * gravity;
            }
        }
    }

    /// Returns the load per metre of a chain whose load has the given sum, and whether lengths are
    /// measured in plan.
    fn load_per_metre(
        &self,
        chain: &BlendedChain,
        total: DVec2,
        places: &[DVec2],
    ) -> (DVec2, bool) {
        let spans = chain
            .members
            .iter()
            .map(|&member| self.span(member, places));
        let (plan, whole) = spans.fold((0.0, 0.0), |(plan, whole), span| {
            (plan + span.x.abs(), whole + span.length())
        });
        // A chain that has become vertical has no length in plan.
        let in_plan = chain.in_plan && plan > 1e-6 * whole;
        (total / if in_plan { plan } else { whole }, in_plan)
    }

    /// Spreads a load over a chain of members.
    fn spread(&self, chain: &BlendedChain, total: DVec2, places: &[DVec2], loads: &mut [DVec2]) {
        let (load, in_plan) = self.load_per_metre(chain, total, places);
        for &member in &chain.members {
            let span = self.span(member, places);
            let share = if in_plan {
                span.x.abs() / span.length()
            } else {
                1.0
            };
            loads[member] += share * load;
        }
    }

    /// Returns the vector from the first node of a member to the second.
    fn span(&self, member: usize, places: &[DVec2]) -> DVec2 {
        let [a, b] = self.bars[member].map(|node| places[node as usize]);
        b - a
    }
}

/// Load case at given weights, in N and m.
pub(super) struct LoadCaseAt<'a> {
    pub(super) name: &'a str,
    pub(super) factor: f64,
    /// Loaded nodes with their force and moment.
    pub(super) nodes: Vec<(u32, DVec2, f64)>,
    /// Chains of members with their load per metre, and whether lengths are measured in plan.
    pub(super) chains: Vec<(&'a [usize], DVec2, bool)>,
    /// Share of the weight of the members that acts.
    pub(super) self_weight: f64,
}

impl StructuralBlend {
    /// Returns all load cases at the given weights, with the nodes at `places` in m. Loads that are
    /// zero are left out.
    pub(super) fn cases_at(&self, weights: &[f64], places: &[DVec2]) -> Vec<LoadCaseAt<'_>> {
        let cases = self.cases.iter();
        cases
            .map(|case| self.case_at(case, weights, places))
            .collect()
    }

    fn case_at<'a>(
        &self,
        case: &'a BlendedLoadCase,
        weights: &[f64],
        places: &[DVec2],
    ) -> LoadCaseAt<'a> {
        let nodes = case.nodes.iter().map(|(&node, designs)| {
            let (force, moment) = mean_load(designs, weights);
            (node, force, moment)
        });
        let chains = case.chains.iter().map(|chain| {
            let total = chain.totals.iter().zip(weights).map(|(f, w)| *f * *w).sum();
            let (load, in_plan) = self.load_per_metre(chain, total, places);
            (chain.members.as_slice(), load, in_plan)
        });
        LoadCaseAt {
            name: &case.name,
            factor: weighted(&case.factors, weights),
            nodes: nodes
                .filter(|(_, f, m)| *f != DVec2::ZERO || *m != 0.0)
                .collect(),
            chains: chains.filter(|(_, load, _)| *load != DVec2::ZERO).collect(),
            self_weight: weighted(&case.self_weight, weights),
        }
    }
}

/// Returns the direction of gravity at the given weights.
pub(super) fn mean_down(blend: &StructuralBlend, weights: &[f64]) -> DVec2 {
    let down: DVec2 = blend.down.iter().zip(weights).map(|(d, w)| *d * *w).sum();
    down.normalize_or_zero()
}

/// Returns the weighted mean of the forces and moments at a node in all designs.
fn mean_load(designs: &[(DVec2, f64)], weights: &[f64]) -> (DVec2, f64) {
    let add = |sum: (DVec2, f64), (load, weight): (&(DVec2, f64), &f64)| {
        (sum.0 + *weight * load.0, sum.1 + weight * load.1)
    };
    designs.iter().zip(weights).fold((DVec2::ZERO, 0.0), add)
}

/// Returns the weighted sum of numbers.
fn weighted(numbers: &[f64], weights: &[f64]) -> f64 {
    numbers.iter().zip(weights).map(|(x, w)| x * w).sum()
}

/// Returns the model with its members in the order and direction of `bars`.
fn in_order_of(
    bars: &[[u32; 2]],
    node_count: usize,
    model: StructuralModel,
) -> Result<StructuralModel, StructureError> {
    if model.node_count != node_count || model.bars.len() != bars.len() {
        return Err(StructureError::BarsDiffer);
    }
    let key = |[a, b]: [u32; 2]| [a.min(b), a.max(b)];
    let index: HashMap<[u32; 2], usize> =
        (model.bars.iter().enumerate().map(|(i, &bar)| (key(bar), i))).collect();
    let place = |&bar: &[u32; 2]| {
        let old = *index.get(&key(bar)).ok_or(StructureError::BarsDiffer)?;
        Ok((old, model.bars[old] != bar))
    };
    let order: Result<Vec<(usize, bool)>, StructureError> = bars.iter().map(place).collect();
    Ok(model.with_members_in_order(&order?))
}

/// Returns the load cases of all designs. Cases with the same name are one case.
fn load_cases(models: &[StructuralModel]) -> Vec<BlendedLoadCase> {
    let mut cases: Vec<BlendedLoadCase> = Vec::new();
    for (design, model) in models.iter().enumerate() {
        for case in &model.cases {
            let index = cases.iter().position(|other| other.name == case.name);
            let index = index.unwrap_or_else(|| {
                cases.push(BlendedLoadCase::empty(&case.name, models.len()));
                cases.len() - 1
            });
            cases[index].add(design, models.len(), case);
        }
    }
    // A design without a load case has no loads in it; only its factor is that of the others.
    for case in &mut cases {
        let given = case.factors.iter().copied().find(|factor| !factor.is_nan());
        for factor in &mut case.factors {
            if factor.is_nan() {
                *factor = given.unwrap_or(1.0);
            }
        }
    }
    cases
}

impl BlendedLoadCase {
    /// Returns a case without loads, whose factors are not known yet (NaN).
    fn empty(name: &str, designs: usize) -> Self {
        Self {
            name: name.to_owned(),
            factors: vec![f64::NAN; designs],
            nodes: BTreeMap::new(),
            chains: Vec::new(),
            self_weight: vec![0.0; designs],
        }
    }

    /// Adds the loads of one design.
    fn add(&mut self, design: usize, designs: usize, case: &ModelLoadCase) {
        self.factors[design] = case.factor;
        if case.self_weight {
            self.self_weight[design] = 1.0;
        }
        for (&node, load) in &case.nodes {
            let loads = self.nodes.entry(node);
            let loads = loads.or_insert_with(|| vec![(DVec2::ZERO, 0.0); designs]);
            loads[design].0 += load.0;
            loads[design].1 += load.1;
        }
        for chain in &case.chains {
            let is_same = |other: &BlendedChain| {
                other.members == chain.members && other.in_plan == chain.in_plan
            };
            let index = self.chains.iter().position(is_same).unwrap_or_else(|| {
                self.chains.push(BlendedChain {
                    members: chain.members.clone(),
                    in_plan: chain.in_plan,
                    totals: vec![DVec2::ZERO; designs],
                });
                self.chains.len() - 1
            });
            self.chains[index].totals[design] += chain.total;
        }
    }
}

//! The truss between several designs, as a truss of its own that can be written to a file.

use super::blend::{StructuralBlend, mean_down};
use super::node_axes::GroundSpring;
use super::solver::StructureSolver;
use crate::design::{
    GRAVITY, Truss, TrussForceUnit, TrussInputError, TrussLengthUnit, TrussLineLoad, TrussLoad,
    TrussLoadCase, TrussMaterial, TrussParts, TrussSection, TrussSpring, TrussSupport, TrussUnits,
};
use crate::geometry::DVec2;

/// Units of a truss between designs: metres, newtons and pascals.
const UNITS: TrussUnits = TrussUnits {
    length: TrussLengthUnit::Metre,
    force: TrussForceUnit::Newton,
    stress: None,
};

impl StructureSolver {
    /// Returns the truss of the last analysis, which was that with the given weights of the designs.
    /// An analysis of this truss gives the same results. Lengths are in m, forces in N.
    ///
    /// # Errors
    /// [`TrussInputError`] if the places make no valid truss, for example because the two nodes of
    /// a bar coincide.
    ///
    /// # Panics
    /// If there are fewer weights than designs.
    pub fn truss_between(&self, weights: &[f64]) -> Result<Truss, TrussInputError> {
        let blend = self.blend();
        let mut parts = TrussParts {
            units: Some(UNITS),
            nodes: self.places().to_vec(),
            bars: blend.bars().to_vec(),
            springs: self.springs_between(),
            ..TrussParts::default()
        };
        blend.write_members(weights, &mut parts);
        blend.write_supports(weights, &mut parts);
        blend.write_cases(self.places(), weights, &mut parts);
        Truss::from_parts(parts)
    }

    /// Returns the springs of the last analysis, among them those of supports that not all designs
    /// have.
    fn springs_between(&self) -> Vec<TrussSpring> {
        let spring = |spring: &GroundSpring| {
            let axes = &self.axes()[spring.node as usize];
            let [x, y, rotation] = axes.global(spring.mode);
            TrussSpring {
                node: spring.node,
                along: (rotation == 0.0).then_some(DVec2::new(x, y)),
                stiffness: spring.stiffness,
            }
        };
        self.springs().iter().map(spring).collect()
    }
}

impl StructuralBlend {
    /// Writes areas, sections, materials and fixities. Equal sections and materials are written
    /// once.
    fn write_members(&self, weights: &[f64], parts: &mut TrussParts) {
        for bar in 0..self.bars().len() {
            let own = self.properties(bar, weights);
            let section = TrussSection {
                radius_of_gyration: (own.radius > 0.0).then_some(own.radius),
                depth: (own.depth > 0.0).then_some(own.depth),
                ..TrussSection::default()
            };
            let material = TrussMaterial {
                name: self.material_name(bar, weights),
                youngs_modulus: Some(own.modulus),
                density: Some(own.density),
                strength: Some(own.strength),
            };
            parts.areas.push(own.area);
            parts
                .bar_sections
                .push(index_of(&mut parts.sections, section));
            parts
                .bar_materials
                .push(index_of(&mut parts.materials, material));
            parts.bar_fixity.push(own.fixity);
        }
        if let Some(&first) = parts.bar_fixity.first()
            && first[0] == first[1]
            && parts.bar_fixity.iter().all(|ends| *ends == first)
        {
            parts.fixity = first[0];
            parts.bar_fixity.clear();
        }
    }

    /// Writes rigid supports.
    fn write_supports(&self, weights: &[f64], parts: &mut TrussParts) {
        for restraint in self.restraints.iter().map(|all| all.at(weights)) {
            if !restraint.is_rigid() {
                continue;
            }
            let node = restraint.node;
            let mut support = TrussSupport {
                node,
                fixed: [false; 3],
                rolls_along: None,
            };
            match restraint.along {
                None => support.fixed[2] = true,
                Some(along) if along.y.abs() < 1e-12 => support.fixed[0] = true,
                Some(along) if along.x.abs() < 1e-12 => support.fixed[1] = true,
                Some(along) => support.rolls_along = Some(-along.perp()),
            }
            // Fixed displacements of one node are one support.
            match parts.supports.iter_mut().find(|other| {
                other.node == node && other.rolls_along.is_none() && support.rolls_along.is_none()
            }) {
                Some(other) => {
                    for (all, own) in other.fixed.iter_mut().zip(support.fixed) {
                        *all |= own;
                    }
                }
                None => parts.supports.push(support),
            }
        }
    }

    /// Writes the loads of all load cases.
    fn write_cases(&self, places: &[DVec2], weights: &[f64], parts: &mut TrussParts) {
        let down = mean_down(self, weights);
        for case in self.cases_at(weights, places) {
            let mut file_case = TrussLoadCase {
                name: case.name.to_owned(),
                factor: case.factor,
                loads: case
                    .nodes
                    .iter()
                    .map(|&(node, force, moment)| TrussLoad {
                        node,
                        force,
                        moment,
                    })
                    .collect(),
                line_loads: case
                    .chains
                    .iter()
                    .map(|(members, force, in_plan)| TrussLineLoad {
                        bars: members.iter().map(|&bar| bar as u32).collect(),
                        force: *force,
                        in_plan: *in_plan,
                    })
                    .collect(),
                self_weight: case.self_weight == 1.0 && down == DVec2::NEG_Y,
            };
            if !file_case.self_weight && case.self_weight != 0.0 {
                let weight = |bar: usize| {
                    let own = self.properties(bar, weights);
                    TrussLineLoad {
                        bars: vec![bar as u32],
                        force: case.self_weight * own.density * own.area * GRAVITY * down,
                        in_plan: false,
                    }
                };
                file_case
                    .line_loads
                    .extend((0..self.bars().len()).map(weight));
            }
            let is_plain = file_case.factor == 1.0
                && file_case.line_loads.is_empty()
                && !file_case.self_weight;
            match file_case.name.is_empty() && is_plain {
                true => parts.loads = file_case.loads,
                false => parts.load_cases.push(file_case),
            }
        }
    }
}

/// Returns the index of an item in a list, to which it is added if it is missing.
fn index_of<T: PartialEq>(list: &mut Vec<T>, item: T) -> u32 {
    let index = list.iter().position(|other| *other == item);
    index.unwrap_or_else(|| {
        list.push(item);
        list.len() - 1
    }) as u32
}

//! Validation of truss files.

use super::error::TrussInputError;
use super::loads::{TrussLoad, TrussSupport};
use super::members::{SectionShape, TrussSection};
use super::parts::TrussParts;
use crate::geometry::{Bounds, DesignSizeError, is_in_range};
use std::collections::HashMap;

/// Returns an error for the first item that is not valid. `what` names the kind of the items,
/// `rule` advises the user.
fn check_items<'a, T: 'a>(
    what: &'static str,
    rule: &'static str,
    items: impl IntoIterator<Item = &'a T>,
    is_valid: impl Fn(&T) -> bool,
) -> Result<(), TrussInputError> {
    match items.into_iter().position(|item| !is_valid(item)) {
        Some(index) => Err(TrussInputError::Number { what, index, rule }),
        None => Ok(()),
    }
}

/// Checks references, given as pairs (index of the referring entry, index it refers to). Returns an
/// error for the first one that is not below `count`, the number of entries of the kind `kind`.
fn check_references(
    what: &'static str,
    mut references: impl Iterator<Item = (usize, u32)>,
    kind: &'static str,
    count: usize,
) -> Result<(), TrussInputError> {
    match references.find(|&(_, named)| named as usize >= count) {
        Some((index, named)) => Err(TrussInputError::OutOfRange {
            what,
            index,
            kind,
            named,
            count,
        }),
        None => Ok(()),
    }
}

impl TrussParts {
    /// Checks all guarantees of [`Truss`](super::Truss).
    pub(super) fn check(&self) -> Result<(), TrussInputError> {
        if self.bars.is_empty() {
            let nodes = self.nodes.len();
            return Err(TrussInputError::NoBars { nodes });
        }
        // The order matters: later checks use indices that earlier checks have validated.
        self.check_numbers()?;
        self.check_indices()?;
        self.check_bars()?;
        self.check_nodes_are_used()?;
        self.check_supports_and_sections()?;
        let all = Bounds::of(self.nodes.iter().copied());
        Ok(all
            .map_or(Ok(0.0), |all| DesignSizeError::check(&all))
            .map(drop)?)
    }

    /// Checks that all numbers are finite and within their ranges.
    fn check_numbers(&self) -> Result<(), TrussInputError> {
        const FINITE: &str = "use finite numbers";
        const POSITIVE: &str = "use finite numbers above zero";
        const NOT_NEGATIVE: &str = "use finite numbers, zero or above";
        const FIXITY: &str = "use numbers from 0 (pinned) to 1 (rigid)";
        let is_positive = |&x: &f64| x.is_finite() && x > 0.0;
        if let Some(node) = self.nodes.iter().position(|&p| !is_in_range(p)) {
            return Err(TrussInputError::CoordinateRange(node));
        }
        for loads in self.lists_of_loads() {
            check_items("load", FINITE, loads, |l| {
                l.force.is_finite() && l.moment.is_finite()
            })?;
        }
        let line_loads = self.load_cases.iter().flat_map(|case| &case.line_loads);
        check_items("line load", FINITE, line_loads, |l| l.force.is_finite())?;
        check_items("load case", FINITE, &self.load_cases, |case| {
            case.factor.is_finite()
        })?;
        let is_number = |&x: &f64| x.is_finite() && x >= 0.0;
        check_items("spring", NOT_NEGATIVE, &self.springs, |spring| {
            is_number(&spring.stiffness)
                && spring
                    .along
                    .is_none_or(|along| along.try_normalize().is_some())
        })?;
        check_items("area", NOT_NEGATIVE, &self.areas, is_number)?;
        check_items("material", POSITIVE, &self.materials, |m| {
            [m.youngs_modulus, m.density, m.strength]
                .iter()
                .flatten()
                .all(is_positive)
        })?;
        check_items("section", POSITIVE, &self.sections, |s| {
            [s.radius_of_gyration, s.second_moment, s.depth]
                .iter()
                .flatten()
                .all(is_positive)
                && s.area.iter().all(is_number)
                && s.shape.is_none_or(SectionShape::is_valid)
        })?;
        let is_fixity = |x: &f64| (0.0..=1.0).contains(x);
        check_items("the fixity of all bars,", FIXITY, [&self.fixity], |x| {
            is_fixity(x)
        })?;
        check_items("the fixity of bar", FIXITY, &self.bar_fixity, |ends| {
            ends.iter().all(is_fixity)
        })
    }

    /// Checks list lengths and that all indices refer to existing entries.
    fn check_indices(&self) -> Result<(), TrussInputError> {
        let bars = self.bars.len();
        for (list, found) in [
            ("areas", self.areas.len()),
            ("colours", self.colours.len()),
            ("bar_materials", self.bar_materials.len()),
            ("bar_sections", self.bar_sections.len()),
            ("bar_fixity", self.bar_fixity.len()),
        ] {
            if found != 0 && found != bars {
                return Err(TrussInputError::PerBar { list, found, bars });
            }
        }
        let nodes = self.nodes.len();
        let bars = self.bars.iter().enumerate();
        let ends = bars.flat_map(|(i, bar)| bar.map(|n| (i, n)));
        check_references("bar", ends, "node", nodes)?;
        let supports = self.supports.iter().map(|s| s.node);
        check_references("support", supports.enumerate(), "node", nodes)?;
        let springs = self.springs.iter().map(|s| s.node);
        check_references("spring", springs.enumerate(), "node", nodes)?;
        for loads in self.lists_of_loads() {
            let loads = loads.iter().map(|l| l.node);
            check_references("load", loads.enumerate(), "node", nodes)?;
        }
        let line_loads = self.load_cases.iter().flat_map(|case| &case.line_loads);
        let loaded = line_loads
            .enumerate()
            .flat_map(|(i, load)| load.bars.iter().map(move |&bar| (i, bar)));
        check_references("line load", loaded, "bar", self.bars.len())?;
        let of_bars = self.bar_sections.iter().copied().enumerate();
        let sections = self.sections.len();
        check_references("the section of bar", of_bars, "section", sections)?;
        let of_bars = self.bar_materials.iter().copied().enumerate();
        let materials = self.materials.len();
        check_references("the material of bar", of_bars, "material", materials)
    }

    /// Checks that bars have a length and are unique.
    fn check_bars(&self) -> Result<(), TrussInputError> {
        let mut seen = HashMap::new();
        for (bar, &[a, b]) in self.bars.iter().enumerate() {
            // Compares positions, not indices: a bar between two nodes at one position has no
            // direction either.
            if self.nodes[a as usize] == self.nodes[b as usize] {
                let nodes = [a, b];
                return Err(TrussInputError::NoLength { bar, nodes });
            }
            // Bars have no direction: [a, b] and [b, a] are the same bar.
            if let Some(first) = seen.insert([a.min(b), a.max(b)], bar) {
                let second = bar;
                return Err(TrussInputError::Duplicate { first, second });
            }
        }
        Ok(())
    }

    /// Checks that every node belongs to a bar.
    fn check_nodes_are_used(&self) -> Result<(), TrussInputError> {
        let mut is_used = vec![false; self.nodes.len()];
        for &node in self.bars.iter().flatten() {
            is_used[node as usize] = true;
        }
        match is_used.iter().position(|&used| !used) {
            Some(node) => Err(TrussInputError::UnusedNode(node)),
            None => Ok(()),
        }
    }

    /// Returns the loads at nodes: those of no load case, then those of each load case.
    fn lists_of_loads(&self) -> impl Iterator<Item = &[TrussLoad]> {
        let of_cases = self.load_cases.iter().map(|case| case.loads.as_slice());
        std::iter::once(self.loads.as_slice()).chain(of_cases)
    }

    /// Checks that each support and each section is described in exactly one way.
    fn check_supports_and_sections(&self) -> Result<(), TrussInputError> {
        let is_valid = |support: &TrussSupport| match support.rolls_along {
            None => true,
            Some(along) => {
                !(support.fixed[0] || support.fixed[1]) && along.try_normalize().is_some()
            }
        };
        if let Some(index) = self.supports.iter().position(|s| !is_valid(s)) {
            return Err(TrussInputError::Rollers(index));
        }
        let is_valid = |section: &TrussSection| {
            let numbers = [section.radius_of_gyration, section.second_moment];
            let needed = match section.shape {
                Some(SectionShape::I) => 1..=1,
                Some(_) => 0..=0,
                None => 0..=1,
            };
            needed.contains(&numbers.iter().flatten().count())
        };
        match self.sections.iter().position(|s| !is_valid(s)) {
            Some(index) => Err(TrussInputError::SectionStiffness(index)),
            None => Ok(()),
        }
    }
}

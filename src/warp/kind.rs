//! The list of warps, with every name and description shown to users.
//!
//! A method is a pair of a warp and a content (solid, field or colours). To add a warp, add a
//! variant to [`WarpKind`], a row to the name table, and a [`WarpLabels`] constant with the texts
//! for each content. The command line, the window and the reports read all their texts from here.

use crate::settings::named;

/// Kind of warp, independent of the content it carries.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum WarpKind {
    /// Identity: nothing moves.
    None,
    /// Boundary vertices on straight or intrinsic paths (Sederberg, Gao, Wang, Mu 1993).
    Paths,
    /// Rigidity-preserving interpolation of compatible triangulations (Alexa, Cohen-Or, Levin
    /// 2000).
    Arap,
    /// Line pairs (Beier, Neely 1992).
    Lines,
    /// Scattered points with radial basis functions (Ruprecht, Müller 1995).
    Scattered,
    /// Multilevel B-spline lattices (Lee, Wolberg, Shin 1997).
    Lattice,
}

named! { WarpKind {
    None: "none", "None", "All points stay where they are.";
    Paths: "paths", "Paths",
        "Each outline vertex moves along its own path, straight or with rotating edges \
         (Sederberg et al. 1993).";
    Arap: "arap", "Rigid",
        "Each part moves as rigidly as possible, so limbs rotate instead of shrinking.";
    Lines: "lines", "Lines", "Line pairs drag the plane along (Beier and Neely 1992).";
    Scattered: "scattered", "Points",
        "Pins drag the plane along, with smooth interpolation between them (radial basis \
         functions).";
    Lattice: "lattice", "Lattice",
        "Pins deform a B-spline grid in increasingly fine levels, without folds.";
} }

impl WarpKind {
    /// All warps, ordered by the conditions that they impose on the designs, from the most to the
    /// fewest.
    pub const BY_DEMAND: [Self; Self::ALL.len()] = [
        Self::Arap,
        Self::Paths,
        Self::Scattered,
        Self::Lines,
        Self::Lattice,
        Self::None,
    ];

    /// Returns whether the warp deforms the whole plane by pins and lines alone, so that it
    /// works with any designs.
    #[must_use]
    pub const fn is_plane_warp(self) -> bool {
        matches!(self, Self::Lines | Self::Scattered | Self::Lattice)
    }

    /// Returns the texts shown for the warp and for each of its contents.
    ///
    /// ```
    /// use morphospace::warp::WarpKind;
    /// assert_eq!(WarpKind::Arap.labels().name, "rigid parts");
    /// assert!(WarpKind::None.labels().solid.is_err());
    /// ```
    #[must_use]
    pub const fn labels(self) -> &'static WarpLabels {
        match self {
            Self::None => &NONE,
            Self::Paths => &PATHS,
            Self::Arap => &ARAP,
            Self::Lines => &LINES,
            Self::Scattered => &SCATTERED,
            Self::Lattice => &LATTICE,
        }
    }
}

/// Texts shown for a warp.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WarpLabels {
    /// Full name in a report; empty for the identity.
    pub name: &'static str,
    /// Texts for solids.
    pub solid: CellSupport,
    /// Texts for distance fields.
    pub field: CellSupport,
    /// Texts for a morph of two pictures.
    pub colours: CellSupport,
}

/// Texts for a warp with one content, or the reason why the two cannot be combined.
pub type CellSupport = Result<CellLabels, &'static str>;

/// Texts shown for a warp with one content.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CellLabels {
    /// Name in running text, in lower case.
    pub name: &'static str,
    /// Label of the button that selects the method, unique among all methods.
    pub button: &'static str,
    /// Row title in a table of measurements.
    pub report: &'static str,
    /// Description in one or two sentences.
    pub sentence: &'static str,
}

/// Reason why a plane warp cannot carry solids.
const NOTHING_TO_LOOK_UP: &str = "this warp distorts a picture of the plane, and a solid has no picture; choose fields or colours, or rigid parts (arap)";

/// Reason why boundary paths can only carry solids.
const NOTHING_INSIDE: &str = "this warp moves outlines but nothing inside them; choose solids, or rigid parts (arap) to carry fields and colours";

/// Returns the texts for a distance field carried by a warp.
const fn carried_field(
    name: &'static str,
    button: &'static str,
    report: &'static str,
) -> CellLabels {
    CellLabels {
        name,
        button,
        report,
        sentence: "Distance fields move with the warp, so parts travel instead of dissolving. \
                   Without pins, outlines are matched and pinned automatically.",
    }
}

/// Returns the texts for a morph of two pictures carried by a warp.
const fn morph(name: &'static str, button: &'static str, report: &'static str) -> CellLabels {
    CellLabels {
        name,
        button,
        report,
        sentence: "Aligns matching features while one picture fades into the other. Place pins \
                   or lines on eyes, corners and edges (key E).",
    }
}

/// Texts for [`WarpKind::None`].
const NONE: WarpLabels = WarpLabels {
    name: "",
    solid: Err("a solid can only change by moving, so it needs a warp; choose rigid parts (arap)"),
    field: Ok(CellLabels {
        name: "field blend",
        button: "Blend",
        report: "field",
        sentence: "Blends each point's distances to the two outlines. Works for any shapes and \
                   holes, but parts that move dissolve and regrow instead of rotating.",
    }),
    colours: Ok(CellLabels {
        name: "cross-dissolve",
        button: "Dissolve",
        report: "dissolve",
        sentence: "Fades one picture into the other, in linear light. Nothing moves.",
    }),
};

/// Texts for [`WarpKind::Arap`].
const ARAP: WarpLabels = WarpLabels {
    name: "rigid parts",
    solid: Ok(CellLabels {
        name: "rigid parts",
        button: "Rigid parts",
        report: "arap",
        sentence: "Rotates and stretches each triangle evenly, then joins them by least squares. \
                   Parts keep their shape while they move. Outlines are matched automatically.",
    }),
    field: Ok(carried_field(
        "carried field (rigid parts)",
        "Carried by rigid parts",
        "arap warp",
    )),
    colours: Ok(morph(
        "morph (rigid parts)",
        "Morph by rigid parts",
        "arap warp",
    )),
};

/// Texts for [`WarpKind::Paths`].
const PATHS: WarpLabels = WarpLabels {
    name: "boundary paths",
    solid: Ok(CellLabels {
        name: "boundary paths",
        button: "Outlines",
        report: "paths",
        sentence: "Moves the vertices of matched outlines and nothing inside them, either straight \
                   or so that edges rotate and keep their lengths. Outlines may cross themselves.",
    }),
    field: Err(NOTHING_INSIDE),
    colours: Err(NOTHING_INSIDE),
};

/// Texts for [`WarpKind::Lines`].
const LINES: WarpLabels = WarpLabels {
    name: "line pairs",
    solid: Err(NOTHING_TO_LOOK_UP),
    field: Ok(carried_field(
        "carried field (lines)",
        "Carried by lines",
        "lines",
    )),
    colours: Ok(morph("morph (lines)", "Morph by lines", "lines")),
};

/// Texts for [`WarpKind::Scattered`].
const SCATTERED: WarpLabels = WarpLabels {
    name: "scattered points",
    solid: Err(NOTHING_TO_LOOK_UP),
    field: Ok(carried_field(
        "carried field (points)",
        "Carried by points",
        "scattered",
    )),
    colours: Ok(morph("morph (points)", "Morph by points", "scattered")),
};

/// Texts for [`WarpKind::Lattice`].
const LATTICE: WarpLabels = WarpLabels {
    name: "B-spline lattices",
    solid: Err(NOTHING_TO_LOOK_UP),
    field: Ok(carried_field(
        "carried field (lattice)",
        "Carried by lattice",
        "lattice",
    )),
    colours: Ok(morph("morph (lattice)", "Morph by lattice", "lattice")),
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_orders_list_every_warp_once() {
        for warp in WarpKind::ALL {
            let entries = WarpKind::BY_DEMAND.iter().filter(|other| **other == warp);
            assert_eq!(entries.count(), 1, "{warp:?}");
        }
    }

    #[test]
    fn no_two_methods_have_the_same_button() {
        let cells = WarpKind::ALL.map(WarpKind::labels);
        let cells = cells.map(|warp| [warp.solid, warp.field, warp.colours]);
        let mut buttons: Vec<&str> = cells
            .as_flattened()
            .iter()
            .filter_map(|cell| Some(cell.ok()?.button))
            .collect();
        let count = buttons.len();
        buttons.sort_unstable();
        buttons.dedup();
        assert_eq!(buttons.len(), count, "{buttons:?}");
    }
}

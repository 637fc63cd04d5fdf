//! The rows of the table, and all that is said of each wherever a warp is
//! offered, listed or reported.
//!
//! A new warp is a variant of [`WarpKind`] with its row of names, and a
//! constant of [`WarpLabels`] here; command line, window, reports and the table of
//! cells read it from there. Warps know nothing of contents, so a column is
//! named by a field.

use crate::settings::choice::named;

/// Which warp: a row of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum WarpKind {
    /// Nothing moves.
    None,
    /// Boundary points on straight or intrinsic paths (Sederberg, Gao, Wang,
    /// Mu 1993).
    Paths,
    /// Rigidity-preserving interpolation of compatible triangulations.
    Arap,
    /// Pairs of lines (Beier, Neely 1992).
    Lines,
    /// Scattered points, by radial basis functions.
    Scattered,
    /// B-spline lattices.
    Lattice,
}

named! { WarpKind {
    None: "none", "Still", "Nothing moves: each point stays where it is.";
    Paths: "paths", "Paths",
        "Points of the outline move on paths of their own, straight or so that its edges turn \
         (Sederberg and others 1993).";
    Arap: "arap", "Rigid", "Each part moves as rigidly as it can: limbs turn instead of shrinking.";
    Lines: "lines", "Lines", "Pairs of lines pull the plane along (Beier and Neely 1992).";
    Scattered: "scattered", "Points",
        "Pins pull the plane along, smoothly between them (radial basis functions).";
    Lattice: "lattice", "Lattice", "Pins bend a grid of splines, finer and finer, without folds.";
} }

impl WarpKind {
    /// All of them, those that ask least of the designs last.
    pub const BY_DEMAND: [Self; Self::ALL.len()] = [
        Self::Arap,
        Self::Paths,
        Self::Scattered,
        Self::Lines,
        Self::Lattice,
        Self::None,
    ];

    /// Whether it moves the whole plane by pins and lines, whatever the
    /// designs are.
    #[must_use]
    pub const fn is_of_the_plane(self) -> bool {
        matches!(self, Self::Lines | Self::Scattered | Self::Lattice)
    }

    /// What is said of it.
    ///
    /// ```
    /// use morphospace::warp::WarpKind;
    /// assert_eq!(WarpKind::Arap.words().name, "rigid parts");
    /// assert!(WarpKind::None.words().solid.is_err());
    /// ```
    #[must_use]
    pub const fn words(self) -> &'static WarpLabels {
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

/// What is said of a warp.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WarpLabels {
    /// Its name in a report, in full; of no warp nothing is said.
    pub name: &'static str,
    /// With solids.
    pub solid: CellSupport,
    /// With distance fields.
    pub field: CellSupport,
    /// With two pictures.
    pub colours: CellSupport,
}

/// What is said of a warp with one content, or why they do not go together.
pub type CellSupport = Result<CellLabels, &'static str>;

/// What is said of a warp with one content.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CellLabels {
    /// What it is called, in a few words.
    pub name: &'static str,
    /// What it is called on a button, beside the title of its row.
    pub button: &'static str,
    /// What it is called in a table of measures.
    pub report: &'static str,
    /// What it does, in a sentence or two.
    pub sentence: &'static str,
}

/// Why a warp of the plane does not go with solids.
const NOTHING_TO_LOOK_UP: &str = "this warp says where to look in the designs, and a solid has nothing to look up; choose fields or colours, or rigid parts (arap)";

/// Why boundary paths go with solids only.
const NOTHING_INSIDE: &str = "this warp moves the points of an outline and nothing inside it; choose solids, or rigid parts (arap) to carry fields and colours";

/// A field that a warp carries.
const fn carried_field(name: &'static str, report: &'static str) -> CellLabels {
    CellLabels {
        name,
        button: "Carried field",
        report,
        sentence: "Distance fields that travel with the warp: parts move instead of dissolving. \
                   Where nothing is pinned, the outlines are matched and pinned by themselves.",
    }
}

/// Two pictures that a warp carries.
const fn morph(name: &'static str, report: &'static str) -> CellLabels {
    CellLabels {
        name,
        button: "Morph",
        report,
        sentence: "Moves what belongs together onto each other while one picture fades into the \
                   other. Set pins, or lines, on eyes, corners and edges (key E).",
    }
}

const NONE: WarpLabels = WarpLabels {
    name: "",
    solid: Err("a solid changes by moving, so it needs a warp; choose rigid parts (arap)"),
    field: Ok(CellLabels {
        name: "field blend",
        button: "Blend",
        report: "field",
        sentence: "Blends how far each point lies from the two outlines. Any shapes, with holes; \
                   parts that move grow out of each other instead of turning.",
    }),
    colours: Ok(CellLabels {
        name: "cross-dissolve",
        button: "Dissolve",
        report: "dissolve",
        sentence: "Fades one picture into the other, in linear light. Nothing moves.",
    }),
};

const ARAP: WarpLabels = WarpLabels {
    name: "rigid parts",
    solid: Ok(CellLabels {
        name: "rigid parts",
        button: "Rigid parts",
        report: "arap",
        sentence: "Turns and stretches each triangle evenly and joins them again. Parts keep \
                   their form while they move; outlines are matched by themselves.",
    }),
    field: Ok(carried_field("fields by rigid parts", "arap warp")),
    colours: Ok(morph("pictures by rigid parts", "arap warp")),
};

const PATHS: WarpLabels = WarpLabels {
    name: "boundary paths",
    solid: Ok(CellLabels {
        name: "boundary paths",
        button: "Outlines",
        report: "paths",
        sentence: "Moves the points of matched outlines and nothing inside: straight, or so that \
                   edges turn and keep their lengths. The outline may cross itself.",
    }),
    field: Err(NOTHING_INSIDE),
    colours: Err(NOTHING_INSIDE),
};

const LINES: WarpLabels = WarpLabels {
    name: "pairs of lines",
    solid: Err(NOTHING_TO_LOOK_UP),
    field: Ok(carried_field("fields by lines", "lines")),
    colours: Ok(morph("pictures by lines", "lines")),
};

const SCATTERED: WarpLabels = WarpLabels {
    name: "scattered points",
    solid: Err(NOTHING_TO_LOOK_UP),
    field: Ok(carried_field("fields by scattered points", "scattered")),
    colours: Ok(morph("pictures by scattered points", "scattered")),
};

const LATTICE: WarpLabels = WarpLabels {
    name: "B-spline lattices",
    solid: Err(NOTHING_TO_LOOK_UP),
    field: Ok(carried_field("fields by lattices", "lattice")),
    colours: Ok(morph("pictures by lattices", "lattice")),
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_orders_have_every_warp_once() {
        for warp in WarpKind::ALL {
            let places = WarpKind::BY_DEMAND.iter().filter(|other| **other == warp);
            assert_eq!(places.count(), 1, "{warp:?}");
        }
    }
}

//! The rows of the table, and all that is said of each wherever a warp is
//! offered, listed or reported.
//!
//! A new warp is a variant of [`WarpKind`] and a constant of [`Words`] here;
//! command line, window, reports and the table of cells read it from there.
//! Warps know nothing of contents, so a column is named by a field.

use serde::{Deserialize, Serialize};

/// Which warp: a row of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
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

/// How many warps there are.
const COUNT: usize = WarpKind::ALL.len();

impl WarpKind {
    /// All of them, in the order of the table.
    pub const ALL: [Self; 6] = [
        Self::None,
        Self::Paths,
        Self::Arap,
        Self::Lines,
        Self::Scattered,
        Self::Lattice,
    ];

    /// All of them, those that ask least of the designs last.
    pub const BY_DEMAND: [Self; COUNT] = [
        Self::Arap,
        Self::Paths,
        Self::Scattered,
        Self::Lines,
        Self::Lattice,
        Self::None,
    ];

    /// Their names in files and on the command line, in the order of the
    /// table.
    pub const KEYS: [&'static str; COUNT] = {
        let mut keys = [""; COUNT];
        let mut k = 0;
        while k < COUNT {
            keys[k] = Self::ALL[k].words().key;
            k += 1;
        }
        keys
    };

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
    /// assert_eq!(WarpKind::Arap.words().key, "arap");
    /// assert!(WarpKind::None.words().solid.is_err());
    /// ```
    #[must_use]
    pub const fn words(self) -> &'static Words {
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
pub struct Words {
    /// Its name in files and on the command line.
    pub key: &'static str,
    /// Its name in a report, in full; of no warp nothing is said.
    pub name: &'static str,
    /// Its name at the head of a row, one word.
    pub title: &'static str,
    /// What it does, in one sentence.
    pub sentence: &'static str,
    /// With solids.
    pub solid: Column,
    /// With distance fields.
    pub field: Column,
    /// With two pictures.
    pub colours: Column,
}

/// What is said of a warp with one content, or why they do not go together.
pub type Column = Result<CellWords, &'static str>;

/// What is said of a warp with one content.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CellWords {
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
const fn carried_field(name: &'static str, report: &'static str) -> CellWords {
    CellWords {
        name,
        button: "Carried field",
        report,
        sentence: "Distance fields that travel with the warp: parts move instead of dissolving. \
                   Where nothing is pinned, the outlines are matched and pinned by themselves.",
    }
}

/// Two pictures that a warp carries.
const fn morph(name: &'static str, report: &'static str) -> CellWords {
    CellWords {
        name,
        button: "Morph",
        report,
        sentence: "Moves what belongs together onto each other while one picture fades into the \
                   other. Set pins, or lines, on eyes, corners and edges (key E).",
    }
}

const NONE: Words = Words {
    key: "none",
    name: "",
    title: "Still",
    sentence: "Nothing moves: each point stays where it is.",
    solid: Err("a solid changes by moving, so it needs a warp; choose rigid parts (arap)"),
    field: Ok(CellWords {
        name: "field blend",
        button: "Blend",
        report: "field",
        sentence: "Blends how far each point lies from the two outlines. Any shapes, with holes; \
                   parts that move grow out of each other instead of turning.",
    }),
    colours: Ok(CellWords {
        name: "cross-dissolve",
        button: "Dissolve",
        report: "dissolve",
        sentence: "Fades one picture into the other, in linear light. Nothing moves.",
    }),
};

const ARAP: Words = Words {
    key: "arap",
    name: "rigid parts",
    title: "Rigid",
    sentence: "Each part moves as rigidly as it can: limbs turn instead of shrinking.",
    solid: Ok(CellWords {
        name: "rigid parts",
        button: "Rigid parts",
        report: "arap",
        sentence: "Turns and stretches each triangle evenly and joins them again. Parts keep \
                   their form while they move; outlines are matched by themselves.",
    }),
    field: Ok(carried_field("fields by rigid parts", "arap warp")),
    colours: Ok(morph("pictures by rigid parts", "arap warp")),
};

const PATHS: Words = Words {
    key: "paths",
    name: "boundary paths",
    title: "Paths",
    sentence: "Points of the outline move on paths of their own, straight or so that its edges \
               turn (Sederberg and others 1993).",
    solid: Ok(CellWords {
        name: "boundary paths",
        button: "Outlines",
        report: "paths",
        sentence: "Moves the points of matched outlines and nothing inside: straight, or so that \
                   edges turn and keep their lengths. The outline may cross itself.",
    }),
    field: Err(NOTHING_INSIDE),
    colours: Err(NOTHING_INSIDE),
};

const LINES: Words = Words {
    key: "lines",
    name: "pairs of lines",
    title: "Lines",
    sentence: "Pairs of lines pull the plane along (Beier and Neely 1992).",
    solid: Err(NOTHING_TO_LOOK_UP),
    field: Ok(carried_field("fields by lines", "lines")),
    colours: Ok(morph("pictures by lines", "lines")),
};

const SCATTERED: Words = Words {
    key: "scattered",
    name: "scattered points",
    title: "Points",
    sentence: "Pins pull the plane along, smoothly between them (radial basis functions).",
    solid: Err(NOTHING_TO_LOOK_UP),
    field: Ok(carried_field("fields by scattered points", "scattered")),
    colours: Ok(morph("pictures by scattered points", "scattered")),
};

const LATTICE: Words = Words {
    key: "lattice",
    name: "B-spline lattices",
    title: "Lattice",
    sentence: "Pins bend a grid of splines, finer and finer, without folds.",
    solid: Err(NOTHING_TO_LOOK_UP),
    field: Ok(carried_field("fields by lattices", "lattice")),
    colours: Ok(morph("pictures by lattices", "lattice")),
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_those_of_the_file() {
        for (warp, key) in WarpKind::ALL.into_iter().zip(WarpKind::KEYS) {
            assert_eq!(serde_json::to_value(warp).expect("written"), key);
        }
    }

    #[test]
    fn both_orders_have_every_warp_once() {
        for warp in WarpKind::ALL {
            let places = WarpKind::BY_DEMAND.iter().filter(|other| **other == warp);
            assert_eq!(places.count(), 1, "{warp:?}");
        }
    }
}

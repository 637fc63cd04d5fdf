//! Contents: what is seen at a material point, a file for each column of the
//! table of cells. A content reads placements and knows nothing of warps.

mod field;

pub use field::{BlendSpace, FieldBlend, FieldPair, FieldPairError};

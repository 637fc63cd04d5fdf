//! Edges of triangles as pairs of vertex indices.

/// Returns the three edges of a face, each from a corner to the next.
pub(crate) fn sides([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

/// Returns an edge in a form that does not depend on its direction: the smaller vertex index first.
pub(crate) fn undirected([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

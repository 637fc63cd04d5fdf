//! The edges of faces, by their vertices.

/// The sides of a face, each from its corner to the next one.
pub(crate) fn sides([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

/// An edge whichever way it is run: its smaller vertex first.
pub(crate) fn undirected([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

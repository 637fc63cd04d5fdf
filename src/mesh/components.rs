//! Finds the connected components of a graph by disjoint sets with path halving.

/// Returns for each vertex of a graph with the edges `links` the index of its connected component.
/// Components are numbered from 0 in the order of their first vertices. Takes almost linear time.
///
/// ```
/// use morphospace::mesh::components;
/// assert_eq!(components(4, [[2, 0], [3, 1]]), [0, 1, 0, 1]);
/// ```
///
/// # Panics
/// If a link names a vertex that does not exist.
#[must_use]
pub fn components(vertices: usize, links: impl IntoIterator<Item = [u32; 2]>) -> Vec<u32> {
    let mut parent: Vec<u32> = (0..vertices as u32).collect();
    for [a, b] in links {
        let (a, b) = (root(&mut parent, a), root(&mut parent, b));
        parent[a.max(b) as usize] = a.min(b);
    }
    let mut number = vec![u32::MAX; vertices];
    let mut count = 0;
    (0..vertices as u32)
        .map(|v| {
            let number = &mut number[root(&mut parent, v) as usize];
            if *number == u32::MAX {
                *number = count;
                count += 1;
            }
            *number
        })
        .collect()
}

/// Returns the representative of the set that contains `v`, and halves the path to it.
fn root(parent: &mut [u32], mut v: u32) -> u32 {
    while parent[v as usize] != v {
        parent[v as usize] = parent[parent[v as usize] as usize];
        v = parent[v as usize];
    }
    v
}

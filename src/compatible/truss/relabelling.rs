//! Correspondence of the nodes of two trusses that are the same graph but number their nodes
//! differently.
//!
//! Nodes are distinguished by the numbers of their neighbours, of the neighbours of these and so on
//! (colour refinement; Weisfeiler and Leman 1968). Among the correspondences under which both
//! trusses have the same bars, a backtracking search finds the one whose nodes have the least sum
//! of squared distances, after both trusses are moved to the same centroid and scaled to the same
//! spread. The search is limited; then the best one so far is taken.

use crate::design::Truss;
use crate::geometry::DVec2;
use std::collections::BTreeMap;

/// Maximum number of candidates that the search examines (resource limit: less than a second).
const MAX_CANDIDATES: usize = 1_000_000;

/// Returns for each node of the source the node of the target that corresponds to it; `None` if the
/// trusses are different graphs, or none was found within the limit.
pub(crate) fn corresponding_nodes(source: &Truss, target: &Truss) -> Option<Vec<u32>> {
    let is_equal = |count: fn(&Truss) -> usize| count(source) == count(target);
    if !is_equal(|truss| truss.nodes().len()) || !is_equal(|truss| truss.bars().len()) {
        return None;
    }
    let graphs = [source, target].map(TrussGraph::of);
    let classes = refined_classes(&graphs);
    let [of_source, of_target] = classes.each_ref().map(|classes| {
        let mut sorted = classes.clone();
        sorted.sort_unstable();
        sorted
    });
    if of_source != of_target {
        return None;
    }
    NodeSearch::new(&graphs, classes).run()
}

/// Nodes of a truss with their neighbours and normalised positions.
struct TrussGraph {
    neighbours: Vec<Vec<usize>>,
    places: Vec<DVec2>,
}

impl TrussGraph {
    fn of(truss: &Truss) -> Self {
        let nodes = truss.nodes();
        let count = nodes.len() as f64;
        let centroid = nodes.iter().sum::<DVec2>() / count;
        let spread = nodes.iter().map(|p| p.distance_squared(centroid));
        let spread = (spread.sum::<f64>() / count).sqrt().max(f64::MIN_POSITIVE);
        let mut neighbours = vec![Vec::new(); nodes.len()];
        for &[a, b] in truss.bars() {
            neighbours[a as usize].push(b as usize);
            neighbours[b as usize].push(a as usize);
        }
        for list in &mut neighbours {
            list.sort_unstable();
        }
        Self {
            neighbours,
            places: nodes.iter().map(|p| (*p - centroid) / spread).collect(),
        }
    }

    fn has_bar(&self, a: usize, b: usize) -> bool {
        self.neighbours[a].binary_search(&b).is_ok()
    }
}

/// Returns a class for each node of both graphs; corresponding nodes have the same class.
fn refined_classes(graphs: &[TrussGraph; 2]) -> [Vec<usize>; 2] {
    let mut classes = graphs.each_ref().map(|graph| vec![0; graph.places.len()]);
    let mut count = 1;
    loop {
        let mut numbers = BTreeMap::new();
        let signature = |k: usize, node: usize| {
            let mut around: Vec<usize> = (graphs[k].neighbours[node].iter())
                .map(|&other| classes[k][other])
                .collect();
            around.sort_unstable();
            (classes[k][node], around)
        };
        let signatures = [0, 1].map(|k| {
            let nodes = 0..graphs[k].places.len();
            nodes.map(|node| signature(k, node)).collect::<Vec<_>>()
        });
        for signature in signatures.iter().flatten() {
            let next = numbers.len();
            numbers.entry(signature.clone()).or_insert(next);
        }
        classes = signatures.map(|list| list.iter().map(|one| numbers[one]).collect());
        if numbers.len() == count {
            return classes;
        }
        count = numbers.len();
    }
}

/// Search for the correspondence with the least sum of squared distances.
struct NodeSearch<'g> {
    graphs: &'g [TrussGraph; 2],
    /// Nodes of the target by class.
    members: Vec<Vec<usize>>,
    classes: [Vec<usize>; 2],
    /// Nodes of the source in the order in which they are matched: where possible, each has a
    /// neighbour before it.
    order: Vec<usize>,
    /// For each position in `order`, the least possible cost of the nodes from there on.
    rest: Vec<f64>,
    /// For each node of the source, its node of the target so far.
    image: Vec<Option<usize>>,
    is_used: Vec<bool>,
    examined: usize,
}

/// Position in `order` with the candidates for its node that are still to be tried.
struct SearchStep {
    /// Candidates with their costs, the nearest last.
    candidates: Vec<(f64, usize)>,
    /// Sum of the costs of the nodes before.
    cost: f64,
}

impl<'g> NodeSearch<'g> {
    fn new(graphs: &'g [TrussGraph; 2], classes: [Vec<usize>; 2]) -> Self {
        let count = graphs[0].places.len();
        let mut members = vec![Vec::new(); 1 + classes[1].iter().max().copied().unwrap_or(0)];
        for (node, &class) in classes[1].iter().enumerate() {
            members[class].push(node);
        }
        let order = search_order(&graphs[0], |node| members[classes[0][node]].len());
        let mut search = Self {
            graphs,
            members,
            classes,
            order,
            rest: vec![0.0; count + 1],
            image: vec![None; count],
            is_used: vec![false; count],
            examined: 0,
        };
        for k in (0..count).rev() {
            let node = search.order[k];
            let costs = search.members[search.classes[0][node]].iter();
            let costs = costs.map(|&other| search.cost(node, other));
            search.rest[k] = search.rest[k + 1] + costs.fold(f64::INFINITY, f64::min);
        }
        search
    }

    fn cost(&self, node: usize, other: usize) -> f64 {
        self.graphs[0].places[node].distance_squared(self.graphs[1].places[other])
    }

    /// Returns the candidates for the node at a position, the nearest last.
    fn step(&mut self, position: usize, cost: f64) -> SearchStep {
        let node = self.order[position];
        let class = self.classes[0][node];
        let matched = |&other: &usize| self.image[other];
        let images: Vec<usize> = (self.graphs[0].neighbours[node].iter())
            .filter_map(matched)
            .collect();
        let pool = match images.first() {
            Some(&image) => &self.graphs[1].neighbours[image],
            None => &self.members[class],
        };
        self.examined += pool.len();
        let is_candidate = |&&other: &&usize| {
            let joins_all = || {
                images
                    .iter()
                    .all(|&image| self.graphs[1].has_bar(image, other))
            };
            !self.is_used[other] && self.classes[1][other] == class && joins_all()
        };
        let candidates = pool.iter().filter(is_candidate);
        let mut candidates: Vec<(f64, usize)> = candidates
            .map(|&other| (self.cost(node, other), other))
            .collect();
        candidates.sort_by(|a, b| b.0.total_cmp(&a.0));
        SearchStep { candidates, cost }
    }

    fn run(mut self) -> Option<Vec<u32>> {
        let count = self.order.len();
        let mut best: Option<(f64, Vec<Option<usize>>)> = None;
        let mut steps = vec![self.step(0, 0.0)];
        while let Some(position) = steps.len().checked_sub(1) {
            let node = self.order[position];
            if let Some(last) = self.image[node].take() {
                self.is_used[last] = false;
            }
            let step = &mut steps[position];
            let bound = best.as_ref().map_or(f64::INFINITY, |best| best.0);
            let next = step
                .candidates
                .pop()
                .filter(|(cost, _)| step.cost + cost + self.rest[position + 1] < bound);
            // Farther candidates cost more.
            let Some((cost, other)) = next.filter(|_| self.examined <= MAX_CANDIDATES) else {
                steps.pop();
                continue;
            };
            let cost = step.cost + cost;
            self.image[node] = Some(other);
            self.is_used[other] = true;
            if position + 1 == count {
                best = Some((cost, self.image.clone()));
            } else {
                let step = self.step(position + 1, cost);
                steps.push(step);
            }
        }
        let (_, image) = best?;
        image.into_iter().map(|node| Some(node? as u32)).collect()
    }
}

/// Returns the nodes of a graph so that each follows one of its neighbours, if it has any before
/// it. Each connected component begins with a node of the smallest class; `class_size` returns the
/// size of the class of a node.
fn search_order(graph: &TrussGraph, class_size: impl Fn(usize) -> usize) -> Vec<usize> {
    let mut starts: Vec<usize> = (0..graph.places.len()).collect();
    starts.sort_by_key(|&node| class_size(node));
    let mut is_listed = vec![false; starts.len()];
    let mut order = Vec::with_capacity(starts.len());
    for start in starts {
        if std::mem::replace(&mut is_listed[start], true) {
            continue;
        }
        let mut next = order.len();
        order.push(start);
        while let Some(&node) = order.get(next) {
            next += 1;
            for &other in &graph.neighbours[node] {
                if !std::mem::replace(&mut is_listed[other], true) {
                    order.push(other);
                }
            }
        }
    }
    order
}

//! A project of many designs as projects of two: one for each leg of the way.
//!
//! What is said of points of two designs, and what was found for them, belongs to the
//! leg between them; all else is said once for the whole. A pair has one leg, and its
//! document has no list of legs: it stays what it was before there were sequences.
//!
//! Where the film goes along a path over the map, its legs are the ways between the stops of
//! that, and all is said once; what is said of two designs stays with these meanwhile.
//!
//! Guaranteed: a leg that is taken out and put back unchanged changes nothing; when
//! designs change places, what belongs to two that stay neighbours stays with them.

use super::document::{DesignEntry, Project};
use super::map::MapSettings;
use super::segment_settings::SegmentRecord;
use crate::geometry::DVec2;
use crate::space::MapPath;
use crate::transition::{CachedMatch, TransitionStop};

/// A design with the number that it had before, where it was there before.
pub type MovedDesigns = (DesignEntry, Option<usize>);

impl Project {
    /// How many transitions there are: one from design to design, or from stop to stop of
    /// the path over the map.
    #[must_use]
    pub fn leg_count(&self) -> usize {
        match self.follows_path() {
            true => self.map.path.leg_count(),
            false => self.pair_count(),
        }
    }

    /// How many ways from one design to the next there are: one less than designs, or as
    /// many where the last leads back to the first.
    #[must_use]
    pub fn pair_count(&self) -> usize {
        let back = usize::from(self.closed);
        (self.designs.len() + back).saturating_sub(1).max(1)
    }

    /// Whether the film goes along a path over the map.
    #[must_use]
    pub fn follows_path(&self) -> bool {
        !self.map.path.is_none()
    }

    /// Whether the film ends where it begins.
    #[must_use]
    pub fn leads_back(&self) -> bool {
        let places = &self.map.path.places;
        match self.follows_path() {
            true => places.first().map(|p| p.at) == places.last().map(|p| p.at),
            false => self.closed,
        }
    }

    /// Whether there is more than one way from a design to the next.
    #[must_use]
    pub fn is_sequence(&self) -> bool {
        self.pair_count() > 1
    }

    /// The numbers of the two designs of a leg; of a path, which goes between all, of the
    /// first and the last.
    #[must_use]
    pub fn leg_designs(&self, leg: usize) -> [usize; 2] {
        match self.follows_path() {
            true => [0, self.designs.len().saturating_sub(1)],
            false => self.pair_designs(leg),
        }
    }

    /// The numbers of the two designs of a way from one to the next.
    #[must_use]
    pub fn pair_designs(&self, pair: usize) -> [usize; 2] {
        [pair, pair + 1].map(|design| design % self.designs.len().max(1))
    }

    /// The project of a leg alone: two designs, and all that is said of them. Its times
    /// and stops are those of the whole. A leg of a path has all designs.
    #[must_use]
    pub fn leg(&self, leg: usize) -> Self {
        match self.follows_path() {
            true => self.clone(),
            false => self.pair_alone(leg),
        }
    }

    /// As [`Self::leg`], of a way from one design to the next.
    #[must_use]
    pub fn pair_alone(&self, leg: usize) -> Self {
        if !self.is_sequence() {
            return self.clone();
        }
        let mut alone = self.clone();
        let designs = self.pair_designs(leg);
        alone.designs = designs.map(|k| self.designs[k].clone()).to_vec();
        (alone.legs, alone.closed) = (Vec::new(), false);
        alone.map = MapSettings::default();
        alone.hold(self.legs.get(leg).cloned().unwrap_or_default());
        alone
    }

    /// Takes a leg back as [`Self::leg`] gave it, with what was changed since.
    pub fn take_leg(&mut self, leg: usize, changed: Self) {
        match self.follows_path() {
            true => *self = changed,
            false => self.take_pair(leg, changed),
        }
    }

    /// As [`Self::take_leg`], of a way from one design to the next.
    pub fn take_pair(&mut self, leg: usize, mut changed: Self) {
        if !self.is_sequence() {
            *self = changed;
            return;
        }
        let own = changed.let_go();
        let mut designs = std::mem::take(&mut self.designs);
        for (k, entry) in self.leg_designs_of(leg, designs.len()).zip(changed.designs) {
            designs[k] = entry;
        }
        let mut legs = std::mem::take(&mut self.legs);
        if legs.len() <= leg {
            legs.resize_with(leg + 1, SegmentRecord::default);
        }
        legs[leg] = own;
        *self = Self {
            designs,
            closed: self.closed,
            map: std::mem::take(&mut self.map),
            ..changed
        };
        self.put_legs(legs);
    }

    fn leg_designs_of(&self, leg: usize, designs: usize) -> impl Iterator<Item = usize> + use<> {
        [leg, leg + 1].into_iter().map(move |k| k % designs.max(1))
    }

    /// Other designs, or the same in another order. What is said of two that stay
    /// neighbours stays, stops go with their designs, and a pass through all goes on
    /// through all. Nothing happens where fewer than two are left.
    pub fn rearrange(&mut self, designs: Vec<MovedDesigns>) {
        self.rearranged(designs, self.closed);
    }

    /// The designs with their numbers, as [`Self::rearrange`] takes them.
    #[must_use]
    pub fn in_order(&self) -> Vec<MovedDesigns> {
        let designs = self.designs.iter().cloned().enumerate();
        designs.map(|(k, entry)| (entry, Some(k))).collect()
    }

    /// As [`Self::in_order`], with design `k` before the one that is at `place`, or behind all;
    /// none where that is where it is.
    #[must_use]
    pub fn with_moved(&self, k: usize, place: usize) -> Option<Vec<MovedDesigns>> {
        let to = if place > k { place - 1 } else { place };
        if to == k {
            return None;
        }
        let mut order = self.in_order();
        let design = order.remove(k);
        order.insert(to, design);
        Some(order)
    }

    /// As [`Self::in_order`], with design `k` once more behind itself.
    #[must_use]
    pub fn with_repeated(&self, k: usize) -> Vec<MovedDesigns> {
        let mut order = self.in_order();
        order.insert(k + 1, (order[k].0.clone(), None));
        order
    }

    /// As [`Self::in_order`], without design `k`.
    #[must_use]
    pub fn without(&self, k: usize) -> Vec<MovedDesigns> {
        let mut order = self.in_order();
        order.remove(k);
        order
    }

    /// Whether the last design leads back to the first.
    pub fn close(&mut self, closed: bool) {
        self.rearranged(self.in_order(), closed);
    }

    fn rearranged(&mut self, designs: Vec<MovedDesigns>, closed: bool) {
        if designs.len() < 2 {
            return;
        }
        let old = self.clone();
        let (entries, origins): (Vec<_>, Vec<_>) = designs.into_iter().unzip();
        (self.designs, self.closed) = (entries, closed);
        let from_leg = |leg: usize| {
            let [a, b] = self.pair_designs(leg).map(|k| origins[k]);
            (0..old.pair_count()).find(|&k| old.pair_designs(k).map(Some) == [a, b])
        };
        let sources: Vec<Option<usize>> = (0..self.pair_count()).map(from_leg).collect();
        let legs = sources.iter();
        // What is said of no points, as how holes are treated, holds for new legs as well.
        let new = || SegmentRecord {
            matching: old.pair_alone(0).options.matching.without_places(),
            ..SegmentRecord::default()
        };
        let legs = legs.map(|&leg| leg.map_or_else(new, |leg| old.leg_settings(leg)));
        let legs = legs.collect();
        (self.options.matching, self.options.parts) = Default::default();
        self.found = CachedMatch::default();
        self.put_legs(legs);
        self.map.sites = moved_sites(&old.map.sites, &origins);
        if self.follows_path() {
            // Its times are not the designs'.
            return;
        }
        self.stops = moved_stops(&old, &origins, &sources);
        let (before, now) = (old.leg_count() as f64, self.leg_count() as f64);
        if (old.timing.from, old.timing.to) == (0.0, before) {
            self.timing.to = now;
            self.timing.duration_secs *= now / before;
        } else {
            // A pass may end at a design that is gone.
            let timing = &mut self.timing;
            (timing.from, timing.to) = (timing.from.min(now), timing.to.min(now));
            if timing.from == timing.to {
                (timing.from, timing.to) = (0.0, now);
            }
        }
    }

    /// What is said of a leg.
    fn leg_settings(&self, leg: usize) -> SegmentRecord {
        self.pair_alone(leg).let_go()
    }

    /// What a pair says of its leg, taken out of it.
    pub(super) fn let_go(&mut self) -> SegmentRecord {
        SegmentRecord {
            matching: std::mem::take(&mut self.options.matching),
            parts: std::mem::take(&mut self.options.parts),
            found: std::mem::take(&mut self.found),
        }
    }

    /// As a pair, says this of its leg.
    fn hold(&mut self, leg: SegmentRecord) {
        (self.options.matching, self.options.parts, self.found) =
            (leg.matching, leg.parts, leg.found);
    }

    /// Says this of its legs: of a pair where a pair says it.
    pub(super) fn put_legs(&mut self, mut legs: Vec<SegmentRecord>) {
        if !self.is_sequence() {
            let only = legs.into_iter().next();
            self.legs = Vec::new();
            return self.hold(only.unwrap_or_default());
        }
        let is_bare = |leg: &SegmentRecord| *leg == SegmentRecord::default() && leg.found.is_none();
        while legs.last().is_some_and(is_bare) {
            legs.pop();
        }
        self.legs = legs;
    }

    /// Keeps what was found for a leg.
    pub fn keep_found(&mut self, leg: usize, found: CachedMatch) {
        if !self.is_sequence() {
            self.found = found;
            return;
        }
        if self.legs.len() <= leg {
            self.legs.resize_with(leg + 1, SegmentRecord::default);
        }
        self.legs[leg].found = found;
    }

    /// Lets the film go along a path over the map, or from design to design where it is
    /// none, through all of it, at the pace that it had and with a rest at each stop.
    pub fn follow(&mut self, path: MapPath) {
        let before = self.leg_count() as f64;
        let was_path = self.follows_path();
        let is_as_long = path.leg_count() == self.map.path.leg_count();
        self.map.path = path;
        if is_as_long {
            return;
        }
        let now = self.leg_count() as f64;
        // A path that goes on, or ends earlier, keeps what is said of its stops.
        let stays = was_path && self.follows_path();
        self.stops.retain(|stop| stays && stop.t <= now);
        (self.timing.from, self.timing.to) = (0.0, now);
        self.timing.duration_secs *= now / before;
        *self = self.clone().resting_at_designs();
    }

    /// With a rest at each design within, where nothing else was said.
    pub(super) fn resting_at_designs(mut self) -> Self {
        for k in 1..self.leg_count() {
            let t = k as f64;
            if self.stops.iter().all(|stop| stop.t != t) {
                self.stops
                    .push(TransitionStop::at(t).resting(self.timing.hold_secs));
            }
        }
        self.stops.sort_by(|a, b| a.t.total_cmp(&b.t));
        self
    }
}

/// The sites of designs that have new numbers; none where a design is new, which has none.
fn moved_sites(sites: &[DVec2], origins: &[Option<usize>]) -> Vec<DVec2> {
    let moved = origins.iter().map(|origin| sites.get((*origin)?).copied());
    let mut moved: Vec<DVec2> = moved.collect::<Option<_>>().unwrap_or_default();
    // Of a design that is there twice, both would be in one place.
    for k in 1..moved.len() {
        if moved[..k].contains(&moved[k]) {
            moved.clear();
            break;
        }
    }
    moved
}

/// The stops of a project whose designs have new numbers, and its legs as well.
fn moved_stops(
    old: &Project,
    origins: &[Option<usize>],
    legs: &[Option<usize>],
) -> Vec<TransitionStop> {
    let end = legs.len() as f64;
    let old_end = old.pair_count() as f64;
    let at = |stop: &TransitionStop, t: f64| TransitionStop { t, ..stop.clone() };
    let within = |stop: &&TransitionStop, k: usize| (k as f64) < stop.t && stop.t < (k + 1) as f64;
    let mut stops: Vec<TransitionStop> = Vec::new();
    stops.extend(old.stops.iter().filter(|stop| stop.t < 0.0).cloned());
    for t in 0..=legs.len() {
        // What leads back to the first design ends there.
        let design = t % origins.len();
        let kept = origins[design]
            .and_then(|origin| old.stops.iter().find(|stop| stop.t == origin as f64));
        let is_inner = t > 0 && t < legs.len();
        let says =
            |stop: &&TransitionStop| is_inner || !stop.name.is_empty() || !stop.note.is_empty();
        if let Some(stop) = kept.filter(says) {
            stops.push(at(stop, t as f64));
        } else if is_inner {
            stops.push(TransitionStop::at(t as f64).resting(old.timing.hold_secs));
        }
        if let Some(Some(leg)) = legs.get(t) {
            let of_leg = old.stops.iter().filter(|stop| within(stop, *leg));
            stops.extend(of_leg.map(|stop| at(stop, stop.t - *leg as f64 + t as f64)));
        }
    }
    let behind = old.stops.iter().filter(|stop| stop.t > old_end);
    stops.extend(behind.map(|stop| at(stop, stop.t - old_end + end)));
    stops
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::correspondence::PointPair;
    use crate::space::Waypoint;

    fn names(project: &Project) -> Vec<String> {
        let path = |entry: &DesignEntry| entry.path.display().to_string();
        project.designs.iter().map(path).collect()
    }

    fn pinned(project: &mut Project, leg: usize, x: f64) {
        let mut alone = project.leg(leg);
        let pin = PointPair {
            source: DVec2::new(x, 0.0),
            target: DVec2::new(0.0, x),
        };
        alone.options.matching.pins = vec![pin];
        project.take_leg(leg, alone);
    }

    fn pin(project: &Project, leg: usize) -> Option<f64> {
        let matching = project.leg(leg).options.matching;
        matching.pins.first().map(|pin| pin.source.x)
    }

    fn four() -> Project {
        let mut project = Project::of(["a.svg", "b.svg", "c.svg", "d.svg"]);
        pinned(&mut project, 0, 1.0);
        pinned(&mut project, 2, 3.0);
        project.stops[0].name = "at b".to_owned();
        project
            .stops
            .push(TransitionStop::at(2.5).named("on the way to d"));
        project
    }

    fn kept(project: &Project, order: &[usize]) -> Vec<MovedDesigns> {
        let entry = |&k: &usize| (project.designs[k].clone(), Some(k));
        order.iter().map(entry).collect()
    }

    #[test]
    fn a_leg_is_a_pair_and_comes_back_as_it_was() {
        let mut project = four();
        assert_eq!(project.leg_count(), 3);
        assert_eq!(names(&project.leg(1)), ["b.svg", "c.svg"]);
        assert_eq!(
            [0, 1, 2].map(|leg| pin(&project, leg)),
            [Some(1.0), None, Some(3.0)]
        );
        let before = project.clone();
        for leg in 0..3 {
            let alone = project.leg(leg);
            assert!(!alone.is_sequence());
            project.take_leg(leg, alone);
            assert_eq!(project, before);
        }
        let mut pair = Project::pair("a.svg", "b.svg");
        let alone = pair.leg(0);
        assert_eq!(alone, pair);
        pair.take_leg(0, alone.clone());
        assert_eq!(alone, pair);
    }

    #[test]
    fn neighbours_keep_what_is_theirs() {
        let mut project = four();
        let order = kept(&project, &[2, 3, 0, 1]);
        project.rearrange(order);
        assert_eq!(names(&project), ["c.svg", "d.svg", "a.svg", "b.svg"]);
        assert_eq!(
            [0, 1, 2].map(|leg| pin(&project, leg)),
            [Some(3.0), None, Some(1.0)]
        );
        let stops: Vec<(f64, &str)> = project
            .stops
            .iter()
            .map(|s| (s.t, s.name.as_str()))
            .collect();
        assert_eq!(
            stops,
            [
                (0.5, "on the way to d"),
                (1.0, ""),
                (2.0, ""),
                (3.0, "at b")
            ]
        );
    }

    #[test]
    fn what_is_left_of_two_is_a_pair_and_a_third_makes_it_a_sequence() {
        let mut project = four();
        let order = kept(&project, &[2, 3]);
        project.rearrange(order);
        assert!(!project.is_sequence() && project.legs.is_empty());
        assert_eq!(project.options.matching.pins.len(), 1);
        assert_eq!((project.timing.from, project.timing.to), (0.0, 1.0));
        assert!((project.timing.duration_secs - 4.0).abs() < 1e-12);
        let mut order = kept(&project, &[0, 1]);
        order.push((DesignEntry::new("e.svg"), None));
        project.rearrange(order);
        assert_eq!(pin(&project, 0), Some(3.0));
        assert!(project.options.matching.pins.is_empty());
        assert_eq!(project.timing.to, 2.0);
        assert_eq!(
            project.stops.last().map(|stop| (stop.t, stop.hold_secs)),
            Some((1.0, 0.5))
        );
        let one = kept(&project, &[0]);
        let before = project.clone();
        project.rearrange(one);
        assert_eq!(project, before);
    }

    #[test]
    fn a_closed_way_leads_back() {
        let mut project = four();
        project.close(true);
        assert_eq!(project.leg_count(), 4);
        assert_eq!(names(&project.leg(3)), ["d.svg", "a.svg"]);
        assert_eq!(project.timing.to, 4.0);
        assert_eq!(pin(&project, 2), Some(3.0));
        project.close(false);
        assert_eq!(project, four());
    }

    #[test]
    fn a_path_has_legs_of_its_own_and_gives_the_designs_theirs_back() {
        let mut project = four();
        let before = project.clone();
        let stop = |x: f64| Waypoint::stop(DVec2::new(x, 0.5));
        let path = |xs: &[f64]| MapPath {
            name: "a walk".to_owned(),
            places: xs.iter().copied().map(stop).collect(),
        };
        project.follow(path(&[0.0, 0.2, 0.4]));
        assert!(project.follows_path());
        assert_eq!((project.leg_count(), project.pair_count()), (2, 3));
        assert_eq!(project.timing.to, 2.0);
        assert_eq!(project.stops.len(), 1);
        let alone = project.leg(1);
        project.take_leg(1, alone.clone());
        assert_eq!(project, alone);
        // What is said of two designs is still there.
        let again = Project::parse(&project.to_toml().expect("text")).expect("a project");
        project.version = again.version;
        assert_eq!(again, project);
        project.follow(MapPath::default());
        assert_eq!(project.legs, before.legs);
        assert_eq!(project.timing, before.timing);
        assert_eq!(project.stops.len(), 2);
    }

    #[test]
    fn sites_go_with_their_designs() {
        let mut project = four();
        project.map.sites = (0..4).map(|k| DVec2::new(f64::from(k), 0.0)).collect();
        let mut order = project.in_order();
        order.reverse();
        project.rearrange(order);
        assert_eq!(project.map.sites[0], DVec2::new(3.0, 0.0));
        let mut order = project.in_order();
        order[1].1 = None;
        project.rearrange(order);
        assert!(project.map.sites.is_empty());
    }

    #[test]
    fn a_design_goes_where_it_is_put() {
        let whole = Project::of(["a.svg", "b.svg", "c.svg", "d.svg"]);
        let order = |k: usize, place: usize| -> Option<Vec<usize>> {
            let moved = whole.with_moved(k, place)?;
            Some(moved.into_iter().filter_map(|(_, from)| from).collect())
        };
        assert_eq!(order(0, 4), Some(vec![1, 2, 3, 0]));
        assert_eq!(order(3, 0), Some(vec![3, 0, 1, 2]));
        assert_eq!(order(1, 3), Some(vec![0, 2, 1, 3]));
        // On either side of itself it stays.
        assert_eq!(order(2, 2), None);
        assert_eq!(order(2, 3), None);
    }
}

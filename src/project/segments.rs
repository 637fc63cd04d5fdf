//! Segments of a project: splitting it into projects of two designs, and changing its designs.
//!
//! Match settings, part timing and cached matches belong to the segment between two consecutive
//! designs; everything else belongs to the whole project. A project of two designs has one segment,
//! whose settings are stored at the top level. If the film follows a path over the map, its
//! segments lie between the stops of the path and share all settings. The settings of the pairs of
//! designs stay in the project and apply again once the path is removed.
//!
//! Taking out a segment and putting it back unchanged changes nothing. When designs are reordered,
//! settings stay with pairs that remain neighbours.

use super::document::{DesignEntry, Project};
use super::map::MapSettings;
use super::segment_settings::SegmentRecord;
use crate::geometry::DVec2;
use crate::space::MapPath;
use crate::transition::{CachedMatch, TransitionStop};

/// An entry of a new list of designs: the design, and the index that it had before; `None` for a
/// new design.
pub type MovedDesigns = (DesignEntry, Option<usize>);

impl Project {
    /// Returns the number of segments of the film: between designs, or between the stops of the
    /// path over the map.
    #[must_use]
    pub fn segment_count(&self) -> usize {
        match self.follows_path() {
            true => self.map.path.segment_count(),
            false => self.pair_count(),
        }
    }

    /// Returns the number of pairs of consecutive designs. It is one less than the number of
    /// designs. In a closed film, which continues from the last design to the first, the two
    /// numbers are equal.
    #[must_use]
    pub fn pair_count(&self) -> usize {
        let closing_pair = usize::from(self.closed);
        (self.designs.len() + closing_pair).saturating_sub(1).max(1)
    }

    /// Returns whether the film follows a path over the map.
    #[must_use]
    pub fn follows_path(&self) -> bool {
        !self.map.path.is_too_short()
    }

    /// Returns whether the film ends with the shape with which it starts.
    #[must_use]
    pub fn ends_where_it_starts(&self) -> bool {
        let places = &self.map.path.places;
        match self.follows_path() {
            true => places.first().map(|p| p.at) == places.last().map(|p| p.at),
            false => self.closed,
        }
    }

    /// Returns whether there is more than one pair of consecutive designs.
    #[must_use]
    pub fn is_sequence(&self) -> bool {
        self.pair_count() > 1
    }

    /// Returns the indices of the two designs of a segment.
    ///
    /// A segment of a path blends all designs. For such a segment, the first and the last design
    /// are returned.
    #[must_use]
    pub fn segment_designs(&self, segment: usize) -> [usize; 2] {
        match self.follows_path() {
            true => [0, self.designs.len().saturating_sub(1)],
            false => self.pair_designs(segment),
        }
    }

    /// Returns the indices of the two designs of a pair. The pair that closes a film ends at index
    /// 0.
    #[must_use]
    pub fn pair_designs(&self, pair: usize) -> [usize; 2] {
        [pair, pair + 1].map(|design| design % self.designs.len().max(1))
    }

    /// Returns one segment as a separate project of two designs with their settings.
    ///
    /// Timing and stops are those of the whole project. If the film follows a path, the segment
    /// keeps all designs.
    #[must_use]
    pub fn segment(&self, segment: usize) -> Self {
        match self.follows_path() {
            true => self.clone(),
            false => self.pair_project(segment),
        }
    }

    /// Like [`Self::segment`], but always returns a pair of consecutive designs, even if the film
    /// follows a path.
    #[must_use]
    pub fn pair_project(&self, pair: usize) -> Self {
        if !self.is_sequence() {
            return self.clone();
        }
        let mut project = self.clone();
        let designs = self.pair_designs(pair);
        project.designs = designs.map(|k| self.designs[k].clone()).to_vec();
        (project.legs, project.closed) = (Vec::new(), false);
        project.map = MapSettings::default();
        project.set_pair_record(self.legs.get(pair).cloned().unwrap_or_default());
        project
    }

    /// Puts back a segment that was taken out with [`Self::segment`] and then changed.
    pub fn replace_segment(&mut self, segment: usize, changed: Self) {
        match self.follows_path() {
            true => *self = changed,
            false => self.replace_pair(segment, changed),
        }
    }

    /// Like [`Self::replace_segment`], for a pair that was taken out with [`Self::pair_project`].
    pub fn replace_pair(&mut self, pair: usize, mut changed: Self) {
        if !self.is_sequence() {
            *self = changed;
            return;
        }
        let record = changed.take_pair_record();
        let mut designs = std::mem::take(&mut self.designs);
        for (k, entry) in self.cyclic_pair(pair, designs.len()).zip(changed.designs) {
            designs[k] = entry;
        }
        let mut records = std::mem::take(&mut self.legs);
        if records.len() <= pair {
            records.resize_with(pair + 1, SegmentRecord::default);
        }
        records[pair] = record;
        *self = Self {
            designs,
            closed: self.closed,
            map: std::mem::take(&mut self.map),
            ..changed
        };
        self.set_segment_records(records);
    }

    /// Returns the indices of the two designs of a pair of consecutive designs, in a project of
    /// `designs` designs. The first design follows the last one.
    fn cyclic_pair(&self, pair: usize, designs: usize) -> impl Iterator<Item = usize> + use<> {
        [pair, pair + 1]
            .into_iter()
            .map(move |k| k % designs.max(1))
    }

    /// Replaces or reorders the designs. Does nothing if fewer than two are given.
    ///
    /// Pairs that remain neighbours keep their settings, and stops move with their designs. A film
    /// that showed all designs still shows all of them.
    pub fn set_designs(&mut self, designs: Vec<MovedDesigns>) {
        self.rearrange(designs, self.closed);
    }

    /// Returns the designs with their indices, as [`Self::set_designs`] takes them.
    #[must_use]
    pub fn designs_with_indices(&self) -> Vec<MovedDesigns> {
        let designs = self.designs.iter().cloned().enumerate();
        designs.map(|(k, entry)| (entry, Some(k))).collect()
    }

    /// Like [`Self::designs_with_indices`], with design `k` moved in front of the design with index
    /// `place`, or to the end if there is no such design.
    ///
    /// Returns `None` if this would not change the order.
    #[must_use]
    pub fn with_moved(&self, k: usize, place: usize) -> Option<Vec<MovedDesigns>> {
        let to = if place > k { place - 1 } else { place };
        if to == k {
            return None;
        }
        let mut order = self.designs_with_indices();
        let design = order.remove(k);
        order.insert(to, design);
        Some(order)
    }

    /// Like [`Self::designs_with_indices`], with a copy of design `k` after it.
    #[must_use]
    pub fn with_duplicated(&self, k: usize) -> Vec<MovedDesigns> {
        let mut order = self.designs_with_indices();
        order.insert(k + 1, (order[k].0.clone(), None));
        order
    }

    /// Like [`Self::designs_with_indices`], without design `k`.
    #[must_use]
    pub fn without(&self, k: usize) -> Vec<MovedDesigns> {
        let mut order = self.designs_with_indices();
        order.remove(k);
        order
    }

    /// Sets whether the film continues from the last design to the first.
    pub fn set_closed(&mut self, closed: bool) {
        self.rearrange(self.designs_with_indices(), closed);
    }

    /// Sets the designs and whether the film is closed, and moves settings, sites and stops
    /// accordingly.
    fn rearrange(&mut self, designs: Vec<MovedDesigns>, closed: bool) {
        if designs.len() < 2 {
            return;
        }
        let old = self.clone();
        let (entries, origins): (Vec<_>, Vec<_>) = designs.into_iter().unzip();
        (self.designs, self.closed) = (entries, closed);
        let old_pair = |pair: usize| {
            let [a, b] = self.pair_designs(pair).map(|k| origins[k]);
            (0..old.pair_count()).find(|&k| old.pair_designs(k).map(Some) == [a, b])
        };
        let old_pairs: Vec<Option<usize>> = (0..self.pair_count()).map(old_pair).collect();
        // A new pair copies the first pair's settings, except those that contain positions, such as
        // pins.
        let new_record = || SegmentRecord {
            matching: old.pair_project(0).options.matching.without_places(),
            ..SegmentRecord::default()
        };
        let records = old_pairs
            .iter()
            .map(|&pair| pair.map_or_else(new_record, |pair| old.pair_record(pair)));
        let records = records.collect();
        (self.options.matching, self.options.parts) = Default::default();
        self.found = CachedMatch::default();
        self.set_segment_records(records);
        self.map.sites = moved_sites(&old.map.sites, &origins);
        if self.follows_path() {
            // The timing and the stops of a film along a path do not depend on the order of the
            // designs.
            return;
        }
        self.stops = moved_stops(&old, &origins, &old_pairs);
        let (count_before, count_after) = (old.segment_count() as f64, self.segment_count() as f64);
        if (old.timing.from, old.timing.to) == (0.0, count_before) {
            self.timing.to = count_after;
            self.timing.duration_secs *= count_after / count_before;
        } else {
            // The film must not end at a removed design.
            let timing = &mut self.timing;
            (timing.from, timing.to) = (timing.from.min(count_after), timing.to.min(count_after));
            if timing.from == timing.to {
                (timing.from, timing.to) = (0.0, count_after);
            }
        }
    }

    /// Returns the settings of a pair of consecutive designs.
    fn pair_record(&self, pair: usize) -> SegmentRecord {
        self.pair_project(pair).take_pair_record()
    }

    /// Removes the match settings, part timing and cached match at the top level and returns them.
    /// There, a project of two designs stores the settings of its segment.
    pub(super) fn take_pair_record(&mut self) -> SegmentRecord {
        SegmentRecord {
            matching: std::mem::take(&mut self.options.matching),
            parts: std::mem::take(&mut self.options.parts),
            found: std::mem::take(&mut self.found),
        }
    }

    /// Stores segment settings at the top level, as a project of two designs does.
    fn set_pair_record(&mut self, record: SegmentRecord) {
        (self.options.matching, self.options.parts, self.found) =
            (record.matching, record.parts, record.found);
    }

    /// Stores the settings of all pairs of consecutive designs: at the top level if there is only
    /// one pair, otherwise in `legs`.
    pub(super) fn set_segment_records(&mut self, mut records: Vec<SegmentRecord>) {
        if !self.is_sequence() {
            let record = records.into_iter().next();
            self.legs = Vec::new();
            return self.set_pair_record(record.unwrap_or_default());
        }
        // Trailing defaults are left out of the file.
        let is_default =
            |record: &SegmentRecord| *record == SegmentRecord::default() && record.found.is_none();
        while records.last().is_some_and(is_default) {
            records.pop();
        }
        self.legs = records;
    }

    /// Stores the solved match and motion of a segment.
    pub fn cache_match(&mut self, segment: usize, cached: CachedMatch) {
        if !self.is_sequence() {
            self.found = cached;
            return;
        }
        if self.legs.len() <= segment {
            self.legs.resize_with(segment + 1, SegmentRecord::default);
        }
        self.legs[segment].found = cached;
    }

    /// Makes the film follow a path over the map, or go from design to design if the path is too
    /// short.
    ///
    /// If the number of segments of the path changes (0 without a path), the film then covers all
    /// segments, keeps its average duration per segment, and pauses at each stop of the path or at
    /// each design.
    pub fn set_path(&mut self, path: MapPath) {
        let count_before = self.segment_count() as f64;
        let had_path = self.follows_path();
        let has_same_count = path.segment_count() == self.map.path.segment_count();
        self.map.path = path;
        if has_same_count {
            return;
        }
        let count_after = self.segment_count() as f64;
        // If a new path replaces an old one, the stops of the film within the new length remain. If
        // the film starts or ceases to follow a path, all of its stops are removed.
        let keeps_stops = had_path && self.follows_path();
        self.stops
            .retain(|stop| keeps_stops && stop.t <= count_after);
        (self.timing.from, self.timing.to) = (0.0, count_after);
        self.timing.duration_secs *= count_after / count_before;
        *self = self.clone().with_pauses_at_designs();
    }

    /// Adds a [`TransitionStop`] with a pause at each whole t between the start and the end of the
    /// film, unless there is a stop already. At a whole t, the film shows a design or the blend at
    /// a stop of its path.
    pub(super) fn with_pauses_at_designs(mut self) -> Self {
        for k in 1..self.segment_count() {
            let t = k as f64;
            if self.stops.iter().all(|stop| stop.t != t) {
                self.stops
                    .push(TransitionStop::at(t).with_pause(self.timing.hold_secs));
            }
        }
        self.stops.sort_by(|a, b| a.t.total_cmp(&b.t));
        self
    }
}

/// Returns the sites in the new order of the designs; an empty list if a design has no site, or if
/// two would share one.
fn moved_sites(sites: &[DVec2], origins: &[Option<usize>]) -> Vec<DVec2> {
    let moved = origins.iter().map(|origin| sites.get((*origin)?).copied());
    let mut moved: Vec<DVec2> = moved.collect::<Option<_>>().unwrap_or_default();
    // Two copies of a design must not share a site.
    for k in 1..moved.len() {
        if moved[..k].contains(&moved[k]) {
            moved.clear();
            break;
        }
    }
    moved
}

/// Returns the stops after a change of the designs.
///
/// `origins` holds the previous index of each design, `old_pairs` that of each pair of consecutive
/// designs; `None` for new ones. A stop at a design moves with the design, a stop between two
/// designs with the pair. New inner designs get a pause.
fn moved_stops(
    old: &Project,
    origins: &[Option<usize>],
    old_pairs: &[Option<usize>],
) -> Vec<TransitionStop> {
    let end = old_pairs.len() as f64;
    let old_end = old.pair_count() as f64;
    let moved_to = |stop: &TransitionStop, t: f64| TransitionStop { t, ..stop.clone() };
    let is_within =
        |stop: &&TransitionStop, k: usize| (k as f64) < stop.t && stop.t < (k + 1) as f64;
    let mut stops: Vec<TransitionStop> = Vec::new();
    stops.extend(old.stops.iter().filter(|stop| stop.t < 0.0).cloned());
    for t in 0..=old_pairs.len() {
        // A closed film ends at the first design.
        let design = t % origins.len();
        let old_stop = origins[design]
            .and_then(|origin| old.stops.iter().find(|stop| stop.t == origin as f64));
        let is_inner = t > 0 && t < old_pairs.len();
        // At the start and the end of the film, a stop without a name or note has no effect.
        let is_needed =
            |stop: &&TransitionStop| is_inner || !stop.name.is_empty() || !stop.note.is_empty();
        if let Some(stop) = old_stop.filter(is_needed) {
            stops.push(moved_to(stop, t as f64));
        } else if is_inner {
            stops.push(TransitionStop::at(t as f64).with_pause(old.timing.hold_secs));
        }
        if let Some(Some(pair)) = old_pairs.get(t) {
            let of_pair = old.stops.iter().filter(|stop| is_within(stop, *pair));
            stops.extend(of_pair.map(|stop| moved_to(stop, stop.t - *pair as f64 + t as f64)));
        }
    }
    let after_end = old.stops.iter().filter(|stop| stop.t > old_end);
    stops.extend(after_end.map(|stop| moved_to(stop, stop.t - old_end + end)));
    stops
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::correspondence::PointPair;
    use crate::space::Waypoint;

    /// Returns the paths of the designs.
    fn names(project: &Project) -> Vec<String> {
        let path = |entry: &DesignEntry| entry.path.display().to_string();
        project.designs.iter().map(path).collect()
    }

    /// Sets a single pin with the coordinate `x` in a segment.
    fn set_pin(project: &mut Project, segment: usize, x: f64) {
        let mut segment_project = project.segment(segment);
        let pin = PointPair {
            source: DVec2::new(x, 0.0),
            target: DVec2::new(0.0, x),
        };
        segment_project.options.matching.pins = vec![pin];
        project.replace_segment(segment, segment_project);
    }

    /// Returns the coordinate of the pin of a segment.
    fn pin(project: &Project, segment: usize) -> Option<f64> {
        let matching = project.segment(segment).options.matching;
        matching.pins.first().map(|pin| pin.source.x)
    }

    /// Returns a project of four designs with pins in the first and the last segment, and two named
    /// stops.
    fn four_designs() -> Project {
        let mut project = Project::from_paths(["a.svg", "b.svg", "c.svg", "d.svg"]);
        set_pin(&mut project, 0, 1.0);
        set_pin(&mut project, 2, 3.0);
        project.stops[0].name = "at b".to_owned();
        project
            .stops
            .push(TransitionStop::at(2.5).with_name("on the way to d"));
        project
    }

    /// Returns the designs of a project with the given indices, in that order.
    fn selected(project: &Project, order: &[usize]) -> Vec<MovedDesigns> {
        let entry = |&k: &usize| (project.designs[k].clone(), Some(k));
        order.iter().map(entry).collect()
    }

    #[test]
    fn taking_out_a_segment_and_putting_it_back_changes_nothing() {
        let mut project = four_designs();
        assert_eq!(project.segment_count(), 3);
        assert_eq!(names(&project.segment(1)), ["b.svg", "c.svg"]);
        assert_eq!(
            [0, 1, 2].map(|segment| pin(&project, segment)),
            [Some(1.0), None, Some(3.0)]
        );
        let before = project.clone();
        for segment in 0..3 {
            let segment_project = project.segment(segment);
            assert!(!segment_project.is_sequence());
            project.replace_segment(segment, segment_project);
            assert_eq!(project, before);
        }
        let mut pair = Project::from_pair("a.svg", "b.svg");
        let segment_project = pair.segment(0);
        assert_eq!(segment_project, pair);
        pair.replace_segment(0, segment_project.clone());
        assert_eq!(segment_project, pair);
    }

    #[test]
    fn pairs_that_stay_neighbours_keep_their_settings() {
        let mut project = four_designs();
        let order = selected(&project, &[2, 3, 0, 1]);
        project.set_designs(order);
        assert_eq!(names(&project), ["c.svg", "d.svg", "a.svg", "b.svg"]);
        assert_eq!(
            [0, 1, 2].map(|segment| pin(&project, segment)),
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
    fn removing_and_adding_designs_switches_between_pair_and_sequence() {
        let mut project = four_designs();
        let order = selected(&project, &[2, 3]);
        project.set_designs(order);
        assert!(!project.is_sequence() && project.legs.is_empty());
        assert_eq!(project.options.matching.pins.len(), 1);
        assert_eq!((project.timing.from, project.timing.to), (0.0, 1.0));
        assert!((project.timing.duration_secs - 4.0).abs() < 1e-12);
        let mut order = selected(&project, &[0, 1]);
        order.push((DesignEntry::new("e.svg"), None));
        project.set_designs(order);
        assert_eq!(pin(&project, 0), Some(3.0));
        assert!(project.options.matching.pins.is_empty());
        assert_eq!(project.timing.to, 2.0);
        assert_eq!(
            project.stops.last().map(|stop| (stop.t, stop.hold_secs)),
            Some((1.0, 0.5))
        );
        let single = selected(&project, &[0]);
        let before = project.clone();
        project.set_designs(single);
        assert_eq!(project, before);
    }

    #[test]
    fn a_closed_project_has_a_segment_back_to_the_first_design() {
        let mut project = four_designs();
        project.set_closed(true);
        assert_eq!(project.segment_count(), 4);
        assert_eq!(names(&project.segment(3)), ["d.svg", "a.svg"]);
        assert_eq!(project.timing.to, 4.0);
        assert_eq!(pin(&project, 2), Some(3.0));
        project.set_closed(false);
        assert_eq!(project, four_designs());
    }

    #[test]
    fn removing_a_path_restores_the_segments_of_the_designs() {
        let mut project = four_designs();
        let before = project.clone();
        let stop = |x: f64| Waypoint::stop(DVec2::new(x, 0.5));
        let path = |xs: &[f64]| MapPath {
            name: "a path".to_owned(),
            places: xs.iter().copied().map(stop).collect(),
        };
        project.set_path(path(&[0.0, 0.2, 0.4]));
        assert!(project.follows_path());
        assert_eq!((project.segment_count(), project.pair_count()), (2, 3));
        assert_eq!(project.timing.to, 2.0);
        assert_eq!(project.stops.len(), 1);
        let segment_project = project.segment(1);
        project.replace_segment(1, segment_project.clone());
        assert_eq!(project, segment_project);
        // The film follows the path, but the project file also keeps the settings of the pairs of
        // designs.
        let reread = Project::parse(&project.to_toml().expect("text")).expect("a project");
        project.version = reread.version;
        assert_eq!(reread, project);
        project.set_path(MapPath::default());
        assert_eq!(project.legs, before.legs);
        assert_eq!(project.timing, before.timing);
        assert_eq!(project.stops.len(), 2);
    }

    #[test]
    fn sites_move_with_their_designs() {
        let mut project = four_designs();
        project.map.sites = (0..4).map(|k| DVec2::new(f64::from(k), 0.0)).collect();
        let mut order = project.designs_with_indices();
        order.reverse();
        project.set_designs(order);
        assert_eq!(project.map.sites[0], DVec2::new(3.0, 0.0));
        let mut order = project.designs_with_indices();
        order[1].1 = None;
        project.set_designs(order);
        assert!(project.map.sites.is_empty());
    }

    #[test]
    fn a_design_moves_to_the_given_place() {
        let project = Project::from_paths(["a.svg", "b.svg", "c.svg", "d.svg"]);
        let order = |k: usize, place: usize| -> Option<Vec<usize>> {
            let moved = project.with_moved(k, place)?;
            Some(moved.into_iter().filter_map(|(_, from)| from).collect())
        };
        assert_eq!(order(0, 4), Some(vec![1, 2, 3, 0]));
        assert_eq!(order(3, 0), Some(vec![3, 0, 1, 2]));
        assert_eq!(order(1, 3), Some(vec![0, 2, 1, 3]));
        // Moving a design in front of itself or behind itself changes nothing.
        assert_eq!(order(2, 2), None);
        assert_eq!(order(2, 3), None);
    }
}

//! Segments that have left the stage and may return to it, and methods that play in place of the
//! requested ones.

use super::OpenDocument;
use crate::app::session::load;
use crate::app::session::load::{BuiltSegment, PlayableSegment, SegmentSettings};
use crate::app::session::transition_problem::TransitionProblem;
use crate::project::Project;
use crate::transition::TransitionMethod;

/// Maximum number of segments that are kept after they have left the stage, so that undo brings
/// them back at once (resource limit: each holds a mesh and its motion).
const MAX_EARLIER: usize = 16;

/// Films that were on the stage before.
impl OpenDocument {
    /// Puts segments back on the stage that were built for the current settings before, as after
    /// undo. Returns `false` if one of them is not known; nothing changes then.
    pub fn restage_earlier(&mut self) -> bool {
        if self.must_reread || load::reads_differently(&self.staged, &self.loaded.project) {
            return false;
        }
        let on_stage = self.segments.iter().filter_map(|s| s.playable.clone());
        let known: Vec<PlayableSegment> = self.earlier.iter().cloned().chain(on_stage).collect();
        let find = |k| load::find_reusable(&known, &SegmentSettings::of(&self.loaded, k));
        let count = self.loaded.project.segment_count();
        let Some(found) = (0..count).map(find).collect::<Option<Vec<_>>>() else {
            return false;
        };
        self.keep_earlier();
        let built_segment = |stage| BuiltSegment {
            playable: Some(stage),
            problem: None,
        };
        self.segments = found.into_iter().map(built_segment).collect();
        self.staged = self.loaded.project.clone();
        self.select_segment(self.segment_index);
        true
    }

    /// Remembers the segments on the stage, which are about to leave it.
    pub(super) fn keep_earlier(&mut self) {
        let on_stage = self.segments.iter().filter_map(|s| s.playable.clone());
        for segment in on_stage {
            let is_same = |known: &PlayableSegment| known.transition.is_same(&segment.transition);
            self.earlier.retain(|known| !is_same(known));
            self.earlier.push(segment);
        }
        let excess = self.earlier.len().saturating_sub(MAX_EARLIER);
        self.earlier.drain(..excess);
    }
}

/// Methods that could not be built.
impl OpenDocument {
    /// Sets the method to the one that plays, if the requested one could not be built for some
    /// segment: the method that replaces it there is then requested for all segments. Returns
    /// whether the settings changed.
    pub fn adopt_playing_method(&mut self) -> bool {
        let failed = |segment: &&BuiltSegment| segment.problem.is_some();
        let Some(segment) = self.segments.iter().find(failed) else {
            self.unavailable = None;
            return false;
        };
        let Some(playing) = segment.playable.as_ref().map(|of| of.transition.method()) else {
            return false;
        };
        let requested = (self.loaded.project.warp, self.loaded.project.content);
        let method = (Some(playing.warp()), Some(playing.content()));
        if requested == method {
            return false;
        }
        let problem = segment.problem.as_ref();
        if problem.is_some_and(TransitionProblem::exceeds_limits) {
            self.refused = Some(self.loaded.project.clone());
        }
        if let (Some(warp), Some(content)) = requested {
            self.unavailable = TransitionMethod::new(warp, content).ok();
        }
        let was_saved = !self.is_dirty();
        let set = |project: &mut Project| (project.warp, project.content) = method;
        if self.history.can_undo() {
            self.amend(|now, _| set(now));
        } else {
            set(&mut self.loaded.project);
            self.refresh_segment();
        }
        if was_saved {
            // The user has changed nothing.
            set(&mut self.saved);
        }
        if self.method_on_stage() == Some(playing) {
            set(&mut self.staged);
        }
        true
    }

    /// Requests the method again that could not be built, if `edited` changes the designs or their
    /// match, which may have been the reason.
    pub(super) fn retry_unavailable_method(&mut self, edited: &mut Project) {
        let now = &self.loaded.project;
        if (now.warp, now.content) != (edited.warp, edited.content) {
            self.unavailable = None;
            return;
        }
        let is_same_cause = now.designs == edited.designs
            && now.fit == edited.fit
            && now.options.matching == edited.options.matching
            && now.legs == edited.legs;
        if !is_same_cause && let Some(method) = self.unavailable.take() {
            (edited.warp, edited.content) = (Some(method.warp()), Some(method.content()));
        }
    }

    /// The method that was requested last and could not be built; `None` once another one was.
    #[must_use]
    pub fn unavailable_method(&self) -> Option<TransitionMethod> {
        self.unavailable
    }

    /// Requests the settings again that were refused because of the limits on time and memory.
    pub fn request_refused(&mut self) {
        if let Some(refused) = self.refused.take() {
            let before = self.snapshot();
            self.loaded.project = refused;
            self.refresh_segment();
            self.history.record(before, self.snapshot(), None);
        }
    }
}

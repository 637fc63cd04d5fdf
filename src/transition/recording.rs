//! Records a transition on request and returns its recording.

use super::transition::Transition;
use crate::recording::{Recording, RecordingError, RecordingOptions};
use crate::work::progress::Progress;

impl Transition {
    /// Records the warp over [0, 1]. From then on, all frames, including existing ones, are
    /// evaluated from the recording instead of being solved; the difference is invisible. If there
    /// is a recording already, returns it.
    ///
    /// # Errors
    /// [`RecordingError`] with the reason why frames continue to be solved.
    ///
    /// ```
    /// use morphospace::recording::RecordingOptions;
    /// use morphospace::work::progress::Silent;
    /// use morphospace::{Design, Transition};
    /// let [a, b] = [[[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]], [[0.0, 0.0], [5.0, 1.0], [1.0, 3.0]]];
    /// let transition = Transition::between(Design::from_rings("a", [a])?, Design::from_rings("b", [b])?)?;
    /// let mut frame = transition.frame(0.5);
    /// let solved = frame.placement().in_frame.clone();
    /// transition.record(&RecordingOptions::default(), &Silent)?;
    /// frame.seek(0.5);
    /// let played = frame.placement().in_frame.iter().zip(&solved);
    /// assert!(played.map(|(p, q)| p.distance(*q)).all(|off| off < 1e-8));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn record(
        &self,
        options: &RecordingOptions,
        progress: &dyn Progress,
    ) -> Result<Recording, RecordingError> {
        if let Some(existing) = self.recording() {
            return existing.clone();
        }
        let recording = Recording::record(self.shared_warp(), options, progress);
        // These errors are not stored, because a later attempt may succeed.
        if matches!(
            recording,
            Err(RecordingError::Cancelled(_) | RecordingError::TooLarge { .. })
        ) {
            return recording;
        }
        self.recording_slot().get_or_init(|| recording).clone()
    }

    /// Returns the recording or the reason why there is none; `None` until a recording has been
    /// requested.
    #[must_use]
    pub fn recording(&self) -> Option<&Result<Recording, RecordingError>> {
        self.recording_slot().get()
    }
}

//! The film of a transition, once somebody has recorded it.

use super::transition::Transition;
use crate::recording::{Recording, RecordingError, RecordingOptions};
use crate::work::progress::Progress;

impl Transition {
    /// Records the warp over [0, 1]. From then on all frames within, those that there
    /// are already among them, are played from memory instead of solved; to the eye
    /// they are the same. Does nothing where that was done before.
    ///
    /// # Errors
    /// [`RecordingError`] says why frames go on being solved.
    ///
    /// ```
    /// use morphospace::{Design, Transition, film::FilmOptions, progress::Silent};
    /// let [a, b] = [[[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]], [[0.0, 0.0], [5.0, 1.0], [1.0, 3.0]]];
    /// let transition = Transition::between(Design::of_rings("a", [a])?, Design::of_rings("b", [b])?)?;
    /// let mut frame = transition.frame(0.5);
    /// let solved = frame.placement().in_frame.clone();
    /// transition.record(&FilmOptions::default(), &Silent)?;
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
        if let Some(known) = self.film() {
            return known.clone();
        }
        let film = Recording::record(self.shared_warp(), options, progress);
        // Another time, or with more room, there may be one.
        if matches!(
            film,
            Err(RecordingError::Cancelled(_) | RecordingError::TooLarge { .. })
        ) {
            return film;
        }
        self.slot().get_or_init(|| film).clone()
    }

    /// The film, or why there is none; nothing as long as nobody has recorded it.
    #[must_use]
    pub fn film(&self) -> Option<&Result<Recording, RecordingError>> {
        self.slot().get()
    }
}

//! Sequences: transitions one after another, through many designs.
//!
//! The parameter t counts the designs: the first design is at 0, the second at 1, and so on. The
//! transition between two consecutive designs is a *segment*. Two designs form a sequence of one
//! segment; it is shown, measured and exported exactly like the single transition.
//!
//! Guaranteed: at each integer t from 0 to the number of segments, the frame shows the design
//! itself, whether the preceding or the following segment is evaluated. Not guaranteed: that points
//! leave a design in the direction in which they arrived. Playback pauses at the designs or is
//! eased, which hides the change.

use super::frame::Frame;
use super::style::TransitionStyle;
use super::transition::Transition;
use crate::geometry::Bounds;
use std::sync::Arc;

/// One or more transitions, one after another. Cloning is cheap.
///
/// ```
/// use morphospace::transition::Sequence;
/// use morphospace::{Design, Transition};
/// let box_ = |w: f64, h: f64| Design::from_rings("box", [[[0.0, 0.0], [w, 0.0], [w, h], [0.0, h]]]);
/// let segments = vec![
///     Transition::between(box_(1.0, 1.0)?, box_(3.0, 1.0)?)?,
///     Transition::between(box_(3.0, 1.0)?, box_(3.0, 3.0)?)?,
/// ];
/// let sequence = Sequence::new(segments).expect("two segments");
/// assert_eq!(sequence.end(), 2.0);
/// let mut frame = sequence.frame(0.0);
/// frame.seek(1.5);
/// assert_eq!((frame.segment(), frame.frame().t()), (1, 0.5));
/// # Ok::<(), morphospace::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Sequence {
    segments: Arc<[Transition]>,
    /// Whether the last segment leads back to the first design.
    is_closed: bool,
}

impl From<Transition> for Sequence {
    fn from(only: Transition) -> Self {
        Self {
            segments: [only].into(),
            is_closed: false,
        }
    }
}

impl From<&Transition> for Sequence {
    fn from(only: &Transition) -> Self {
        only.clone().into()
    }
}

impl From<&Self> for Sequence {
    fn from(same: &Self) -> Self {
        same.clone()
    }
}

impl Sequence {
    /// Creates a sequence, or returns `None` if there are no segments. The caller must ensure that
    /// each segment begins with the design with which the previous segment ends.
    #[must_use]
    pub fn new(segments: Vec<Transition>) -> Option<Self> {
        (!segments.is_empty()).then(|| Self {
            segments: segments.into(),
            is_closed: false,
        })
    }

    /// Sets whether the last segment leads back to the first design. If so, colours that change
    /// with t return to the first colour as well.
    #[must_use]
    pub fn closed(self, is_closed: bool) -> Self {
        Self { is_closed, ..self }
    }

    /// Returns the transitions in order.
    #[must_use]
    pub fn segments(&self) -> &[Transition] {
        &self.segments
    }

    /// Returns whether two sequences consist of the same shared transitions. Only pointers are
    /// compared, because comparing the data would take longer.
    #[must_use]
    pub fn is_same(&self, other: &Self) -> bool {
        let same = |(a, b): (&Transition, &Transition)| a.is_same(b);
        self.segments.len() == other.segments.len()
            && self.segments.iter().zip(other.segments.iter()).all(same)
    }

    /// Returns the t of the last design, which is the number of segments.
    #[must_use]
    pub fn end(&self) -> f64 {
        self.segments.len() as f64
    }

    /// Returns the index of the segment shown at `t`, and the t within that segment. Before the
    /// first design and beyond the last one, the t within the segment lies outside [0, 1].
    #[must_use]
    pub fn segment_at(&self, t: f64) -> (usize, f64) {
        segment_at(self.segments.len(), t)
    }

    /// Returns a box around every frame from the first design to the last. Approximate: frames are
    /// sampled.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        let boxes = self.segments.iter().map(Transition::bounds);
        boxes
            .reduce(|a, b| a.union(&b))
            .unwrap_or_else(|| unreachable!("there is a segment"))
    }

    /// Returns every t at which a segment other than the first begins, or at which a part starts,
    /// stops or abruptly changes its speed. Between these times every point moves smoothly. The
    /// list is unsorted and may include 0 and the end of the sequence.
    #[must_use]
    pub fn break_times(&self) -> Vec<f64> {
        let breaks_of_segment = |(k, segment): (usize, &Transition)| {
            let first = k as f64;
            let segment_start = (k > 0).then_some(first);
            let within = segment.break_times().into_iter().map(move |t| first + t);
            segment_start.into_iter().chain(within)
        };
        self.segments
            .iter()
            .enumerate()
            .flat_map(breaks_of_segment)
            .collect()
    }

    /// Returns the style of a segment, given the style of the whole sequence. The colours of the
    /// whole sequence change with t; each segment gets the colours at its two designs as its source
    /// and target colour.
    #[must_use]
    pub fn style_of(&self, segment: usize, style: &TransitionStyle) -> TransitionStyle {
        let layout = SequenceLayout {
            segment_count: self.segments.len(),
            is_closed: self.is_closed,
        };
        style_of(segment, layout, style)
    }

    /// Creates a frame at `t`, with its own memory; a `t` that is not finite counts as 0.
    #[must_use]
    pub fn frame(&self, t: f64) -> SequenceFrame {
        let t = if t.is_finite() { t } else { 0.0 };
        let (segment, within) = self.segment_at(t);
        let mut frames: Vec<Option<Frame>> = self.segments.iter().map(|_| None).collect();
        frames[segment] = Some(self.segments[segment].frame(within));
        SequenceFrame {
            sequence: self.clone(),
            frames,
            segment,
            t,
        }
    }
}

/// Number of segments of a sequence, and whether it is closed.
///
/// ```
/// use morphospace::transition::{SequenceLayout, colour_fraction};
/// let layout = SequenceLayout { segment_count: 4, is_closed: true };
/// assert_eq!([0.0, 1.0, 2.0, 4.0].map(|t| colour_fraction(t, layout)), [0.0, 0.5, 1.0, 0.0]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SequenceLayout {
    /// Number of segments.
    pub segment_count: usize,
    /// Whether the last segment leads back to the first design.
    pub is_closed: bool,
}

/// Returns the segment shown at `t` and the t within it, as [`Sequence::segment_at`], for a
/// sequence of `segment_count` segments.
#[must_use]
pub fn segment_at(segment_count: usize, t: f64) -> (usize, f64) {
    let last = segment_count.saturating_sub(1);
    // `as` saturates and converts NaN to 0.
    let segment = (t.floor().max(0.0) as usize).min(last);
    (segment, t - segment as f64)
}

/// Returns the style of a segment, as [`Sequence::style_of`], for a sequence with the given layout.
#[must_use]
pub fn style_of(
    segment: usize,
    layout: SequenceLayout,
    style: &TransitionStyle,
) -> TransitionStyle {
    let colour_of_design = |k: usize| style.fill_at(colour_fraction(k as f64, layout));
    TransitionStyle {
        source: colour_of_design(segment),
        target: colour_of_design(segment + 1),
        ..*style
    }
}

/// Returns the colour at `t` as a position between the source colour (0) and the target colour (1)
/// of the style. The position runs from 0 to 1 over all segments, or from 0 to 1 and back to 0 if
/// the sequence is closed.
#[must_use]
pub fn colour_fraction(t: f64, layout: SequenceLayout) -> f64 {
    let fraction = t / layout.segment_count.max(1) as f64;
    match layout.is_closed {
        true => 1.0 - (2.0 * fraction - 1.0).abs(),
        false => fraction,
    }
}

/// A sequence at one t. Memory is allocated only for segments that have been shown.
#[derive(Debug)]
pub struct SequenceFrame {
    sequence: Sequence,
    frames: Vec<Option<Frame>>,
    segment: usize,
    t: f64,
}

impl SequenceFrame {
    /// Moves to `t`. Does not allocate if the segment at `t` has been shown before. A `t` that is
    /// not finite counts as 0.
    pub fn seek(&mut self, t: f64) {
        self.t = if t.is_finite() { t } else { 0.0 };
        let (segment, within) = self.sequence.segment_at(self.t);
        self.segment = segment;
        match &mut self.frames[segment] {
            Some(frame) => frame.seek(within),
            none => *none = Some(self.sequence.segments[segment].frame(within)),
        }
    }

    /// Returns the frame of the segment that is shown.
    ///
    /// # Panics
    /// Never, because the segment that is shown always has a frame.
    #[must_use]
    pub fn frame(&self) -> &Frame {
        self.frames[self.segment]
            .as_ref()
            .unwrap_or_else(|| unreachable!("it was sought"))
    }

    /// Returns the index of the segment that is shown.
    #[must_use]
    pub fn segment(&self) -> usize {
        self.segment
    }

    /// Returns the t of the frame in the whole sequence.
    #[must_use]
    pub fn t(&self) -> f64 {
        self.t
    }

    /// Returns the style of the segment that is shown; see [`Sequence::style_of`].
    #[must_use]
    pub fn style(&self, style: &TransitionStyle) -> TransitionStyle {
        self.sequence.style_of(self.segment, style)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::Design;

    fn design(name: &str, size: [f64; 2]) -> Design {
        let [w, h] = size;
        let ring = [[0.0, 0.0], [w, 0.0], [w, h], [0.3 * w, 1.2 * h], [0.0, h]];
        Design::from_rings(name, [ring]).expect("a design")
    }

    fn three() -> Sequence {
        let sizes = [[1.0, 1.0], [3.0, 1.0], [2.0, 4.0]];
        let segment = |k: usize| {
            let [a, b] = [0, 1].map(|i| design("x", sizes[k + i]));
            Transition::between(a, b).expect("a transition")
        };
        Sequence::new(vec![segment(0), segment(1)]).expect("two segments")
    }

    #[test]
    #[ignore = "slow; run by scripts/test"]
    fn a_segment_equals_the_single_transition() {
        let sequence = three();
        let mut frame = sequence.frame(0.25);
        for t in [0.25, 1.75, 0.5, 1.0, -0.5, 2.5, 2.0] {
            frame.seek(t);
            let (segment, within) = sequence.segment_at(t);
            let alone = sequence.segments()[segment].frame(within).figure();
            assert_eq!(frame.frame().figure(), alone, "{t}");
            assert_eq!((frame.t(), frame.segment()), (t, segment));
        }
        assert_eq!(
            [-0.5, 0.0, 1.0, 1.5, 2.0, 2.5].map(|t| sequence.segment_at(t).0),
            [0, 0, 1, 1, 1, 1]
        );
        assert_eq!(sequence.segment_at(2.5), (1, 1.5));
        frame.seek(f64::NAN);
        assert_eq!(frame.t(), 0.0);
        assert!(Sequence::new(vec![]).is_none());
    }

    #[test]
    #[ignore = "slow; run by scripts/test"]
    fn designs_are_exact_from_both_sides() {
        let sequence = three();
        let [arriving, leaving] = [(0, 1.0), (1, 0.0)].map(|(segment, t)| {
            let frame = sequence.segments()[segment].frame(t);
            let mut points = frame.figure().rings.concat();
            points.retain(|p| design("x", [3.0, 1.0]).extent.padded(1e-9).contains(*p));
            points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
            let corners = design("x", [3.0, 1.0]);
            let corners = corners.outline(0.0).expect("an outline");
            let corners: Vec<_> = corners.rings().flat_map(|r| r.points().to_vec()).collect();
            corners.into_iter().all(|c| points.contains(&c))
        });
        assert!(arriving && leaving);
    }

    #[test]
    #[ignore = "slow; run by scripts/test"]
    fn colours_run_once_through_all_segments() {
        let (sequence, style) = (three(), TransitionStyle::default());
        let [first, second] = [0, 1].map(|segment| sequence.style_of(segment, &style));
        assert_eq!(first.source, style.source);
        assert_eq!(second.target, style.target);
        assert_eq!(first.target, second.source);
        assert_eq!(first.target, style.fill_at(0.5));
        let one = Sequence::from(sequence.segments()[0].clone());
        assert_eq!(one.style_of(0, &style), style);
        let round = sequence.closed(true);
        assert_eq!(round.style_of(0, &style), style);
        assert_eq!(round.style_of(1, &style).target, style.source);
    }

    #[test]
    #[ignore = "slow; run by scripts/test"]
    fn breaks_are_those_of_the_segments_and_the_designs_between_them() {
        assert_eq!(three().break_times(), [1.0]);
    }
}

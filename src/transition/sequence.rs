//! Transitions one after the other: a film through many designs.
//!
//! t counts the designs: at 0 there is the first, at 1 the second, and between the two
//! the transition from one to the other, the first *leg*. A pair is the case of one
//! leg, and all that is shown, measured or written of it is the same to the last bit.
//!
//! Guaranteed: at each whole t the design itself, whichever leg it is reached by.
//! Not guaranteed: that points go on in the direction that they arrived in; a pass
//! rests there, or is eased, so that nobody sees it.

use super::frame::Frame;
use super::style::TransitionStyle;
use super::transition::Transition;
use crate::geometry::Bounds;
use std::sync::Arc;

/// Transitions one after the other, at least one. Cloning is cheap.
///
/// ```
/// use morphospace::transition::Sequence;
/// use morphospace::{Design, Transition};
/// let box_ = |w: f64, h: f64| Design::of_rings("box", [[[0.0, 0.0], [w, 0.0], [w, h], [0.0, h]]]);
/// let leg = |a: Design, b: Design| Transition::between(a, b);
/// let legs = vec![
///     leg(box_(1.0, 1.0)?, box_(3.0, 1.0)?)?,
///     leg(box_(3.0, 1.0)?, box_(3.0, 3.0)?)?,
/// ];
/// let sequence = Sequence::new(legs).expect("two are more than none");
/// assert_eq!(sequence.end(), 2.0);
/// let mut frame = sequence.frame(0.0);
/// frame.seek(1.5);
/// assert_eq!((frame.leg(), frame.now().t()), (1, 0.5));
/// # Ok::<(), morphospace::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Sequence {
    legs: Arc<[Transition]>,
    /// The last leg leads back to the first design.
    leads_back: bool,
}

impl From<Transition> for Sequence {
    fn from(only: Transition) -> Self {
        Self {
            legs: [only].into(),
            leads_back: false,
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
    /// None of no legs. That each begins with the design that the last one ends with is
    /// for the caller to see to.
    #[must_use]
    pub fn new(legs: Vec<Transition>) -> Option<Self> {
        (!legs.is_empty()).then(|| Self {
            legs: legs.into(),
            leads_back: false,
        })
    }

    /// The same, whose last leg leads back to the first design, or does not: then the
    /// colours that go with t come back as well.
    #[must_use]
    pub fn leading_back(self, leads_back: bool) -> Self {
        Self { leads_back, ..self }
    }

    /// The transitions, in their order.
    #[must_use]
    pub fn legs(&self) -> &[Transition] {
        &self.legs
    }

    /// Whether these are the same transitions. Clones share what they are made of; comparing
    /// that would take longer.
    #[must_use]
    pub fn is(&self, other: &Self) -> bool {
        let same = |(a, b): (&Transition, &Transition)| a.is(b);
        self.legs.len() == other.legs.len() && self.legs.iter().zip(other.legs.iter()).all(same)
    }

    /// The t of the last design: how many legs there are.
    #[must_use]
    pub fn end(&self) -> f64 {
        self.legs.len() as f64
    }

    /// The leg that is shown at `t`, and where in it: before the first design and behind
    /// the last one it extrapolates.
    #[must_use]
    pub fn place(&self, t: f64) -> (usize, f64) {
        segment_at(self.legs.len(), t)
    }

    /// The box that holds every frame for t from the first design to the last, nearly.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        let boxes = self.legs.iter().map(Transition::bounds);
        boxes
            .reduce(|a, b| a.union(&b))
            .unwrap_or_else(|| unreachable!("there is a leg"))
    }

    /// The t within, at which a design is reached or something sets out, arrives or
    /// changes its pace: between them every point moves smoothly. In no order.
    #[must_use]
    pub fn breaks(&self) -> Vec<f64> {
        let of_leg = |(k, leg): (usize, &Transition)| {
            let first = k as f64;
            let joint = (k > 0).then_some(first);
            let within = leg.breaks().into_iter().map(move |t| first + t);
            joint.into_iter().chain(within)
        };
        self.legs.iter().enumerate().flat_map(of_leg).collect()
    }

    /// How a leg is painted where the whole is painted so: colours that go with t go once
    /// through all legs.
    #[must_use]
    pub fn style_of(&self, leg: usize, style: &TransitionStyle) -> TransitionStyle {
        style_of(leg, (self.legs.len(), self.leads_back), style)
    }

    /// A frame at `t`, with memory of its own; a `t` that is not finite counts as 0.
    #[must_use]
    pub fn frame(&self, t: f64) -> SequenceFrame {
        let t = if t.is_finite() { t } else { 0.0 };
        let (leg, within) = self.place(t);
        let mut frames: Vec<Option<Frame>> = self.legs.iter().map(|_| None).collect();
        frames[leg] = Some(self.legs[leg].frame(within));
        SequenceFrame {
            sequence: self.clone(),
            frames,
            leg,
            t,
        }
    }
}

/// As [`Sequence::place`], of so many legs.
#[must_use]
pub fn segment_at(legs: usize, t: f64) -> (usize, f64) {
    let last = legs.saturating_sub(1);
    // `as` saturates, and takes what is no number for 0.
    let leg = (t.floor().max(0.0) as usize).min(last);
    (leg, t - leg as f64)
}

/// As [`Sequence::style_of`], of so many legs, which lead back or do not.
#[must_use]
pub fn style_of(leg: usize, all: (usize, bool), style: &TransitionStyle) -> TransitionStyle {
    let at = |k: usize| style.fill_at(colour_fraction(k as f64, all));
    TransitionStyle {
        source: at(leg),
        target: at(leg + 1),
        ..*style
    }
}

/// Where between the first colour of a style and its second one so many legs have come at
/// `t`: from one to the other, and back where they lead back.
#[must_use]
pub fn colour_fraction(t: f64, (legs, leads_back): (usize, bool)) -> f64 {
    let share = t / legs.max(1) as f64;
    match leads_back {
        true => 1.0 - (2.0 * share - 1.0).abs(),
        false => share,
    }
}

/// A sequence at one t. Only legs that were looked at have memory.
#[derive(Debug)]
pub struct SequenceFrame {
    sequence: Sequence,
    frames: Vec<Option<Frame>>,
    leg: usize,
    t: f64,
}

impl SequenceFrame {
    /// Moves to `t`, without allocating within a leg that was looked at before. A `t`
    /// that is not finite counts as 0.
    pub fn seek(&mut self, t: f64) {
        self.t = if t.is_finite() { t } else { 0.0 };
        let (leg, within) = self.sequence.place(self.t);
        self.leg = leg;
        match &mut self.frames[leg] {
            Some(frame) => frame.seek(within),
            none => *none = Some(self.sequence.legs[leg].frame(within)),
        }
    }

    /// The frame of the leg that is shown.
    ///
    /// # Panics
    /// Never: the leg that is shown was looked at.
    #[must_use]
    pub fn now(&self) -> &Frame {
        self.frames[self.leg]
            .as_ref()
            .unwrap_or_else(|| unreachable!("it was sought"))
    }

    /// The number of that leg, from 0.
    #[must_use]
    pub fn leg(&self) -> usize {
        self.leg
    }

    /// Where it is in the whole.
    #[must_use]
    pub fn t(&self) -> f64 {
        self.t
    }

    /// How it is painted where the whole is painted so; see [`Sequence::style_of`].
    #[must_use]
    pub fn style(&self, style: &TransitionStyle) -> TransitionStyle {
        self.sequence.style_of(self.leg, style)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::Design;

    fn design(name: &str, size: [f64; 2]) -> Design {
        let [w, h] = size;
        let ring = [[0.0, 0.0], [w, 0.0], [w, h], [0.3 * w, 1.2 * h], [0.0, h]];
        Design::of_rings(name, [ring]).expect("a design")
    }

    fn three() -> Sequence {
        let sizes = [[1.0, 1.0], [3.0, 1.0], [2.0, 4.0]];
        let leg = |k: usize| {
            let [a, b] = [0, 1].map(|i| design("x", sizes[k + i]));
            Transition::between(a, b).expect("a transition")
        };
        Sequence::new(vec![leg(0), leg(1)]).expect("two legs")
    }

    #[test]
    fn a_leg_is_what_it_is_alone() {
        let sequence = three();
        let mut frame = sequence.frame(0.25);
        for t in [0.25, 1.75, 0.5, 1.0, -0.5, 2.5, 2.0] {
            frame.seek(t);
            let (leg, within) = sequence.place(t);
            let alone = sequence.legs()[leg].frame(within).figure();
            assert_eq!(frame.now().figure(), alone, "{t}");
            assert_eq!((frame.t(), frame.leg()), (t, leg));
        }
        assert_eq!(
            [-0.5, 0.0, 1.0, 1.5, 2.0, 2.5].map(|t| sequence.place(t).0),
            [0, 0, 1, 1, 1, 1]
        );
        assert_eq!(sequence.place(2.5), (1, 1.5));
        frame.seek(f64::NAN);
        assert_eq!(frame.t(), 0.0);
        assert!(Sequence::new(vec![]).is_none());
    }

    #[test]
    fn designs_are_met_from_both_sides_to_the_last_bit() {
        let sequence = three();
        let [arriving, leaving] = [(0, 1.0), (1, 0.0)].map(|(leg, t)| {
            let frame = sequence.legs()[leg].frame(t);
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
    fn colours_go_once_through_all_legs() {
        let (sequence, style) = (three(), TransitionStyle::default());
        let [first, second] = [0, 1].map(|leg| sequence.style_of(leg, &style));
        assert_eq!(first.source, style.source);
        assert_eq!(second.target, style.target);
        assert_eq!(first.target, second.source);
        assert_eq!(first.target, style.fill_at(0.5));
        let one = Sequence::from(sequence.legs()[0].clone());
        assert_eq!(one.style_of(0, &style), style);
        let round = sequence.leading_back(true);
        assert_eq!(round.style_of(0, &style), style);
        assert_eq!(round.style_of(1, &style).target, style.source);
    }

    #[test]
    fn breaks_are_those_of_the_legs_and_the_designs_between() {
        assert_eq!(three().breaks(), [1.0]);
    }
}

//! Rigidity-preserving interpolation in which each connected part has its own timing.
//!
//! The [`PartClock`] of a part maps the transition time t to another time, and the part is shown at
//! its position in the unstaggered interpolation at that time. Each part thus follows its usual
//! path and only starts later or arrives earlier; the ends of the motion are unchanged. Parts share
//! no vertices, so evaluation at one t still takes a single solve, however many clocks there are.
//! An anchor vertex moves on its straight path according to the clock of its part.

use super::{Arap, Placer, Warp};
use crate::time::{EasingFunction, NamedEasing};
use std::sync::Arc;

/// Time window and easing of the motion of one part.
///
/// The part waits until `from`, moves with `easing`, and has arrived at `to`. For t outside [0, 1],
/// the part extrapolates as it would without a clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartClock {
    /// Time at which the part starts, at least 0.
    pub from: f64,
    /// Time at which the part arrives, later than `from` and at most 1.
    pub to: f64,
    /// Easing of the motion between `from` and `to`.
    pub easing: EasingFunction,
}

impl PartClock {
    /// Clock of a part that moves during the whole transition at constant speed.
    pub const WHOLE: Self = Self {
        from: 0.0,
        to: 1.0,
        easing: EasingFunction::Named(NamedEasing::Linear),
    };

    /// Returns the time at which the part is evaluated at the transition time `t`; exactly 0 for
    /// t = 0 and exactly 1 for t = 1.
    ///
    /// ```
    /// use morphospace::time::NamedEasing;
    /// use morphospace::warp::PartClock;
    /// let late = PartClock { from: 0.5, to: 1.0, easing: NamedEasing::Linear.into() };
    /// assert_eq!([0.0, 0.5, 0.75, 1.0].map(|t| late.part_time(t)), [0.0, 0.0, 0.5, 1.0]);
    /// ```
    #[must_use]
    pub fn part_time(&self, t: f64) -> f64 {
        if !(0.0..=1.0).contains(&t) {
            return t;
        }
        let share = ((t - self.from) / (self.to - self.from)).clamp(0.0, 1.0);
        self.easing.apply(share)
    }

    /// Returns the transition time at which the part reaches `time` in [0, 1], the inverse of
    /// [`Self::part_time`].
    pub(crate) fn transition_time(&self, time: f64) -> f64 {
        self.from + (self.to - self.from) * self.easing.inverse(time)
    }

    /// Returns the clock for the reversed motion.
    #[must_use]
    pub fn backwards(&self) -> Self {
        Self {
            from: 1.0 - self.to,
            to: 1.0 - self.from,
            easing: self.easing.reversed(),
        }
    }
}

/// Rigidity-preserving interpolation with one clock per connected part.
#[derive(Clone, Debug)]
pub struct StaggeredArap {
    arap: Arap,
    clocks: Arc<[PartClock]>,
    /// For each connected part, the index of its clock in `clocks`.
    clock_of_part: Arc<[u32]>,
    /// For each vertex, the index of its connected part.
    part_of_vertex: Arc<[u32]>,
}

impl StaggeredArap {
    /// Assigns clocks to the connected parts of the mesh.
    ///
    /// `clock_of_part` holds an index into `clocks` for each part. Parts with `None`, and parts
    /// beyond the end of the list, use [`PartClock::WHOLE`].
    ///
    /// # Panics
    /// If an index is out of range.
    #[must_use]
    pub fn new(arap: Arap, clocks: &[PartClock], clock_of_part: &[Option<usize>]) -> Self {
        let clocks: Arc<[PartClock]> = clocks.iter().copied().chain([PartClock::WHOLE]).collect();
        let whole = clocks.len() - 1;
        let part_of_vertex: Arc<[u32]> = arap.mesh().components().into();
        let count = part_of_vertex
            .iter()
            .max()
            .map_or(0, |&last| last as usize + 1);
        let index = |part: usize| {
            let chosen = clock_of_part.get(part).copied().flatten();
            chosen.unwrap_or(whole) as u32
        };
        let clock_of_part: Arc<[u32]> = (0..count).map(index).collect();
        assert!(
            clock_of_part.iter().all(|&k| (k as usize) < clocks.len()),
            "clock indices are in range"
        );
        Self {
            arap,
            clocks,
            clock_of_part,
            part_of_vertex,
        }
    }

    /// Returns the underlying interpolation, without clocks.
    #[must_use]
    pub fn arap(&self) -> &Arap {
        &self.arap
    }

    /// Returns the motion with the same clocks for another interpolation of the same parts.
    #[must_use]
    pub(crate) fn with_arap(&self, arap: Arap) -> Self {
        Self {
            arap,
            ..self.clone()
        }
    }

    /// Returns the reversed motion, given the interpolation `arap` of the exchanged designs.
    #[must_use]
    pub(crate) fn backwards(&self, arap: Arap) -> Self {
        Self {
            arap,
            clocks: self.clocks.iter().map(PartClock::backwards).collect(),
            ..self.clone()
        }
    }

    /// Returns the clock of the part that contains a vertex.
    #[must_use]
    pub fn clock(&self, vertex: u32) -> PartClock {
        let part = self.part_of_vertex[vertex as usize];
        self.clocks[self.clock_of_part[part as usize] as usize]
    }
}

impl Warp for StaggeredArap {
    fn placer(&self) -> Placer {
        let clock_of_part = Arc::clone(&self.clock_of_part);
        let clocks = Arc::clone(&self.clocks);
        self.arap
            .placer_by(move |part, t| clocks[clock_of_part[part] as usize].part_time(t))
    }

    fn break_times(&self) -> Vec<f64> {
        let parts = self.clock_of_part.iter().enumerate();
        let breaks = parts.flat_map(|(part, &clock)| {
            let clock = self.clocks[clock as usize];
            let window = self.arap.time_windows().get(part).copied().flatten();
            let window_ends = window
                .into_iter()
                .flat_map(|window| [window.from, window.to]);
            let part_times = window_ends.chain(self.arap.guard_times().iter().copied());
            // A break time of the part occurs at the transition time at which the part's clock
            // reaches it.
            let when = move |time: f64| clock.transition_time(time);
            [clock.from, clock.to]
                .into_iter()
                .chain(part_times.map(when))
        });
        breaks.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compatible::CompatibleMesh;
    use crate::geometry::{DMat2, DVec2};
    use crate::warp::ArapOptions;
    use crate::work::progress::Silent;

    /// Returns an interpolation of two distant triangles that rotate and move up.
    fn arap() -> Arap {
        let triangle = [DVec2::ZERO, DVec2::X, DVec2::Y];
        let source: Vec<DVec2> = triangle
            .iter()
            .copied()
            .chain(triangle.map(|p| p + 5.0 * DVec2::X))
            .collect();
        let turn = DMat2::from_angle(0.8);
        let target = source.iter().map(|&p| turn * p + 3.0 * DVec2::Y).collect();
        let faces = vec![[0, 1, 2], [3, 4, 5]];
        let mesh = CompatibleMesh::new(faces, source, target, vec![]).expect("two faces");
        Arap::build(&mesh, &ArapOptions::default(), &Silent).expect("a solution")
    }

    fn positions(warp: &dyn Warp, t: f64) -> Vec<DVec2> {
        let mut placer = warp.placer();
        placer.place(t);
        placer.placement().in_frame.clone()
    }

    const LATE: PartClock = PartClock {
        from: 0.5,
        to: 1.0,
        easing: EasingFunction::Named(NamedEasing::EaseIn),
    };

    #[test]
    fn a_part_follows_the_plain_motion_at_the_time_of_its_clock() {
        let arap = arap();
        let late = StaggeredArap::new(arap.clone(), &[LATE], &[None, Some(0)]);
        for t in [0.0, 0.3, 0.5, 0.8, 1.0, 1.2, -0.4] {
            let (plain, delayed) = (positions(&arap, t), positions(&arap, LATE.part_time(t)));
            let expected: Vec<DVec2> = plain[..3].iter().chain(&delayed[3..]).copied().collect();
            assert_eq!(positions(&late, t), expected, "{t}");
        }
        let mesh = arap.mesh();
        assert_eq!(positions(&late, 0.2)[3..], mesh.source()[3..]);
        assert_eq!(positions(&late, 1.0), mesh.target());
    }

    #[test]
    fn the_reversed_motion_shows_the_same_frames() {
        let arap = arap();
        let late = StaggeredArap::new(arap.clone(), &[LATE], &[Some(0)]);
        let back = arap.swapped(&Silent).expect("a reversed solution");
        let back = late.backwards(back);
        for t in [0.1, 0.5, 0.75, 0.9] {
            for (p, q) in positions(&late, t)
                .into_iter()
                .zip(positions(&back, 1.0 - t))
            {
                assert!(p.distance(q) < 1e-12, "{t}: {p} {q}");
            }
        }
    }
}

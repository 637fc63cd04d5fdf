//! Rigid parts that make their way in their own time: one sets out later,
//! another is there sooner.
//!
//! A part is at t where the plain film has it at another time, which its
//! [`PartClock`] tells. The film of the parts is the same, and so are its ends;
//! what the whole does between them, each part does when its time has come. Since
//! parts do not touch, a frame is one solve, however many clocks there are. Where
//! an anchor holds the film, it is held in the time of the anchor's part.

use super::{Arap, Placer, Warp};
use crate::time::easing::{EasingFunction, NamedEasing};
use std::sync::Arc;

/// When a part makes its way: it waits until `from`, arrives at `to`, and runs
/// in between as `easing` says. Beyond [0, 1] it goes on as the whole does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartClock {
    /// When it sets out, from 0.
    pub from: f64,
    /// When it arrives, later than that, up to 1.
    pub to: f64,
    /// How it runs in between.
    pub easing: EasingFunction,
}

impl PartClock {
    /// That of the whole.
    pub const WHOLE: Self = Self {
        from: 0.0,
        to: 1.0,
        easing: EasingFunction::Named(NamedEasing::Linear),
    };

    /// The time that it shows at `t`: exactly 0 and 1 at the ends.
    ///
    /// ```
    /// use morphospace::time::easing::Easing;
    /// use morphospace::warp::Clock;
    /// let late = Clock { from: 0.5, to: 1.0, easing: Easing::Linear.into() };
    /// assert_eq!([0.0, 0.5, 0.75, 1.0].map(|t| late.at(t)), [0.0, 0.0, 0.5, 1.0]);
    /// ```
    #[must_use]
    pub fn at(&self, t: f64) -> f64 {
        if !(0.0..=1.0).contains(&t) {
            return t;
        }
        let share = ((t - self.from) / (self.to - self.from)).clamp(0.0, 1.0);
        self.easing.apply(share)
    }

    /// When it shows a time within [0, 1].
    pub(crate) fn when(&self, time: f64) -> f64 {
        self.from + (self.to - self.from) * self.easing.inverse(time)
    }

    /// The same in the film that is run backwards.
    #[must_use]
    pub fn backwards(&self) -> Self {
        Self {
            from: 1.0 - self.to,
            to: 1.0 - self.from,
            easing: self.easing.backwards(),
        }
    }
}

/// Rigid parts with a clock each.
#[derive(Clone, Debug)]
pub struct StaggeredArap {
    arap: Arap,
    clocks: Arc<[PartClock]>,
    /// For each connected part the number of its clock.
    of_parts: Arc<[u32]>,
    /// For each vertex its connected part.
    of_vertices: Arc<[u32]>,
}

impl StaggeredArap {
    /// The same film, in which the connected parts of the mesh have these clocks,
    /// each by its number; that of the whole beyond the list.
    ///
    /// # Panics
    /// If there is no clock of a number.
    #[must_use]
    pub fn new(arap: Arap, clocks: &[PartClock], of_parts: &[Option<usize>]) -> Self {
        let clocks: Arc<[PartClock]> = clocks.iter().copied().chain([PartClock::WHOLE]).collect();
        let whole = clocks.len() - 1;
        let of_vertices: Arc<[u32]> = arap.mesh().components().into();
        let count = of_vertices
            .iter()
            .max()
            .map_or(0, |&last| last as usize + 1);
        let of_part = |part: usize| of_parts.get(part).copied().flatten().unwrap_or(whole) as u32;
        let of_parts: Arc<[u32]> = (0..count).map(of_part).collect();
        assert!(
            of_parts.iter().all(|&k| (k as usize) < clocks.len()),
            "a clock for each number"
        );
        Self {
            arap,
            clocks,
            of_parts,
            of_vertices,
        }
    }

    /// The film in which every part goes by the clock of the whole.
    #[must_use]
    pub fn arap(&self) -> &Arap {
        &self.arap
    }

    /// The same clocks for another film of the same parts.
    #[must_use]
    pub(crate) fn of(&self, arap: Arap) -> Self {
        Self {
            arap,
            ..self.clone()
        }
    }

    /// The same for the film of the exchanged designs.
    #[must_use]
    pub(crate) fn backwards(&self, arap: Arap) -> Self {
        Self {
            arap,
            clocks: self.clocks.iter().map(PartClock::backwards).collect(),
            ..self.clone()
        }
    }

    /// The clock of a vertex.
    #[must_use]
    pub fn clock(&self, vertex: u32) -> PartClock {
        let part = self.of_vertices[vertex as usize];
        self.clocks[self.of_parts[part as usize] as usize]
    }
}

impl Warp for StaggeredArap {
    fn placer(&self) -> Placer {
        let of_parts = Arc::clone(&self.of_parts);
        let clocks = Arc::clone(&self.clocks);
        self.arap
            .placer_by(move |part, t| clocks[of_parts[part] as usize].at(t))
    }

    fn breaks(&self) -> Vec<f64> {
        let of_parts = self.of_parts.iter().enumerate();
        let breaks = of_parts.flat_map(|(part, &clock)| {
            let clock = self.clocks[clock as usize];
            let life = self.arap.lives().get(part).copied().flatten();
            let lives = life.into_iter().flat_map(|life| [life.from, life.to]);
            let within = lives.chain(self.arap.guard_times().iter().copied());
            let when = move |share: f64| clock.when(share);
            [clock.from, clock.to].into_iter().chain(within.map(when))
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

    /// Two triangles far apart that turn and go up.
    fn film() -> Arap {
        let one = [DVec2::ZERO, DVec2::X, DVec2::Y];
        let source: Vec<DVec2> = one
            .iter()
            .copied()
            .chain(one.map(|p| p + 5.0 * DVec2::X))
            .collect();
        let turn = DMat2::from_angle(0.8);
        let target = source.iter().map(|&p| turn * p + 3.0 * DVec2::Y).collect();
        let faces = vec![[0, 1, 2], [3, 4, 5]];
        let mesh = CompatibleMesh::new(faces, source, target, vec![]).expect("two faces");
        Arap::build(&mesh, &ArapOptions::default(), &Silent).expect("a film")
    }

    fn at(warp: &dyn Warp, t: f64) -> Vec<DVec2> {
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
    fn a_part_is_where_the_plain_film_has_it_when_its_time_has_come() {
        let film = film();
        let late = StaggeredArap::new(film.clone(), &[LATE], &[None, Some(0)]);
        for t in [0.0, 0.3, 0.5, 0.8, 1.0, 1.2, -0.4] {
            let (plain, own) = (at(&film, t), at(&film, LATE.at(t)));
            let expected: Vec<DVec2> = plain[..3].iter().chain(&own[3..]).copied().collect();
            assert_eq!(at(&late, t), expected, "{t}");
        }
        let mesh = film.mesh();
        assert_eq!(at(&late, 0.2)[3..], mesh.source()[3..]);
        assert_eq!(at(&late, 1.0), mesh.target());
    }

    #[test]
    fn backwards_is_the_same_film() {
        let film = film();
        let late = StaggeredArap::new(film.clone(), &[LATE], &[Some(0)]);
        let back = film.swapped(&Silent).expect("the film backwards");
        let back = late.backwards(back);
        for t in [0.1, 0.5, 0.75, 0.9] {
            for (p, q) in at(&late, t).into_iter().zip(at(&back, 1.0 - t)) {
                assert!(p.distance(q) < 1e-12, "{t}: {p} {q}");
            }
        }
    }
}

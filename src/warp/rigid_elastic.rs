//! Warps composed of a common rigid motion and an elastic remainder.
//!
//! After Cohen-Or, Levin, Solomovici, "Three-dimensional distance field metamorphosis" (1998), §4:
//! the best rotation of the source features onto the target features is applied as a rotation, and
//! only the remaining displacement is warped. A rotating shape therefore keeps its size, whereas
//! features on straight lines would shrink it. The elastic warp works in rest coordinates, in which
//! both designs are centred and rotated to the halfway angle.
//!
//! Guaranteed for plane warps: at t = 0 the mapping to the source is exactly the identity; at t = 1
//! the mapping to the target is. Exchanging the designs reverses the motion up to rounding, except
//! that a rotation by π is counter-clockwise in both directions. Features that differ by a rigid
//! motion move rigidly.

use super::rigid_motion::{CommonRigidMotion, conjugate};
use super::{MissedFeatures, Placement, Placer, PlaneWarp, Warp};
use crate::correspondence::{LinePair, PointPair};
use crate::geometry::{Bounds, DVec2};
use std::sync::Arc;

/// Plane warp composed of a rigid motion and an elastic plane warp.
#[derive(Clone, Debug)]
pub struct RigidElasticPlaneWarp<W> {
    rigid: CommonRigidMotion,
    elastic: W,
    /// Points of the most recent look-up in rest coordinates, in which both designs are centred and
    /// rotated to the halfway angle; the memory is reused.
    rest: Vec<DVec2>,
}

impl<W> RigidElasticPlaneWarp<W> {
    /// Splits off `rigid` and builds the elastic warp of the remaining displacements.
    ///
    /// `elastic` receives the frame and the features in rest coordinates, in which both designs are
    /// centred and rotated to the halfway angle.
    ///
    /// # Errors
    /// The error of `elastic`.
    pub fn new<E>(
        rigid: CommonRigidMotion,
        frame: &Bounds,
        points: &[PointPair],
        lines: &[LinePair],
        elastic: impl FnOnce(&Bounds, &[PointPair], &[LinePair]) -> Result<W, E>,
    ) -> Result<Self, E> {
        let points: Vec<PointPair> = points
            .iter()
            .map(|pair| {
                let [source, target] = rigid.rest_positions(pair.source, pair.target);
                PointPair { source, target }
            })
            .collect();
        let lines: Vec<LinePair> = lines
            .iter()
            .map(|line| {
                let [a, b] = [0, 1].map(|k| rigid.rest_positions(line.source[k], line.target[k]));
                LinePair {
                    source: [a[0], b[0]],
                    target: [a[1], b[1]],
                }
            })
            .collect();
        Ok(Self {
            rigid,
            elastic: elastic(&rigid.frame_to_rest(frame), &points, &lines)?,
            rest: Vec::new(),
        })
    }
}

impl<W: PlaneWarp> PlaneWarp for RigidElasticPlaneWarp<W> {
    fn look_up(
        &mut self,
        t: f64,
        frame: &[DVec2],
        in_source: &mut [DVec2],
        in_target: &mut [DVec2],
    ) {
        let t = if t.is_finite() { t } else { 0.0 };
        let (back, centre) = self.rigid.at(t);
        self.rest.clear();
        let rest = frame.iter().map(|p| back.rotate(*p - centre));
        self.rest.extend(rest);
        self.elastic.look_up(t, &self.rest, in_source, in_target);
        let looks = [&mut *in_source, &mut *in_target];
        for (places, from_rest) in looks.into_iter().zip(self.rigid.maps_from_rest()) {
            places.iter_mut().for_each(|p| *p = from_rest(*p));
        }
        // At t = 0 and t = 1 one of the mappings is the identity; copying avoids the rounding of
        // the two rotations.
        if t == 0.0 {
            in_source.copy_from_slice(frame);
        }
        if t == 1.0 {
            in_target.copy_from_slice(frame);
        }
    }

    fn missed_features(&self, t: f64) -> Option<MissedFeatures> {
        let missed = self.elastic.missed_features(t)?;
        let (back, centre) = self.rigid.at(t);
        let place = conjugate(back).rotate(missed.place) + centre;
        Some(MissedFeatures { place, ..missed })
    }
}

/// A mesh warp built in rest coordinates (in which both designs are centred and rotated to the
/// halfway angle) and composed with a rigid motion.
///
/// It is suitable for warps in which each vertex shows the same point of a design at every t, such
/// as [`super::Arap`].
#[derive(Clone, Debug)]
pub struct RigidElasticWarp<W> {
    rigid: CommonRigidMotion,
    rest_warp: W,
}

impl<W: Warp> RigidElasticWarp<W> {
    /// Composes the warp `at_rest` with the motion `rigid`.
    pub const fn new(rigid: CommonRigidMotion, at_rest: W) -> Self {
        Self {
            rigid,
            rest_warp: at_rest,
        }
    }

    /// Returns the warp in rest coordinates, without the rigid motion.
    pub const fn rest_warp(&self) -> &W {
        &self.rest_warp
    }
}

impl<W: Warp> Warp for RigidElasticWarp<W> {
    fn placer(&self) -> Placer {
        let mut at_rest = self.rest_warp.placer();
        let rest = at_rest.placement();
        let [source, target] = self.rigid.maps_from_rest();
        let placement = Placement {
            faces: Arc::clone(&rest.faces),
            in_frame: rest.in_frame.clone(),
            in_source: rest.in_source.iter().copied().map(source).collect(),
            in_target: rest.in_target.iter().copied().map(target).collect(),
        };
        let rigid = self.rigid;
        let mut placer = Placer::new(placement, move |t, placement| {
            at_rest.place(t);
            let (back, centre) = rigid.at(if t.is_finite() { t } else { 0.0 });
            let rest = &at_rest.placement().in_frame;
            for (p, rest) in placement.in_frame.iter_mut().zip(rest) {
                *p = conjugate(back).rotate(*rest) + centre;
            }
        });
        placer.place(0.0);
        placer
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::warp::{Lattice, LatticeOptions, ScatteredOptions, ScatteredWarp};
    use proptest::prelude::*;
    use std::f64::consts::PI;

    const FRAME: Bounds = Bounds {
        min: DVec2::new(-2.0, -2.0),
        max: DVec2::new(2.0, 2.0),
    };

    fn frame_points() -> Vec<DVec2> {
        let at = |k: u32| DVec2::new(f64::from(k % 5) - 2.0, f64::from(k / 5) - 2.0);
        (0..25).map(at).collect()
    }

    fn lookups<W: PlaneWarp>(warp: &W, t: f64, frame: &[DVec2]) -> [Vec<DVec2>; 2] {
        let [mut source, mut target] = [frame.to_vec(), frame.to_vec()];
        warp.clone().look_up(t, frame, &mut source, &mut target);
        [source, target]
    }

    fn rigid_pairs(points: &[DVec2], turn: f64, by: DVec2) -> Vec<PointPair> {
        let to = |p: &DVec2| DVec2::from_angle(turn).rotate(*p) + by;
        points
            .iter()
            .map(|p| PointPair {
                source: *p,
                target: to(p),
            })
            .collect()
    }

    fn thin_plate(pairs: &[PointPair]) -> RigidElasticPlaneWarp<ScatteredWarp> {
        let rigid = CommonRigidMotion::fit(pairs, &[]).expect("two places");
        RigidElasticPlaneWarp::new(rigid, &FRAME, pairs, &[], |frame, points, lines| {
            ScatteredWarp::new(frame, points, lines, ScatteredOptions::default())
        })
        .expect("a warp")
    }

    const CORNERS: [DVec2; 4] = [
        DVec2::new(-1.0, -1.0),
        DVec2::new(1.0, -0.5),
        DVec2::new(0.5, 1.0),
        DVec2::new(-0.7, 0.4),
    ];

    #[test]
    fn features_that_differ_by_a_rigid_motion_move_rigidly() {
        for turn in [0.3, 2.0, -3.0, PI] {
            let pairs = rigid_pairs(&CORNERS, turn, DVec2::new(0.4, -0.2));
            let lattice = {
                let rigid = CommonRigidMotion::fit(&pairs, &[]).expect("two places");
                RigidElasticPlaneWarp::new(rigid, &FRAME, &pairs, &[], |frame, points, lines| {
                    Lattice::new(frame, points, lines, LatticeOptions::default())
                })
                .expect("a warp")
            };
            let frame = frame_points();
            for t in [0.0, 0.3, 0.5, 0.8, 1.0, 1.4] {
                for both in [
                    lookups(&thin_plate(&pairs), t, &frame),
                    lookups(&lattice, t, &frame),
                ] {
                    for side in &both {
                        for (k, p) in side.iter().enumerate() {
                            for (l, q) in side.iter().enumerate() {
                                let (apart, expected) =
                                    (p.distance(*q), frame[k].distance(frame[l]));
                                assert!((apart - expected).abs() < 1e-9, "turn {turn} at {t}");
                            }
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn the_ends_are_exact() {
        let mut pairs = rigid_pairs(&CORNERS, 1.3, DVec2::new(0.3, 0.1));
        pairs[2].target += DVec2::new(0.2, -0.4);
        let (warp, frame) = (thin_plate(&pairs), frame_points());
        assert_eq!(lookups(&warp, 0.0, &frame)[0], frame);
        assert_eq!(lookups(&warp, 1.0, &frame)[1], frame);
    }

    fn pairs() -> impl Strategy<Value = Vec<PointPair>> {
        let place = || (-2.0..2.0, -2.0..2.0).prop_map(DVec2::from);
        let pair = (place(), place()).prop_map(|(source, target)| PointPair { source, target });
        prop::collection::vec(pair, 2..7)
    }

    proptest! {
        #[test]
        fn exchanged_designs_reverse_the_motion_and_stay_finite(pairs in pairs(), t in 0.0..1.0) {
            let exchanged: Vec<PointPair> = pairs
                .iter()
                .map(|p| PointPair { source: p.target, target: p.source })
                .collect();
            let frame = frame_points();
            let forward = lookups(&thin_plate(&pairs), t, &frame);
            let backward = lookups(&thin_plate(&exchanged), 1.0 - t, &frame);
            // Near half a turn rounding decides the direction of rotation.
            let turn = CommonRigidMotion::fit(&pairs, &[]).expect("two points").turn();
            prop_assume!(turn.abs() < 3.1);
            for k in 0..frame.len() {
                prop_assert!(forward[0][k].is_finite() && forward[1][k].is_finite());
                let scale = 1.0 + forward[0][k].length() + forward[1][k].length();
                prop_assert!(forward[0][k].distance(backward[1][k]) < 1e-5 * scale);
                prop_assert!(forward[1][k].distance(backward[0][k]) < 1e-5 * scale);
            }
        }
    }
}

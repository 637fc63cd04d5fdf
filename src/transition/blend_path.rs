//! Turns the path from one blend of many designs to another into a transition.
//!
//! Blends themselves are computed in the `space` module. As a transition, a path between two of
//! them can be played, measured and exported like a transition of two designs.

use super::any_warp::AnyWarp;
use super::method::TransitionMethod;
use super::transition::{RecordingSlot, Transition, TransitionData};
use crate::content::{Content, ContentKind, FieldContent, SolidContent};
use crate::design::Design;
use crate::geometry::Bounds;
use crate::warp::{AlongBlend, IdentityWarp, WarpKind};
use std::sync::Arc;

/// The blends at t = 0 and t = 1, and a box around everything that is visible from one to the
/// other.
#[derive(Clone, Debug)]
pub(crate) struct BlendEnds {
    pub designs: [Arc<Design>; 2],
    pub bounds: Bounds,
    /// Width of truss bars in units of the designs.
    pub bar_width: f64,
}

impl Transition {
    /// Creates a transition of rigid parts from one blend to another.
    pub(crate) fn along_blend(ends: BlendEnds, warp: AlongBlend, solid: SolidContent) -> Self {
        Self::from_blend(
            ends,
            TransitionMethod::RIGID_PARTS,
            AnyWarp::Blend(warp),
            Content::Solid(solid),
        )
    }

    /// Creates a transition of distance fields, mixed in place, from one blend to another.
    pub(crate) fn through_fields(ends: BlendEnds, fields: FieldContent) -> Self {
        let still = IdentityWarp::new(fields.first_pair().grid().bounds());
        let cell = TransitionMethod::new(WarpKind::None, ContentKind::Field)
            .unwrap_or_else(|_| unreachable!("it is in the table"));
        Self::from_blend(ends, cell, AnyWarp::Identity(still), Content::Field(fields))
    }

    /// Creates a transition without notes, match or cached data.
    fn from_blend(
        ends: BlendEnds,
        cell: TransitionMethod,
        warp: AnyWarp,
        content: Content,
    ) -> Self {
        let BlendEnds {
            designs,
            bounds,
            bar_width,
        } = ends;
        Self::from(TransitionData {
            method: cell,
            designs,
            built_warp: warp.into(),
            content,
            bounds,
            bar_width,
            recording: RecordingSlot::default(),
        })
    }
}

//! Channels of a placement: its three position lists, of which a warp moves some and leaves the
//! others constant.

use crate::geometry::DVec2;
use crate::warp::Placement;

/// Set of the channels of a placement that a warp moves. The other channels are the same at every
/// t.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct MovingChannels {
    /// Whether the positions in the frame move.
    pub in_frame: bool,
    in_source: bool,
    in_target: bool,
}

/// Channel: one of the three position lists of a placement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PlacementChannel {
    Frame,
    Source,
    Target,
}

impl PlacementChannel {
    /// Returns the position list of this channel.
    pub(super) fn of(self, placement: &Placement) -> &[DVec2] {
        match self {
            Self::Frame => &placement.in_frame,
            Self::Source => &placement.in_source,
            Self::Target => &placement.in_target,
        }
    }

    /// Returns the position list of this channel, for writing.
    pub(super) fn of_mut(self, placement: &mut Placement) -> &mut [DVec2] {
        match self {
            Self::Frame => &mut placement.in_frame,
            Self::Source => &mut placement.in_source,
            Self::Target => &mut placement.in_target,
        }
    }
}

impl MovingChannels {
    /// Returns this set with the channels (position lists) added in which two placements differ.
    pub(super) fn with_changes(self, first: &Placement, other: &Placement) -> Self {
        let differs = |channel: PlacementChannel| channel.of(other) != channel.of(first);
        Self {
            in_frame: self.in_frame || differs(PlacementChannel::Frame),
            in_source: self.in_source || differs(PlacementChannel::Source),
            in_target: self.in_target || differs(PlacementChannel::Target),
        }
    }

    /// Returns the channels (position lists) that move, in a fixed order.
    pub(super) fn channels(self) -> impl Iterator<Item = PlacementChannel> {
        let all = [
            (self.in_frame, PlacementChannel::Frame),
            (self.in_source, PlacementChannel::Source),
            (self.in_target, PlacementChannel::Target),
        ];
        all.into_iter()
            .filter_map(|(moves, channel)| moves.then_some(channel))
    }
}

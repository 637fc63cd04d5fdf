//! A project file that another program or window has changed since it was read or last saved.

use bevy::prelude::Resource;

/// The question whether to replace the changed file.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ConflictQuestion {
    /// Whether the question waits for an answer.
    pub is_open: bool,
}

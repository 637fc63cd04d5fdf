//! Whether the user is being asked about a project file that was changed elsewhere.

use bevy::prelude::Resource;

/// The question whether to replace a project file that another program or window has changed.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ConflictQuestion {
    /// Number of the document that the question is about; `None` if no question is open.
    document: Option<u64>,
}

impl ConflictQuestion {
    /// Whether the question waits for an answer.
    #[must_use]
    pub const fn is_open(&self) -> bool {
        self.document.is_some()
    }

    /// Opens the question about the open document, given by its number.
    pub fn ask(&mut self, document: Option<u64>) {
        self.document = document;
    }

    /// Closes the question; returns whether it was open.
    pub fn close(&mut self) -> bool {
        self.document.take().is_some()
    }

    /// Closes the question if another document has been opened; returns whether it was closed.
    pub fn close_unless(&mut self, document: Option<u64>) -> bool {
        self.document != document && self.close()
    }
}

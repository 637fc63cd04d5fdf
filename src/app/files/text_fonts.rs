//! List of the machine's fonts, in which the file dialog offers to draw text.

use bevy::prelude::{DetectChangesMut, Res, ResMut, Resource};

use crate::app::files::file_dialog::FileDialogRequest;
use crate::app::jobs::job::{BackgroundJob, JobTracker};
use crate::design::{InstalledFont, installed_fonts};
use crate::work::progress::Cancelled;

/// The installed fonts; they are looked up in the background when the file dialog opens first.
#[derive(Resource, Debug, Default)]
pub struct TextFonts {
    job: Option<BackgroundJob<Vec<InstalledFont>, Cancelled>>,
    fonts: Option<Vec<InstalledFont>>,
}

impl TextFonts {
    /// The fonts, sorted by name; `None` while they are being looked up.
    #[must_use]
    pub fn list(&self) -> Option<&[InstalledFont]> {
        self.fonts.as_deref()
    }
}

/// Looks up the fonts once the file dialog is open.
pub fn follow(dialog: Res<FileDialogRequest>, mut fonts: ResMut<TextFonts>) {
    // This system runs in every screen update; only a new list counts as a change.
    let now = fonts.bypass_change_detection();
    if dialog.purpose().is_some() && now.fonts.is_none() && now.job.is_none() {
        let list = |_: &JobTracker| Ok(installed_fonts());
        now.job = Some(BackgroundJob::start("the list of fonts", list));
    }
    if let Some(list) = BackgroundJob::take_result(&mut now.job) {
        now.fonts = Some(list.unwrap_or_default());
        fonts.set_changed();
    }
}

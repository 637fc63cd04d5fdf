//! Tests of the app's systems without a window: injected keys and intents, and their effects.
#![cfg(feature = "app")]

mod autosave;
mod comparison;
#[path = "../hostile/endless_fonts.rs"]
mod endless_fonts;
mod files;
mod first_minute;
mod headless_window;
mod hidden_panels;
mod hostile_files;
mod jobs_and_notices;
mod keys;
mod map;
mod match_editor;
mod method_search;
mod new_films;
mod presentation;
mod redraw_pace;
mod remedies;
mod save;
mod sequence;
mod stage_recording;
mod undo;

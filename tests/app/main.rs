//! Tests of the app's systems without a window: injected keys and intents, and their effects.
#![cfg(feature = "app")]

mod autosave;
mod comparison;
mod files;
mod first_minute;
mod headless_window;
mod hidden_panels;
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

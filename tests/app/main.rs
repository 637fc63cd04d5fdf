//! The window's systems without a window: injected keys, intents, and what comes of them.
#![cfg(feature = "app")]

mod audience;
mod beside;
mod choosing;
mod editor;
mod film;
mod history;
mod keeping;
mod keys;
mod map;
mod opening;
mod rest;
mod saving;
mod sequence;
mod talk;
mod telling;
mod window;

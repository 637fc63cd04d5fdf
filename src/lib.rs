//! Morphospace: the space of all forms between given forms.
//!
//! Two designs go in, and every design between them comes out. **A transition
//! is a warp and a content**: the warp says where each material point is at
//! time t, the content says what is seen there.
//!
//! | warp ↓ · content → | solid (regions, bars) | distance field (contour) | colours (two pictures) |
//! |---|---|---|---|
//! | none | – | log-space blending of signed distances | cross-dissolve |
//! | boundary paths | polygon blending | – | – |
//! | ARAP | rigidity-preserving interpolation | fields carried by moving parts | textured morph |
//! | pairs of lines | – | carried fields | morph |
//! | scattered points | – | carried fields | morph |
//! | B-spline lattices | – | carried fields | morph |
//!
//! What joins the two is a [`warp::Placement`]: faces, and for each vertex its
//! place in the frame, in the source and in the target.
//!
//! # In twenty lines
//!
//! What most programs need stands at the root of the crate: a [`Design`] of
//! points or of a file, the [`Transition`] between two, a [`Frame`] of it, and
//! a [`Camera`] that makes SVG and pixels.
//!
//! ```
//! use morphospace::{Camera, Design, Error, Transition};
//!
//! # fn main() -> Result<(), Error> {
//! let kite = [[2.0, 0.0], [4.0, 3.0], [2.0, 4.0], [0.0, 3.0]];
//! let house = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [2.0, 5.0], [0.0, 3.0]];
//! let source = Design::of_rings("kite", [kite])?;
//! let target = Design::of_rings("house", [house])?;
//! let transition = Transition::between(source, target)?;
//! let mut frame = transition.frame(0.0);
//! for i in 0..=4 {
//!     frame.seek(f64::from(i) / 4.0); // cannot fail
//!     println!("{:?}", frame.figure().rings);
//! }
//! println!("{}", Camera::around(transition, 480).svg(0.5));
//! # Ok(())
//! # }
//! ```
//!
//! # The way the data flows
//!
//! ```text
//! files ─► Design ─► RegionMatch ─► CompatibleMesh ─► Transition ─► Frame(t) ─┬─► stage (Bevy)
//!          regions    who is who     one list of       warp×content           ├─► export: SVG, …
//!          mesh       └─── of unlike outlines several ───┘                    └─► measures
//!          truss        choice: each match gets its film,
//!                       the one with the least trouble stays
//! ```
//!
//! One direction, no way back. Where outlines are unlike, a transition of rigid
//! parts is built from several matches: each gets its mesh and its film, and
//! the one that folds least, then crosses itself least, then distorts least is
//! kept. Parts in each other's way are let go: they die and are born, where and
//! when there is room.
//! Everything that can fail fails while a [`Transition`] is built; a [`Frame`]
//! cannot fail and allocates nothing when it moves to another t. It is
//! unevaluated: the stage evaluates it on the GPU, export and tests on the CPU.
//! What was done otherwise than asked is told: [`Transition::notes`].
//!
//! # Layers
//!
//! A module uses modules above it, never below, and no files use each other in
//! a circle; `tests/layers.rs` reads this list and holds the code to it.
//!
//! ```text
//! names                         what the values of options are called
//! one_line, file_name           what came from elsewhere, in one line; names of files
//! progress, easing              how work tells how far it is; how a share runs
//! budget                        what is too much to begin without being asked twice
//! atomic_file, reading          files that are there whole or not at all, and read so
//! colour                        paints, and the way from one to another
//! geometry                      points, matrices, polygons, exact predicates
//! linalg                        sparse positive definite systems (faer)
//! mesh                          triangles, connectivity, subdivision
//! field                         grids, distance transforms, contours
//! design                        the given forms and their importers
//! correspondence                which point of one design is which of the other
//! compatible                    one connectivity, two embeddings
//! homotopy                      paths of 2×2 matrices
//! warp        content           the rows and the columns of the table
//! film                          a warp recorded as polynomials in t
//! transition                    the cells, frames, timing, style
//! space                         many designs at once, and the map of them
//! measure                       quality in numbers
//! project                       the .morph document and the gallery
//! export                        SVG, PNG, DXF, GIF, APNG, MP4, motion, contact sheets
//! short                         from files to a transition, one error
//! stage  (feature `bevy`)       MorphPlugin: transitions in a Bevy world
//! app    (feature `app`)        the window: playback, panels, keys, capture
//! cli    (feature `cli`)        the subcommands
//! ```
//!
//! Coordinates are `f64` with y up. The core keeps no global state, logs
//! nothing and prints nothing.

mod io;
pub mod settings;
pub mod time;
pub mod work;

pub mod colour;

mod error;
pub mod geometry;
pub mod mesh;
pub mod numerics;

pub mod field;

pub mod design;

pub mod correspondence;

pub mod compatible;

pub mod content;
pub mod warp;

pub mod recording;

pub mod transition;

pub mod space;

pub mod measure;

pub mod project;

pub mod export;

#[cfg(feature = "bevy")]
pub mod stage;

#[cfg(feature = "app")]
pub mod app;

#[cfg(feature = "cli")]
pub mod cli;

pub use design::Design;
pub use error::{Error, open_pair, open_project};
pub use export::{Camera, PixelSize};
pub use geometry::DVec2;
pub use transition::{Frame, Transition, TransitionMethod, VectorFigure};

/// What the readme shows is compiled.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

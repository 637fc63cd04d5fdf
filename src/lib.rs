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
//! # The way the data flows
//!
//! ```text
//! files ─► Design ─► RegionMatch ─► CompatibleMesh ─► Transition ─► Frame(t) ─┬─► stage (Bevy)
//!          regions    who is who     one list of       warp×content           ├─► export: SVG, …
//!          mesh                      faces, two        prefactored            └─► measures
//!          truss                     embeddings
//! ```
//!
//! One direction, no way back. Everything that can fail fails while a
//! [`transition::Transition`] is built; a [`transition::Frame`] cannot fail
//! and allocates nothing when it moves to another t. It is unevaluated: the
//! stage evaluates it on the GPU, export and tests on the CPU.
//!
//! ```
//! use morphospace::project::gallery;
//! use morphospace::progress::Silent;
//! use morphospace::transition::Transition;
//!
//! let loaded = gallery::load("triangle-polar")?;
//! let transition = Transition::build(&loaded.spec()?, &Silent)?;
//! let mut frame = transition.frame(0.0);
//! for i in 0..=4 {
//!     frame.seek(f64::from(i) / 4.0);
//!     println!("{:?}", frame.figure().rings);
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Layers
//!
//! A module uses modules above it, never below.
//!
//! ```text
//! names                         what the values of options are called
//! progress, easing              how work tells how far it is; how a share runs
//! atomic_file                   files that are there whole or not at all
//! geometry                      points, matrices, polygons, exact predicates
//! linalg                        sparse positive definite systems (faer)
//! mesh                          triangles, connectivity, subdivision
//! field                         grids, distance transforms, contours
//! design                        the given forms and their importers
//! correspondence                which point of one design is which of the other
//! compatible                    one connectivity, two embeddings
//! homotopy                      paths of 2×2 matrices
//! warp        content           the rows and the columns of the table
//! transition                    the cells, frames, timing, style
//! measure                       quality in numbers
//! project                       the .morph document and the gallery
//! export                        SVG, PNG, GIF, APNG, MP4, contact sheets
//! stage  (feature `bevy`)       MorphPlugin: transitions in a Bevy world
//! app    (feature `app`)        the window: playback, panels, keys, capture
//! cli    (feature `cli`)        the subcommands
//! ```
//!
//! Coordinates are `f64` with y up. The core keeps no global state, logs
//! nothing and prints nothing.

mod atomic_file;
pub mod names;

pub mod easing;
pub mod progress;

pub mod geometry;
pub mod linalg;
pub mod mesh;

pub mod field;

pub mod design;

pub mod correspondence;

pub mod compatible;

pub mod homotopy;

pub mod content;
pub mod warp;

pub mod transition;

pub mod measure;

pub mod project;

pub mod export;

#[cfg(feature = "bevy")]
pub mod stage;

#[cfg(feature = "app")]
pub mod app;

#[cfg(feature = "cli")]
pub mod cli;

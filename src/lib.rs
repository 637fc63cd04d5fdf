//! Morphospace: blends between given designs, as animations and as maps.
//!
//! Takes two or more designs and computes every design between them. **A transition is a warp and
//! a content**: the warp says where each point is at blend parameter t, the content says what is
//! drawn there.
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
//! Warp and content meet in a [`warp::Placement`]: a list of faces, and for each vertex its
//! position in the frame, in the source and in the target.
//!
//! # Basic use
//!
//! Most programs need only the crate root: a [`Design`] from points or from a file, the
//! [`Transition`] between two, a [`Frame`] of it, and a [`Camera`] that draws SVG and pixels.
//!
//! ```
//! use morphospace::{Camera, Design, Error, Transition};
//!
//! # fn main() -> Result<(), Error> {
//! let kite = [[2.0, 0.0], [4.0, 3.0], [2.0, 4.0], [0.0, 3.0]];
//! let house = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [2.0, 5.0], [0.0, 3.0]];
//! let source = Design::from_rings("kite", [kite])?;
//! let target = Design::from_rings("house", [house])?;
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
//! # Data flow
//!
//! ```text
//! files ─► Design ─► RegionMatch ─► CompatibleMesh ─► Transition ─► Frame(t) ─┬─► stage (Bevy)
//!          regions    which part     one list of       warp×content           ├─► export: SVG, …
//!          mesh       is which       faces, one                               └─► measures
//!          truss      └── several candidates for ──┘
//!                         dissimilar outlines; the best stays
//! ```
//!
//! Data flows in one direction. For dissimilar outlines, a transition of rigid parts is built from
//! several candidate matches. Each gets a mesh and its motion; the candidate with the fewest folds,
//! then the fewest crossings, then the least distortion is used. Parts that would collide are
//! unpaired: they disappear and appear where and when there is room.
//!
//! Everything that can fail fails while a [`Transition`] is built. A [`Frame`] cannot fail and
//! allocates nothing when it moves to another t. It is unevaluated: the stage evaluates it on the
//! GPU, export and tests on the CPU. Deviations from the request are reported as notes
//! ([`Transition::notes`]).
//!
//! # Layers
//!
//! A module uses only modules above it in this list, and no files use each other in a cycle.
//! `tests/layers.rs` reads the list and checks the code against it.
//!
//! ```text
//! settings                      names of option values
//! io                            atomic writes, bounded reads, file names, escaping
//! work                          progress, cancellation, size limits of jobs
//! time                          easing curves and timing
//! colour                        paints and their interpolation
//! geometry                      points, matrices, polygons, exact predicates
//! numerics                      sparse positive definite systems and small solvers
//! mesh                          triangle meshes: connectivity, triangulation, subdivision
//! field                         grids, distance transforms, contours
//! design                        designs and their importers
//! correspondence                which point of one design is which of another
//! compatible                    one connectivity, several embeddings
//! warp                          rows of the table: where each point is at t
//! content                       columns of the table: what is drawn there
//! recording                     a warp as polynomials in t, and checks at every t
//! transition                    methods, matching, frames, style
//! space                         blends of many designs, and maps of them
//! structure                     statics of trusses and of their in-betweens
//! measure                       quality measures, defects and remedies
//! project                       project files and the gallery
//! export                        images, contact sheets, animations, vector files
//! error                         from files to a transition, one error type
//! stage  (feature `bevy`)       MorphPlugin: transitions in a Bevy world
//! app    (feature `app`)        the window: playback, panels, keys, capture
//! cli    (feature `cli`)        the subcommands
//! ```
//!
//! Coordinates are `f64` with y up. The core has no global state, logs nothing and prints nothing.

#![forbid(unsafe_code)]

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

pub mod structure;

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

/// Compiles the examples in the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

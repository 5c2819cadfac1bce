//! Changes of topology: cutting, filling holes, and joining two surfaces.
//!
//! Every other crate keeps the triangles that a file has. This one takes surfaces with their attributes ([`Part`]) and
//! gives a [`NewShape`]: old and new vertices and triangles, each with its source, so that a caller can find materials,
//! groups and polygons again. [`fill()`] makes the least triangulation of each rim, as dense as the surface around, and
//! fairs it; [`merge()`] bends two parts by any method of `deform` until their borders meet, and puts them together
//! without a crack. Borders that have no such answer ([`Borders::faulty`]) are refused in words.
//!
//! A hole in a sphere is closed by points that lie on the sphere again:
//!
//! ```
//! use pliant_deform::Budget;
//! use pliant_mesh::{Cancel, Progress, shapes};
//! use pliant_stitch::{Holes, fill};
//!
//! let mut sphere = shapes::icosphere(4);
//! let positions = sphere.positions.clone();
//! sphere.triangles.retain(|corners| corners.iter().all(|corner| positions[corner.index()].z < 0.9));
//! let model = shapes::model(sphere);
//! let filled = fill(&model, Holes::Every, Budget::default(), &Progress::new(), &Cancel::new())?;
//!
//! assert_eq!(filled.holes.len(), 1);
//! let points = &filled.holes[0].points;
//! assert!(!points.is_empty() && points.iter().all(|point| (point.length() - 1.0).abs() < 0.01));
//! # Ok::<(), pliant_stitch::StitchError>(())
//! ```

mod borders;
mod crossing;
mod cut;
mod dress;
mod error;
mod fill;
mod filled_shape;
mod merge;
mod part;
mod shape;

pub use borders::{Border, Borders};
pub use error::{BorderFault, StitchError};
pub use fill::{Filled, FilledHole, Holes, fill};
pub use merge::{Joins, MergeError, Merged, Pair, PlacementOfB, Seam, merge};
pub use part::{Attributes, Part};
pub use shape::{Age, NewShape, TriangleSource, VertexSource};

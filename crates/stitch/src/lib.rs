//! Changes of topology: cutting, filling holes, and joining two surfaces.
//!
//! Every other crate keeps the triangles of a file. This one takes surfaces with their attributes ([`Part`]) and gives
//! a [`NewShape`]: old and new vertices and triangles, each with its source, so that a caller can find materials,
//! groups and polygons again. [`fill()`] triangulates each rim with least weight, as dense as the surrounding surface,
//! and fairs the patch; [`merge()`] bends two parts by any method of `deform` until their borders meet, and joins them
//! without a crack. Borders without a solution ([`Borders::faulty`]) are refused with a sentence.
//!
//! Points that are again on the sphere close a hole in it:
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
mod curve;
mod cut;
mod dress;
mod error;
mod fill;
mod filled_shape;
mod merge;
mod part;
mod pieces;
mod plane;
mod shape;

pub use borders::{Border, Borders};
pub use curve::{Sight, SurfaceCurve};
pub use error::{BorderFault, StitchError};
pub use fill::{Filled, FilledHole, Holes, Reason, Unfilled, fill};
pub use merge::{Joins, MergeError, Merged, Pair, PartBending, PlacementOfB, Seam, merge};
pub use part::{Attributes, Part};
pub use plane::{Keep, Plane};
pub use shape::{Age, NewShape, TriangleSource, VertexSource};

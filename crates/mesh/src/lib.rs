//! A triangle surface in memory: topology, geometry, welding, diagnosis, distances along the surface and a
//! bounding-volume hierarchy, and the one pair of [`Progress`] and [`Cancel`] that every long job takes.
//!
//! Three vertex sets exist and must not be mixed; each has its own id type:
//! [`FileVertex`] (what is saved), [`DrawnVertex`] (a file vertex seen through one node: what is rendered and
//! picked) and [`SurfaceVertex`] (welded in world space: what is solved). [`Model`] holds the tables between them.
//!
//! Long loops run on the rayon pool that the caller installed. How work is cut into pieces never depends on the
//! number of threads, so results are the same bits whatever it is.

mod areas;
mod blocks;
mod boundary;
mod bvh;
mod components;
mod contacts;
mod contours;
mod diagnosis;
mod distance;
mod distortion;
mod drawn;
mod drawn_set;
mod drawn_triangles;
mod faces;
mod finding;
mod findings;
mod front;
pub mod geometry;
mod gradient;
mod ids;
mod joining;
mod model;
mod morton;
mod normals;
mod object;
mod parts;
mod progress;
mod rings;
pub mod shapes;
mod surface;
mod survey;
mod topology;
mod triangle_distance;
mod weld;

pub use bvh::{Bvh, Hit};
pub use components::Component;
pub use contacts::{Contact, component_areas, contacts};
pub use contours::{ContourLine, Crossing, contours};
pub use diagnosis::{Diagnosis, Example};
pub use distance::{DistanceSearch, distances_along_surface};
pub use distortion::Distortion;
pub use drawn::Drawn;
pub use drawn_set::DrawnSet;
pub use faces::Faces;
pub use finding::Finding;
pub use findings::{FindingKind, Findings, Named};
pub use geometry::{
    Bounds, area_of_lengths, bounding_box, cotangents, edge_lengths, face_area, face_areas, face_normal,
    mixed_corner_areas, mixed_voronoi_areas, signed_volume, vertex_normals,
};
pub use gradient::face_gradient;
pub use ids::{DrawnVertex, FileVertex, SurfaceVertex};
pub use model::{Model, SurfaceOfFile, WeldOptions};
pub use object::Object;
pub use progress::{Cancel, Cancelled, Progress};
pub use rings::FanKind;
pub use surface::Surface;
pub use survey::Survey;
pub use topology::Topology;

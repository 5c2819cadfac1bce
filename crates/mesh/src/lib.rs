//! A triangle surface in memory: topology, geometry, welding, findings, distances along the surface, symmetry,
//! curves and a bounding-volume hierarchy, and the one pair of [`Progress`] and [`Cancel`] that every long job takes.
//!
//! Three vertex sets exist and must not be mixed; each has its own id type: [`FileVertex`] (saved), [`DrawnVertex`] (a
//! file vertex seen through one node; rendered and picked) and [`SurfaceVertex`] (welded in world space; solved for).
//! [`Model`] holds the tables between them.
//!
//! Long loops run on the rayon pool that the caller installed. The pieces of the work never depend on the number of
//! threads, so the bits of results do not either.
//!
//! A square of two triangles that don't share their vertices, welded into a surface:
//!
//! ```
//! use glam::DVec3;
//! use pliant_mesh::{Cancel, Drawn, DrawnVertex, Model, Progress, SurfaceVertex, WeldOptions, vertex_normals};
//!
//! let corner = |x, y| DVec3::new(x, y, 0.0);
//! let positions = vec![
//!     corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0),
//!     corner(0.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0),
//! ];
//! let triangles = vec![[0, 1, 2].map(DrawnVertex), [3, 4, 5].map(DrawnVertex)];
//! let drawn = Drawn::once(positions, triangles);
//! let model = Model::weld(drawn, &WeldOptions::default(), &Progress::new(), &Cancel::new())?;
//!
//! assert_eq!(model.drawn.vertex_count(), 6);
//! assert_eq!(model.surface.positions.len(), 4);
//! assert_eq!(model.topology.components().len(), 1);
//! assert_eq!(model.drawn.surface_vertex(DrawnVertex(3)), Some(SurfaceVertex(0)));
//! let mut normals = Vec::new();
//! vertex_normals(&model.surface.triangles, &model.topology, &model.surface.positions, &mut normals);
//! assert_eq!(normals, [DVec3::Z; 4]);
//! # Ok::<(), pliant_mesh::Cancelled>(())
//! ```

mod bvh;
mod contacts;
mod curves;
mod drawn;
mod findings;
mod geodesics;
pub mod geometry;
mod ids;
mod inspection;
mod model;
mod oriented_points;
mod progress;
pub mod shapes;
mod surface;
mod symmetry;
mod topology;
mod vectors;
mod weld;

pub use bvh::{Bvh, Hit, SelfIntersection, SelfIntersections};
pub use contacts::{Contact, component_areas, contacts};
pub use curves::{
    BendRange, Curve, CurveMotion, CurvePath, CurveRefused, FREE_BEND, JointLimits, LARGEST_TWIST_DEG, SCALE_RANGE,
    feature_line, pulled_briefly, pulled_chain, pulled_within, triangles_under,
};
pub use drawn::{Drawn, DrawnSet, Object, Rounding};
pub use findings::{Finding, FindingKind, Findings, Named};
pub use geodesics::{DistanceSearch, JOINT_RINGS, Joint, Shape, distances_along_surface, joint_of, level_crossing};
pub use geometry::{
    Bounds, Damage, Damaged, Distortion, Vector3, area_of_lengths, bounding_box, concavities, cotangents, edge_lengths,
    face_area, face_areas, face_gradient, face_normal, has_normal, is_without_area, mean_curvatures,
    mixed_corner_areas, mixed_voronoi_areas, point_in_words, vertex_normals,
};
pub use ids::{DrawnVertex, FileVertex, SurfaceVertex};
pub use inspection::{Example, Inspection, LocatedFinding};
pub use model::{LOOSE_BIT, Model, SurfaceOfFile};
pub use oriented_points::{NearPoint, OrientedPoints};
pub use progress::{Cancel, Cancelled, Progress};
pub use surface::Surface;
pub use symmetry::{Counterparts, MirrorPlane, image_of, mirror_planes, symmetry_plane};
pub use topology::{Component, ContourLine, Crossing, Faces, FanKind, Topology, contours};
pub use vectors::{Vectors, vectors};
pub use weld::WeldOptions;

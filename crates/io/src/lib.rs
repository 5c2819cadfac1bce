//! Files as bytes: glTF/GLB, OBJ, PLY, STL, OFF, 3MF and USDZ in and out, losslessly; image decoding.
//!
//! [`read`] gives the complete file as stored (a [`Scene`]) and the geometry that it shows ([`pliant_mesh::Drawn`]).
//! [`Scene::save`] gives bytes back in which only the moved vertices' numbers differ, or the same shape as another kind
//! of file. Bytes come in and go out; a [`Resolver`] supplies neighbours (a `.gltf`'s buffers, an `.obj`'s materials),
//! so nothing here knows a path.
//!
//! One vertex of an OFF file is moved; the rest of the file stays the same:
//!
//! ```
//! use pliant_io::{Bytes, Format, MorphDeltas, Placement, Resolver, Save, SceneAndDrawn, read};
//! use pliant_mesh::{Cancel, Progress};
//!
//! /// A file that needs no other.
//! struct Alone;
//!
//! impl Resolver for Alone {
//!     fn read(&self, uri: &str) -> Result<Bytes, String> {
//!         Err(format!("there is no {uri}"))
//!     }
//! }
//!
//! let file = "OFF # a triangle\n3 1 0\n0 0 0\n1.50 0 0\n0 1 0\n3 0 1 2\n";
//! let (progress, cancel) = (Progress::new(), Cancel::new());
//! let SceneAndDrawn { scene, drawn } =
//!     read(file.into(), Format::Off, "triangle.off", &Alone, &progress, &cancel)?;
//! let mut positions = drawn.positions.clone();
//! positions[2].y = 2.25;
//! let save = Save {
//!     drawn: &drawn,
//!     positions: &positions,
//!     deltas: MorphDeltas::WhereFarOff,
//!     turned: &[],
//!     format: Format::Off,
//!     name: "triangle.off",
//!     placement: Placement::SameFile,
//! };
//! let saved = scene.save(&save, &progress, &cancel)?;
//!
//! let expected = "OFF # a triangle\n3 1 0\n0 0 0\n1.50 0 0\n0 2.25 0\n3 0 1 2\n";
//! assert_eq!(saved.files[0].bytes, expected.as_bytes());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod appearance;
mod archive;
mod bytes;
mod cache_frames;
mod convert;
mod difference;
mod error;
mod format;
mod gltf;
mod images;
mod obj;
mod objects;
mod off;
mod ply;
mod point_cache;
mod polygon;
mod quote;
mod save;
mod scene;
mod source;
mod stl;
mod summary;
mod text;
mod threemf;
mod usdz;

pub use appearance::{
    AlphaMode, Appearance, Group, Image, Lighting, Map, Material, ObjNames, Origin, OriginalMaterial, UvSet, Wrap,
};
pub use bytes::Bytes;
pub use cache_frames::CacheFrames;
pub use convert::Polygons;
pub use difference::{Difference, What};
pub use error::{ImageError, ReadError, SaveError};
pub use format::{Format, UnknownFormat};
pub use gltf::{
    MorphPlayback, bytes_of_name, is_same_document, name_of_bytes, neighbours_named, with_neighbours_renamed,
};
pub use images::pixels::Rgba8;
pub use images::{DecodedImage, IMAGE_BYTES, decode_images};
pub use point_cache::{PointCache, PointCacheFormat};
pub use quote::{quoted, steers};
pub use save::{
    FewTargets, MorphAnimation, MorphDeltas, MorphTarget, OutputFile, Placement, Role, Save, Saved, ShapeDirections,
    numbered,
};
pub use scene::pose::positions_in_pose;
pub use scene::unsaved::UnsavedShape;
pub use scene::{Scene, SceneAndDrawn, read};
pub use source::Resolver;
pub use summary::Summary;

//! Files as bytes: glTF/GLB, OBJ, PLY, STL and OFF in and out, losslessly; image decoding.
//!
//! [`read`] gives the file as stored (a [`Scene`], nothing thrown away) and what it shows ([`pliant_mesh::Drawn`]).
//! [`Scene::save`] gives bytes back in which only the moved vertices' numbers differ, or the same shape as another
//! kind of file. Bytes come in and go out; neighbours (a `.gltf`'s buffers, an `.obj`'s materials) are asked for
//! through a [`Resolver`], so nothing here knows a path.

mod appearance;
mod bytes;
mod convert;
mod error;
mod format;
mod gltf;
mod images;
mod obj;
mod off;
mod ply;
mod polygon;
mod quote;
mod save;
mod scene;
mod source;
mod stl;
mod text;

pub use appearance::{AlphaMode, Appearance, Group, Image, Lighting, Map, Material, Origin, UvSet, Wrap};
pub use bytes::Bytes;
pub use error::{ImageError, ReadError, SaveError, UnknownFormat};
pub use format::Format;
pub use gltf::{bytes_of_name, is_same_document, name_of_bytes, neighbours_named, with_neighbours_renamed};
pub use images::decode::decode_image;
pub use images::pixels::Rgba8;
pub use images::{DecodedImage, IMAGE_BYTES, decode_images};
pub use quote::{quoted, steers};
pub use save::{MorphTarget, OutputFile, Placement, Role, Save, Saved, numbered};
pub use scene::difference::{Difference, What};
pub use scene::summary::Summary;
pub use scene::{Scene, SceneAndDrawn, read};
pub use source::Resolver;

//! Drawing with wgpu: slices of numbers in, a texture or picked triangle numbers out.
//!
//! A [`Renderer`] owns the pipelines of one device. A [`Surface`] is a triangle mesh in GPU buffers, made from a
//! [`SurfaceData`] of slices and updated in place while it moves. A [`Frame`] says what to draw and how it is seen;
//! [`Renderer::draw`] draws it into a [`Target`], a texture of our own that a window shows as an image, and
//! [`Renderer::draw_to_image`] draws the very same frame into bytes. [`Renderer::pick`] answers which triangles lie
//! under a rectangle of pixels. [`Headless`] is a renderer that needs no window.
//!
//! "World" here is *relative to a centre that the caller subtracts in f64*: scans stand at geographic coordinates
//! where f32 has no digits left. Depth is reversed: 1 at the near plane, 0 far away.
//!
//! Invariant: no mesh type, no solver, no egui, no camera, no files.

mod bindings;
mod buffers;
mod chunks;
mod draw_calls;
mod edges;
mod environment;
mod error;
mod frame;
mod fullscreen;
mod grid;
mod guard;
mod headless;
mod image;
mod lod;
mod matcap;
mod material;
mod overlay;
mod pages;
mod palette;
mod pick;
mod pipelines;
mod readback;
mod recording;
mod renderer;
mod shaders;
mod surface;
mod surface_data;
mod surface_line;
mod target;
mod texture;
mod timer;
mod uniforms;
mod view;

pub use chunks::{ChunkBounds, Chunks};
pub use error::{NoGpu, RenderError};
pub use frame::{Background, Borders, Detail, Faces, Frame, Outlines, Shading, Style, Wireframe};
pub use grid::Grid;
pub use headless::{Headless, device_descriptor};
pub use image::Image;
pub use matcap::Matcap;
pub use material::{AlphaMode, Lighting, Map, Material, MaterialGroup, UvSet, Wrap};
pub use overlay::{Overlay, OverlayLine, OverlayTriangle};
pub use palette::{border, region};
pub use pick::{IdTarget, PickRequest, Picked, PickedIds, PixelRect};
pub use renderer::Renderer;
pub use surface::{Materials, ShapeData, Surface};
pub use surface_data::{ColourSpace, SurfaceData};
pub use surface_line::{EdgePoint, SurfaceLine};
pub use target::{Samples, Target};
pub use texture::{Encoding, TextureData};
pub use view::View;

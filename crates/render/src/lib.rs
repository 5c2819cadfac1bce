//! Rendering with wgpu: slices of numbers go in, a texture or picked triangle ids come out.
//!
//! A [`Renderer`] owns the pipelines of one device. A [`Surface`] is a triangle mesh in GPU buffers, made from the
//! slices of a [`SurfaceData`] and updated in place while it moves. A [`Frame`] says what to draw and from where.
//! [`Renderer::draw`] draws it into a [`Target`], an offscreen texture that a window shows as an image;
//! [`Renderer::draw_to_image`] draws the same frame into memory. [`Renderer::pick`] finds the triangles in a rectangle
//! of pixels. [`Headless`] is a renderer without a window.
//!
//! World space here is *relative to a centre that the caller subtracts in f64*, because scans can have geographic
//! coordinates, for which f32 is too coarse. Depth is reversed: 1 at the near plane, 0 at infinity.
//!
//! Invariant: this crate knows no mesh type, no solver, no egui, no camera and no files.

mod device;
mod frame;
mod materials;
mod pick;
mod pipelines;
mod renderer;
mod surface;

pub use device::error::{NoGpu, RenderError};
pub use device::headless::{Headless, device_descriptor};
pub use frame::grid::Grid;
pub use frame::image::Image;
pub use frame::overlay::{Overlay, OverlayLine, OverlayTriangle};
pub use frame::palette::{border, region};
pub use frame::target::{Samples, Target};
pub use frame::view::View;
pub use frame::{Background, Borders, Detail, Faces, Frame, Outlines, Shading, Style, Wireframe};
pub use materials::Materials;
pub use materials::matcap::Matcap;
pub use materials::material::{AlphaMode, Lighting, Map, Material, MaterialGroup, UvSet, Wrap};
pub use materials::texture::{Encoding, TextureData};
pub use pick::{IdTarget, PickRequest, Picked, PickedIds, PixelRect};
pub use renderer::Renderer;
pub use surface::Surface;
pub use surface::chunks::{ChunkBounds, Chunks};
pub use surface::data::{ColourSpace, SurfaceData};
pub use surface::lines::{EdgePoint, SurfaceLine};
pub use surface::update::ShapeData;

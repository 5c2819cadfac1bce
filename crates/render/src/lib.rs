//! Rendering with wgpu: slices of numbers go in, a texture or picked triangle ids come out.
//!
//! A [`Renderer`] draws on one device, its [`Gpu`]. A [`Surface`] is a triangle mesh in GPU buffers, made from the
//! slices of a [`SurfaceData`] and updated in place while it moves. A [`Frame`] has the things to draw and the view.
//! [`Renderer::draw`] draws it into a [`Target`], an offscreen texture that a window shows as an image;
//! [`Renderer::draw_to_image`] draws the same frame into memory. [`Renderer::pick`] finds the triangles in a rectangle
//! of pixels. [`Headless`] is a renderer without a window.
//!
//! World space here is *relative to a centre that the caller subtracts in f64*, because scans can have geographic
//! coordinates, for which f32 is too coarse. Depth is reversed: 1 at the near plane, 0 at infinity.
//!
//! Invariant: this crate knows no mesh type, no solver, no egui, no camera and no files.
//!
//! A triangle, drawn without a window:
//!
//! ```
//! use glam::Vec3;
//! use pliant_render::{Frame, Headless, Samples, Style, Surface, SurfaceData, View};
//!
//! # match Headless::new() {
//! #     Err(error) => return Ok(println!("skipped: pictures ({error})")),
//! #     Ok(_) => {}
//! # }
//! let mut headless = Headless::new()?;
//! let triangle = SurfaceData {
//!     positions: &[[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]],
//!     normals: &[[0.0, 0.0, 1.0]; 3],
//!     triangles: &[[0, 1, 2]],
//!     ..Default::default()
//! };
//! let surface = Surface::new(headless.renderer.gpu(), &triangle)?;
//! let eye = View::look_at(Vec3::new(0.0, 0.0, 4.0), Vec3::ZERO, Vec3::Y);
//! let frame = Frame {
//!     view: &View::perspective(0.8, 1.5, 0.01, eye),
//!     style: &Style::default(),
//!     surfaces: &[&surface],
//!     grid: None,
//!     overlays: &[],
//! };
//! let image = headless.renderer.draw_to_image([120, 80], Samples::Four, &frame)?;
//!
//! let (middle, corner) = (image.pixel(60, 40), image.pixel(0, 0));
//! assert_ne!(middle, corner, "clay in the middle, the background in the corner");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod device;
mod frame;
mod gpu;
mod headless;
mod materials;
mod pick;
mod pipelines;
mod renderer;
mod surface;
mod target;
mod texture;
mod uniforms;

pub use device::error::{NoGpu, RenderError};
pub use device::opening::device_descriptor;
pub use frame::grid::Grid;
pub use frame::image::Image;
pub use frame::overlay::{Overlay, OverlayLine, OverlayTriangle};
pub use frame::palette::{border, region};
pub use frame::style::{Background, Borders, Detail, Faces, Outlines, Shading, Shadows, Style, Wireframe};
pub use frame::view::View;
pub use gpu::Gpu;
pub use headless::Headless;
pub use materials::Materials;
pub use materials::matcap::Matcap;
pub use materials::material::{AlphaMode, Lighting, Map, Material, MaterialGroup, UvSet};
pub use pick::{IdTarget, PickRequest, Picked, PickedIds, PixelRect};
pub use renderer::Renderer;
pub use renderer::frame::Frame;
pub use surface::Surface;
pub use surface::chunks::{ChunkBounds, Chunks};
pub use surface::data::{ColourSpace, SurfaceData};
pub use surface::lines::{EdgePoint, SurfaceLine};
pub use surface::update::ShapeData;
pub use target::{Samples, Target};
pub use texture::{Encoding, TextureData, Wrap};

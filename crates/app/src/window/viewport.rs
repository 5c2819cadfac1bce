//! The one place where egui meets the renderer: the 3D view, drawn into a texture of its own and shown as an image.
//!
//! The picture is drawn anew only when the shape, the colours, the marks, the camera, the style or the size changed.
//! On a device that is the processor itself a changing view is drawn with one sample a pixel, and once more with four
//! when it has come to rest.

use std::sync::{Arc, PoisonError, RwLock, RwLockReadGuard};
use std::time::{Duration, Instant};

use eframe::egui::{self, TextureId};
use eframe::egui_wgpu::RenderState;
use glam::DVec3;
use pliant_editor::{Editor, SceneView};
use pliant_render::{Frame, RenderError, Renderer, Samples, Style, Surface, Target};

use super::message::Posed;
use crate::drawing::{self, Drawing, Pose};

/// Surfaces above this many triangles are not drawn a second time for smooth borders on a software device.
const SOFT_SMOOTH_TRIANGLES: usize = 300_000;

/// The view's GPU side.
pub struct Viewport {
    state: RenderState,
    gpu: Gpu,
    software: Option<String>,
    target: Target,
    texture: Option<TextureId>,
    surface: Option<Shown>,
    drawn: Option<DrawnKey>,
    drawings: u64,
    drawing_time: Duration,
}

/// The device, shared with the threads that upload files. Drawing needs it alone, and rather skips a frame than wait.
#[derive(Clone)]
pub struct Gpu(Arc<RwLock<Renderer>>);

impl Gpu {
    /// Uploads a file's surface.
    ///
    /// # Errors
    /// As [`Surface::new`].
    pub fn upload(&self, drawing: &Drawing, pose: &Pose) -> Result<Surface, RenderError> {
        drawing.upload(&self.read(), pose)
    }

    fn read(&self) -> RwLockReadGuard<'_, Renderer> {
        // A panic elsewhere leaves the device as it is.
        self.0.read().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The surface in GPU buffers and what it shows.
struct Shown {
    surface: Surface,
    drawing: Arc<Drawing>,
    displacements: Arc<Vec<DVec3>>,
    regions_revision: Option<u64>,
}

/// What the picture in the texture was drawn from.
#[derive(Clone, PartialEq)]
struct DrawnKey {
    pixels_per_point: f32,
    shape: usize,
    regions: Option<u64>,
    overlay: u64,
    camera: u64,
    style: Style,
    size_px: [u32; 2],
    samples: Samples,
}

impl Viewport {
    /// A view on the window's device.
    ///
    /// # Errors
    /// As [`Renderer::new`].
    pub fn new(state: RenderState) -> Result<Self, RenderError> {
        let renderer = Renderer::new(&state.device, &state.queue)?;
        let software = renderer.is_software().then(|| renderer.device_name());
        Ok(Self {
            state,
            gpu: Gpu(Arc::new(RwLock::new(renderer))),
            software,
            target: Target::new(),
            texture: None,
            surface: None,
            drawn: None,
            drawings: 0,
            drawing_time: Duration::ZERO,
        })
    }

    /// The device's name if it is the processor itself.
    pub fn software_device(&self) -> Option<&str> {
        self.software.as_deref()
    }

    /// What uploads files' surfaces, from any thread.
    pub fn gpu(&self) -> Gpu {
        self.gpu.clone()
    }

    /// How often a picture was drawn.
    pub fn drawings(&self) -> u64 {
        self.drawings
    }

    /// How long drawing has kept the window's thread busy so far: on a software device it is the processor that
    /// draws.
    pub fn drawing_time(&self) -> Duration {
        self.drawing_time
    }

    /// Shows another file.
    pub fn show(&mut self, drawing: Arc<Drawing>, surface: Surface, displacements: Arc<Vec<DVec3>>) {
        self.drawn = None;
        self.surface = Some(Shown {
            surface,
            drawing,
            displacements,
            regions_revision: None,
        });
    }

    /// Moves the surface to a pose of the file that is shown.
    ///
    /// # Errors
    /// As [`Surface::update_positions`].
    pub fn pose(&mut self, posed: Posed) -> Result<(), RenderError> {
        let Some(shown) = &mut self.surface else { return Ok(()) };
        let renderer = self.gpu.read();
        shown.surface.update_positions(&renderer, &posed.pose.positions)?;
        shown.surface.update_normals(&renderer, &posed.pose.normals)?;
        shown.displacements = posed.displacements;
        Ok(())
    }

    /// The shape in the GPU's buffers.
    pub fn displacements(&self) -> Option<&Arc<Vec<DVec3>>> {
        self.surface.as_ref().map(|shown| &shown.displacements)
    }

    /// Draws if anything changed and paints the picture into `rect`. Returns whether a smoother picture is worth a
    /// second drawing when nothing has changed for a while.
    ///
    /// # Errors
    /// As [`Renderer::draw`].
    pub fn paint(
        &mut self,
        ui: &egui::Ui,
        rect: egui::Rect,
        editor: &Editor,
        smooth: Smoothness,
    ) -> Result<bool, RenderError> {
        let view = editor.view();
        let pixels_per_point = ui.ctx().pixels_per_point();
        let size_px = pixels(rect.size() * pixels_per_point);
        let software = self.software.is_some();
        let triangles = self.surface.as_ref().map_or(0, |shown| shown.surface.triangle_count());
        let samples = match smooth {
            Smoothness::Moving if software => Samples::One,
            Smoothness::Resting if software && triangles > SOFT_SMOOTH_TRIANGLES => Samples::One,
            Smoothness::Moving | Smoothness::Resting => Samples::Four,
        };
        self.update_regions(editor, &view)?;
        let mut key = self.key(&view, pixels_per_point, size_px, samples);
        // A picture of the same thing with more samples than asked for is good as it is.
        let finer = DrawnKey {
            samples: Samples::Four,
            ..key.clone()
        };
        if self.drawn.as_ref() == Some(&finer) {
            key = finer;
        } else if self.drawn.as_ref() != Some(&key) {
            if self.draw(&view, &key)? {
                self.drawn = Some(key.clone());
                self.drawings += 1;
            } else {
                ui.ctx().request_repaint();
            }
        }
        if let Some(texture) = self.texture {
            let whole = egui::Rect::from_min_max(egui::Pos2::ZERO, egui::pos2(1.0, 1.0));
            ui.painter().image(texture, rect, whole, egui::Color32::WHITE);
        }
        Ok(key.samples == Samples::One && triangles <= SOFT_SMOOTH_TRIANGLES)
    }

    fn key(&self, view: &SceneView<'_>, pixels_per_point: f32, size_px: [u32; 2], samples: Samples) -> DrawnKey {
        DrawnKey {
            pixels_per_point,
            shape: self
                .surface
                .as_ref()
                .map_or(0, |shown| Arc::as_ptr(&shown.displacements) as usize),
            regions: self.surface.as_ref().and_then(|shown| shown.regions_revision),
            overlay: view.overlay_revision,
            camera: view.camera_revision,
            style: drawing::style(view),
            size_px,
            samples,
        }
    }

    fn update_regions(&mut self, editor: &Editor, view: &SceneView<'_>) -> Result<(), RenderError> {
        let (Some(shown), Some(model)) = (&mut self.surface, view.model) else {
            return Ok(());
        };
        if shown.regions_revision == Some(view.regions_revision) {
            return Ok(());
        }
        let mut colours = Vec::new();
        editor.region_colours(&mut colours);
        let colours = drawing::drawn_colours(model, &colours);
        shown.surface.update_regions(&self.gpu.read(), &colours)?;
        shown.regions_revision = Some(view.regions_revision);
        Ok(())
    }

    /// Draws; false if a file is just being uploaded, which this thread does not wait for.
    fn draw(&mut self, view: &SceneView<'_>, key: &DrawnKey) -> Result<bool, RenderError> {
        let gpu = self.gpu.clone();
        let Ok(mut renderer) = gpu.0.try_write() else {
            return Ok(false);
        };
        if self.target.resize(&renderer, key.size_px, key.samples)? {
            self.register();
        }
        let centre = self.surface.as_ref().map_or(DVec3::ZERO, |shown| shown.drawing.centre);
        let eye = drawing::view(view.camera, view.viewport_px, centre);
        let overlays = drawing::overlays(view, centre, key.pixels_per_point);
        let surfaces: Vec<&Surface> = self.surface.iter().map(|shown| &shown.surface).collect();
        let frame = Frame {
            view: &eye,
            style: &key.style,
            surfaces: &surfaces,
            overlays: &overlays,
        };
        let start = Instant::now();
        let drawn = renderer.draw(&self.target, &frame);
        self.drawing_time += start.elapsed();
        drawn.map(|()| true)
    }

    /// Tells egui about a new texture.
    fn register(&mut self) {
        let mut egui_renderer = self.state.renderer.write();
        let Some(view) = self.target.texture_view() else {
            if let Some(texture) = self.texture.take() {
                egui_renderer.free_texture(&texture);
            }
            return;
        };
        let (device, filter) = (&self.state.device, wgpu::FilterMode::Linear);
        match self.texture {
            Some(texture) => egui_renderer.update_egui_texture_from_wgpu_texture(device, view, filter, texture),
            None => self.texture = Some(egui_renderer.register_native_texture(device, view, filter)),
        }
    }
}

/// Whether the view changes or rests.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Smoothness {
    /// Something moves: speed first.
    Moving,
    /// Nothing has moved for a while: beauty first.
    Resting,
}

fn pixels(size: egui::Vec2) -> [u32; 2] {
    [size.x, size.y].map(|side| side.round().clamp(0.0, 16_384.0) as u32)
}

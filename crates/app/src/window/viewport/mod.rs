//! The one place where egui meets the renderer: the 3D view, drawn into a texture of its own and shown as an image.
//!
//! The picture is drawn again only when the shape, the colours, the marks, the camera, the style or the size changes.
//! If the processor itself draws, a changing view is drawn with one sample a pixel and large meshes with fewer
//! triangles, and again in full when it has come to rest.

pub(in crate::window) mod axis_ball;
pub(in crate::window) mod backdrop;
pub(in crate::window) mod before;
pub(in crate::window) mod beside;
pub(in crate::window) mod coarseness;
pub(in crate::window) mod context_menu;
pub(in crate::window) mod drawn_key;
pub(in crate::window) mod gpu;
pub(in crate::window) mod method_views;
mod pictures;
pub(in crate::window) mod pose_queue;
pub(in crate::window) mod shown;
pub(in crate::window) mod side_view;
pub(in crate::window) mod skins;
pub(in crate::window) mod stiffness_legend;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use eframe::egui::{self, TextureId};
use eframe::egui_wgpu::RenderState;
use glam::DVec3;
use pliant_editor::{Editor, Look, SceneView, Shading};
use pliant_render::{
    Background, Detail, Frame, Materials, RenderError, Renderer, Samples, Shadows, Style, Surface, Target,
};

use crate::window::threads::message::Posed;
use crate::window::viewport::drawn_key::DrawnKey;
use backdrop::Backdrop;
use coarseness::Coarseness;
use gpu::Gpu;
use pliant_picture::drawing::{self, Drawing, Field, Scale};
use shown::{Colours, Floor, Shown, address};

/// Surfaces above this many triangles are not drawn a second time for smooth borders on a software device.
const SOFT_SMOOTH_TRIANGLES: usize = 300_000;
/// The view's GPU side.
pub struct Viewport {
    state: RenderState,
    gpu: Gpu,
    software: Option<String>,
    /// Set by whoever notices that the device is lost.
    lost: Arc<AtomicBool>,
    target: Target,
    texture: Option<TextureId>,
    surface: Option<Shown>,
    drawn: Option<DrawnKey>,
    drawings: u64,
    drawing_time: Duration,
    coarseness: Coarseness,
    /// The opacity of the picture over its background; below 1 the surroundings of the surface are left out.
    opacity: f32,
    /// The colour by which the picture is multiplied.
    tint: egui::Color32,
    /// True if the surface is drawn without its surroundings, which lie under it in another view.
    is_cut_out: bool,
    /// The ground of a view without a surface.
    floor: Option<Floor>,
}

impl Viewport {
    /// A view on the window's device.
    ///
    /// # Errors
    /// As [`Renderer::new`].
    pub fn new(state: RenderState) -> Result<Self, RenderError> {
        let lost = Arc::new(AtomicBool::new(false));
        let is_lost = Arc::clone(&lost);
        state
            .device
            .set_device_lost_callback(move |_, _| is_lost.store(true, Ordering::Relaxed));
        // Our own requests to the device return their errors; another party's error on a device that is being lost must
        // not end the program.
        state.device.on_uncaptured_error(Arc::new(|_| {}));
        let renderer = Renderer::new(&state.device, &state.queue)?;
        let software = renderer.is_software().then(|| renderer.device_name());
        Ok(Self::of(state, Gpu::new(renderer), software, lost))
    }

    /// Another view on the same device, still empty.
    pub fn beside(&self) -> Self {
        let lost = Arc::clone(&self.lost);
        Self::of(self.state.clone(), self.gpu.clone(), self.software.clone(), lost)
    }

    fn of(state: RenderState, gpu: Gpu, software: Option<String>, lost: Arc<AtomicBool>) -> Self {
        Self {
            state,
            gpu,
            software,
            lost,
            target: Target::new(),
            texture: None,
            surface: None,
            drawn: None,
            drawings: 0,
            drawing_time: Duration::ZERO,
            coarseness: Coarseness::default(),
            opacity: 1.0,
            tint: egui::Color32::WHITE,
            is_cut_out: false,
            floor: None,
        }
    }

    /// Chooses the opacity of the picture over its background: 1, or less for the surface alone.
    pub fn set_opacity(&mut self, opacity: f32) {
        if self.opacity != opacity {
            self.opacity = opacity;
            self.drawn = None;
        }
    }

    /// Draws the surface with its surroundings, or without them.
    pub fn set_cut_out(&mut self, is_cut_out: bool) {
        if self.is_cut_out != is_cut_out {
            self.is_cut_out = is_cut_out;
            self.drawn = None;
        }
    }

    /// Draws only the surroundings of another view's surface.
    pub fn set_surroundings_of(&mut self, other: &Self) {
        let floor = other.surface.as_ref().map(Shown::floor);
        if self.floor != floor {
            self.floor = floor;
            self.drawn = None;
        }
    }

    /// Chooses the colour by which the picture is multiplied.
    pub fn set_tint(&mut self, tint: egui::Color32) {
        self.tint = tint;
    }

    /// The shown file.
    pub fn shows(&self, drawing: &Arc<Drawing>) -> bool {
        self.surface
            .as_ref()
            .is_some_and(|shown| Arc::ptr_eq(&shown.drawing, drawing))
    }

    /// Returns true if the device is lost: a driver was updated or crashed, or a card was removed.
    pub fn is_lost(&self) -> bool {
        self.lost.load(Ordering::Relaxed)
    }

    /// Loses the device, like a driver that crashes, to test that nothing else is lost.
    pub fn lose_device(&self) {
        self.state.device.destroy();
        self.lost.store(true, Ordering::Relaxed);
    }

    /// The device's name if it is the processor itself.
    pub fn software_device(&self) -> Option<&str> {
        self.software.as_deref()
    }

    /// The graphics device in use: its name, interface and driver.
    pub fn device(&self) -> String {
        let info = self.state.adapter.get_info();
        let driver = format!("{} {}", info.driver, info.driver_info);
        match driver.trim() {
            "" => format!("{} ({})", info.name, info.backend),
            driver => format!("{} ({}, {driver})", info.name, info.backend),
        }
    }

    /// The means to upload files' surfaces, from any thread.
    pub fn gpu(&self) -> Gpu {
        self.gpu.clone()
    }

    /// The number of drawn pictures.
    pub fn drawings(&self) -> u64 {
        self.drawings
    }

    /// The time that drawing has kept the window's thread busy so far: a software device draws on the processor.
    pub fn drawing_time(&self) -> Duration {
        self.drawing_time
    }

    /// Shows another file. Returns the surface that was shown.
    pub fn show(&mut self, shown: Shown) -> Option<Shown> {
        self.drawn = None;
        self.coarseness = Coarseness::default();
        self.surface.replace(shown)
    }

    /// Gives the shown file its materials with their images, if it is still this one.
    ///
    /// # Errors
    /// As [`Surface::set_materials`].
    pub fn set_materials(&mut self, drawing: &Arc<Drawing>, materials: Materials) -> Result<(), RenderError> {
        match &mut self.surface {
            Some(shown) if Arc::ptr_eq(&shown.drawing, drawing) => {
                shown.materials_revision += 1;
                shown.awaits_images = false;
                shown.materials = Some(materials.clone());
                shown.surface.set_materials(materials)
            }
            _ => Ok(()),
        }
    }

    /// Shows the materials of the file without their images, which are not available.
    pub fn give_up_images(&mut self, drawing: &Arc<Drawing>) {
        if let Some(shown) = &mut self.surface
            && Arc::ptr_eq(&shown.drawing, drawing)
        {
            shown.materials_revision += 1;
            shown.awaits_images = false;
        }
    }

    /// Returns true if the file's images are still to come.
    pub fn awaits_images(&self) -> bool {
        self.surface.as_ref().is_some_and(|shown| shown.awaits_images)
    }

    /// The look that can be shown now: clay in place of materials whose images are still to come, because without them
    /// they are plain white, and in place of weights if there are none.
    fn present_look(&self, look: Look) -> Look {
        let shading = match look.shading {
            Shading::Material if self.awaits_images() => Shading::Clay,
            Shading::Weights if self.field() != Some(Field::Weight) => Shading::Clay,
            shading => shading,
        };
        Look {
            shading,
            // One switch shows and hides regions with their outlines.
            outlines: look.outlines && look.regions,
            ..look
        }
    }

    /// The materials with their images of the shown file, if it has them.
    pub fn materials(&self) -> Option<&Materials> {
        self.surface.as_ref()?.materials.as_ref()
    }

    /// The numbers behind the surface's colours.
    pub fn field(&self) -> Option<Field> {
        match self.surface.as_ref()?.colours {
            Colours::Field(field) => Some(field),
            Colours::Stiffness(_) => Some(Field::Stiffness),
            Colours::Weights(_) => Some(Field::Weight),
            Colours::None | Colours::Regions(_) => None,
        }
    }

    /// The meaning of the surface's colours, if they show numbers.
    pub fn scale(&self) -> Option<&Scale> {
        self.field()?;
        self.surface.as_ref()?.scale.as_deref()
    }

    /// Moves the surface to a pose of the shown drawing; a pose of another one changes nothing.
    ///
    /// # Errors
    /// As [`Surface::update_shape`].
    pub fn pose(&mut self, posed: Posed) -> Result<(), RenderError> {
        let Some(shown) = &mut self.surface else { return Ok(()) };
        if !Arc::ptr_eq(&posed.drawing, &shown.drawing) {
            return Ok(());
        }
        let renderer = self.gpu.read();
        shown.surface.update_shape(renderer.gpu(), &posed.pose.data())?;
        shown.displacements = posed.displacements;
        shown.drawing.put_back(posed.pose);
        if let Some(painted) = posed.painted {
            shown.surface.update_regions(renderer.gpu(), &painted.colours)?;
            shown.colours = Colours::Field(painted.field);
            shown.scale = Some(painted.scale);
        }
        Ok(())
    }

    /// The shape in the GPU's buffers.
    pub fn displacements(&self) -> Option<&Arc<Vec<DVec3>>> {
        self.surface.as_ref().map(|shown| &shown.displacements)
    }

    /// Draws the scene `view` with the editor's colours if anything changed, and paints the picture into `rect`.
    /// Returns whether a smoother picture is worth a second drawing when nothing has changed for a while.
    ///
    /// # Errors
    /// As [`Renderer::draw`].
    pub fn paint(
        &mut self,
        ui: &egui::Ui,
        rect: egui::Rect,
        view: &SceneView<'_>,
        editor: &Editor,
        smooth: Smoothness,
    ) -> Result<bool, RenderError> {
        let pixels_per_point = ui.ctx().pixels_per_point();
        let size_px = pixels(rect.size() * pixels_per_point);
        let software = self.software.is_some();
        let triangles = self.surface.as_ref().map_or(0, |shown| shown.surface.triangle_count());
        let samples = match smooth {
            Smoothness::Moving if software => Samples::One,
            Smoothness::Resting if software && triangles > SOFT_SMOOTH_TRIANGLES => Samples::One,
            Smoothness::Moving | Smoothness::Resting => Samples::Four,
        };
        if let Some(shown) = &mut self.surface {
            shown.update_regions(editor, &self.gpu)?;
            shown.update_rims(editor, &self.gpu)?;
        }
        let factor = match smooth {
            Smoothness::Moving => self.coarseness.factor(),
            Smoothness::Resting => 1,
        };
        let drawn_px = size_px.map(|side| side.div_ceil(factor));
        let detail = match smooth {
            Smoothness::Moving if software && self.may_be_reduced(view) => Detail::Reduced,
            Smoothness::Moving | Smoothness::Resting => Detail::Full,
        };
        // A moving surface keeps its last shadow: a new one is made when it rests.
        let wanted_shadow = self.surface.as_ref().and_then(|shown| shown.wanted_shadow(view));
        let shadow = match smooth {
            Smoothness::Moving => self.surface.as_ref().and_then(|shown| shown.shadow),
            Smoothness::Resting => wanted_shadow,
        };
        let key = DrawnKey {
            detail,
            shadow,
            backdrop: Backdrop::of(ui.visuals()),
            ..self.key(view, pixels_per_point, drawn_px, samples)
        };
        if !self.drawn.as_ref().is_some_and(|drawn| drawn.serves(&key, size_px)) {
            if self.draw(view, &key)? {
                self.drawn = Some(key);
                self.drawings += 1;
                if smooth == Smoothness::Moving
                    && let Some(ms) = self.device_ms()
                {
                    self.coarseness.took(ms);
                }
            } else {
                ui.ctx().request_repaint();
            }
        }
        if let Some(texture) = self.texture {
            let whole = egui::Rect::from_min_max(egui::Pos2::ZERO, egui::pos2(1.0, 1.0));
            let tint = self.tint.gamma_multiply(self.opacity);
            ui.painter().image(texture, rect, whole, tint);
        }
        let is_less = |drawn: &DrawnKey| drawn.size_px != size_px || drawn.detail == Detail::Reduced;
        let is_coarse = self.drawn.as_ref().is_some_and(is_less);
        let is_jagged = self.drawn.as_ref().is_some_and(|drawn| drawn.samples == Samples::One);
        let is_stale = wanted_shadow.is_some() && shadow != wanted_shadow;
        Ok(is_coarse || is_stale || (is_jagged && triangles <= SOFT_SMOOTH_TRIANGLES))
    }

    /// Returns true if the surface can be drawn with fewer triangles: not with materials and not with its edges.
    fn may_be_reduced(&self, view: &SceneView<'_>) -> bool {
        let Some(shown) = &self.surface else { return false };
        let eye = drawing::view(view.camera, view.viewport_px, shown.drawing.centre());
        self.present_look(view.look).shading != Shading::Material
            && !view.look.wireframe
            && shown.surface.has_reduced(&eye)
    }

    /// The time that the device has recently needed for a drawing.
    fn device_ms(&self) -> Option<f64> {
        self.gpu.try_read()?.device_ms()
    }

    fn key(&self, view: &SceneView<'_>, pixels_per_point: f32, size_px: [u32; 2], samples: Samples) -> DrawnKey {
        DrawnKey {
            pixels_per_point,
            shape: self
                .surface
                .as_ref()
                .map_or(0, |shown| Arc::as_ptr(&shown.displacements) as usize),
            colours: self.surface.as_ref().map_or(Colours::None, |shown| shown.colours),
            materials_revision: self.surface.as_ref().map_or(0, |shown| shown.materials_revision),
            rims: view.rims_revision,
            shown: self.surface.as_ref().map_or(0, |shown| address(shown.shown.as_ref())),
            shadow: None,
            overlay: view.overlay_revision,
            camera: view.camera_revision,
            look: view.look,
            is_faded: view.is_dragging,
            size_px,
            samples,
            detail: Detail::Full,
            backdrop: Backdrop::Dark,
        }
    }

    /// Draws; false if a file is being uploaded, for which this thread does not wait.
    fn draw(&mut self, view: &SceneView<'_>, key: &DrawnKey) -> Result<bool, RenderError> {
        let gpu = self.gpu.clone();
        let Some(mut renderer) = gpu.try_write() else {
            return Ok(false);
        };
        if self.target.resize(renderer.device(), key.size_px, key.samples)? {
            self.register();
        }
        let floor = self.surface.as_ref().map(Shown::floor).or(self.floor);
        let centre = floor.map_or(DVec3::ZERO, |floor| floor.centre);
        let eye = drawing::view(view.camera, view.viewport_px, centre);
        // Marks keep their width on the screen when the picture has fewer pixels.
        let drawn_share = f64::from(key.size_px[1]) / view.viewport_px.y.max(1.0);
        let pixels_per_point = drawn_share as f32;
        let overlays = drawing::overlays(view, centre, pixels_per_point);
        let start = Instant::now();
        if let Some(shown) = &mut self.surface {
            shown.update_shadow(&mut renderer, view, key.shadow)?;
        }
        let surfaces: Vec<&Surface> = self.surface.iter().map(|shown| &shown.surface).collect();
        let is_alone = self.opacity < 1.0 || self.is_cut_out;
        let ground = floor.map(|floor| key.backdrop.grid(floor.grid(view)));
        let has_ground = view.look.grid && !is_alone;
        let frame = Frame {
            view: &eye,
            style: &Style {
                detail: key.detail,
                background: match is_alone {
                    true => Background::Transparent,
                    false => key.backdrop.background(),
                },
                shadows: match key.shadow {
                    Some(_) if !is_alone => Shadows::On,
                    _ => Shadows::Off,
                },
                ..match key.is_faded {
                    true => drawing::faded_style(&self.present_look(key.look), pixels_per_point),
                    false => drawing::style(&self.present_look(key.look), pixels_per_point),
                }
            },
            surfaces: &surfaces,
            grid: ground.as_ref().filter(|_| has_ground),
            overlays: &overlays,
        };
        let drawn = renderer.draw(&self.target, &frame);
        self.drawing_time += start.elapsed();
        drawn.map(|()| true)
    }

    /// Registers a new texture with egui.
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

impl Drop for Viewport {
    fn drop(&mut self) {
        if let Some(texture) = self.texture.take() {
            self.state.renderer.write().free_texture(&texture);
        }
    }
}

/// The state of the view: changing or at rest.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Smoothness {
    /// Something moves: speed first.
    Moving,
    /// Nothing has moved for a while: quality first.
    Resting,
}

fn pixels(size: egui::Vec2) -> [u32; 2] {
    [size.x, size.y].map(|side| side.round().clamp(0.0, 16_384.0) as u32)
}

//! Pictures of the view's scene, apart from what the window shows.

use eframe::egui;
use glam::DVec2;
use pliant_editor::Editor;
use pliant_picture::{drawing, legend, painting};
use pliant_render::{Background, Detail, Frame, Image, RenderError, Samples, Shadows};

use super::{Viewport, pixels};
use crate::window::threads::message::{Ground, PictureKind};

impl Viewport {
    /// A picture of the view's scene, without its marks; `None` while a file is being uploaded or nothing is open.
    ///
    /// # Errors
    /// As [`Renderer::draw_to_image`].
    pub fn picture(&mut self, editor: &Editor, kind: PictureKind) -> Result<Option<Image>, RenderError> {
        let Some(key) = &self.drawn else { return Ok(None) };
        // As large as the view, even if that is being drawn with fewer pixels.
        let viewport_px = editor.view().viewport_px;
        let [width, height] = viewport_px.as_vec2().to_array();
        let pixels_per_point = key.pixels_per_point * kind.scale.max(1) as f32;
        let size_px =
            pixels(egui::vec2(width, height) * key.pixels_per_point).map(|side| side.max(1) * kind.scale.max(1));
        let drawn = self.draw_apart(
            editor,
            viewport_px,
            size_px,
            pixels_per_point,
            (kind.ground, Detail::Full),
        )?;
        let (Some(mut image), Some(renderer)) = (drawn, self.gpu.try_read()) else {
            return Ok(None);
        };
        if let Some(scale) = self.scale() {
            let legend = legend::picture(&renderer, scale, pixels_per_point)?;
            painting::composite(&mut image, &legend, [(14.0 * pixels_per_point) as u32; 2]);
        }
        Ok(Some(image))
    }

    /// A picture of the same scene with so many pixels, drawn with fewer triangles where the processor draws; `None` as
    /// for [`Self::picture`].
    ///
    /// # Errors
    /// As [`Renderer::draw_to_image`].
    pub fn small_picture(&mut self, editor: &Editor, size_px: [u32; 2]) -> Result<Option<Image>, RenderError> {
        let detail = match self.software {
            Some(_) => Detail::Reduced,
            None => Detail::Full,
        };
        let viewport_px = DVec2::from(size_px.map(f64::from));
        self.draw_apart(editor, viewport_px, size_px, 1.0, (Ground::AsShown, detail))
    }

    fn draw_apart(
        &mut self,
        editor: &Editor,
        viewport_px: DVec2,
        size_px: [u32; 2],
        pixels_per_point: f32,
        (surroundings, detail): (Ground, Detail),
    ) -> Result<Option<Image>, RenderError> {
        let (view, gpu) = (editor.view(), self.gpu.clone());
        let (Some(shown), Some(key), Some(mut renderer)) = (&self.surface, &self.drawn, gpu.try_write()) else {
            return Ok(None);
        };
        let mut style = drawing::style(&self.present_look(view.look), pixels_per_point);
        style.detail = detail;
        style.background = key.backdrop.background();
        let mut ground = view.look.grid.then(|| key.backdrop.grid(shown.ground(&view)));
        if surroundings == Ground::Transparent {
            (style.background, ground) = (Background::Transparent, None);
            style.shadows = Shadows::Off;
        }
        let frame = Frame {
            view: &drawing::view(view.camera, viewport_px, shown.drawing.centre()),
            style: &style,
            surfaces: &[&shown.surface],
            grid: ground.as_ref(),
            overlays: &[],
        };
        renderer.draw_to_image(size_px, Samples::Four, &frame).map(Some)
    }
}

//! What programs that drive the window, and the window itself, ask the application.

use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use eframe::egui;
use glam::DVec3;
use pliant_editor::{Editor, Shading};

use crate::window::application::Application;
use crate::window::panels::notes::Note;
use crate::window::viewport::before::OriginalView;

impl Application {
    /// Returns true if the graphics device is lost, so that the window must be opened again.
    pub fn has_lost_its_device(&self) -> bool {
        self.viewport.is_lost()
    }

    /// The editor, for reading.
    pub fn editor(&self) -> &Editor {
        &self.editor
    }

    /// The path of the file that was last read or saved as the open one.
    pub fn path(&self) -> Option<&Path> {
        self.session.open.as_ref()?.path.as_deref()
    }

    /// Returns true if materials are requested and their images are still being decoded.
    pub fn is_loading_textures(&self) -> bool {
        self.editor.view().look.shading == Shading::Material && self.viewport.awaits_images()
    }

    /// Returns true if nothing is in progress: no job, no file being read or written, and the picture shows the present
    /// shape.
    pub fn is_settled(&self) -> bool {
        let view = self.editor.view();
        let shown = self
            .viewport
            .displacements()
            .is_some_and(|shown| Arc::ptr_eq(shown, view.drawn));
        let comparison = self.editor.comparison();
        let compared = comparison.is_none_or(|comparison| self.beside.methods.are_settled(comparison));
        let original = self
            .beside
            .original
            .as_ref()
            .is_none_or(|original| original.is_settled(&view));
        let skins = self.beside.skins.are_settled(view.skins);
        let drawn = self.redrawing.is_none() && self.shows_what_is_turned();
        let is_idle = self.session.doing().is_none() && !self.is_saving() && !self.is_loading_textures();
        view.settled && shown && compared && original && skins && drawn && is_idle
    }

    /// The shape in the GPU's buffers, per surface vertex, from the file's.
    pub fn shown_displacements(&self) -> Option<&Arc<Vec<DVec3>>> {
        self.viewport.displacements()
    }

    /// The place of the 3D view in the window, in points.
    pub fn view_rect(&self) -> egui::Rect {
        self.layout.view_rect
    }

    /// The number of times that the 3D view was drawn.
    pub fn drawings(&self) -> u64 {
        self.viewport.drawings()
    }

    /// The newest sentence about a file that was saved or could not be opened or saved.
    pub fn headline(&self) -> Option<&str> {
        match self.notes.headline.as_ref()? {
            Note::Done(sentence) | Note::Saved(sentence, _) | Note::Failed(sentence) => Some(sentence),
        }
    }

    /// The longest time that a frame has kept the window's thread busy since the last call, without the drawing itself.
    pub fn take_longest_frame(&mut self) -> Duration {
        std::mem::take(&mut self.longest_frame)
    }

    /// The time that drawing has kept the window's thread busy so far.
    pub fn drawing_time(&self) -> Duration {
        let original = self.beside.original.as_ref();
        let original = original.map_or(Duration::ZERO, OriginalView::drawing_time);
        self.viewport.drawing_time() + original + self.beside.methods.drawing_time()
    }
}

//! The open file in another drawing, when other parts of it are turned inside out.

use std::sync::Arc;

use crate::window::application::Application;
use crate::window::threads::message::{Message, Redrawn};
use crate::window::viewport::shown::Shown;
use pliant_picture::drawing::Drawing;

impl Application {
    /// Returns true if the drawing turns the same parts inside out as the document.
    pub(in crate::window) fn shows_what_is_turned(&self) -> bool {
        let open = self.session.open.as_ref();
        open.is_none_or(|open| open.drawing.inside_out == *self.editor.document().inside_out())
    }

    /// Draws the file with the document's parts turned inside out, off the window's thread.
    pub(in crate::window) fn request_drawing(&mut self) {
        let Some(open) = &self.session.open else { return };
        if self.shows_what_is_turned() || self.redrawing.is_some() {
            return;
        }
        let wanted = self.editor.document().inside_out();
        self.redrawing = Some(Arc::clone(wanted));
        let (gpu, loaded, wanted) = (self.viewport.gpu(), Arc::clone(&open.loaded), Arc::clone(wanted));
        let displacements = Arc::clone(self.editor.view().drawn);
        self.workers.spawn(
            "redrawing",
            move || {
                let drawing = Drawing::new(&loaded.model, loaded.scene.appearance(), wanted);
                let pose = drawing.pose(&loaded.model, &displacements);
                let uploaded = gpu.upload(&drawing, &pose).map_err(|error| error.to_string());
                Message::Redrawn(uploaded.map(|surface| {
                    Box::new(Redrawn {
                        loaded,
                        drawing: Arc::new(drawing),
                        surface,
                        displacements,
                    })
                }))
            },
            |sentence| Message::Redrawn(Err(sentence)),
        );
    }

    /// Shows the other drawing, if its file is still open.
    pub(in crate::window) fn take_drawing(&mut self, result: Result<Box<Redrawn>, String>) {
        let wanted = self.redrawing.take();
        let redrawn = match result {
            Ok(redrawn) => redrawn,
            Err(sentence) => {
                // This is not requested again and again.
                self.redrawing = wanted;
                return self.fail(format!("the view can't show parts turned inside out: {sentence}"));
            }
        };
        let Redrawn {
            loaded,
            drawing,
            surface,
            displacements,
        } = *redrawn;
        let (Some(open), Some(mut source)) = (&mut self.session.open, self.workers.pose_source()) else {
            return;
        };
        if !Arc::ptr_eq(&open.loaded, &loaded) {
            return;
        }
        open.drawing = Arc::clone(&drawing);
        source.drawing = Arc::clone(&drawing);
        self.workers.set_pose_source(source);
        self.poses.cancel();
        self.stop_images();
        self.viewport
            .show(Shown::new(drawing, surface, displacements, &loaded.model));
    }
}

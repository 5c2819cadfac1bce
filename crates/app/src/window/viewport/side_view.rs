//! A further view on the window's device: the open file's surface, uploaded once more, in a shape of its own.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};

use eframe::egui;
use glam::DVec3;

use super::Viewport;
use crate::window::threads::message::{Message, Posed};
use crate::window::threads::workers::{PoseSource, Workers};
use crate::window::viewport::pose_queue::PoseQueue;
use crate::window::viewport::shown::Shown;
use pliant_picture::drawing::Drawing;

/// A view beside the first, with its own threads.
pub struct SideView {
    pub viewport: Viewport,
    pub workers: Workers,
    messages: Receiver<Message>,
    /// The file whose surface is being uploaded for it.
    uploading: Option<Arc<Drawing>>,
    poses: PoseQueue,
    /// The last failure, in a sentence.
    pub problem: Option<String>,
}

impl SideView {
    /// An empty view, on the device of another.
    pub fn beside(context: &egui::Context, first: &Viewport) -> Self {
        let (sender, messages) = channel();
        Self {
            viewport: first.beside(),
            workers: Workers::new(context.clone(), sender),
            messages,
            uploading: None,
            poses: PoseQueue::default(),
            problem: None,
        }
    }

    /// Returns true if it shows this shape.
    pub fn shows(&self, shape: &Arc<Vec<DVec3>>) -> bool {
        self.viewport
            .displacements()
            .is_some_and(|shown| Arc::ptr_eq(shown, shape))
    }

    /// Returns true if the open file is being uploaded for it.
    pub fn is_uploading(&self) -> bool {
        self.uploading.is_some()
    }

    /// The results of its threads.
    pub fn receive(&mut self) -> Option<Message> {
        self.messages.try_recv().ok()
    }

    /// Takes the results of its threads; `wanted` is the shape to show.
    pub fn take(&mut self, message: Message, wanted: &Arc<Vec<DVec3>>, source: &PoseSource) {
        match message {
            Message::Posed(stamp, result) => {
                self.poses.finish(stamp);
                match result {
                    Ok(posed) => self.show_pose(posed, wanted),
                    Err(sentence) => self.problem = Some(sentence),
                }
            }
            Message::Uploaded(drawing, result) => {
                self.uploading = None;
                match result {
                    Ok(surface) => {
                        let model = &source.loaded.model;
                        let rest = Arc::new(vec![DVec3::ZERO; model.surface.positions.len()]);
                        self.viewport.show(Shown::new(drawing, surface, rest, model));
                    }
                    Err(sentence) => self.problem = Some(sentence),
                }
            }
            _ => {}
        }
    }

    /// Shows a pose, unless another shape is wanted by now.
    pub fn show_pose(&mut self, posed: Posed, wanted: &Arc<Vec<DVec3>>) {
        let is_present = Arc::ptr_eq(&posed.displacements, wanted);
        let fits = self.viewport.displacements().map(|shown| shown.len()) == Some(posed.displacements.len());
        if is_present
            && fits
            && let Err(error) = self.viewport.pose(posed)
        {
            self.problem = Some(error.to_string());
        }
    }

    /// Requests everything that it lacks to show the shape `wanted` of the open file in the first view's style.
    pub fn follow(&mut self, wanted: &Arc<Vec<DVec3>>, first: &Viewport, source: &PoseSource) {
        self.upload(source);
        self.set_materials(first, source);
        if self.viewport.shows(&source.drawing) {
            self.poses.follow(wanted, &self.viewport, source, &self.workers);
        }
    }

    /// Shows the same images as the first view.
    fn set_materials(&mut self, first: &Viewport, source: &PoseSource) {
        let lacks_what_is_there = self.viewport.shows(&source.drawing)
            && self.viewport.awaits_images()
            && first.shows(&source.drawing)
            && !first.awaits_images();
        if !lacks_what_is_there {
            return;
        }
        let Some(materials) = first.materials() else {
            self.viewport.give_up_images(&source.drawing);
            return;
        };
        if let Err(error) = self.viewport.set_materials(&source.drawing, materials.clone()) {
            self.problem = Some(error.to_string());
        }
    }

    /// Uploads the open file's surface again.
    fn upload(&mut self, source: &PoseSource) {
        let drawing = &source.drawing;
        let is_under_way = self
            .uploading
            .as_ref()
            .is_some_and(|under_way| Arc::ptr_eq(under_way, drawing));
        if self.viewport.shows(drawing) || is_under_way {
            return;
        }
        self.uploading = Some(Arc::clone(drawing));
        let (gpu, source) = (self.viewport.gpu(), source.clone());
        let (drawing, failed) = (Arc::clone(drawing), Arc::clone(drawing));
        self.workers.spawn(
            "uploading",
            move || {
                let rest = vec![DVec3::ZERO; source.loaded.model.surface.positions.len()];
                let pose = drawing.pose(&source.loaded.model, &rest);
                let surface = gpu.upload(&drawing, &pose).map_err(|error| error.to_string());
                Message::Uploaded(drawing, surface)
            },
            move |sentence| Message::Uploaded(Arc::clone(&failed), Err(sentence)),
        );
    }
}

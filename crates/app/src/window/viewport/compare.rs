//! A second view beside the first: the same handles and the same camera, bent by another method on threads of its own.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use eframe::egui::{self, Rect, RichText, UiBuilder, vec2};
use glam::{DVec2, DVec3};
use pliant_deform::{METHODS, Method};
use pliant_editor::{Editor, Event};
use pliant_render::RenderError;

use super::{Smoothness, Viewport};
use crate::drawing::Drawing;
use crate::window::panels::method::choose_method;
use crate::window::threads::message::{Message, Posed};
use crate::window::threads::pose_queue::PoseQueue;
use crate::window::threads::workers::{Stage, Workers};

/// The second view and the editor behind it.
pub struct Compare {
    editor: Editor,
    viewport: Viewport,
    workers: Workers,
    messages: Receiver<Message>,
    method: Method,
    /// The file whose surface is being uploaded for it.
    uploading: Option<Arc<Drawing>>,
    poses: PoseQueue,
    problem: Option<String>,
}

impl Compare {
    /// A view beside another, with the first method that the other does not have.
    pub fn new(context: &egui::Context, beside: &Viewport, leader: &Editor) -> Self {
        let (sender, messages) = channel();
        let workers = Workers::new(context.clone(), sender);
        let theirs = leader.document().method().name();
        let other = METHODS.iter().find(|declaration| declaration.name != theirs);
        Self {
            editor: Editor::new(Box::new(workers.clone())),
            viewport: beside.beside(),
            workers,
            messages,
            method: other.map_or_else(Method::default, |declaration| (declaration.first_choice)()),
            uploading: None,
            poses: PoseQueue::default(),
            problem: None,
        }
    }

    /// The editor behind the view, to look at.
    pub fn editor(&self) -> &Editor {
        &self.editor
    }

    /// How long drawing it has kept the window's thread busy so far.
    pub fn drawing_time(&self) -> Duration {
        self.viewport.drawing_time()
    }

    /// Whether it shows what its method makes of the handles.
    pub fn is_settled(&self) -> bool {
        let view = self.editor.view();
        let shown = self.viewport.displacements();
        view.settled && shown.is_some_and(|shown| Arc::ptr_eq(shown, view.displacements))
    }

    /// Takes over what the first view and its editor have, and what has ended elsewhere.
    pub fn follow(&mut self, leader: &Editor, first: &Viewport, stage: &Stage) {
        self.workers.set_stage(stage.clone());
        while let Ok(message) = self.messages.try_recv() {
            self.take(message);
        }
        if let Some(leader) = leader.snapshot() {
            self.editor.handle(Event::Follow {
                leader: Box::new(leader),
                method: self.method.clone(),
            });
        }
        self.upload(stage);
        self.set_materials(first, stage);
        self.request_pose(stage);
    }

    /// Shows the same images as the first view.
    fn set_materials(&mut self, first: &Viewport, stage: &Stage) {
        let lacks_what_is_there = self.viewport.shows(&stage.drawing)
            && self.viewport.awaits_images()
            && first.shows(&stage.drawing)
            && !first.awaits_images();
        if !lacks_what_is_there {
            return;
        }
        let Some(materials) = first.materials() else {
            self.viewport.give_up_images(&stage.drawing);
            return;
        };
        if let Err(error) = self.viewport.set_materials(&stage.drawing, materials.clone()) {
            self.problem = Some(error.to_string());
        }
    }

    fn take(&mut self, message: Message) {
        match message {
            Message::Job(done, posed) => {
                self.editor.handle(Event::JobDone(done));
                if let Some(posed) = posed {
                    self.show_pose(posed);
                }
            }
            Message::Posed(stamp, result) => {
                self.poses.finish(stamp);
                match result {
                    Ok(posed) => self.show_pose(posed),
                    Err(sentence) => self.problem = Some(sentence),
                }
            }
            Message::Uploaded(drawing, result) => {
                self.uploading = None;
                match (result, self.editor.view().model) {
                    (Ok(surface), Some(model)) => {
                        let lowest = model.bounds().map_or(DVec3::ZERO, |bounds| bounds.min);
                        let rest = Arc::new(vec![DVec3::ZERO; model.surface.positions.len()]);
                        self.viewport.show(drawing, surface, rest, lowest);
                    }
                    (Err(sentence), _) => self.problem = Some(sentence),
                    (Ok(_), None) => {}
                }
            }
            _ => {}
        }
    }

    /// A pose of a shape that the editor no longer has is not shown.
    fn show_pose(&mut self, posed: Posed) {
        let is_present = Arc::ptr_eq(&posed.displacements, self.editor.view().displacements);
        let fits = self.viewport.displacements().map(|shown| shown.len()) == Some(posed.displacements.len());
        if is_present
            && fits
            && let Err(error) = self.viewport.pose(posed)
        {
            self.problem = Some(error.to_string());
        }
    }

    /// Has the open file's surface uploaded once more.
    fn upload(&mut self, stage: &Stage) {
        let drawing = &stage.drawing;
        let is_under_way = self
            .uploading
            .as_ref()
            .is_some_and(|under_way| Arc::ptr_eq(under_way, drawing));
        if self.viewport.shows(drawing) || is_under_way {
            return;
        }
        self.uploading = Some(Arc::clone(drawing));
        let (gpu, stage) = (self.viewport.gpu(), stage.clone());
        let (drawing, failed) = (Arc::clone(drawing), Arc::clone(drawing));
        self.workers.spawn(
            "uploading",
            move || {
                let rest = vec![DVec3::ZERO; stage.loaded.model.surface.positions.len()];
                let pose = drawing.pose(&stage.loaded.model, &rest);
                let surface = gpu.upload(&drawing, &pose).map_err(|error| error.to_string());
                Message::Uploaded(drawing, surface)
            },
            move |sentence| Message::Uploaded(Arc::clone(&failed), Err(sentence)),
        );
    }

    /// Asks for the pose of the present shape if it is not the one that is shown.
    fn request_pose(&mut self, stage: &Stage) {
        if self.viewport.shows(&stage.drawing) {
            self.poses
                .follow(self.editor.view().displacements, &self.viewport, stage, &self.workers);
        }
    }

    /// Shows the view in `rect`. Returns whether it is worth a second drawing when nothing has changed for a while.
    ///
    /// # Errors
    /// As [`Viewport::paint`].
    pub fn show(&mut self, ui: &mut egui::Ui, rect: Rect, smooth: Smoothness) -> Result<bool, RenderError> {
        let size_px = DVec2::new(f64::from(rect.width()), f64::from(rect.height()));
        if self.editor.view().viewport_px != size_px {
            self.editor.handle(Event::Viewport { size_px });
        }
        let again = self.viewport.paint(ui, rect, &self.editor, smooth)?;
        let line = egui::Stroke::new(1.0, ui.visuals().widgets.noninteractive.bg_stroke.color);
        ui.painter().vline(rect.left(), rect.y_range(), line);
        let place = Rect::from_min_size(rect.min + vec2(10.0, 8.0), vec2(rect.width() - 20.0, 44.0));
        ui.scope_builder(UiBuilder::new().max_rect(place), |ui| {
            self.choose(ui);
            let said = self.problem.as_deref().or(self.editor.view().problem);
            if let Some(sentence) = said {
                ui.label(RichText::new(sentence).weak().small());
            }
        });
        Ok(again)
    }

    fn choose(&mut self, ui: &mut egui::Ui) {
        let (list, chosen) = choose_method(ui, "compared method", &self.method, 190.0);
        if let Some(method) = chosen {
            self.method = method;
        }
        list.widget_info(|| egui::WidgetInfo::labeled(egui::Role::ComboBox, true, "Method of the second view"));
    }
}

//! A second view beside the first: the same handles and the same camera, bent by another method on threads of its own.

use std::time::Duration;

use eframe::egui::{self, Rect, RichText, UiBuilder, vec2};
use glam::DVec2;
use pliant_deform::{METHODS, Method};
use pliant_editor::{Editor, Event};
use pliant_render::RenderError;

use super::side_view::SideView;
use super::{Smoothness, Viewport};
use crate::window::panels::method::choose_method;
use crate::window::threads::message::Message;
use crate::window::threads::workers::Stage;

/// The second view and the editor behind it.
pub struct Compare {
    editor: Editor,
    side: SideView,
    method: Method,
}

impl Compare {
    /// A view beside another, with the first method that the other does not have.
    pub fn new(context: &egui::Context, beside: &Viewport, leader: &Editor) -> Self {
        let side = SideView::beside(context, beside);
        let theirs = leader.document().method().name();
        let other = METHODS.iter().find(|declaration| declaration.name != theirs);
        Self {
            editor: Editor::new(Box::new(side.workers.clone())),
            side,
            method: other.map_or_else(Method::default, |declaration| (declaration.first_choice)()),
        }
    }

    /// The editor behind the view, for reading.
    pub fn editor(&self) -> &Editor {
        &self.editor
    }

    /// The time that drawing it has kept the window's thread busy so far.
    pub fn drawing_time(&self) -> Duration {
        self.side.viewport.drawing_time()
    }

    /// Returns true if it shows its method's result for the handles.
    pub fn is_settled(&self) -> bool {
        let view = self.editor.view();
        view.settled && self.side.shows(view.drawn)
    }

    /// Takes over the state of the first view and its editor, and the results of other threads.
    pub fn follow(&mut self, leader: &Editor, first: &Viewport, stage: &Stage) {
        self.side.workers.set_stage(stage.clone());
        if self.editor.most_memory() != leader.most_memory() {
            self.editor.handle(Event::Memory(leader.most_memory()));
        }
        while let Some(message) = self.side.receive() {
            let posed = match message {
                Message::Job(done, posed) => {
                    self.editor.handle(Event::JobDone(done));
                    posed
                }
                message => {
                    self.side.take(message, self.editor.view().drawn, stage);
                    None
                }
            };
            if let Some(posed) = posed {
                self.side.show_pose(posed, self.editor.view().drawn);
            }
        }
        if let Some(leader) = leader.snapshot() {
            self.editor.handle(Event::Follow {
                leader: Box::new(leader),
                method: self.method.clone(),
            });
        }
        self.side.follow(self.editor.view().drawn, first, stage);
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
        let view = self.editor.view();
        let again = self.side.viewport.paint(ui, rect, &view, &self.editor, smooth)?;
        let line = egui::Stroke::new(1.0, ui.visuals().widgets.noninteractive.bg_stroke.color);
        ui.painter().vline(rect.left(), rect.y_range(), line);
        let place = Rect::from_min_size(rect.min + vec2(10.0, 8.0), vec2(rect.width() - 20.0, 44.0));
        ui.scope_builder(UiBuilder::new().max_rect(place), |ui| {
            self.choose(ui);
            let said = self.side.problem.as_deref().or(self.editor.view().problem);
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

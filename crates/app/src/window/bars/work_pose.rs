//! While the document is in a work pose: a reminder at the top of the view, with the way back.

use eframe::egui::{self, Align2, Id, Rect, RichText, vec2};
use pliant_editor::{Command, Editor};

use crate::window::widgets::outbox::Outbox;

/// Shows it over the view.
pub fn show(context: &egui::Context, view_rect: Rect, editor: &Editor, commands: &mut Outbox) {
    if !editor.document().is_in_work_pose() {
        return;
    }
    egui::Area::new(Id::unique("work pose"))
        .order(egui::Order::Middle)
        .fixed_pos(view_rect.center_top() + vec2(0.0, 10.0))
        .pivot(Align2::CENTER_TOP)
        .constrain_to(view_rect)
        .show(context, |ui| {
            egui::Frame::popup(ui.style()).show(ui, |ui| {
                ui.horizontal(|ui| {
                    ui.label(RichText::new("Work pose").strong()).on_hover_text(
                        "Paint and corrections stay when you return. Saved files have the shape without it.",
                    );
                    if ui.button("Return").clicked() {
                        commands.push(Command::WorkPose);
                    }
                });
            });
        });
}

//! The result of a person's request, over the view's lower right corner, where it moves nothing else.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use eframe::egui::{self, Align2, Id, Rect, RichText, Role, WidgetInfo, vec2};

use super::status::{done, failed};
use crate::window::input::file_command::FileCommand;
use crate::window::panels::notes::Note;

/// The time that good news stays. The log keeps it afterwards.
const GOOD_NEWS: Duration = Duration::from_secs(8);
/// The distance to the view's edge, in points.
const MARGIN: f32 = 16.0;
/// The width at which a sentence is easy to read, in points.
const WIDTH: f32 = 460.0;

/// The shown sentence, and its start.
#[derive(Debug, Default)]
pub struct Toast {
    shown: Option<(Note, Instant)>,
    /// The saved file to show in its folder.
    to_show: Option<PathBuf>,
}

impl Toast {
    /// The saved file that the person wants to see in its folder, once.
    pub fn take_to_show(&mut self) -> Option<PathBuf> {
        self.to_show.take()
    }

    /// Shows the document's problem (`problem`), and the newest success or failure with a file (`headline`), until the
    /// person closes it. Returns its place, if anything is shown.
    pub fn show(
        &mut self,
        context: &egui::Context,
        view_rect: Rect,
        problem: Option<&str>,
        headline: &mut Option<Note>,
    ) -> Option<Rect> {
        let since = match (&self.shown, &*headline) {
            (Some((shown, since)), Some(note)) if shown == note => *since,
            _ => Instant::now(),
        };
        self.shown = headline.clone().map(|note| (note, since));
        let left = GOOD_NEWS.saturating_sub(since.elapsed());
        let note = headline.clone().filter(|note| match note {
            Note::Failed(_) => true,
            Note::Done(_) | Note::Saved(..) => !left.is_zero(),
        });
        if let Some(Note::Done(_) | Note::Saved(..)) = note {
            context.request_repaint_after(left);
        }
        if problem.is_none() && note.is_none() {
            return None;
        }
        let width = WIDTH.min(view_rect.width() - 2.0 * MARGIN).max(120.0);
        let area = egui::Area::new(Id::unique("toast"))
            .order(egui::Order::Middle)
            .fixed_pos(view_rect.right_bottom() - vec2(MARGIN, MARGIN))
            .pivot(Align2::RIGHT_BOTTOM)
            .constrain_to(view_rect)
            .show(context, |ui| {
                egui::Frame::popup(ui.style()).inner_margin(10.0).show(ui, |ui| {
                    ui.set_max_width(width);
                    if let Some(problem) = problem {
                        ui.add(egui::Label::new(RichText::new(problem).color(failed(ui))).wrap());
                    }
                    let Some(note) = note else { return };
                    let (sentence, colour, saved) = match note {
                        Note::Done(sentence) => (sentence, done(ui), None),
                        Note::Saved(sentence, path) => (sentence, done(ui), Some(path)),
                        Note::Failed(sentence) => (sentence, failed(ui), None),
                    };
                    ui.horizontal_top(|ui| {
                        let dismiss = ui.small_button("×").on_hover_text("Dismiss");
                        // A cross means nothing to people who use a screen reader.
                        let name = format!("Dismiss: {sentence}");
                        dismiss.widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
                        if dismiss.clicked() {
                            *headline = None;
                        }
                        ui.vertical(|ui| {
                            ui.add(egui::Label::new(RichText::new(sentence).color(colour)).wrap());
                            if saved.is_some() && ui.small_button(FileCommand::ShowInFolder.name()).clicked() {
                                self.to_show = saved;
                            }
                        });
                    });
                });
            });
        Some(area.response.rect)
    }
}

//! The line below the view: the program's activity, and the next possible step.

use eframe::egui::{self, Align, Color32, Id, Label, Layout, ProgressBar, RichText, Spinner, UiBuilder};
use pliant_editor::{Command, Editor};

use crate::window::widgets::outbox::Outbox;

/// The colour of failures, legible on a dim and on a bright ground.
pub fn failed(ui: &egui::Ui) -> Color32 {
    if ui.visuals().dark_mode {
        Color32::from_rgb(255, 138, 122)
    } else {
        Color32::from_rgb(176, 32, 20)
    }
}

/// The colour of successes.
pub fn done(ui: &egui::Ui) -> Color32 {
    if ui.visuals().dark_mode {
        Color32::from_rgb(150, 210, 140)
    } else {
        Color32::from_rgb(30, 108, 36)
    }
}

/// The share of the line that a waiting save's sentence may take.
const WAITING_SHARE: f32 = 0.5;

/// The activity on files.
pub struct FileWork {
    /// The file that is being read or written, with its progress (0 to 1).
    pub doing: Option<(&'static str, f32)>,
    /// The waiting saves and their reason, in a sentence.
    pub waiting: Option<String>,
    /// True if the file's images are being decoded.
    pub is_loading_textures: bool,
}

/// A person's request about it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum FileWorkAnswer {
    /// To stop it.
    Stop,
    /// To save the shape of this moment.
    SaveAsItIs,
}

/// Shows the line.
pub fn show(
    ui: &mut egui::Ui,
    editor: &Editor,
    file_work: &FileWork,
    software_device: Option<&str>,
    commands: &mut Outbox,
) -> Option<FileWorkAnswer> {
    let view = editor.view();
    let mut answer = None;
    ui.horizontal(|ui| {
        // The right end first: the sentences have the room that it leaves.
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if let Some(name) = software_device {
                ui.label(RichText::new("software drawing").weak())
                    .on_hover_text(format!(
                        "No graphics card was found, so {name} draws slowly on the processor."
                    ));
            }
            let job = view.jobs.first().map(|(kind, _)| kind.doing());
            let doing = file_work.doing.map(|(doing, _)| doing);
            if job.is_some_and(|job| ui.small_button(stop(job, doing)).clicked()) {
                commands.push(Command::CancelJobs);
            }
            // A name of its own: what comes and goes at the right end must not make other buttons of these between the
            // press and the release of a click.
            let rest = UiBuilder::new().scope_id(Id::unique("the status line's sentences"));
            let rest = rest.layout(Layout::left_to_right(Align::Center));
            ui.scope_builder(rest, |ui| {
                answer = file_line(ui, file_work, job);
                for (kind, share) in &view.jobs {
                    // A job too short to notice needs no bar.
                    if *share > 0.0 {
                        progress(ui, kind.doing(), *share);
                    }
                }
                if file_work.is_loading_textures {
                    ui.add(Spinner::new().size(14.0));
                    ui.add(Label::new(RichText::new("loading textures…").weak()).truncate());
                }
                ui.add(Label::new(&view.status).truncate());
            });
        });
    });
    answer
}

/// The label of the button that stops work: if there is `other` work to stop, it names its own.
fn stop(doing: &str, other: Option<&str>) -> String {
    other.map_or_else(|| "Stop".to_owned(), |_| format!("Stop {doing}"))
}

/// The activity on files, and the ways to end it. The editor's own work is `job`.
fn file_line(ui: &mut egui::Ui, file_work: &FileWork, job: Option<&str>) -> Option<FileWorkAnswer> {
    let mut answer = None;
    if let Some(waiting) = &file_work.waiting {
        ui.add(Spinner::new().size(14.0));
        // The buttons come first: a sentence that changes its length must not move them from under the pointer.
        if ui.small_button("Save now").clicked() {
            answer = Some(FileWorkAnswer::SaveAsItIs);
        }
        if ui.small_button("Don't save").clicked() {
            answer = Some(FileWorkAnswer::Stop);
        }
        let width = WAITING_SHARE * ui.available_width();
        ui.scope(|ui| {
            ui.set_max_width(width);
            ui.add(Label::new(waiting).truncate());
        });
    }
    if let Some((doing, share)) = file_work.doing {
        progress(ui, doing, share);
        if ui.small_button(stop(doing, job)).clicked() {
            answer = Some(FileWorkAnswer::Stop);
        }
    }
    answer
}

fn progress(ui: &mut egui::Ui, doing: &str, share: f32) {
    ui.add(ProgressBar::new(share).desired_width(110.0).desired_height(14.0))
        .on_hover_text(doing);
    ui.add(Label::new(RichText::new(format!("{doing}…")).weak()).truncate());
}

//! The window's file commands, the questions that they raise, and their results.

use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui;
use glam::DVec3;
use pliant_deform::{Attachment, ControlMesh, ExampleShape};
use pliant_editor::Command;

use crate::window::application::Application;
use crate::window::application::saves::project_path;
use crate::window::dialogs::about::{MANUAL, REPORTS};
use crate::window::dialogs::file_dialog;
use crate::window::dialogs::palette::Palette;
use crate::window::dialogs::question::{Answer, Question, Then};
use crate::window::files::listing;
use crate::window::files::recovery::left;
use crate::window::files::save_request::{AnimationToWrite, Content, FramesToWrite};
use crate::window::input::event_queue::EventQueue;
use crate::window::input::file_command::FileCommand;
use crate::window::session::{OpenFile, Source};
use crate::window::threads::message::{Message, Purpose};
use crate::window::widgets::theme;
use pliant_engine::control_mesh::control_mesh;
use pliant_engine::watch::Watch;
use pliant_engine::{EngineError, ExistingFrames, Loaded, animation_path, examples, is_project};

impl Application {
    pub(in crate::window) fn file_shortcuts(&mut self, context: &egui::Context) {
        if self.dialogs.question.is_some() || self.dialogs.keys.takes_keys() {
            return;
        }
        let is_typing = EventQueue::is_typing(context) || context.egui_wants_keyboard_input();
        for command in FileCommand::WITH_SHORTCUTS {
            let Some(shortcut) = command.shortcut() else { continue };
            // A letter goes to the field that has the focus.
            let is_letter = shortcut.modifiers.is_none() && shortcut.logical_key == egui::Key::N;
            if is_letter && (self.dialogs.palette.is_some() || self.editor.is_acting() || is_typing) {
                continue;
            }
            let is_pressed = context.input_mut(|input| match is_letter {
                true => take_plain_key(input, shortcut.logical_key),
                false => input.consume_shortcut(&shortcut),
            });
            if is_pressed {
                self.file_command(context, command.clone());
            }
        }
        let dropped = context.input(|input| input.raw.dropped_files.first().map(|file| file.path().to_owned()));
        if let Some(path) = dropped {
            self.file_command(context, FileCommand::OpenPath(path));
        }
    }

    pub(in crate::window) fn chosen(&mut self, purpose: Purpose, path: Option<PathBuf>) {
        match (purpose, path) {
            (Purpose::Open, Some(path)) => self.open(path),
            (Purpose::OpenSequence, Some(path)) => self.open_sequence(path),
            (Purpose::ApplyEdit, Some(path)) => self.ask_to_open(path),
            (Purpose::SaveAs, Some(path)) if is_project(&path) => self.save_project_to(path),
            (Purpose::SaveAs, Some(path)) => self.save_as(path),
            (Purpose::SaveMorph, Some(path)) => self.save_morph_to(path),
            (Purpose::SaveProject, Some(path)) => self.save_project_to(path),
            (Purpose::ExportEdit, Some(path)) => match self.editor.edit_file() {
                Ok(edit) => self.save_copy(&path, Content::Edit(Box::new(edit))),
                Err(error) => self.fail(error.to_string()),
            },
            (Purpose::Append, Some(path)) => self.append(path),
            (Purpose::ExportAnimation, Some(path)) => self.export_animation(&path),
            (Purpose::ExportFrames, Some(path)) => self.export_frames(&path),
            (Purpose::LoadCage, Some(path)) => self.load_cage(path),
            (Purpose::AddExample, Some(path)) => self.load_example(path),
            (Purpose::SavePicture(kind), Some(path)) => match self.viewport.picture(&self.editor, kind) {
                Ok(Some(image)) => self.save_copy(&path, Content::Picture(Arc::new(image))),
                Ok(None) => self.fail("the view is busy or empty: try again".to_owned()),
                Err(error) => self.fail(error.to_string()),
            },
            // The action that was to follow the save is given up with it.
            (_, None) => self.waiting.then = None,
        }
    }

    /// Writes the document's unsaved changes.
    fn save_copy(&mut self, path: &Path, content: Content) {
        // A failure before this is over.
        self.notes.headline = None;
        let mark = self.editor.save_mark();
        self.session.save(path, content, mark, &self.workers);
    }

    /// Writes the edit over time, off the window's thread: a file for each frame if the format has one shape in a file.
    pub fn export_animation(&mut self, path: &Path) {
        let path = &animation_path(path);
        let Some(open) = &self.session.open else { return };
        let mesh = open.mesh.clone();
        match self.editor.edit_file() {
            Ok(edit) => {
                let animation = AnimationToWrite {
                    edit,
                    fps: self.editor.document().animation().fps(),
                    frames: ExistingFrames::Keep,
                    mesh,
                    dye: self.editor.document().fluid().kept.clone(),
                    watch: Watch::default(),
                };
                self.save_copy(path, Content::Animation(Box::new(animation)));
            }
            Err(error) => self.fail(error.to_string()),
        }
    }

    /// Writes all frames of the open sequence with the edit, off the window's thread.
    pub fn export_frames(&mut self, path: &Path) {
        let Some(open) = &self.session.open else { return };
        let Some(sequence) = &open.sequence else { return };
        let (place, mesh) = (sequence.path().to_owned(), open.loaded.path.clone());
        match self.editor.edit_file() {
            Ok(edit) => {
                let frames = FramesToWrite {
                    edit,
                    cached_mesh: sequence.is_cache().then_some(mesh),
                    sequence: place,
                    fps: sequence.fps(),
                    existing: ExistingFrames::Keep,
                    watch: Watch::default(),
                };
                self.save_copy(path, Content::Frames(Box::new(frames)));
            }
            Err(error) => self.fail(error.to_string()),
        }
    }

    /// The name under which the frames of the open sequence are exported, beside it.
    fn suggested_frames(&self) -> Option<PathBuf> {
        let sequence = self.session.open.as_ref()?.sequence.as_ref()?.path();
        let mut name = sequence.file_stem()?.to_owned();
        name.push("-edited");
        Some(match sequence.extension().filter(|_| sequence.is_file()) {
            Some(ending) => sequence.with_file_name(name).with_extension(ending),
            None => sequence.with_file_name(name),
        })
    }

    /// Asks for a file by the system's dialog.
    pub(in crate::window) fn choose(&self, purpose: Purpose) {
        file_dialog::choose(purpose, &self.suggested_path(purpose), &self.workers);
    }

    /// Asks for a file to open by the window's own dialog, as on systems without one.
    pub fn browse_to_open(&mut self) {
        self.browse(Purpose::Open, &self.suggested_path(Purpose::Open));
    }

    /// The same for the name to save the model under.
    pub fn browse_to_save(&mut self) {
        self.browse(Purpose::SaveAs, &self.suggested_path(Purpose::SaveAs));
    }

    /// Asks for a file by the window's own dialog, which begins at `suggested`.
    pub(in crate::window) fn browse(&mut self, purpose: Purpose, suggested: &Path) {
        let browser = file_dialog::browser(purpose, suggested, self.path(), &self.settings.get().recent);
        self.dialogs.question = Some(Question::File(purpose, Box::new(browser)));
        self.read_folder();
    }

    /// Reads the folder that the window's own dialog wants to show, off the window's thread.
    pub(in crate::window) fn read_folder(&mut self) {
        let Some(Question::File(_, browser)) = &mut self.dialogs.question else {
            return;
        };
        if let Some(folder) = browser.take_wanted() {
            let unread = folder.clone();
            self.workers.spawn(
                "folder",
                move || {
                    let contents = listing::read(&folder);
                    Message::Folder(folder, contents)
                },
                move |sentence| Message::Folder(unread.clone(), Err(sentence)),
            );
        }
    }

    pub(in crate::window) fn suggested_path(&self, purpose: Purpose) -> PathBuf {
        let beside = |path: &Path, ending: &str| path.with_extension(ending);
        match (purpose, self.path()) {
            (
                Purpose::Open
                | Purpose::OpenSequence
                | Purpose::ApplyEdit
                | Purpose::Append
                | Purpose::LoadCage
                | Purpose::AddExample
                | Purpose::SaveAs,
                path,
            ) => path.unwrap_or(Path::new("edited.glb")).to_owned(),
            (Purpose::SaveMorph, Some(path)) => beside(path, "morph.glb"),
            (Purpose::ExportEdit, Some(path)) => beside(path, "edit.json"),
            (Purpose::ExportFrames, _) => self.suggested_frames().unwrap_or_else(|| PathBuf::from("sequence")),
            (Purpose::ExportAnimation, Some(path)) => beside(path, "animation.glb"),
            (Purpose::SaveProject, Some(path)) => beside(path, "pliant"),
            (Purpose::SavePicture(_), Some(path)) => beside(path, "png"),
            (Purpose::SaveMorph, None) => PathBuf::from("morph.glb"),
            (Purpose::SaveProject, None) => PathBuf::from("edited.pliant"),
            (Purpose::ExportAnimation, None) => PathBuf::from("animation.glb"),
            (Purpose::ExportEdit, None) => PathBuf::from("edit.json"),
            (Purpose::SavePicture(_), None) => PathBuf::from("picture.png"),
        }
    }

    /// Returns true if saving under a path from the window's own dialog would replace a file other than the open one;
    /// the system's dialogs ask that themselves.
    fn would_be_lost(&self, purpose: Purpose, path: &Path) -> bool {
        let path = match purpose {
            Purpose::SaveProject => project_path(path.to_owned()),
            _ => path.to_owned(),
        };
        let open = self.session.open.as_ref();
        let is_own = open.is_some_and(|open| open.is_at(&path) || open.is_project_at(&path));
        file_dialog::asks_to_save(purpose) && path.is_file() && !is_own
    }

    pub(in crate::window) fn may_write_over(&self) -> bool {
        self.session.open.as_ref().is_some_and(|open| open.may_write_over)
    }

    pub(in crate::window) fn file_command(&mut self, context: &egui::Context, command: FileCommand) {
        match command {
            FileCommand::Open => self.unless_unsaved(Then::Open(None)),
            FileCommand::OpenSequence => self.unless_unsaved(Then::OpenSequence),
            FileCommand::OpenPath(path) => self.ask_to_open(path),
            FileCommand::NewFromSample => self.unless_unsaved(Then::Sample),
            FileCommand::ShowInFolder => self.show_in_folder(),
            FileCommand::Manual => self.show_page(MANUAL),
            FileCommand::Report => self.show_page(REPORTS),
            FileCommand::About => self.dialogs.about.open = true,
            FileCommand::Save if !self.is_sequence() => self.save(),
            FileCommand::SaveAs | FileCommand::SaveMorph => {
                match (command.unavailable_because(&self.editor), command) {
                    (Some(why), _) => self.fail(why.to_owned()),
                    (None, FileCommand::SaveAs) => self.choose(Purpose::SaveAs),
                    (None, _) => self.choose(Purpose::SaveMorph),
                }
            }
            FileCommand::Save | FileCommand::SaveProject => {
                match self.session.open.as_ref().and_then(|open| open.project.clone()) {
                    Some(path) => self.save_project_to(path),
                    None => self.choose(Purpose::SaveProject),
                }
            }
            FileCommand::SaveProjectAs => self.choose(Purpose::SaveProject),
            FileCommand::ExportEdit => self.choose(Purpose::ExportEdit),
            FileCommand::ExportAnimation | FileCommand::ExportFrames => {
                match (command.unavailable_because(&self.editor), command) {
                    (Some(why), _) => self.fail(why.to_owned()),
                    (None, FileCommand::ExportFrames) => self.choose(Purpose::ExportFrames),
                    (None, _) => self.choose(Purpose::ExportAnimation),
                }
            }
            FileCommand::ApplyEdit => match command.unavailable_because(&self.editor) {
                Some(why) => self.fail(why.to_owned()),
                None => self.choose(Purpose::ApplyEdit),
            },
            FileCommand::MergeOptions => self.dialogs.merge.open = true,
            FileCommand::Append | FileCommand::LoadCage | FileCommand::AddExample | FileCommand::AddMorphTarget(_) => {
                match (command.unavailable_because(&self.editor), command) {
                    (Some(why), _) => self.fail(why.to_owned()),
                    (None, FileCommand::Append) => self.choose(Purpose::Append),
                    (None, FileCommand::LoadCage) => self.choose(Purpose::LoadCage),
                    (None, FileCommand::AddMorphTarget(target)) => self.load_morph_target(target),
                    (None, _) => self.choose(Purpose::AddExample),
                }
            }
            FileCommand::Weld(weld) => self.weld_anew(weld),
            FileCommand::Palette => self.dialogs.palette = Some(Palette::default()),
            FileCommand::Panel => self.layout.is_panel_hidden = !self.layout.is_panel_hidden,
            FileCommand::Log => self.dialogs.log.open = true,
            FileCommand::Keys => self.dialogs.keys.open = true,
            FileCommand::Memory => self.dialogs.memory.open = true,
            FileCommand::NextTheme => {
                self.settings.change(|settings| settings.theme = settings.theme.next());
                theme::apply(context, self.settings.get());
            }
            FileCommand::Scale(tenths) => {
                self.settings.change(|settings| {
                    let scale = (settings.ui_scale * 10.0).round() + f32::from(tenths);
                    settings.ui_scale = (scale / 10.0).clamp(0.5, 3.0);
                });
                theme::apply(context, self.settings.get());
            }
            FileCommand::Hints => self.settings.change(|settings| settings.hints_seen = false),
            FileCommand::SavePicture(kind) => self.choose(Purpose::SavePicture(kind)),
            FileCommand::Quit => self.unless_unsaved(Then::Close),
        }
        context.request_repaint();
    }

    /// Reads a cage, off the window's thread.
    pub fn load_cage(&mut self, path: PathBuf) {
        let read = move || {
            let mesh = control_mesh(&path, &Watch::default());
            Message::Cage(mesh.map_err(|error| error.to_string()))
        };
        self.workers
            .spawn("control mesh", read, |sentence| Message::Cage(Err(sentence)));
    }

    /// Takes the cage that was read.
    pub(in crate::window) fn take_cage(&mut self, mesh: Result<(Vec<DVec3>, Vec<[u32; 3]>), String>) {
        match mesh {
            Ok((rest, triangles)) => {
                let rest = Arc::new(rest);
                let cage = Attachment::Mesh(ControlMesh {
                    moved: Arc::clone(&rest),
                    rest,
                    triangles: Arc::new(triangles),
                });
                self.command(Command::BringAttachment(cage));
            }
            Err(sentence) => self.fail(sentence),
        }
    }

    /// Reads a shape of the open file for an example, off the window's thread.
    pub fn load_example(&mut self, path: PathBuf) {
        self.read_example(move |loaded| {
            let displacements = examples::from_file(&path, loaded, &Watch::default())?;
            Ok(example(
                &path.file_stem().unwrap_or_default().to_string_lossy(),
                displacements,
            ))
        });
    }

    /// Reads a morph target of the open file for an example, off the window's thread.
    fn load_morph_target(&mut self, target: String) {
        self.read_example(move |loaded| {
            let displacements = examples::from_morph_target(&target, loaded, &Watch::default())?;
            Ok(example(&target, displacements))
        });
    }

    fn read_example(&mut self, read: impl FnOnce(&Loaded) -> Result<ExampleShape, EngineError> + Send + 'static) {
        let Some(open) = &self.session.open else { return };
        let loaded = Arc::clone(&open.loaded);
        let unread = Arc::clone(&loaded);
        self.workers.spawn(
            "example",
            move || {
                let shape = read(&loaded).map_err(|error| error.to_string());
                Message::Example(loaded, shape)
            },
            move |sentence| Message::Example(unread.clone(), Err(sentence)),
        );
    }

    /// Takes the example that was read, unless another file has been opened.
    pub(in crate::window) fn take_example(&mut self, of: &Arc<Loaded>, shape: Result<ExampleShape, String>) {
        let is_open = |open: &OpenFile| Arc::ptr_eq(&open.loaded, of);
        if !self.session.open.as_ref().is_some_and(is_open) {
            return;
        }
        match shape.map(Command::AddExample) {
            Ok(command) => match self.editor.unavailable_because(&command).map(Cow::into_owned) {
                Some(why) => self.fail(why),
                None => self.command(command),
            },
            Err(sentence) => self.fail(sentence),
        }
    }

    /// Goes on at once after the running saves, or when the person has agreed to lose unsaved work.
    fn unless_unsaved(&mut self, then: Then) {
        if self.is_saving() {
            self.waiting.then = Some(then);
        } else if self.editor.view().unsaved {
            self.dialogs.question = Some(self.about_unsaved(then));
        } else {
            self.go_on(then);
        }
    }

    /// Opens a file, after a question if unsaved work would be lost.
    pub fn ask_to_open(&mut self, path: PathBuf) {
        self.unless_unsaved(Then::Open(Some(path)));
    }

    pub(in crate::window) fn go_on(&mut self, then: Then) {
        match then {
            Then::Open(Some(path)) => self.open(path),
            Then::Open(None) => self.choose(Purpose::Open),
            Then::OpenSequence => self.choose(Purpose::OpenSequence),
            Then::Sample => self.session.load(Source::Sample, &self.viewport.gpu(), &self.workers),
            Then::Close => self.closing = true,
        }
    }

    pub(in crate::window) fn answer(&mut self, answer: Answer) {
        let question = self.dialogs.question.take();
        match answer {
            Answer::WriteOver(path) => self.write_over(path),
            Answer::SaveAs => self.choose(Purpose::SaveAs),
            Answer::Save => {
                if let Some(Question::Discard(then, _)) = question {
                    self.waiting.then = Some(then);
                }
                self.save_what_is_open();
            }
            Answer::Reload => self.reload_changed(),
            Answer::Overwrite => self.overwrite(),
            Answer::ReplaceFrames => self.replace_frames(),
            Answer::Beside => self.save_beside(),
            Answer::Path(purpose, path) if self.would_be_lost(purpose, &path) => {
                self.dialogs.question = Some(Question::Replace(purpose, path));
            }
            Answer::Path(purpose, path) | Answer::Replace(purpose, path) => self.chosen(purpose, Some(path)),
            Answer::Rename(purpose, path) => {
                self.browse(purpose, &path);
            }
            Answer::Discard(then) => self.go_on(then),
            Answer::Recover(project) => {
                self.session
                    .load(Source::Recovered(project), &self.viewport.gpu(), &self.workers);
            }
            Answer::Forget(projects) => projects.iter().for_each(|project| left::remove(project)),
            Answer::Cancel => {
                self.waiting.then = None;
                self.waiting.unwritten = None;
            }
        }
    }

    /// Lets the window close unless there is unsaved work that nobody agreed to lose.
    pub(in crate::window) fn close_or_stay(&mut self, context: &egui::Context) {
        let has_more_to_do = || self.editor.view().unsaved || self.is_saving();
        if self.closing {
            context.send_viewport_cmd(egui::ViewportCommand::Close);
        } else if context.input(|input| input.viewport().close_requested()) && has_more_to_do() {
            context.send_viewport_cmd(egui::ViewportCommand::CancelClose);
            // The question comes in the next frame, without waiting for the pointer to move.
            self.unless_unsaved(Then::Close);
            context.request_repaint();
        }
    }
}

/// Takes presses of a key without any modifier: egui counts a shortcut without Shift as pressed with Shift, too.
fn take_plain_key(input: &mut egui::InputState, plain: egui::Key) -> bool {
    let before = input.events.len();
    input.events.retain(|event| {
        !matches!(event, egui::Event::Key { key, pressed: true, modifiers, .. } if *key == plain && modifiers.is_none())
    });
    input.events.len() < before
}

fn example(name: &str, displacements: Vec<DVec3>) -> ExampleShape {
    ExampleShape {
        name: name.to_owned(),
        displacements: Arc::new(displacements),
    }
}

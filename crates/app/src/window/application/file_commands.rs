//! The window's file commands and their shortcuts.

use eframe::egui;

use crate::window::application::Application;
use crate::window::dialogs::about::{MANUAL, REPORTS};
use crate::window::dialogs::palette::Palette;
use crate::window::dialogs::question::Then;
use crate::window::input::event_queue::EventQueue;
use crate::window::input::file_command::FileCommand;
use crate::window::threads::message::Purpose;
use crate::window::widgets::theme;

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
            FileCommand::ExportAnimation | FileCommand::ExportFrames | FileCommand::ExportFlow => {
                match (command.unavailable_because(&self.editor), command) {
                    (Some(why), _) => self.fail(why.to_owned()),
                    (None, FileCommand::ExportFrames) => self.choose(Purpose::ExportFrames),
                    (None, FileCommand::ExportFlow) => self.choose(Purpose::ExportFlow),
                    (None, _) => self.choose(Purpose::ExportAnimation),
                }
            }
            FileCommand::ApplyEdit => match command.unavailable_because(&self.editor) {
                Some(why) => self.fail(why.to_owned()),
                None => self.choose(Purpose::ApplyEdit),
            },
            FileCommand::MergeOptions => self.dialogs.merge.open = true,
            FileCommand::Append
            | FileCommand::Mix
            | FileCommand::LoadCage
            | FileCommand::AddExample
            | FileCommand::AddMorphTarget(_) => match (command.unavailable_because(&self.editor), command) {
                (Some(why), _) => self.fail(why.to_owned()),
                (None, FileCommand::Append) => self.choose(Purpose::Append),
                (None, FileCommand::Mix) => self.choose(Purpose::Mix),
                (None, FileCommand::LoadCage) => self.choose(Purpose::LoadCage),
                (None, FileCommand::AddMorphTarget(target)) => self.load_morph_target(target),
                (None, _) => self.choose(Purpose::AddExample),
            },
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
}

/// Takes presses of a key without any modifier: egui counts a shortcut without Shift as pressed with Shift, too.
fn take_plain_key(input: &mut egui::InputState, plain: egui::Key) -> bool {
    let before = input.events.len();
    input.events.retain(|event| {
        !matches!(event, egui::Event::Key { key, pressed: true, modifiers, .. } if *key == plain && modifiers.is_none())
    });
    input.events.len() < before
}

//! One frame of the window: from messages and input to the editor, and back to the screen.

use std::time::{Duration, Instant};

use eframe::egui::{self, CentralPanel, Panel};
use pliant_editor::Event;

use crate::window::application::Application;
use crate::window::bars::recent_menu::Recent;
use crate::window::bars::status::{FileWork, FileWorkAnswer};
use crate::window::bars::{status, timeline, tool_column, tool_settings, top_bar, view_bar};
use crate::window::dialogs::palette::{Found, Outcome};
use crate::window::dialogs::{about, keys_window, log, memory_window, merge_window, question};
use crate::window::input::event_queue::EventQueue;
use crate::window::input::file_command::FileCommand;
use crate::window::panels::{self, PanelChange};
use crate::window::session::OpenFile;
use crate::window::threads::interface_pool;
use crate::window::widgets::outbox::Outbox;

/// The time between two looks whether the next frame of an animation is due, or events wait no longer.
const TICK: Duration = Duration::from_millis(4);

impl eframe::App for Application {
    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        debug_assert!(
            interface_pool::is_installed(),
            "the window's loops would wait behind jobs' on this thread"
        );
        let _span = tracing::trace_span!("frame").entered();
        let (start, drawn_before) = (Instant::now(), self.drawing_time());
        let context = ui.ctx().clone();
        let has_heard = self.take_messages() || context.input(|input| input.events.iter().any(may_change_layout));
        if self.viewport.is_lost() {
            context.send_viewport_cmd(egui::ViewportCommand::Close);
            return;
        }
        self.file_shortcuts(&context);
        self.close_by_escape(&context);

        let view = self.editor.view();
        if view.is_animating || view.is_catching_up {
            self.editor.handle(Event::Tick);
            // Often enough for the next frame to come in time.
            context.request_repaint_after(TICK);
        }
        let mut commands = Outbox::default();
        let (file_command, layout) = self.bars_and_panel(ui, &mut commands);
        if std::mem::replace(&mut self.layout.bars, layout) != layout || has_heard {
            // egui lays out by its measurements of the frame before.
            context.request_repaint();
        }
        let painted = CentralPanel::no_frame().show(ui, |ui| self.view(ui)).inner;
        if let Err(error) = painted {
            self.fail(error.to_string());
        }

        for event in commands.take() {
            self.last_change = Instant::now();
            self.editor.handle(event);
            context.request_repaint();
        }
        self.follow_frames(&context);
        self.follow_mesh();
        self.begin_stitching();
        if let Some(command) = file_command {
            self.file_command(&context, command);
        }
        self.save_what_has_settled();
        self.take_recent_picture(&context);
        self.dialogs(&context);
        self.fill_screen(&context);
        self.remember_size(&context);
        self.close_or_stay(&context);
        self.keep_for_recovery();
        self.entitle(&context);
        if let Some(recovery) = &self.recovery
            && let Some(wait) = recovery.wait(self.editor.snapshot_key(), self.editor.view().unsaved)
        {
            context.request_repaint_after(wait);
        }
        if self.session.doing().is_some() || !self.editor.view().jobs.is_empty() {
            context.request_repaint_after(Duration::from_millis(100));
        }
        let drawing = self.drawing_time().saturating_sub(drawn_before);
        self.longest_frame = self.longest_frame.max(start.elapsed().saturating_sub(drawing));
    }
}

impl Application {
    /// The bars and panels around the view. Returns the chosen file command, and the places of the content, the bars
    /// and the panel.
    fn bars_and_panel(&mut self, ui: &mut egui::Ui, commands: &mut Outbox) -> (Option<FileCommand>, [egui::Rect; 7]) {
        let context = ui.ctx().clone();
        let title = self.session.open.as_ref().map(OpenFile::name).unwrap_or_default();
        let top = Panel::top("top").show(ui, |ui| {
            let takes_keys = self.dialogs.question.is_none()
                && self.dialogs.palette.is_none()
                && !self.dialogs.keys.takes_keys()
                && !self.editor.is_acting();
            let recent = Recent {
                files: &self.settings.get().recent,
                pictures: &self.recent_pictures,
            };
            top_bar::show(ui, &self.editor, takes_keys, &title, &recent, commands)
        });
        let device = self.viewport.software_device().map(str::to_owned);
        let file_work = FileWork {
            doing: self.session.doing(),
            waiting: self.waiting_save(),
            is_loading_textures: self.is_loading_textures(),
        };
        let status = Panel::bottom("status").show(ui, |ui| {
            status::show(ui, &self.editor, &file_work, device.as_deref(), commands)
        });
        match status.inner {
            Some(FileWorkAnswer::Stop) => self.stop_file_work(),
            Some(FileWorkAnswer::SaveAsItIs) => self.save_as_it_is(),
            None => {}
        }
        let panel = match self.layout.is_panel_hidden {
            true => egui::Rect::NOTHING,
            false => self.panel(ui, commands),
        };
        let tools = Panel::left("tools").exact_size(tool_column::WIDTH).resizable(false);
        let tools = tools.show(ui, |ui| tool_column::show(ui, &self.editor, commands));
        let view_bar = Panel::top("view bar").show(ui, |ui| {
            view_bar::show(ui, &self.editor, commands);
            tool_settings::show(ui, &self.editor, commands);
        });
        let timeline = timeline::show(ui, &self.editor, commands);
        let bars = [&top.response, &status.response, &tools.response, &view_bar.response].map(|bar| bar.rect);
        let [top_rect, status_rect, tools_rect, view_bar_rect] = bars;
        let layout = [
            context.content_rect(),
            top_rect,
            status_rect,
            panel,
            tools_rect,
            view_bar_rect,
            timeline,
        ];
        (top.inner.or_else(|| commands.take_file()), layout)
    }

    /// The panel beside the view. Returns its place.
    fn panel(&mut self, ui: &mut egui::Ui, commands: &mut Outbox) -> egui::Rect {
        let panel = Panel::right("panel")
            .default_size(self.settings.get().panel_width)
            .min_size(220.0)
            .show(ui, |ui| {
                let open = self.session.open.as_ref();
                let morph_targets = open.map_or(&[][..], |open| &open.morph_targets);
                panels::show(
                    ui,
                    &self.editor,
                    &self.notes,
                    morph_targets,
                    self.settings.get(),
                    commands,
                )
            });
        match panel.inner {
            None => {}
            Some(PanelChange::Page(page)) => self.settings.change(|settings| settings.page = page),
            Some(PanelChange::Folded(title)) => self.settings.change(|settings| {
                if !settings.folded.remove(title) {
                    settings.folded.insert(title.to_owned());
                }
            }),
        }
        let rect = panel.response.rect;
        let is_held = ui.ctx().input(|input| input.pointer.any_down());
        if (rect.width() - self.settings.get().panel_width).abs() > 1.0 && !is_held {
            self.settings.change(|settings| settings.panel_width = rect.width());
        }
        rect
    }

    /// The layers over the view and the panel: the palette, the log, the keys and the waiting question.
    fn dialogs(&mut self, context: &egui::Context) {
        self.show_palette(context);
        for sentence in [
            self.headline().map(str::to_owned),
            self.editor.view().problem.map(str::to_owned),
            self.settled_with(),
        ] {
            self.dialogs.log.say(sentence.as_deref().unwrap_or_default());
        }
        self.dialogs.log.show(context);
        if self.dialogs.keys.show(context, &self.editor, &mut self.settings) {
            self.take_keys();
        }
        if self.dialogs.memory.show(context, &mut self.settings) {
            self.take_memory();
        }
        if let Some(command) = self.dialogs.merge.show(context, &self.editor) {
            self.editor.handle(Event::Command(command));
        }
        if self.dialogs.about.open
            && let Some(command) = self.dialogs.about.show(context, &self.viewport.device())
        {
            self.file_command(context, command);
        }
        let question = self.dialogs.question.as_mut();
        if let Some(answer) = question.and_then(|question| question::ask(context, question)) {
            self.answer(answer);
            context.request_repaint();
        }
        self.read_folder();
    }

    fn show_palette(&mut self, context: &egui::Context) {
        let Some(palette) = &mut self.dialogs.palette else {
            return;
        };
        if let Outcome::Chosen(chosen) = palette.show(context, &self.editor, &self.settings.get().recent_commands) {
            self.dialogs.palette = None;
            if let Some((name, found)) = chosen {
                self.settings.change(|settings| settings.remember_command(name));
                match found {
                    Found::Editor(command) => self.command(command),
                    Found::File(command) => self.file_command(context, command),
                }
            }
            context.request_repaint();
        }
    }

    /// Esc applies to the nearest thing. First come a question, the palette, an open menu, a field with the focus and
    /// the gesture of a tool; then it closes the topmost window of the list of keys, the choice of memory, the log and
    /// the version; only if none is open does the editor get it.
    fn close_by_escape(&mut self, context: &egui::Context) {
        let is_taken = self.dialogs.question.is_some()
            || self.dialogs.palette.is_some()
            || self.dialogs.keys.takes_keys()
            || egui::Popup::is_any_open(context)
            || context.egui_wants_keyboard_input()
            || EventQueue::is_typing(context)
            || self.editor.is_acting();
        let windows = [
            (merge_window::ID, &mut self.dialogs.merge.open),
            (keys_window::ID, &mut self.dialogs.keys.open),
            (memory_window::ID, &mut self.dialogs.memory.open),
            (log::ID, &mut self.dialogs.log.open),
            (about::ID, &mut self.dialogs.about.open),
        ];
        let mut open: Vec<_> = windows.into_iter().filter(|(_, open)| **open).collect();
        if is_taken || open.is_empty() {
            return;
        }
        if !context.input_mut(|input| input.consume_key(egui::Modifiers::NONE, egui::Key::Escape)) {
            return;
        }
        let top = context.memory(|memory| memory.areas().top_layer_id(egui::Order::Middle));
        let is_top = |name: &str| top.is_some_and(|layer| layer.id == egui::Id::unique(name));
        let nearest = open.iter().position(|(name, _)| is_top(name)).unwrap_or(0);
        *open[nearest].1 = false;
    }

    /// The energy with which the shape has settled, for the log.
    fn settled_with(&self) -> Option<String> {
        let view = self.editor.view();
        let descent = view.descent.filter(|_| view.settled)?;
        let end = if descent.converged {
            "Settled"
        } else {
            "Stopped at the step limit"
        };
        Some(format!("{end}, energy {:.3e}.", descent.energy))
    }
}

/// Returns true if an event may change the picture, so that one more frame is needed to lay it out.
fn may_change_layout(event: &egui::Event) -> bool {
    use egui::Event::{MouseMoved, MouseWheel, PointerGone, PointerMoved, Touch, Zoom};
    !matches!(
        event,
        PointerMoved(_) | MouseMoved(_) | MouseWheel { .. } | PointerGone | Touch { .. } | Zoom(_)
    )
}

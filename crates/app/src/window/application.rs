//! The application: what happens in one frame of the window, from messages and input to the editor, and back to the
//! screen.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use eframe::egui::{self, CentralPanel, Panel, Sense, vec2};
use glam::{DVec2, DVec3};
use pliant_editor::{Command, Cursor, Editor, Event, JobQueue, KeyMap, Revision, Shading, method_title};

use super::axis_ball;
use super::compare::Compare;
use super::dialog::{self, Question, Then};
use super::hints;
use super::input::{Attention, Input};
use super::keys_window::KeysWindow;
use super::log::Log;
use super::message::{Dressed, Message, Opened, Posed};
use super::notes::{Note, Notes};
use super::outbox::Outbox;
use super::palette::{Found, Outcome, Palette};
use super::panels;
use super::places::Places;
use super::recovery::{self, Recovery};
use super::session::{KeepOriginal, OpenFile, Session, Source};
use super::settings::SettingsFile;
use super::status;
use super::theme;
use super::top_bar;
use super::viewport::{Smoothness, Viewport};
use super::workers::{Stage, Workers};
use crate::AppError;
use crate::drawing::{self, Drawing, Field};
use crate::legend;

/// How long the view must rest before it is drawn with smooth borders on a software device.
const REST: Duration = Duration::from_millis(300);

/// The window's state beside the editor's: files, threads, the GPU, questions and notes.
pub struct Application {
    pub(super) editor: Editor,
    pub(super) viewport: Viewport,
    /// The second view, while two methods are compared.
    pub(super) compare: Option<Compare>,
    pub(super) workers: Workers,
    messages: Receiver<Message>,
    pub(super) session: Session,
    poses: JobQueue<Arc<Vec<DVec3>>>,
    next_pose: u64,
    input: Input,
    pub(super) settings: SettingsFile,
    recovery: Option<Recovery>,
    pub(super) palette: Option<Palette>,
    /// Whether this is a person's window, where the first steps are shown.
    shows_hints: bool,
    pub(super) log: Log,
    pub(super) keys: KeysWindow,
    pub(super) question: Option<Question>,
    /// What to do once the save that was asked for first has ended.
    pub(super) after_saving: Option<Then>,
    pub(super) notes: Notes,
    last_change: Instant,
    pub(super) closing: bool,
    /// The left session that is open now, until its work is kept or saved by this one.
    recovered_from: Option<PathBuf>,
    longest_frame: Duration,
    /// Whether the open file's images were asked for.
    is_dressed: bool,
    /// Whether a widget had the keys in the last frame.
    had_focus: bool,
    view_rect: egui::Rect,
    title: String,
}

impl Application {
    /// The application in eframe's context, opening `source`.
    ///
    /// # Errors
    /// Where there is no graphics device, or it can't run our pipelines.
    pub fn new(context: &eframe::CreationContext<'_>, source: Source) -> Result<Self, AppError> {
        Self::with_places(context, source, &Places::default())
    }

    /// The same, with a person's settings, and unsaved work kept for a recovery.
    ///
    /// # Errors
    /// As [`Application::new`].
    pub fn with_places(
        context: &eframe::CreationContext<'_>,
        source: Source,
        places: &Places,
    ) -> Result<Self, AppError> {
        let Some(state) = context.wgpu_render_state.clone() else {
            return Err(AppError::System(
                "the window has no graphics device: install a Vulkan driver".to_owned(),
            ));
        };
        let viewport = Viewport::new(state).map_err(|error| AppError::System(error.to_string()))?;
        let (sender, messages) = channel();
        let workers = Workers::new(context.egui_ctx.clone(), sender);
        let settings = SettingsFile::open(places.settings.clone());
        theme::apply(&context.egui_ctx, settings.get());
        let mut notes = Notes {
            headline: settings.problem.clone().map(Note::Failed),
            ..Notes::default()
        };
        let mut left = Vec::new();
        let mut recovery = None;
        if let Some(folder) = &places.recovery {
            left = Recovery::left_in(folder);
            match Recovery::begin(folder) {
                Ok(begun) => recovery = Some(begun),
                Err(sentence) => notes.headline = Some(Note::Failed(sentence)),
            }
        }
        let mut session = Session::default();
        session.load(source, &viewport.gpu(), &workers);
        let mut application = Self {
            editor: Editor::new(Box::new(workers.clone())),
            viewport,
            compare: None,
            workers,
            messages,
            session,
            poses: JobQueue::default(),
            next_pose: 0,
            input: Input::default(),
            settings,
            palette: None,
            shows_hints: places.settings.is_some(),
            log: Log::default(),
            keys: KeysWindow::default(),
            recovery,
            question: (!left.is_empty()).then_some(Question::Recover(left)),
            after_saving: None,
            notes,
            last_change: Instant::now(),
            closing: false,
            recovered_from: None,
            longest_frame: Duration::ZERO,
            is_dressed: false,
            had_focus: false,
            view_rect: egui::Rect::ZERO,
            title: String::new(),
        };
        application.take_keys();
        Ok(application)
    }

    /// Goes on in another window of eframe's, on another device: the document, its history and the jobs that run are
    /// as they were, and what was on the lost device is uploaded again.
    ///
    /// # Errors
    /// As [`Application::new`].
    pub fn revive(&mut self, context: &eframe::CreationContext<'_>) -> Result<(), AppError> {
        theme::apply(&context.egui_ctx, self.settings.get());
        let Some(state) = context.wgpu_render_state.clone() else {
            return Err(AppError::System(
                "the window has no graphics device any more".to_owned(),
            ));
        };
        let system = |error: pliant_render::RenderError| AppError::System(error.to_string());
        self.viewport = Viewport::new(state).map_err(system)?;
        self.compare = None;
        self.workers.wake(context.egui_ctx.clone());
        self.input = Input::default();
        self.is_dressed = false;
        self.title.clear();
        if let Some(open) = &self.session.open {
            let (drawing, model) = (Arc::clone(&open.drawing), &open.loaded.model);
            let displacements = Arc::clone(self.editor.view().displacements);
            let pose = drawing.pose(model, &displacements);
            let surface = self.viewport.gpu().upload(&drawing, &pose).map_err(system)?;
            let lowest = model.bounds().map_or(DVec3::ZERO, |bounds| bounds.min);
            self.viewport.show(drawing, surface, displacements, lowest);
        }
        self.notes.headline = Some(Note::Done(
            "The graphics device was lost and has been opened again; the document is as it was.".to_owned(),
        ));
        Ok(())
    }

    /// Digits of the numeric pad that went down since the last frame, in order.
    pub(super) fn press_numpad(&mut self, digits: VecDeque<u8>) {
        self.input.numpad = digits;
    }

    /// Whether the graphics device is gone, so that the window must be opened anew.
    pub fn has_lost_its_device(&self) -> bool {
        self.viewport.is_lost()
    }

    /// Loses the graphics device, for trying out that nothing else is lost.
    pub fn lose_device(&self) {
        self.viewport.lose_device();
    }

    /// The editor, to look at.
    pub fn editor(&self) -> &Editor {
        &self.editor
    }

    /// The path that the open file was read from or saved to.
    pub fn path(&self) -> Option<&Path> {
        self.session.open.as_ref()?.path.as_deref()
    }

    /// Whether nothing is under way: no job, no file being read or written, and the picture shows the present shape.
    pub fn is_settled(&self) -> bool {
        let view = self.editor.view();
        let shown = self
            .viewport
            .displacements()
            .is_some_and(|shown| Arc::ptr_eq(shown, view.displacements));
        let compared = self.compare.as_ref().is_none_or(Compare::is_settled);
        view.settled && shown && compared && self.session.doing().is_none()
    }

    /// The shape in the GPU's buffers, per surface vertex, from the file's.
    pub fn shown_displacements(&self) -> Option<&Arc<Vec<DVec3>>> {
        self.viewport.displacements()
    }

    /// Where the 3D view stands in the window, in points.
    pub fn view_rect(&self) -> egui::Rect {
        self.view_rect
    }

    /// The editor behind the second view, while two methods are compared.
    pub fn compared(&self) -> Option<&Editor> {
        self.compare.as_ref().map(Compare::editor)
    }

    /// Opens or closes the second view.
    pub fn toggle_compare(&mut self, context: &egui::Context) {
        self.compare = match self.compare.take() {
            Some(_) => None,
            None => Some(Compare::new(context, &self.viewport, &self.editor)),
        };
        self.last_change = Instant::now();
    }

    /// How often the 3D view was drawn.
    pub fn drawings(&self) -> u64 {
        self.viewport.drawings()
    }

    /// The newest sentence about a file that was saved or could not be opened or saved.
    pub fn headline(&self) -> Option<&str> {
        match self.notes.headline.as_ref()? {
            Note::Done(sentence) | Note::Failed(sentence) => Some(sentence),
        }
    }

    /// The longest that a frame has kept the window's thread busy, the drawing itself apart, since the last call.
    pub fn take_longest_frame(&mut self) -> Duration {
        std::mem::take(&mut self.longest_frame)
    }

    /// How long drawing has kept the window's thread busy so far.
    pub fn drawing_time(&self) -> Duration {
        let second = self.compare.as_ref().map_or(Duration::ZERO, Compare::drawing_time);
        self.viewport.drawing_time() + second
    }

    /// Gives the editor a command, as a menu would.
    pub fn command(&mut self, command: Command) {
        self.last_change = Instant::now();
        self.editor.handle(Event::Command(command));
    }

    /// Opens a file without asking whether unsaved work may be lost.
    pub fn open(&mut self, path: PathBuf) {
        self.session
            .load(Source::File(path), &self.viewport.gpu(), &self.workers);
    }

    /// Saves under `path`, without asking whether a source may be written over.
    pub fn save_to(&mut self, path: PathBuf, keep_original: KeepOriginal) {
        let displacements = Arc::clone(self.editor.view().displacements);
        self.session.save(path, &displacements, keep_original, &self.workers);
    }

    fn take_messages(&mut self) {
        while let Ok(message) = self.messages.try_recv() {
            match message {
                Message::Job(done, posed) => {
                    self.editor.handle(Event::JobDone(done));
                    // A stale result's pose is not shown: the editor kept another shape.
                    if let Some(posed) =
                        posed.filter(|posed| Arc::ptr_eq(&posed.displacements, self.editor.view().displacements))
                    {
                        self.show_pose(posed);
                    }
                }
                Message::Posed(stamp, result) => {
                    self.poses.finish(stamp);
                    match result {
                        Ok(posed) if self.belongs_to_open_file(&posed) => self.show_pose(posed),
                        Ok(_) => {}
                        Err(sentence) => self.fail(sentence),
                    }
                }
                // That goes to the second view.
                Message::Uploaded(..) => {}
                Message::Dressed(drawing, result) => self.wear(&drawing, result),
                Message::Opened(stamp, result) => match self.session.loaded(stamp, result, &self.workers) {
                    Some(Ok(opened)) => self.adopt(*opened),
                    Some(Err(sentence)) => self.fail(sentence),
                    None => {}
                },
                Message::Written(stamp, result) => self.written(stamp, result),
                Message::Autosaved(key, result) => {
                    let failed = self
                        .recovery
                        .as_mut()
                        .and_then(|recovery| recovery.written(key, result));
                    if let Some(sentence) = failed {
                        self.fail(sentence);
                    }
                }
                Message::Chosen(purpose, path) => self.chosen(purpose, path),
            }
        }
    }

    fn belongs_to_open_file(&self, posed: &Posed) -> bool {
        posed.displacements.len() == self.editor.view().displacements.len()
    }

    fn adopt(&mut self, opened: Opened) {
        self.session.adopt(&opened);
        let Opened {
            loaded,
            drawing,
            surface,
            displacements,
            beginning,
            notes,
            recovered,
            project,
            path,
            ..
        } = opened;
        if let Some(path) = project.or(path).filter(|_| recovered.is_none()) {
            self.settings.change(|settings| settings.remember(&path));
        }
        let name = self.session.open.as_ref().map(OpenFile::name).unwrap_or_default();
        self.workers.set_stage(Stage {
            loaded: Arc::clone(&loaded),
            drawing: Arc::clone(&drawing),
            field: self.wanted_field(),
            scales: Arc::default(),
        });
        self.poses.cancel();
        self.is_dressed = false;
        let lowest = loaded.model.bounds().map_or(DVec3::ZERO, |bounds| bounds.min);
        self.viewport.show(drawing, surface, displacements, lowest);
        self.notes = Notes {
            headline: None,
            about_file: notes,
        };
        self.editor.handle(Event::Opened {
            model: Arc::clone(&loaded.model),
            name,
            beginning,
        });
        if let Some(left) = recovered {
            self.editor.handle(Event::Recovered);
            self.keep_for_recovery();
            self.recovered_from = Some(left);
        }
    }

    /// Has unsaved work written where the next session finds it.
    fn keep_for_recovery(&mut self) {
        let (Some(recovery), Some(open)) = (&mut self.recovery, &self.session.open) else {
            return;
        };
        let (key, unsaved) = (self.editor.snapshot_key(), self.editor.view().unsaved);
        let Some(work) = recovery.note(key, unsaved, || self.editor.snapshot(), &open.loaded, &open.source) else {
            // What was recovered is kept by this session now, or saved.
            if recovery.has(key) || !unsaved {
                self.recovered_from
                    .take()
                    .iter()
                    .for_each(|left| recovery::remove(left));
            }
            return;
        };
        self.workers.spawn(
            "autosave",
            move || Message::Autosaved(key, work.write()),
            move |sentence| Message::Autosaved(key, Err(sentence)),
        );
    }

    pub(super) fn fail(&mut self, sentence: String) {
        self.notes.headline = Some(Note::Failed(sentence));
    }

    fn show_pose(&mut self, posed: Posed) {
        if let Err(error) = self.viewport.pose(posed) {
            self.fail(error.to_string());
        }
    }

    /// The numbers of the shape that are to be shown as colours. Stiffness is none of the shape's.
    fn wanted_field(&self) -> Option<Field> {
        drawing::field(self.editor.view().look.shading).filter(|&field| field != Field::Stiffness)
    }

    /// Has the images decoded and uploaded when materials are first shown.
    fn request_images(&mut self) {
        let Some(open) = &self.session.open else { return };
        if self.is_dressed
            || self.editor.view().look.shading != Shading::Material
            || !open.drawing.wardrobe.has_images()
        {
            return;
        }
        self.is_dressed = true;
        let (drawing, gpu) = (Arc::clone(&open.drawing), self.viewport.gpu());
        let failed = Arc::clone(&drawing);
        self.workers.spawn(
            "images",
            move || {
                let dress = drawing.wardrobe.decode();
                let outfit = gpu.upload_images(&dress).map_err(|error| error.to_string());
                let notes = dress.notes;
                Message::Dressed(drawing, outfit.map(|outfit| Dressed { outfit, notes }))
            },
            move |sentence| Message::Dressed(Arc::clone(&failed), Err(sentence)),
        );
    }

    fn wear(&mut self, drawing: &Arc<Drawing>, result: Result<Dressed, String>) {
        let worn = result.and_then(|Dressed { outfit, notes }| {
            self.notes.about_file.extend(notes);
            self.viewport.wear(drawing, outfit).map_err(|error| error.to_string())
        });
        if let Err(sentence) = worn {
            self.fail(format!("the materials are shown without their images: {sentence}"));
        }
    }

    /// Asks for the pose of the present shape if it is not the one that is shown (after undo, or while a handle moves
    /// before its binding is ready).
    fn request_pose(&mut self) {
        let field = self.wanted_field();
        let Some(mut stage) = self.workers.stage() else { return };
        if stage.field != field {
            stage.field = field;
            self.workers.set_stage(stage.clone());
        }
        let wanted = self.editor.view().displacements;
        let shown = self.viewport.displacements();
        let is_stale = shown.is_some_and(|shown| !Arc::ptr_eq(shown, wanted))
            || (shown.is_some() && field.is_some() && self.viewport.field() != field);
        if is_stale && !self.poses.is_busy() {
            let wanted = Arc::clone(wanted);
            self.next_pose += 1;
            self.poses.request(Revision(self.next_pose), wanted);
        }
        let Some((running, displacements)) = self.poses.start_next() else {
            return;
        };
        let stamp = running.stamp;
        self.workers.spawn(
            "posing",
            move || Message::Posed(stamp, Ok(stage.pose(displacements))),
            move |sentence| Message::Posed(stamp, Err(sentence)),
        );
    }

    /// Tells the editor which keys a person has chosen.
    fn take_keys(&mut self) {
        let (keys, problems) = KeyMap::of_names(&self.settings.get().keys);
        self.editor.handle(Event::Keys(keys));
        if !problems.is_empty() {
            self.fail(problems.join(" "));
        }
    }

    fn show_palette(&mut self, context: &egui::Context) {
        let Some(palette) = &mut self.palette else { return };
        if let Outcome::Chosen(found) = palette.show(context, &self.editor) {
            self.palette = None;
            match found {
                Some(Found::Editor(command)) => self.command(command),
                Some(Found::File(command)) => self.file_command(context, command),
                None => {}
            }
            context.request_repaint();
        }
    }

    /// Notes how large the window is, once nobody pulls at it.
    fn remember_size(&mut self, context: &egui::Context) {
        let size = context.input(|input| {
            let viewport = input.viewport();
            let is_own = viewport.maximized != Some(true) && viewport.fullscreen != Some(true);
            viewport.inner_rect.filter(|_| is_own).map(|rect| rect.size())
        });
        let Some(size) = size.filter(|_| self.last_change.elapsed() >= REST) else {
            return;
        };
        // The size in points at the scale of the system, whatever the person's own is.
        let size = size * context.zoom_factor();
        let known = self.settings.get().window_size;
        if known.is_none_or(|known| (size - egui::Vec2::from(known)).length() > 1.0) {
            self.settings
                .change(|settings| settings.window_size = Some(size.into()));
        }
    }

    /// Names the open file, or the question that waits, in the window's title.
    fn entitle(&mut self, context: &egui::Context) {
        let about = match (&self.question, &self.session.open) {
            (Some(question), _) => question.title().to_owned(),
            (None, Some(open)) => open.name(),
            (None, None) => "opening".to_owned(),
        };
        let title = format!("Pliant — {about}");
        if self.title != title {
            context.send_viewport_cmd(egui::ViewportCommand::Title(title.clone()));
            self.title = title;
        }
    }

    /// With the pointer over the view and the keys with it, Tab is the view's: it selects the next handle. Elsewhere it
    /// goes from one widget to the next.
    fn keep_tab(&mut self, ui: &egui::Ui, is_over_view: bool) {
        let focused = ui.memory(egui::Memory::focused);
        let is_tab = ui.input(|input| input.key_pressed(egui::Key::Tab));
        if let Some(widget) = focused.filter(|_| is_tab && is_over_view && !self.had_focus) {
            ui.memory_mut(|memory| memory.surrender_focus(widget));
        }
        self.had_focus = ui.memory(egui::Memory::focused).is_some();
    }

    /// The 3D view: input first, then the picture.
    fn view(&mut self, ui: &mut egui::Ui) -> Result<(), pliant_render::RenderError> {
        let (whole, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        let (rect, second) = match self.compare {
            None => (whole, None),
            Some(_) => {
                let (first, second) = whole.split_left_right_at_fraction(0.5);
                (first, Some(second))
            }
        };
        if rect.width() < 1.0 || rect.height() < 1.0 {
            return Ok(());
        }
        self.view_rect = rect;
        let size_px = DVec2::new(f64::from(rect.width()), f64::from(rect.height()));
        if self.editor.view().viewport_px != size_px {
            self.editor.handle(Event::Viewport { size_px });
        }
        if response.is_pointer_button_down_on() {
            ui.memory_mut(|memory| {
                if let Some(focused) = memory.focused() {
                    memory.surrender_focus(focused);
                }
            });
        }
        self.keep_tab(ui, response.contains_pointer());
        let over_ball = axis_ball::contains(rect, ui.input(|input| input.pointer.latest_pos()));
        let attention = Attention {
            rect,
            pointer: ui.input(|input| input.pointer.latest_pos()).unwrap_or(rect.center()),
            pointer_over: response.contains_pointer()
                && ui
                    .input(|input| input.pointer.latest_pos())
                    .is_some_and(|at| rect.contains(at))
                && self.question.is_none()
                && self.palette.is_none()
                && !over_ball,
            follows_pointer: self.editor.view().cursor == Cursor::Move,
            keys: self.question.is_none()
                && self.palette.is_none()
                && !self.keys.takes_keys()
                && !ui.ctx().egui_wants_keyboard_input(),
        };
        let events = self.input.events(ui.ctx(), attention);
        if !events.is_empty() {
            self.last_change = Instant::now();
        }
        for event in events {
            self.editor.handle(event);
        }
        self.request_pose();
        self.request_images();
        ui.ctx().set_cursor_icon(match self.editor.view().cursor {
            _ if !response.contains_pointer() => egui::CursorIcon::Default,
            Cursor::Arrow => egui::CursorIcon::Default,
            Cursor::Brush => egui::CursorIcon::Crosshair,
            Cursor::Grab => egui::CursorIcon::Grab,
            Cursor::Grabbing => egui::CursorIcon::Grabbing,
            Cursor::Move => egui::CursorIcon::Move,
        });
        let resting = self.last_change.elapsed() >= REST && self.editor.view().settled;
        let smooth = if resting {
            Smoothness::Resting
        } else {
            Smoothness::Moving
        };
        if self.viewport.paint(ui, rect, &self.editor, smooth)? {
            ui.ctx().request_repaint_after(
                REST.saturating_sub(self.last_change.elapsed())
                    .max(Duration::from_millis(10)),
            );
        }
        if let (Some(second), Some(compare), Some(stage)) = (second, &mut self.compare, self.workers.stage()) {
            compare.follow(&self.editor, &self.viewport, &stage);
            let resting = smooth == Smoothness::Resting && compare.is_settled();
            let smooth = if resting { smooth } else { Smoothness::Moving };
            if compare.show(ui, second, smooth)? {
                ui.ctx().request_repaint_after(REST);
            }
            let name = method_title(self.editor.document().method().name());
            axis_ball::readout(ui.painter(), rect.center_top() + vec2(-60.0, 12.0), name);
        }
        let outline_px = self.editor.view().outline_px;
        if outline_px.len() > 1 {
            let point = |px: &DVec2| rect.min + vec2(px.x as f32, px.y as f32);
            let mut line: Vec<egui::Pos2> = outline_px.iter().map(point).collect();
            line.push(line[0]);
            let shadow = egui::Stroke::new(3.0, egui::Color32::from_black_alpha(120));
            ui.painter().add(egui::Shape::line(line.clone(), shadow));
            ui.painter()
                .add(egui::Shape::line(line, egui::Stroke::new(1.5, theme::ACCENT)));
        }
        let shown = self.editor.view();
        if let Some(scale) = self.viewport.scale() {
            legend::paint(ui.painter(), rect.left_top() + vec2(14.0, 14.0), scale);
        }
        if let Some(readout) = &shown.readout
            && let Some(at_px) = shown.camera.project(readout.at, shown.viewport_px)
        {
            let at = rect.min + vec2(at_px.x as f32 + 22.0, at_px.y as f32 - 26.0);
            axis_ball::readout(ui.painter(), at, &readout.text);
        }
        if let Some(command) = axis_ball::show(ui, rect, shown.camera) {
            self.command(command);
            ui.ctx().request_repaint();
        }
        if self.shows_hints && !self.settings.get().hints_seen && hints::show(ui, rect, &self.editor) {
            self.settings.change(|settings| settings.hints_seen = true);
        }
        Ok(())
    }
}

impl eframe::App for Application {
    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        let (start, drawn_before) = (Instant::now(), self.drawing_time());
        let context = ui.ctx().clone();
        self.take_messages();
        if self.viewport.is_lost() {
            context.send_viewport_cmd(egui::ViewportCommand::Close);
            return;
        }
        self.file_shortcuts(&context);

        let mut commands = Outbox::default();
        let mut file_command = None;
        let title = self.session.open.as_ref().map(OpenFile::name).unwrap_or_default();
        Panel::top("top").show(ui, |ui| {
            file_command = top_bar::show(ui, &self.editor, &title, &self.settings.get().recent, &mut commands);
        });
        let device = self.viewport.software_device().map(str::to_owned);
        let busy = self.session.doing();
        let stop = Panel::bottom("status")
            .show(ui, |ui| {
                status::show(
                    ui,
                    &self.editor,
                    busy,
                    &mut self.notes.headline,
                    device.as_deref(),
                    &mut commands,
                )
            })
            .inner;
        if stop {
            self.session.stop();
        }
        let panel = Panel::right("panel")
            .default_size(self.settings.get().panel_width)
            .min_size(220.0)
            .show(ui, |ui| {
                let folded = &self.settings.get().folded;
                panels::show(ui, &self.editor, &self.notes, folded, &mut commands)
            });
        if let Some(title) = panel.inner {
            self.settings.change(|settings| {
                if !settings.folded.remove(title) {
                    settings.folded.insert(title.to_owned());
                }
            });
        }
        let width = panel.response.rect.width();
        if (width - self.settings.get().panel_width).abs() > 1.0 && !context.input(|input| input.pointer.any_down()) {
            self.settings.change(|settings| settings.panel_width = width);
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
        if let Some(command) = file_command {
            self.file_command(&context, command);
        }
        self.show_palette(&context);
        for sentence in [
            self.headline().map(str::to_owned),
            self.editor.view().problem.map(str::to_owned),
        ] {
            self.log.say(sentence.as_deref().unwrap_or_default());
        }
        self.log.show(&context);
        if self.keys.show(&context, &self.editor, &mut self.settings) {
            self.take_keys();
        }
        if let Some(answer) = self
            .question
            .as_mut()
            .and_then(|question| dialog::ask(&context, question))
        {
            self.answer(answer);
            context.request_repaint();
        }
        self.remember_size(&context);
        self.close_or_stay(&context);
        self.keep_for_recovery();
        if let Some(recovery) = &self.recovery
            && let Some(wait) = recovery.wait(self.editor.snapshot_key(), self.editor.view().unsaved)
        {
            context.request_repaint_after(wait);
        }
        self.entitle(&context);
        if self.session.doing().is_some() || !self.editor.view().jobs.is_empty() {
            context.request_repaint_after(Duration::from_millis(100));
        }
        let busy = start
            .elapsed()
            .saturating_sub(self.drawing_time().saturating_sub(drawn_before));
        self.longest_frame = self.longest_frame.max(busy);
    }
}

//! The application: the window's state beside the editor's. The files beside this one have its methods, by subject.

mod answers;
pub(in crate::window) mod area;
pub(in crate::window) mod arrivals;
mod attachments;
mod chosen_files;
mod elsewhere;
mod exports;
mod file_commands;
pub(in crate::window) mod frame;
pub(in crate::window) mod layout;
mod meshes;
mod mixing;
mod opening;
mod queries;
pub(in crate::window) mod redrawing;
mod reloading;
pub(in crate::window) mod saves;
mod unsaved_work;
pub(in crate::window) mod waiting_saves;

use std::collections::{BTreeSet, VecDeque};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use pliant_editor::{Command, Editor, Event, KeyMap};
use pliant_mesh::Cancel;

use self::layout::Layout;
use self::waiting_saves::WaitingSaves;
use super::bars::recent_menu::RecentPictures;
use super::bars::toast::Toast;
use super::dialogs::Dialogs;
use super::dialogs::question::Question;
use super::files::app_directories::AppDirectories;
use super::files::desktop::Desktop;
use super::files::recovery::Recovery;
use super::files::recovery::left::left_in;
use super::files::settings::SettingsFile;
use super::input::Input;
use super::input::event_queue::EventQueue;
use super::input::own_keys;
use super::panels::notes::{Note, Notes};
use super::threads::interface_pool;
use super::threads::message::Message;
use super::threads::workers::Workers;
use super::viewport::Viewport;
use super::viewport::beside::ViewsBeside;
use super::widgets::{icon, theme};
use crate::window::session::{Session, Source};
use crate::window::viewport::pose_queue::PoseQueue;
use crate::window::viewport::shown::Shown;
use pliant_engine::EngineError;

/// The time that the view must rest before a software device draws it with smooth borders.
pub(super) const REST: Duration = Duration::from_millis(300);

/// The window's state beside the editor's: files, threads, the GPU, dialogs and notes.
pub struct Application {
    pub(super) editor: Editor,
    pub(super) viewport: Viewport,
    pub(super) beside: ViewsBeside,
    pub(super) workers: Workers,
    pub(super) messages: Receiver<Message>,
    pub(super) session: Session,
    pub(super) poses: PoseQueue,
    pub(super) input: Input,
    pub(super) settings: SettingsFile,
    pub(super) recovery: Option<Recovery>,
    /// The file manager and the browser.
    pub(super) desktop: Desktop,
    pub(super) recent_pictures: RecentPictures,
    pub(super) dialogs: Dialogs,
    pub(super) waiting: WaitingSaves,
    pub(super) notes: Notes,
    pub(super) toast: Toast,
    pub(super) last_change: Instant,
    pub(super) closing: bool,
    /// The recovered session that is open now, until this one keeps or saves its work.
    pub(super) recovered_from: Option<PathBuf>,
    pub(super) longest_frame: Duration,
    pub(super) layout: Layout,
    /// The parts that are turned inside out in the drawing that is being made.
    pub(super) redrawing: Option<Arc<BTreeSet<u32>>>,
    /// Stops the decoding of the open file's images, if it has begun.
    pub(super) images: Option<Cancel>,
    /// True if *Material* was chosen because of the open file's vertex colours.
    pub(super) shows_vertex_colours: bool,
}

impl Application {
    /// The application in eframe's context, opening `source`.
    ///
    /// # Errors
    /// If there is no graphics device, or if it can't run our pipelines.
    pub fn new(context: &eframe::CreationContext<'_>, source: Source) -> Result<Self, EngineError> {
        Self::with_places(context, source, &AppDirectories::default())
    }

    /// The same, with a person's settings, and unsaved work kept for a recovery.
    ///
    /// # Errors
    /// As [`Application::new`].
    pub fn with_places(
        context: &eframe::CreationContext<'_>,
        source: Source,
        places: &AppDirectories,
    ) -> Result<Self, EngineError> {
        interface_pool::install();
        let Some(state) = context.wgpu_render_state.clone() else {
            return Err(EngineError::System(
                "the window has no graphics device: install a Vulkan driver".to_owned(),
            ));
        };
        let viewport = Viewport::new(state).map_err(|error| EngineError::System(error.to_string()))?;
        let (sender, messages) = channel();
        let workers = Workers::new(context.egui_ctx.clone(), sender);
        let settings = SettingsFile::open(places.settings.clone());
        theme::apply(&context.egui_ctx, settings.get());
        icon::install(&context.egui_ctx);
        context.egui_ctx.add_plugin(EventQueue::default());
        let mut notes = Notes {
            headline: settings.problem.clone().map(Note::Failed),
            ..Notes::default()
        };
        let mut left = Vec::new();
        let mut recovery = None;
        if let Some(folder) = &places.recovery {
            left = left_in(folder);
            match Recovery::begin(folder) {
                Ok(begun) => recovery = Some(begun),
                Err(sentence) => notes.headline = Some(Note::Failed(sentence)),
            }
        }
        let mut session = Session::default();
        session.load(source, &viewport.gpu(), &workers);
        let is_to_fill_screen = settings.get().maximised;
        let mut application = Self {
            editor: Editor::new(Box::new(workers.clone())),
            viewport,
            beside: ViewsBeside::default(),
            workers,
            messages,
            session,
            poses: PoseQueue::default(),
            input: Input::default(),
            settings,
            desktop: Desktop::default(),
            recent_pictures: RecentPictures::in_folder(places.pictures.clone()),
            recovery,
            dialogs: Dialogs {
                question: (!left.is_empty()).then_some(Question::Recover(left)),
                ..Dialogs::default()
            },
            waiting: WaitingSaves::default(),
            notes,
            toast: Toast::default(),
            last_change: Instant::now(),
            closing: false,
            recovered_from: None,
            longest_frame: Duration::ZERO,
            layout: Layout::new(places.settings.is_some(), is_to_fill_screen),
            redrawing: None,
            images: None,
            shows_vertex_colours: false,
        };
        application.take_keys();
        application.take_memory();
        application.read_recent_pictures();
        Ok(application)
    }

    /// Goes on in another window of eframe's, on another device: the document, its history and the running jobs stay
    /// the same, and the data of the lost device is uploaded again.
    ///
    /// # Errors
    /// As [`Application::new`].
    pub fn revive(&mut self, context: &eframe::CreationContext<'_>) -> Result<(), EngineError> {
        theme::apply(&context.egui_ctx, self.settings.get());
        icon::install(&context.egui_ctx);
        context.egui_ctx.add_plugin(EventQueue::default());
        let Some(state) = context.wgpu_render_state.clone() else {
            return Err(EngineError::System(
                "the window has lost its graphics device".to_owned(),
            ));
        };
        let system = |error: pliant_render::RenderError| EngineError::System(error.to_string());
        self.viewport = Viewport::new(state).map_err(system)?;
        self.beside.let_go();
        self.recent_pictures.forget_textures();
        self.workers.wake(context.egui_ctx.clone());
        self.input = Input::default();
        self.stop_images();
        self.layout.title.clear();
        if let Some(open) = &self.session.open {
            let (drawing, model) = (Arc::clone(&open.drawing), &open.loaded.model);
            let displacements = Arc::clone(self.editor.view().drawn);
            let pose = drawing.pose(model, &displacements);
            let surface = self.viewport.gpu().upload(&drawing, &pose).map_err(system)?;
            self.viewport.show(Shown::new(drawing, surface, displacements, model));
            // It was in the memory of the lost device.
            self.session.others.keep(None);
        }
        self.notes.headline = Some(Note::Done(
            "The graphics device was lost and opened again; the document is unchanged.".to_owned(),
        ));
        Ok(())
    }

    /// From now on the file manager and the browser are replaced by `desktop`, for programs that drive the window.
    pub fn set_desktop(&mut self, desktop: Desktop) {
        self.desktop = desktop;
    }

    /// Digits of the numeric pad that went down since the last frame, in order.
    pub(super) fn press_numpad(&mut self, digits: VecDeque<u8>) {
        self.input.numpad.extend(digits);
    }

    /// Loses the graphics device, to test that nothing else is lost.
    pub fn lose_device(&self) {
        self.viewport.lose_device();
    }

    /// Gives the editor a command, like a menu.
    pub fn command(&mut self, command: Command) {
        self.last_change = Instant::now();
        self.editor.handle(Event::Command(command));
        self.follow_mesh();
    }

    pub(super) fn fail(&mut self, sentence: String) {
        self.notes.headline = Some(Note::Failed(sentence));
    }

    /// Gives the editor the memory limit that the person has chosen for bindings.
    pub(super) fn take_memory(&mut self) {
        let most = self.settings.get().memory;
        self.editor.handle(Event::Memory(most.map(|most| most.0)));
    }

    /// Gives the editor the keys that the person has chosen.
    pub(super) fn take_keys(&mut self) {
        let mut chosen = self.settings.get().keys.clone();
        let mut problems = own_keys::refuse(&mut chosen);
        let (keys, misread) = KeyMap::of_names(&chosen);
        problems.extend(misread);
        self.editor.handle(Event::Keys(keys));
        if !problems.is_empty() {
            self.fail(problems.join(" "));
        }
    }
}

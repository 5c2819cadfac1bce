//! The window: eframe around the editor. Panels show the editor's state and send it events; files, dialogs, threads and
//! the clock are here; egui meets the renderer only in `viewport`.

mod application;
mod bars;
mod dialogs;
mod fault;
mod files;
mod input;
mod panels;
pub(in crate::window) mod session;
mod shell;
mod system_window;
mod threads;
mod viewport;
mod widgets;

use std::cell::{Cell, RefCell};
use std::rc::Rc;
use std::sync::Arc;

use eframe::UserEvent;
use eframe::egui::{ViewportBuilder, vec2};
use eframe::egui_wgpu::{WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew};

use winit::event_loop::EventLoop;
use winit::platform::run_on_demand::EventLoopExtRunOnDemand;

pub use crate::files::names::original_name;
pub use application::Application;
pub use files::app_directories::AppDirectories;
pub use files::desktop::{Desktop, Elsewhere};
pub use session::{KeepOriginal, Source};

/// Saves and projects without the window, for programs that drive them.
pub mod saving {
    pub use super::files::project_file::{OpenedProject, read as read_project};
    pub use super::files::rest_mesh::{MeshSource, RestMesh};
    pub use super::files::save_request::{
        Changed, Content, KeepOriginal, Model, SaveRequest, Shape, Unwritten, Written, WrittenKind,
    };
    pub use super::files::writing::write;
}

pub use shell::{NumpadDigits, Shared, Shell};

use files::settings::Settings;
use shell::Listener;

use pliant_engine::EngineError;

/// The variables that name a display, on systems with X11 or Wayland.
const DISPLAYS: [&str; 3] = ["WAYLAND_DISPLAY", "WAYLAND_SOCKET", "DISPLAY"];

/// Opens the window and returns when it is closed.
///
/// # Errors
/// If there is no window or no graphics device.
pub fn run(source: Source) -> Result<(), EngineError> {
    if cfg!(all(unix, not(target_os = "macos"))) && DISPLAYS.iter().all(|name| std::env::var_os(name).is_none()) {
        return Err(EngineError::System(format!(
            "there is no display to open a window on (none of {} is set): start it in a desktop session, or use \
             `pliant apply` and `pliant render`, which need none",
            DISPLAYS.join(", ")
        )));
    }
    let places = AppDirectories::of_user();
    if let Some(folder) = &places.recovery {
        fault::listen(folder.clone());
    }
    let refused = |reason: String| EngineError::System(sentence(&reason));
    let mut event_loop = EventLoop::<UserEvent>::with_user_event()
        .build()
        .map_err(|error| refused(error.to_string()))?;
    let (application, numpad) = (Shared::default(), NumpadDigits::default());
    loop {
        // eframe's handler does not report why it could not begin.
        let failure: Rc<RefCell<Option<EngineError>>> = Rc::default();
        let has_begun = Rc::new(Cell::new(false));
        let inner = eframe::create_native(
            "Pliant",
            options(&places),
            {
                let (application, numpad) = (Rc::clone(&application), Rc::clone(&numpad));
                let (source, places) = (source.clone(), places.clone());
                let (failure, has_begun) = (Rc::clone(&failure), Rc::clone(&has_begun));
                Box::new(move |context| {
                    has_begun.set(true);
                    let begin =
                        |context: &eframe::CreationContext<'_>| Application::with_places(context, source, &places);
                    match Shell::new(context, application, begin, numpad) {
                        Ok(shell) => Ok(Box::new(shell) as Box<dyn eframe::App>),
                        Err(error) => {
                            let sentence = error.to_string();
                            *failure.borrow_mut() = Some(error);
                            Err(sentence.into())
                        }
                    }
                })
            },
            &event_loop,
        );
        let mut listener = Listener {
            inner,
            numpad: Rc::clone(&numpad),
        };
        let run = event_loop.run_app_on_demand(&mut listener);
        drop(listener);
        run.map_err(|error| refused(error.to_string()))?;
        if let Some(error) = failure.take() {
            return Err(error);
        }
        if !has_begun.get() {
            // Nearly always the device is the cause; asking for one without a window gives the reason.
            let reason = pliant_render::Headless::new().err().map_or_else(
                || "the window system or the graphics driver refused it".to_owned(),
                |error| error.to_string(),
            );
            return Err(refused(reason));
        }
        let is_lost = application
            .borrow()
            .as_ref()
            .is_some_and(Application::has_lost_its_device);
        if !is_lost {
            return Ok(());
        }
    }
}

fn options(places: &AppDirectories) -> eframe::NativeOptions {
    let read = |path| Settings::read(path).0;
    let remembered = places.settings.as_deref().map(read).unwrap_or_default();
    eframe::NativeOptions {
        viewport: ViewportBuilder::default()
            .with_title("Pliant")
            .with_app_id("pliant")
            .with_inner_size(remembered.window_size.unwrap_or([1280.0, 800.0]))
            .with_maximized(remembered.maximised)
            .with_min_inner_size(vec2(640.0, 400.0))
            .with_drag_and_drop(true),
        renderer: eframe::Renderer::Wgpu,
        wgpu_options: WgpuConfiguration {
            wgpu_setup: setup(),
            ..WgpuConfiguration::default()
        },
        ..eframe::NativeOptions::default()
    }
}

/// A device with the adapter's own limits: large scans need large buffers.
fn setup() -> WgpuSetup {
    let mut setup = WgpuSetupCreateNew::without_display_handle();
    setup.power_preference = wgpu::PowerPreference::HighPerformance;
    setup.device_descriptor = Arc::new(pliant_render::device_descriptor);
    WgpuSetup::CreateNew(setup)
}

fn sentence(reason: &str) -> String {
    let reason = reason.replace(['\n', '\r'], " ");
    format!(
        "no window can be opened ({reason}): start it in a desktop session with a Vulkan, Metal or DirectX 12 driver, \
         or use `pliant apply`, which needs neither"
    )
}

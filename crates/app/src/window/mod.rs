//! The window: eframe around the editor. Panels show what the editor says and send it events; files, dialogs, threads
//! and the clock are here; egui meets the renderer in `viewport.rs` alone.

mod application;
mod brush_panel;
mod command_button;
mod dialog;
mod fault;
mod file_actions;
mod file_panel;
mod handles_panel;
mod hints;
mod history_panel;
mod icon;
mod input;
mod keys_window;
mod log;
mod message;
mod method_panel;
mod notes;
mod outbox;
mod palette;
mod panels;
mod places;
mod project_file;
mod recovery;
mod session;
mod settings;
mod status;
mod theme;
mod top_bar;
mod viewport;
mod workers;

use std::path::PathBuf;
use std::sync::Arc;

use eframe::egui::{ViewportBuilder, vec2};
use eframe::egui_wgpu::{WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew};

pub use application::Application;
pub use places::Places;
pub use session::{KeepOriginal, Source, original_name};

use crate::error::AppError;

/// What tells where a window can be opened, on systems with X11 or Wayland.
const DISPLAYS: [&str; 3] = ["WAYLAND_DISPLAY", "WAYLAND_SOCKET", "DISPLAY"];

/// Opens the window on a file, or on the built-in sample, and returns when it is closed.
///
/// # Errors
/// Where no window or no graphics device can be had.
pub fn run(file: Option<PathBuf>) -> Result<(), AppError> {
    if cfg!(all(unix, not(target_os = "macos"))) && DISPLAYS.iter().all(|name| std::env::var_os(name).is_none()) {
        return Err(AppError::System(format!(
            "there is no display to open a window on (none of {} is set): start it in a desktop session, or use \
             `pliant apply` and `pliant render`, which need none",
            DISPLAYS.join(", ")
        )));
    }
    let places = Places::of_person();
    if let Some(folder) = &places.recovery {
        fault::listen(folder.clone());
    }
    let source = file.map_or(Source::Sample, Source::File);
    let options = eframe::NativeOptions {
        viewport: ViewportBuilder::default()
            .with_title("Pliant")
            .with_app_id("pliant")
            .with_inner_size(vec2(1280.0, 800.0))
            .with_min_inner_size(vec2(640.0, 400.0))
            .with_drag_and_drop(true),
        renderer: eframe::Renderer::Wgpu,
        wgpu_options: WgpuConfiguration {
            wgpu_setup: setup(),
            ..WgpuConfiguration::default()
        },
        ..eframe::NativeOptions::default()
    };
    eframe::run_native(
        "Pliant",
        options,
        Box::new(move |context| Ok(Box::new(Application::with_places(context, source, &places)?))),
    )
    .map_err(|error| AppError::System(sentence(&error)))
}

/// A device with the adapter's own limits: large scans need large buffers.
fn setup() -> WgpuSetup {
    let mut setup = WgpuSetupCreateNew::without_display_handle();
    setup.power_preference = wgpu::PowerPreference::HighPerformance;
    setup.device_descriptor = Arc::new(pliant_render::device_descriptor);
    WgpuSetup::CreateNew(setup)
}

fn sentence(error: &eframe::Error) -> String {
    let reason = error.to_string().replace(['\n', '\r'], " ");
    format!(
        "no window can be opened ({reason}): start it in a desktop session with a Vulkan, Metal or DirectX 12 driver, \
         or use `pliant apply`, which needs neither"
    )
}

//! The exchange with the window system: the title, the size, and whether the window fills the screen.

use std::time::Instant;

use eframe::egui;

use super::application::{Application, REST};

impl Application {
    /// Fills the screen after the window appears: X11's window managers ignore earlier requests.
    pub(super) fn fill_screen(&mut self, context: &egui::Context) {
        if !self.layout.is_to_fill_screen {
            return;
        }
        self.last_change = Instant::now();
        if context.cumulative_pass_nr() < 3 {
            context.request_repaint();
            return;
        }
        self.layout.is_to_fill_screen = false;
        if context.input(|input| input.viewport().maximized) != Some(true) {
            context.send_viewport_cmd(egui::ViewportCommand::Maximized(true));
        }
    }

    /// Notes the window's size, and whether it fills the screen, when nobody is resizing it.
    pub(super) fn remember_size(&mut self, context: &egui::Context) {
        if self.last_change.elapsed() < REST {
            return;
        }
        let (size, maximised) = context.input(|input| {
            let viewport = input.viewport();
            let fills_screen = viewport.maximized == Some(true) || viewport.fullscreen == Some(true);
            let own = viewport.inner_rect.filter(|_| !fills_screen).map(|rect| rect.size());
            (own, viewport.maximized)
        });
        if let Some(maximised) = maximised.filter(|&maximised| maximised != self.settings.get().maximised) {
            self.settings.change(|settings| settings.maximised = maximised);
        }
        // The size in points at the system's scale, not the person's.
        let Some(size) = size.map(|size| size * context.zoom_factor()) else {
            return;
        };
        let known = self.settings.get().window_size;
        if known.is_none_or(|known| (size - egui::Vec2::from(known)).length() > 1.0) {
            self.settings
                .change(|settings| settings.window_size = Some(size.into()));
        }
    }

    /// Puts the name of the open file, or the waiting question, in the window's title.
    pub(super) fn entitle(&mut self, context: &egui::Context) {
        let about = match (&self.dialogs.question, &self.session.open) {
            (Some(question), _) => question.title().to_owned(),
            (None, Some(open)) => open.name(),
            (None, None) if self.session.doing().is_some() => "opening".to_owned(),
            (None, None) => "nothing is open".to_owned(),
        };
        let title = format!("Pliant — {about}");
        if self.layout.title != title {
            context.send_viewport_cmd(egui::ViewportCommand::Title(title.clone()));
            self.layout.title = title;
        }
    }
}

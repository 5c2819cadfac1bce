//! The open file in other programs and in the list of recent files: its folder, web pages, its small picture.

use std::path::Path;

use eframe::egui;

use crate::window::application::{Application, REST};
use crate::window::files::desktop::Elsewhere;
use crate::window::files::small_pictures;
use crate::window::threads::message::Message;

impl Application {
    /// Shows the open file in its folder.
    pub(in crate::window) fn show_in_folder(&mut self) {
        let open = self.session.open.as_ref();
        match open.and_then(|open| open.path.as_deref().or(open.project.as_deref())) {
            Some(path) => self.show_elsewhere(Elsewhere::File(path.to_owned())),
            None => self.fail("the sample is in no folder yet: save it first".to_owned()),
        }
    }

    /// Opens a page in the browser.
    pub(in crate::window) fn show_page(&self, address: &str) {
        self.show_elsewhere(Elsewhere::Page(address.to_owned()));
    }

    /// Asks another program to show something, off the window's thread.
    pub(in crate::window) fn show_elsewhere(&self, elsewhere: Elsewhere) {
        let desktop = self.desktop.clone();
        self.workers.spawn(
            "desktop",
            move || Message::Shown(desktop.show(&elsewhere)),
            |sentence| Message::Shown(Err(sentence)),
        );
    }

    /// Reads the small pictures of the recent files, off the window's thread.
    pub(in crate::window) fn read_recent_pictures(&self) {
        let Some(folder) = self.recent_pictures.folder().map(Path::to_owned) else {
            return;
        };
        let recent = self.settings.get().recent.clone();
        self.workers.spawn(
            "recent pictures",
            move || Message::RecentPictures(small_pictures::read(&folder, &recent)),
            |_| Message::RecentPictures(Vec::new()),
        );
    }

    /// Takes a small picture of the file that was opened or saved, once its shape rests on the screen.
    pub(in crate::window) fn take_recent_picture(&mut self, context: &egui::Context) {
        self.recent_pictures.upload(context);
        if !self.recent_pictures.is_wanted() || !self.is_settled() {
            return;
        }
        if let Some(wait) = REST.checked_sub(self.last_change.elapsed()) {
            return context.request_repaint_after(wait);
        }
        // A picture that can't be drawn now is taken when the view is next drawn.
        let Ok(Some(picture)) = self.viewport.small_picture(&self.editor, small_pictures::SIZE_PX) else {
            return;
        };
        let (Some(file), Some(folder)) = (self.recent_pictures.take_wanted(), self.recent_pictures.folder()) else {
            return;
        };
        let (folder, recent) = (folder.to_owned(), self.settings.get().recent.clone());
        self.workers.spawn(
            "recent pictures",
            move || {
                let copy = picture.clone();
                Message::RecentPictures(match small_pictures::keep(&folder, &file, copy, &recent) {
                    Ok(()) => vec![(file, picture)],
                    // The list of recent files has its names.
                    Err(_) => Vec::new(),
                })
            },
            |_| Message::RecentPictures(Vec::new()),
        );
    }
}

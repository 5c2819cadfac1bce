//! The places of the window's parts, and which of them are shown.

use eframe::egui;

/// The layout of the last frame, and the window's title and size.
pub struct Layout {
    /// True if this is a person's window, which shows the first steps.
    pub shows_hints: bool,
    /// True if the panel beside the view is hidden.
    pub is_panel_hidden: bool,
    /// True if the window is still to fill the screen, as it did last time.
    pub is_to_fill_screen: bool,
    /// The places of the window's content, its bars and its panel.
    pub bars: [egui::Rect; 7],
    /// The place of the view.
    pub view_rect: egui::Rect,
    /// The window's title.
    pub title: String,
}

impl Layout {
    /// Before the first frame.
    pub fn new(shows_hints: bool, is_to_fill_screen: bool) -> Self {
        Self {
            shows_hints,
            is_panel_hidden: false,
            is_to_fill_screen,
            bars: [egui::Rect::NOTHING; 7],
            view_rect: egui::Rect::ZERO,
            title: String::new(),
        }
    }
}

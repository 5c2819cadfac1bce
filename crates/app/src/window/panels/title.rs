//! Titles.

use eframe::egui::RichText;

/// The title of a part of the panel.
pub(super) fn title(name: &str) -> RichText {
    RichText::new(name).strong().size(14.0)
}

//! A row of the list: the icon, the name, the size and the date of an entry.

use std::time::SystemTime;

use chrono::{DateTime, Local};
use eframe::egui::{self, Align2, Rect, Role, Sense, TextStyle, WidgetInfo, WidgetText, vec2};

use crate::window::files::listing::Entry;
use crate::window::widgets::icon::{self, Glyph};

/// The width of the column of sizes.
pub const SIZE_WIDTH: f32 = 76.0;
/// The width of the column of dates.
pub const DATE_WIDTH: f32 = 124.0;
/// The least width that is left for the names.
pub const ICON_WIDTH: f32 = 26.0;
/// The space at both ends of a row.
pub const MARGIN: f32 = 6.0;

/// Shows an entry on a whole row of this height.
pub fn show(ui: &mut egui::Ui, entry: &Entry, is_chosen: bool, height: f32) -> egui::Response {
    // Arrows go from row to row; a thousand stops for Tab would be useless.
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::CLICK);
    response.widget_info(|| WidgetInfo::selected(Role::ListBoxOption, true, is_chosen, &entry.name));
    if !ui.is_rect_visible(rect) {
        return response;
    }
    let visuals = ui.style().interact_selectable(&response, is_chosen);
    if is_chosen || response.hovered() {
        let painter = ui.painter();
        painter.rect_filled(rect, visuals.corner_radius, visuals.weak_bg_fill);
    }
    let text = visuals.text_color();
    let detail = if is_chosen {
        text
    } else {
        ui.visuals().weak_text_color()
    };
    let glyph = if entry.is_folder { Glyph::Folder } else { Glyph::Box };
    let inner = rect.shrink2(vec2(MARGIN, 0.0));
    let painter = ui.painter();
    painter.text(
        inner.left_center(),
        Align2::LEFT_CENTER,
        glyph.unicode(),
        icon::font(15.0),
        text,
    );

    let font = TextStyle::Body.resolve(ui.style());
    let date = entry.modified.and_then(date).unwrap_or_default();
    painter.text(inner.right_center(), Align2::RIGHT_CENTER, date, font.clone(), detail);
    let size_end = inner.right_center() - vec2(DATE_WIDTH, 0.0);
    if !entry.is_folder {
        painter.text(size_end, Align2::RIGHT_CENTER, size(entry.bytes), font, detail);
    }
    let names = Rect::from_min_max(
        inner.min + vec2(ICON_WIDTH, 0.0),
        size_end - vec2(SIZE_WIDTH, -0.5 * height),
    );
    let name = WidgetText::from(&entry.name);
    let name = name.into_galley(ui, Some(egui::TextWrapMode::Truncate), names.width(), TextStyle::Body);
    let is_cut = name.elided;
    let at = names.left_center() - vec2(0.0, 0.5 * name.size().y);
    ui.painter().galley(at, name, text);
    if is_cut {
        response.on_hover_text(&entry.name)
    } else {
        response
    }
}

/// A file's size in three digits, with powers of 1000, as disks are sold.
pub fn size(bytes: u64) -> String {
    let units = ["kB", "MB", "GB", "TB", "PB", "EB"];
    let mut size = bytes as f64 / 1000.0;
    if bytes < 1000 {
        return format!("{bytes} B");
    }
    let mut unit = 0;
    // A value that rounds to 1000 is 1.0 of the next unit.
    while size >= 999.5 && unit + 1 < units.len() {
        size /= 1000.0;
        unit += 1;
    }
    let digits = usize::from(size < 9.95);
    format!("{size:.digits$} {}", units[unit])
}

/// A date and time in the person's time zone; empty if no calendar has it.
fn date(time: SystemTime) -> Option<String> {
    let seconds = i64::try_from(time.duration_since(SystemTime::UNIX_EPOCH).ok()?.as_secs()).ok()?;
    // Four digits of a year.
    let time = DateTime::from_timestamp(seconds, 0).filter(|_| seconds < 253_400_000_000)?;
    Some(time.with_timezone(&Local).format("%Y-%m-%d %H:%M").to_string())
}

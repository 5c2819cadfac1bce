//! The folder browser on the screen, and the keys that it takes.

use std::ops::Range;

use eframe::egui::text::{CCursor, CCursorRange};
use eframe::egui::{
    self, Button, Id, Key, Label, Modifiers, Response, RichText, Role, ScrollArea, TextEdit, WidgetInfo, pos2, vec2,
};
use pliant_editor::thousands;
use pliant_engine::files::shown;
use pliant_io::Format;

use super::browser::{Asked, Contents, FolderBrowser};
use super::row::{self, DATE_WIDTH, ICON_WIDTH, MARGIN, SIZE_WIDTH};
use crate::window::bars::status;
use crate::window::files::listing::Column;
use crate::window::widgets::default_button::default_button;
use crate::window::widgets::icon::{self, Glyph};
use crate::window::widgets::row_label::row_label;

/// The number of rows in a page.
const PAGE: isize = 10;
/// The width of the places beside the list.
const PLACES_WIDTH: f32 = 132.0;
/// The number of seconds after which a folder is called slow.
const SLOW: f64 = 0.5;
/// The number of shown names that Tab may complete.
const TOLD: usize = 4;

/// Shows it under a title; true when the person cancels.
pub fn show(ui: &mut egui::Ui, title: &str, browser: &mut FolderBrowser) -> bool {
    let screen = ui.ctx().content_rect().size();
    ui.set_width((screen.x - 60.0).min(720.0));
    ui.heading(title);
    let ids = [ui.scope_id().with("path"), ui.scope_id().with("name")];
    let is_new = browser.take_is_new();
    keys(ui, browser, ids);
    // This comes before the fields: a field without the focus forgets its selection.
    let main = ids[usize::from(browser.asked() == Asked::ToSave)];
    if is_new || ui.memory(|memory| memory.focused().is_none()) {
        ui.memory_mut(|memory| memory.request_focus(main));
    }

    top(ui, browser, ids[0], is_new);
    let height = (screen.y - 250.0).clamp(60.0, 380.0);
    ui.horizontal_top(|ui| {
        ui.vertical(|ui| places(ui, browser, height));
        ui.vertical(|ui| {
            headers(ui, browser);
            list(ui, browser, height);
        });
    });
    line(ui, browser);
    if browser.asked() == Asked::ToSave {
        name(ui, browser, ids[1], is_new);
    }
    ui.add_space(4.0);
    buttons(ui, browser)
}

/// Takes the keys before the fields do: Enter and arrows, while only a field has the focus.
fn keys(ui: &mut egui::Ui, browser: &mut FolderBrowser, ids: [Id; 2]) {
    let is_pressed = |modifiers, key| ui.input_mut(|input| input.consume_key(modifiers, key));
    if is_pressed(Modifiers::ALT, Key::ArrowUp) {
        browser.go_up();
    }
    if is_pressed(Modifiers::ALT, Key::ArrowLeft) {
        browser.go_back();
    }
    if is_pressed(Modifiers::ALT, Key::ArrowRight) {
        browser.go_forward();
    }
    let focused = ui.memory(|memory| memory.focused());
    if focused.is_some_and(|id| !ids.contains(&id)) {
        return;
    }
    let is_pressed = |key| ui.input_mut(|input| input.consume_key(Modifiers::NONE, key));
    for (key, steps) in [
        (Key::ArrowDown, 1),
        (Key::ArrowUp, -1),
        (Key::PageDown, PAGE),
        (Key::PageUp, -PAGE),
    ] {
        if is_pressed(key) {
            browser.choose_next(steps);
        }
    }
    if is_pressed(Key::Enter) {
        browser.enter();
    }
    if focused == Some(ids[0])
        && let Some(completed) = browser.completion()
        && is_pressed(Key::Tab)
    {
        browser.set_path(&completed);
    }
}

/// The buttons between folders, and the path.
fn top(ui: &mut egui::Ui, browser: &mut FolderBrowser, id: Id, is_new: bool) {
    ui.horizontal(|ui| {
        let [has_back, has_forward] = browser.has_ways();
        if way(ui, Glyph::ArrowLeft, "Back", "Alt+Left", has_back) {
            browser.go_back();
        }
        if way(ui, Glyph::ArrowRight, "Forward", "Alt+Right", has_forward) {
            browser.go_forward();
        }
        if way(ui, Glyph::ArrowUp, "Up", "Alt+Up", browser.has_above()) {
            browser.go_up();
        }
        // Tab goes on to the next widget if it has nothing to complete.
        let takes_tab = browser.completion().is_some();
        let selected = is_new.then(|| {
            let end = browser.path().chars().count();
            end..end
        });
        let (field, typed) = field(ui, id, "Path", browser.path(), selected, takes_tab);
        if field.changed() {
            browser.set_path(&typed);
        }
        field.on_hover_text("Type to filter the list; Tab completes. ~ is your home folder.");
    });
}

fn way(ui: &mut egui::Ui, glyph: Glyph, name: &str, key: &str, is_enabled: bool) -> bool {
    let button = ui.add_enabled(is_enabled, Button::new(icon::text(glyph, 15.0)));
    button.widget_info(|| WidgetInfo::labeled(Role::Button, is_enabled, name));
    button.on_hover_text(format!("{name} ({key})")).clicked()
}

/// A field as wide as there is room, with this part of its text selected; without one, its end is visible if the
/// program has changed it.
fn field(
    ui: &mut egui::Ui,
    id: Id,
    name: &str,
    text: &str,
    selected: Option<Range<usize>>,
    takes_tab: bool,
) -> (Response, String) {
    let known: Option<String> = ui.data(|data| data.get_temp(id));
    let end = text.chars().count();
    let is_changed = known.as_deref().is_some_and(|known| known != text);
    if let Some(selected) = selected.or(is_changed.then_some(end..end)) {
        let mut state = TextEdit::load_state(ui.ctx(), id).unwrap_or_default();
        let range = CCursorRange::two(CCursor::new(selected.start), CCursor::new(selected.end));
        state.cursor.set_char_range(Some(range));
        state.store(ui.ctx(), id);
    }
    let mut typed = text.to_owned();
    let field = TextEdit::singleline(&mut typed)
        .id(id)
        .lock_focus(takes_tab)
        .desired_width(f32::INFINITY);
    let field = ui.add(field);
    field.widget_info(|| WidgetInfo::labeled(Role::TextInput, true, name));
    ui.data_mut(|data| data.insert_temp(id, typed.clone()));
    (field, typed)
}

fn places(ui: &mut egui::Ui, browser: &mut FolderBrowser, height: f32) {
    ui.set_width(PLACES_WIDTH);
    let mut chosen = None;
    ui.label(RichText::new("Places").weak());
    ScrollArea::vertical()
        .id_salt("places")
        .max_height(height)
        .auto_shrink(false)
        .show(ui, |ui| {
            for place in browser.places() {
                let is_here = place.folder == browser.folder();
                let button = Button::selectable(is_here, &place.name)
                    .truncate()
                    .min_size(vec2(ui.available_width(), 0.0));
                if ui.add(button).on_hover_text(shown(&place.folder)).clicked() {
                    chosen = Some(place.folder.clone());
                }
            }
        });
    if let Some(folder) = chosen {
        browser.go(folder);
    }
}

/// The columns' names; a click sorts.
fn headers(ui: &mut egui::Ui, browser: &mut FolderBrowser) {
    let bar = ui.spacing().scroll.allocated_width();
    let names = ui.available_width() - SIZE_WIDTH - DATE_WIDTH - bar - MARGIN;
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 0.0;
        ui.spacing_mut().button_padding.x = 0.0;
        for (column, name, width) in [
            (Column::Name, "Name", names),
            (Column::Size, "Size", SIZE_WIDTH),
            (Column::Modified, "Modified", DATE_WIDTH),
        ] {
            let order = browser.order();
            let sign = match order.is_reversed {
                false => Glyph::ChevronUp,
                true => Glyph::ChevronDown,
            };
            let label = RichText::new(name).weak();
            let centre = egui::Align::Center;
            let (layout, start) = match column {
                Column::Name => (egui::Layout::left_to_right(centre), MARGIN + ICON_WIDTH),
                Column::Size | Column::Modified => (egui::Layout::right_to_left(centre), 0.0),
            };
            let size = vec2(width, ui.spacing().interact_size.y);
            ui.allocate_ui_with_layout(size, layout, |ui| {
                ui.set_min_size(size);
                ui.add_space(start);
                let button = if order.column == column {
                    Button::new((label, icon::text(sign, 12.0)))
                } else {
                    Button::new(label)
                };
                let button = ui.add(button.frame(false));
                let described = format!("Sort by {}", name.to_lowercase());
                button.widget_info(|| WidgetInfo::labeled(Role::Button, true, &described));
                if button.clicked() {
                    browser.sort(column);
                }
            });
        }
    });
}

fn list(ui: &mut egui::Ui, browser: &mut FolderBrowser, height: f32) {
    let slow_since = ui.scope_id().with("slow since");
    let folder = browser.folder();
    let sentence = match browser.contents() {
        Contents::Read(_) if browser.shown().is_empty() => Some("This folder has no such files.".to_owned()),
        Contents::Read(_) => None,
        Contents::Refused(sentence) => Some(sentence.clone()),
        Contents::Awaited => {
            let now = ui.input(|input| input.time);
            let since = ui.data_mut(|data| *data.get_temp_mut_or(slow_since.with(folder), now));
            ui.ctx().request_repaint_after_secs(SLOW as f32);
            let is_slow = now - since > SLOW;
            is_slow.then(|| format!("{} responds slowly: wait, or choose another folder.", shown(folder)))
        }
    };
    if *browser.contents() != Contents::Awaited {
        ui.data_mut(|data| data.remove::<f64>(slow_since.with(folder)));
    }
    let row_height = ui.spacing().interact_size.y + 2.0;
    let (count, chosen) = (browser.shown().len(), browser.chosen());
    let moved_to = ui.scope_id().with("chosen");
    let was_chosen: Option<Option<usize>> = ui.data(|data| data.get_temp(moved_to));
    ui.data_mut(|data| data.insert_temp(moved_to, chosen));
    let mut clicked = None;
    ui.spacing_mut().item_spacing.y = 0.0;
    ScrollArea::vertical()
        .id_salt(("list", folder))
        .max_height(height)
        .auto_shrink(false)
        .show_rows(ui, row_height, count, |ui, range| {
            if let Some(sentence) = &sentence {
                let colour = match browser.contents() {
                    Contents::Refused(_) => status::failed(ui),
                    Contents::Read(_) | Contents::Awaited => ui.visuals().weak_text_color(),
                };
                ui.add(Label::new(RichText::new(sentence).color(colour)).wrap());
            }
            if let Some(place) = chosen.filter(|_| was_chosen != Some(chosen)) {
                let top = ui.max_rect().top() + row_height * (place as f32 - range.start as f32);
                let at = pos2(ui.max_rect().left(), top);
                ui.scroll_to_rect(egui::Rect::from_min_size(at, vec2(1.0, row_height)), None);
            }
            let entries = browser.shown();
            for place in range {
                let Some(entry) = entries.get(place) else { break };
                let row = row::show(ui, entry, chosen == Some(place), row_height);
                if row.clicked() {
                    clicked = Some((place, row.double_clicked()));
                }
            }
        });
    if let Some((place, is_double)) = clicked {
        browser.choose(place);
        if is_double {
            browser.enter();
        }
    }
}

/// The result of Enter, the completions of Tab, or the number of entries.
fn line(ui: &mut egui::Ui, browser: &FolderBrowser) {
    let candidates = browser.candidates();
    let text = match (browser.problem(), browser.contents()) {
        (Some(problem), _) => RichText::new(problem).color(status::failed(ui)),
        (None, Contents::Read(_)) if !candidates.is_empty() => {
            let names: Vec<&str> = candidates.iter().take(TOLD).map(|entry| &*entry.name).collect();
            let more = candidates.len().saturating_sub(TOLD);
            let more = if more > 0 {
                format!(" and {} more", thousands(more))
            } else {
                String::new()
            };
            RichText::new(format!("Tab completes: {}{more}", names.join(", "))).weak()
        }
        (None, Contents::Read(_)) => {
            let shown = browser.shown();
            let folders = shown.iter().filter(|entry| entry.is_folder).count();
            let endings = browser.endings().join(", .");
            let kind = if endings.is_empty() {
                String::new()
            } else {
                format!(" (.{endings})")
            };
            let [folders, files] = [(folders, "folder"), (shown.len() - folders, "file")].map(counted);
            RichText::new(format!("{folders}, {files}{kind}")).weak()
        }
        (None, _) => RichText::new(" "),
    };
    ui.add(Label::new(text.small()).truncate());
}

fn counted((count, what): (usize, &str)) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{} {what}{plural}", thousands(count))
}

fn name(ui: &mut egui::Ui, browser: &mut FolderBrowser, id: Id, is_new: bool) {
    ui.horizontal(|ui| {
        let label = row_label(ui, "Name");
        // Typing replaces the name and leaves its extension.
        let selected = is_new.then(|| {
            let stem = browser.name().rsplit_once('.').map_or(browser.name(), |(stem, _)| stem);
            0..stem.chars().count()
        });
        let (layout, size) = (
            egui::Layout::right_to_left(egui::Align::Center),
            vec2(ui.available_width(), ui.spacing().interact_size.y),
        );
        ui.allocate_ui_with_layout(size, layout, |ui| {
            format(ui, browser);
            let (field, typed) = field(ui, id, "Name", browser.name(), selected, false);
            if field.changed() {
                browser.type_name(typed);
            }
            field.labelled_by(label.id);
        });
    });
}

/// The formats of the saved file, if there are several.
fn format(ui: &mut egui::Ui, browser: &mut FolderBrowser) {
    if browser.endings().len() < 2 {
        return;
    }
    let present = browser.format();
    let mut chosen = present;
    let list = egui::ComboBox::from_id_salt("format")
        .width(96.0)
        .selected_text(present.map_or_else(|| "unknown".to_owned(), format_name))
        .show_ui(ui, |ui| {
            for &ending in browser.endings() {
                ui.selectable_value(&mut chosen, Some(ending), format_name(ending));
            }
        });
    list.response
        .widget_info(|| WidgetInfo::labeled(Role::ComboBox, true, "Format"));
    if let Some(ending) = chosen.filter(|_| chosen != present) {
        browser.set_format(ending);
    }
}

/// The name of the format with this extension.
fn format_name(ending: &str) -> String {
    match Format::of_name(&format!("model.{ending}")) {
        Ok(format) => format!("{format} (.{ending})"),
        Err(_) => format!("{} (.{ending})", ending.to_uppercase()),
    }
}

/// True when the person cancels.
fn buttons(ui: &mut egui::Ui, browser: &mut FolderBrowser) -> bool {
    ui.horizontal(|ui| {
        let verb = match browser.asked() {
            Asked::ToOpen => "Open",
            Asked::ToSave => "Save",
        };
        let button = default_button(ui, verb);
        if ui.add_enabled(browser.can_enter(), button).clicked() {
            browser.enter();
        }
        ui.button("Cancel").clicked()
    })
    .inner
}

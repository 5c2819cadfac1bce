//! A name that a double click renames.

use eframe::egui::{self, Response, TextEdit, Ui};

/// Shows the name of the thing called `what` ("the example") at a place of its list, or the field in which it is being
/// typed. Returns the label, and the new name once it is typed.
pub fn name_label(ui: &mut Ui, what: &str, place: usize, name: &str, is_chosen: bool) -> (Response, Option<String>) {
    let editing = egui::Id::unique(("renamed", what));
    let typed: Option<(usize, String)> = ui.data(|data| data.get_temp(editing));
    if let Some((own, mut text)) = typed
        && own == place
    {
        let field = ui.add(TextEdit::singleline(&mut text).desired_width(110.0));
        field.widget_info(|| egui::WidgetInfo::labeled(egui::Role::TextInput, true, format!("Name of {what}")));
        if !field.lost_focus() {
            field.request_focus();
            ui.data_mut(|data| data.insert_temp(editing, (place, text)));
            return (field, None);
        }
        let is_meant = !ui.input(|input| input.key_pressed(egui::Key::Escape)) && !text.trim().is_empty();
        let renamed = (is_meant && text.trim() != name).then(|| text.trim().to_owned());
        ui.data_mut(|data| data.remove::<(usize, String)>(editing));
        return (field, renamed);
    }
    let label = ui.add(egui::Button::selectable(is_chosen, name).truncate());
    if label.double_clicked() {
        ui.data_mut(|data| data.insert_temp(editing, (place, name.to_owned())));
    }
    (label, None)
}

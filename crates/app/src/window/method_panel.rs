//! The method and its options: widgets made of the editor's list, so that an option that is added there is shown here.

use eframe::egui::{self, ComboBox, DragValue, RichText};
use pliant_deform::Method;
use pliant_editor::{
    Command, Editor, MethodOption, OptionKind, method_options, method_title, option_value, when_to_use, with_option,
};
use serde_json::{Value, json};

use super::outbox::Outbox;

/// Shows the method and its options.
pub fn show(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    let method = editor.document().method();
    ui.horizontal(|ui| {
        let label = ui.label("Method");
        let list = ComboBox::from_id_salt("method")
            .selected_text(method_title(method.name()))
            .width(ui.available_width())
            .show_ui(ui, |ui| {
                for &name in Method::NAMES {
                    let chosen = method.name() == name;
                    let choice = ui
                        .selectable_label(chosen, method_title(name))
                        .on_hover_text(when_to_use(name));
                    if choice.clicked()
                        && !chosen
                        && let Some(method) = Method::from_name(name)
                    {
                        commands.push(Command::SetMethod(method));
                    }
                }
            });
        list.response.labelled_by(label.id);
    });
    ui.label(RichText::new(when_to_use(method.name())).weak().small());
    let options = method_options(method.name());
    if options.is_empty() {
        return;
    }
    egui::CollapsingHeader::new("Options")
        .id_salt("options")
        .show(ui, |ui| {
            egui::Grid::new("method options").num_columns(2).show(ui, |ui| {
                for option in options {
                    row(ui, method, option, commands);
                    ui.end_row();
                }
            });
            let default = Method::from_name(method.name()).filter(|default| default != method);
            let back = ui.add_enabled(default.is_some(), egui::Button::new("Defaults"));
            if let (true, Some(default)) = (back.clicked(), default) {
                commands.push(Command::SetMethod(default));
            }
        });
}

/// An option's name and its widget. What the method refuses (nothing resists both bending and stretching, say) is not
/// sent.
fn row(ui: &mut egui::Ui, method: &Method, option: &MethodOption, commands: &mut Outbox) {
    let name = option.name.replace('_', " ");
    let label = ui.label(title(&name)).on_hover_text(option.says);
    let value = option_value(method, option);
    let set = |value: Value| {
        let method = with_option(method, option.name, value).unwrap_or_else(|_| method.clone());
        Command::SetMethod(method)
    };
    let widget = match option.takes {
        OptionKind::Number { range, unit, .. } => {
            let mut number = value.as_f64().unwrap_or(range[0]);
            // Small numbers go by their own size, so that one drag reaches from 1e-12 to 0.1.
            let speed = (number.abs() * 0.02).max((range[1] - range[0]).min(1.0) * 1e-3);
            let field = DragValue::new(&mut number)
                .range(range[0]..=range[1])
                .speed(speed)
                .custom_formatter(|number, _| short(number))
                .suffix(if unit.is_empty() {
                    String::new()
                } else {
                    format!(" {unit}")
                })
                .update_while_editing(false);
            let field = ui.add(field);
            commands.adjust(&field, || set(json!(number)));
            field
        }
        OptionKind::Whole { range, .. } => {
            let mut number = value.as_u64().unwrap_or(range[0]);
            let speed = (number as f64 * 0.02).max(0.1);
            let field = DragValue::new(&mut number)
                .range(range[0]..=range[1])
                .speed(speed)
                .update_while_editing(false);
            let field = ui.add(field);
            commands.adjust(&field, || set(json!(number)));
            field
        }
        OptionKind::Numbered { choices, .. } => {
            let named = |number: &Value| {
                let found = choices.iter().find(|(choice, _)| Some(*choice) == number.as_u64());
                found.map_or_else(String::new, |(number, words)| format!("{number} · {words}"))
            };
            choose(
                ui,
                option.name,
                named(&value),
                choices,
                |(number, _)| named(&json!(number)),
                |(number, _)| {
                    commands.push(set(json!(number)));
                },
            )
        }
        OptionKind::Named { choices, .. } => {
            let present = value.as_str().unwrap_or_default().to_owned();
            choose(
                ui,
                option.name,
                present,
                choices,
                |name| (*name).to_owned(),
                |name| commands.push(set(json!(name))),
            )
        }
        OptionKind::Switch { .. } => {
            let mut on = value.as_bool().unwrap_or_default();
            let switch = ui.checkbox(&mut on, "");
            if switch.changed() {
                commands.push(set(json!(on)));
            }
            switch
        }
    };
    widget.labelled_by(label.id).on_hover_text(option.says);
}

/// A list to choose from.
fn choose<T>(
    ui: &mut egui::Ui,
    id: &str,
    present: String,
    choices: &[T],
    name: impl Fn(&T) -> String,
    mut chosen: impl FnMut(&T),
) -> egui::Response {
    ComboBox::from_id_salt(id)
        .selected_text(&present)
        .width(ui.available_width().min(150.0))
        .show_ui(ui, |ui| {
            for choice in choices {
                let name = name(choice);
                if ui.selectable_label(name == present, &name).clicked() && name != present {
                    chosen(choice);
                }
            }
        })
        .response
}

/// With a capital letter.
fn title(name: &str) -> String {
    let mut characters = name.chars();
    characters
        .next()
        .map_or_else(String::new, |first| first.to_uppercase().chain(characters).collect())
}

/// A number as short as it can be told apart at a glance.
fn short(number: f64) -> String {
    if number != 0.0 && !(1e-3..1e5).contains(&number.abs()) {
        format!("{number:.3e}").replace(".000e", "e")
    } else {
        let text = format!("{number:.4}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    }
}

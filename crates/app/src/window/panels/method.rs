//! The method and its options: the widgets are made from the methods' declarations, so that every declared option is
//! shown.

use eframe::egui::{self, Atom, Button, ComboBox, RichText};
use pliant_deform::{AttachmentKind, METHODS, Method, OptionDeclaration, OptionKind, OptionValue};
use pliant_editor::{Command, Editor};

use super::{examples, material, method_picture};
use crate::window::input::file_command::FileCommand;
use crate::window::widgets::command_button::{command_button, icon_choice};
use crate::window::widgets::icon::Glyph;
use crate::window::widgets::number_field::{dragged, number_field};
use crate::window::widgets::outbox::Outbox;
use crate::window::widgets::row_label::row_label;

/// Shows the method and its one slider.
pub fn show(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    let method = editor.document().method();
    let declaration = method.declaration();
    ui.horizontal(|ui| {
        let label = row_label(ui, "Method");
        let compared = editor.comparison().is_some();
        let width = ui.available_width() - COMPARE;
        choose_method(ui, editor, width, commands).labelled_by(label.id);
        if icon_choice(ui, editor, &Command::CompareMethods, compared, Glyph::LayoutGrid, None) {
            commands.push(Command::CompareMethods);
        }
    });
    ui.label(RichText::new(declaration.explanation()).weak().small());
    material::show(ui, editor, commands);
}

/// Shows the method's options and attachments; `morph_targets` are the names of the file's own.
pub fn show_options(ui: &mut egui::Ui, editor: &Editor, morph_targets: &[String], commands: &mut Outbox) {
    examples::show(ui, editor, morph_targets, commands);
    control_points(ui, editor, commands);
    options(ui, editor, commands);
}

/// The room for the button that compares methods, in points.
const COMPARE: f32 = 44.0;

/// The method's options, folded, and separately those for experts.
fn options(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    let method = editor.document().method();
    let declared = method.declaration();
    let first_choice = (declared.first_choice)();
    for (title, is_advanced) in [("Options", false), ("Advanced", true)] {
        let mut own = declared
            .options
            .iter()
            .filter(|option| option.is_advanced == is_advanced)
            .peekable();
        if own.peek().is_none() {
            continue;
        }
        let header = egui::CollapsingHeader::new(title).id_salt(title);
        header.default_open(!is_advanced).show(ui, |ui| {
            egui::Grid::new((title, "of the method")).num_columns(2).show(ui, |ui| {
                for option in own {
                    row(ui, method, option, commands);
                    ui.end_row();
                }
            });
            let back = ui.add_enabled(first_choice != *method, Button::new("Defaults"));
            if back
                .on_hover_text("Resets all options of the method, including the advanced ones.")
                .clicked()
            {
                commands.push(Command::SetMethod(first_choice.clone()));
            }
        });
    }
}

/// The method's present cage or lattice, and the commands for it.
fn control_points(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    let declaration = editor.document().method().declaration();
    let mut attachments = declaration.attachments.iter();
    let Some(declared) = attachments.find(|own| own.kind != AttachmentKind::Shapes) else {
        return;
    };
    let title = title(declared.title);
    let sentence = match editor.view().control_points {
        None => format!("{title}: not made yet"),
        Some(points) => {
            let whose = if points.is_own {
                "your own"
            } else {
                "made by the method"
            };
            format!(
                "{title}: {} points, {} selected, {whose}",
                points.count, points.selected
            )
        }
    };
    ui.label(sentence).on_hover_text(
        "The Select tool shows them: click a point to select it, Shift-click to add one, and select many with Ctrl and a \
         drag, a box or a lasso. Move them with the gizmo, G, R or S.",
    );
    ui.horizontal_wrapped(|ui| {
        let make = ui.add_enabled(
            editor.is_enabled(&Command::MakeControls),
            Button::new(format!("Make {}", declared.title)),
        );
        let why = editor.unavailable_because(&Command::MakeControls);
        let make = make.on_hover_text(format!(
            "Replaces your own {} with a new one around the region.",
            declared.title
        ));
        if make
            .on_disabled_hover_text(why.as_deref().unwrap_or_default())
            .clicked()
        {
            commands.push(Command::MakeControls);
        }
        if FileCommand::LoadCage.unavailable_because(editor).is_none()
            && ui
                .button(FileCommand::LoadCage.name())
                .on_hover_text("Loads a closed mesh around the region from a file.")
                .clicked()
        {
            commands.push_file(FileCommand::LoadCage);
        }
        for command in [
            Command::ResetControls,
            Command::SelectControls,
            Command::DeselectControls,
        ] {
            if command_button(ui, editor, &command) {
                commands.push(command);
            }
        }
    });
}

/// A list of all methods.
fn choose_method(ui: &mut egui::Ui, editor: &Editor, width: f32, commands: &mut Outbox) -> egui::Response {
    let present = editor.document().method();
    let list = ComboBox::from_id_salt("method")
        .selected_text(present.declaration().title)
        .width(width)
        // As high as all methods together: nothing shows that a list scrolls.
        .height(640.0)
        .show_ui(ui, |ui| {
            // Pictures are already apart from each other.
            ui.spacing_mut().item_spacing.y = 1.0;
            ui.spacing_mut().button_padding.y = 1.0;
            for declaration in METHODS {
                let is_present = present.name() == declaration.name;
                let picture = Atom::paint(method_picture::SIZE, |ui: &egui::Ui, place| {
                    method_picture::paint(ui, place.rect, declaration.picture, place.fallback_text_color);
                });
                let paper = RichText::new(declaration.paper).weak().small();
                let button = Button::selectable(is_present, (picture, declaration.title)).right_text(paper);
                let command = Command::SetMethod((declaration.first_choice)());
                let why_not = editor.unavailable_because(&command).filter(|_| !is_present);
                let choice = ui.add_enabled(why_not.is_none(), button);
                let choice = choice.on_hover_text(declaration.explanation());
                let choice = choice.on_disabled_hover_text(why_not.as_deref().unwrap_or_default());
                if choice.clicked() && !is_present {
                    commands.push(command);
                }
            }
        });
    list.response
}

/// An option's name and its widget, which is disabled if the option has no effect.
fn row(ui: &mut egui::Ui, method: &Method, option: &OptionDeclaration, commands: &mut Outbox) {
    let default = (method.declaration().default)();
    let (Some(value), Some(default)) = (method.value(option.name), default.value(option.name)) else {
        return;
    };
    let idle = option.idle_because(|other| method.value(other));
    let says = [idle.clone(), Some(option.sentence(default))].into_iter().flatten();
    let says = says.collect::<Vec<_>>().join(" ");
    let label = row_label(ui, title(&option.name.replace('_', " "))).on_hover_text(&says);
    let set = |value: OptionValue| {
        let set = method.with([(option.name, value)]);
        Command::SetMethod(set.unwrap_or_else(|_| method.clone()))
    };
    let widget = ui.add_enabled_ui(idle.is_none(), |ui| widget(ui, option, value, set, commands));
    if let Some(widget) = widget.inner {
        let widget = widget.labelled_by(label.id).on_hover_text(&says);
        widget.on_disabled_hover_text(says);
    }
}

/// The widget of an option with the value `value`. A value that the method refuses (for example no resistance to both
/// bending and stretching) is not sent.
fn widget(
    ui: &mut egui::Ui,
    option: &OptionDeclaration,
    value: OptionValue,
    set: impl Fn(OptionValue) -> Command,
    commands: &mut Outbox,
) -> Option<egui::Response> {
    let widget = match (option.kind, value) {
        (OptionKind::Number { range, unit }, OptionValue::Number(mut number)) => {
            // Small numbers change in proportion to their size, so that one drag goes from 1e-12 to 0.1.
            let speed = (number.abs() * 0.02).max((range[1] - range[0]).min(1.0) * 1e-3);
            let suffix = if unit.is_empty() {
                String::new()
            } else {
                format!(" {unit}")
            };
            let field = number_field(ui, &mut number, |ui, number| {
                let field = dragged(ui, number, &[(unit, 1.0)])
                    .range(range[0]..=range[1])
                    .speed(speed);
                let field = field.custom_formatter(|number, _| short(number)).suffix(suffix);
                ui.add(field)
            });
            commands.adjust(&field, || set(OptionValue::Number(number)));
            field
        }
        (OptionKind::Whole { range }, OptionValue::Whole(mut number)) => {
            let speed = (f64::from(number) * 0.02).max(0.1);
            let field = number_field(ui, &mut number, |ui, number| {
                let field = dragged(ui, number, &[]).range(range[0]..=range[1]).speed(speed);
                ui.add(field)
            });
            commands.adjust(&field, || set(OptionValue::Whole(number)));
            field
        }
        (OptionKind::Numbered { choices }, _) => {
            let named: Vec<(String, OptionValue)> = choices
                .iter()
                .map(|(number, word)| (format!("{number} · {word}"), OptionValue::Whole(*number)))
                .collect();
            choose(ui, option.name, value, &named, |chosen| commands.push(set(chosen)))
        }
        (OptionKind::Named { choices }, _) => {
            let named: Vec<(String, OptionValue)> = choices
                .iter()
                .map(|name| ((*name).to_owned(), OptionValue::Name(name)))
                .collect();
            choose(ui, option.name, value, &named, |chosen| commands.push(set(chosen)))
        }
        (OptionKind::Switch, OptionValue::Switch(mut on)) => {
            let switch = ui.checkbox(&mut on, "");
            if switch.changed() {
                commands.push(set(OptionValue::Switch(on)));
            }
            switch
        }
        // A value is always of its option's kind.
        _ => return None,
    };
    Some(widget)
}

/// A list to choose from.
fn choose(
    ui: &mut egui::Ui,
    id: &str,
    present: OptionValue,
    choices: &[(String, OptionValue)],
    mut chosen: impl FnMut(OptionValue),
) -> egui::Response {
    let name = choices.iter().find(|(_, value)| *value == present);
    ComboBox::from_id_salt(id)
        .selected_text(name.map_or("", |(name, _)| name))
        .width(ui.available_width().min(150.0))
        .show_ui(ui, |ui| {
            for (name, value) in choices {
                if ui.selectable_label(*value == present, name).clicked() && *value != present {
                    chosen(*value);
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

/// A number, as short as it is still distinguishable.
fn short(number: f64) -> String {
    if number != 0.0 && !(1e-3..1e5).contains(&number.abs()) {
        format!("{number:.3e}").replace(".000e", "e")
    } else {
        let text = format!("{number:.4}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    }
}

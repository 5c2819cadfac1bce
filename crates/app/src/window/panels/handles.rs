//! The list of handles, and the selected one in numbers.

use eframe::egui::{self, Align, Color32, ComboBox, Layout, RichText, Sense};
use glam::DVec3;
use pliant_deform::{CONTINUITY_RANGE, ConstraintKind, METHODS};
use pliant_editor::{
    Command, Editor, HANDLE_COLOURS, Handle, HandleId, HandleTransform, PivotPlace, Reach, SOFT_RANGE, ToolMode,
};

use super::{bend, crease};
use crate::window::widgets::command_button::command_button;
use crate::window::widgets::icon::{Icon, toggle};
use crate::window::widgets::number_field::{DEGREES, LENGTHS, Unit, dragged, number_field};
use crate::window::widgets::outbox::Outbox;
use crate::window::widgets::row_label::row_label;

/// Shows the list and the selected handle's numbers.
pub fn show(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    let view = editor.view();
    if view.handles.is_empty() {
        let words = match view.tool {
            ToolMode::Pose => "Drag a limb: it becomes a handle.",
            _ => "Paint the part of the surface that you want to move.",
        };
        ui.label(RichText::new(words).weak());
    }
    for handle in view.handles {
        let is_selected = view.selected == Some(handle.id) || view.companions.contains(&handle.id);
        row(ui, handle, is_selected, commands);
    }
    if let Some(handle) = view.handles.iter().find(|handle| view.selected == Some(handle.id)) {
        ui.add_space(4.0);
        ui.add_enabled_ui(!handle.locked, |ui| numbers(ui, editor, handle, commands));
    }
    ui.add_space(4.0);
    ui.horizontal_wrapped(|ui| {
        for command in [Command::NewHandle, Command::ResetHandle, Command::DeleteHandle] {
            if command_button(ui, editor, &command) {
                commands.push(command);
            }
        }
        ui.menu_button("More", |ui| {
            for command in [
                Command::DuplicateHandle,
                Command::MakeTwin(0),
                Command::MakeTwin(1),
                Command::MakeTwin(2),
                Command::Untwin,
                Command::PinOrUnpin,
                Command::PickPivot,
                Command::Widen,
                Command::ResetRegion,
            ] {
                if command_button(ui, editor, &command) {
                    commands.push(command);
                    ui.close();
                }
            }
        });
    });
}

fn row(ui: &mut egui::Ui, handle: &Handle, is_selected: bool, commands: &mut Outbox) {
    ui.horizontal(|ui| {
        swatch(ui, handle, commands);
        name(ui, handle, is_selected, commands);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.spacing_mut().item_spacing.x = 2.0;
            let hover = "A locked handle can't be moved, painted or deleted.";
            if toggle(ui, Icon::Lock, handle.locked, &format!("Lock {}", handle.name), hover) {
                commands.push(Command::ToggleHandleLocked(handle.id));
            }
            let hover = "Shows or hides the handle's colour and gizmo.";
            if toggle(ui, Icon::Eye, handle.visible, &format!("Show {}", handle.name), hover) {
                commands.push(Command::ToggleHandleVisible(handle.id));
            }
            let badges = [
                ("soft", handle.soft.is_some()),
                ("free", handle.free_along.is_some()),
                ("twin", handle.twin.is_some()),
            ];
            let badges = badges.iter().filter(|(_, has)| *has).map(|(name, _)| *name);
            let badges = badges.collect::<Vec<_>>().join(", ");
            if !badges.is_empty() {
                ui.label(RichText::new(badges).weak().small());
            }
        });
    });
}

/// The handle's colour; a click offers others.
fn swatch(ui: &mut egui::Ui, handle: &Handle, commands: &mut Outbox) {
    let [red, green, blue, _] = handle.colour;
    let button = egui::Button::new("")
        .fill(Color32::from_rgb(red, green, blue))
        .min_size(egui::vec2(14.0, 14.0))
        .small();
    let (response, _) = egui::containers::menu::MenuButton::from_button(button).ui(ui, |ui| {
        ui.horizontal(|ui| {
            for colour in HANDLE_COLOURS {
                let [red, green, blue, _] = colour;
                let (rect, choice) = ui.allocate_exact_size(egui::vec2(18.0, 18.0), Sense::click());
                ui.painter().rect_filled(rect, 4.0, Color32::from_rgb(red, green, blue));
                if choice.clicked() {
                    commands.push(Command::SetHandleColour(handle.id, colour));
                    ui.close();
                }
            }
        });
    });
    let label = format!("Colour of {}", handle.name);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &label));
}

/// egui's id of the name that is being edited.
fn renamed_id() -> egui::Id {
    egui::Id::unique("renamed handle")
}

/// Turns the handle's name in the list into a field.
pub fn rename(context: &egui::Context, handle: &Handle) {
    let edited = (handle.id, handle.name.clone());
    context.data_mut(|data| data.insert_temp(renamed_id(), edited));
}

/// The name: a click selects it, with Ctrl in addition to others; a double click renames.
fn name(ui: &mut egui::Ui, handle: &Handle, is_selected: bool, commands: &mut Outbox) {
    let editing = renamed_id();
    let typed: Option<(HandleId, String)> = ui.data(|data| data.get_temp(editing));
    if let Some((id, mut text)) = typed
        && id == handle.id
    {
        let field = ui.add(egui::TextEdit::singleline(&mut text).desired_width(110.0));
        field.widget_info(|| egui::WidgetInfo::labeled(egui::Role::TextInput, true, "Name of the handle"));
        if field.lost_focus() {
            let is_meant = !ui.input(|input| input.key_pressed(egui::Key::Escape)) && !text.trim().is_empty();
            if is_meant && text.trim() != handle.name {
                commands.push(Command::RenameHandle(handle.id, text.trim().to_owned()));
            }
            ui.data_mut(|data| data.remove::<(HandleId, String)>(editing));
        } else {
            field.request_focus();
            ui.data_mut(|data| data.insert_temp(editing, (id, text)));
        }
        return;
    }
    let label = ui
        .selectable_label(is_selected, &handle.name)
        .on_hover_text("Click selects the handle, Ctrl-click selects several, double-click renames it.");
    if label.double_clicked() {
        rename(ui.ctx(), handle);
    } else if label.clicked() {
        commands.push(if ui.input(|input| input.modifiers.command) {
            Command::ToggleSelected(handle.id)
        } else {
            Command::SelectHandle(handle.id)
        });
    }
}

fn numbers(ui: &mut egui::Ui, editor: &Editor, handle: &Handle, commands: &mut Outbox) {
    egui::Grid::new("handle")
        .num_columns(2)
        .spacing([8.0, 4.0])
        .show(ui, |ui| {
            if let HandleTransform::Trs {
                translation,
                rotation,
                scale,
                pivot,
            } = handle.transform
            {
                let set = |translation, rotation, scale| {
                    let transform = HandleTransform::Trs {
                        translation,
                        rotation,
                        scale,
                        pivot,
                    };
                    Command::SetHandleTransform(handle.id, transform)
                };
                triple(ui, "Move", translation, 0.01, LENGTHS, commands, |moved| {
                    set(moved, rotation, scale)
                });
                triple(ui, "Turn", handle.turn_deg, 0.5, DEGREES, commands, |degrees| {
                    Command::SetTurn(handle.id, degrees)
                });
                triple(ui, "Scale", scale, 0.01, &[], commands, |scale| {
                    set(translation, rotation, scale)
                });
            }
            pivot(ui, handle, commands);
            reach(ui, editor, handle, commands);
            joint(ui, editor, handle, commands);
            softness(ui, handle, commands);
            ui.end_row();
            depth(ui, editor, handle, commands);
            parent(ui, editor, handle, commands);
            bend::show(ui, editor, commands);
            crease::show(ui, editor, commands);
        });
}

/// Three numbers in a row, for x, y and z.
fn triple(
    ui: &mut egui::Ui,
    label: &str,
    value: DVec3,
    speed: f64,
    units: &[Unit],
    commands: &mut Outbox,
    set: impl Fn(DVec3) -> Command,
) {
    let name = row_label(ui, label);
    let (suffix, decimals) = if units == DEGREES { ("°", 1) } else { ("", 3) };
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        ui.spacing_mut().interact_size.x = 54.0;
        for axis in 0..3 {
            let mut changed = value;
            let field = number_field(ui, &mut changed[axis], |ui, value| {
                let field = dragged(ui, value, units)
                    .speed(speed)
                    .max_decimals(decimals)
                    .suffix(suffix);
                let field = field.custom_formatter(without_minus_zero);
                ui.add(field)
            });
            let field = field.labelled_by(name.id).on_hover_text(["x", "y", "z"][axis]);
            commands.adjust(&field, || set(changed));
        }
    });
    ui.end_row();
}

/// As egui writes it, but "0.0" for negative values that round to zero.
fn without_minus_zero(value: f64, decimals: std::ops::RangeInclusive<usize>) -> String {
    let text = egui::emath::format_with_decimals_in_range(value, decimals);
    match text.strip_prefix('-') {
        Some(digits) if digits.chars().all(|digit| matches!(digit, '0' | '.')) => digits.to_owned(),
        _ => text,
    }
}

fn pivot(ui: &mut egui::Ui, handle: &Handle, commands: &mut Outbox) {
    let name = |place| match place {
        PivotPlace::Centroid => "middle",
        PivotPlace::Border => "border",
        PivotPlace::Picked => "picked",
    };
    let label = row_label(ui, "Pivot")
        .on_hover_text("The handle turns about this point. Moving the point does not move the surface.");
    ui.horizontal(|ui| {
        let list = ComboBox::from_id_salt("pivot")
            .selected_text(name(handle.pivot_place))
            .width(74.0)
            .show_ui(ui, |ui| {
                for (place, hover) in [
                    (PivotPlace::Centroid, "Puts the pivot at the middle of the handle."),
                    (
                        PivotPlace::Border,
                        "Puts the pivot at the middle of the handle's border, like an arm's shoulder.",
                    ),
                ] {
                    let chosen = handle.pivot_place == place;
                    if ui.selectable_label(chosen, name(place)).on_hover_text(hover).clicked() && !chosen {
                        commands.push(Command::SetPivotPlace(handle.id, place));
                    }
                }
            });
        list.response.labelled_by(label.id);
        if ui
            .button("Pick")
            .on_hover_text("Puts the pivot where you click on the surface.")
            .clicked()
        {
            commands.push(Command::PickPivot);
        }
    });
    ui.end_row();
}

fn reach(ui: &mut egui::Ui, editor: &Editor, handle: &Handle, commands: &mut Outbox) {
    let label = row_label(ui, "Reach");
    let found = editor.reach_length(handle.id).unwrap_or_default();
    let (mut value, suffix, units, most, make): (f64, _, &[Unit], _, fn(f64) -> Reach) = match handle.reach {
        Reach::Found => (found, " (found)", LENGTHS, f64::MAX, Reach::Bounded),
        Reach::Bounded(length) => (length, "", LENGTHS, f64::MAX, Reach::Bounded),
        Reach::Feature => (found, " (feature)", LENGTHS, f64::MAX, Reach::Creased),
        Reach::Creased(length) => (length, "", LENGTHS, f64::MAX, Reach::Creased),
        Reach::Part => (found, " (part)", LENGTHS, f64::MAX, Reach::Length),
        Reach::Radii(radii) => (radii, " radii", &[("radii", 1.0)], 50.0, Reach::Radii),
        Reach::Length(length) => (length, "", LENGTHS, f64::MAX, Reach::Length),
    };
    let speed = (0.02 * value).max(1e-4);
    let hover = match handle.reach {
        Reach::Found | Reach::Bounded(_) => {
            "Sets the distance along the surface within which it follows this handle. Without a number of yours it ends \
             with the limb or the feature that the handle is on: where another limb begins, where the surface widens, or \
             in a crease. Ways across creases and beyond the limb count as longer, and none leads to a limb beside it."
        }
        Reach::Feature | Reach::Creased(_) => {
            "Sets the distance along the surface within which it follows this handle. Without a number of yours it ends \
             with the feature that the handle is on, where the surface widens or in a crease. Ways across creases count \
             as longer."
        }
        Reach::Part | Reach::Radii(_) | Reach::Length(_) => {
            "Sets the distance along the surface within which it follows this handle."
        }
    };
    let field = number_field(ui, &mut value, |ui, value| {
        let field = dragged(ui, value, units).range(0.0..=most).speed(speed);
        ui.add(field.max_decimals(3).suffix(suffix))
    });
    let field = field.labelled_by(label.id).on_hover_text(hover);
    commands.adjust(&field, || Command::SetReach(handle.id, make(value)));
    ui.end_row();
}

/// The handle with which this one rides along, if there are others.
fn parent(ui: &mut egui::Ui, editor: &Editor, handle: &Handle, commands: &mut Outbox) {
    let document = editor.document();
    let others: Vec<&Handle> = document.possible_parents(handle.id).collect();
    if others.is_empty() {
        return;
    }
    let label = row_label(ui, "Parent");
    let present = handle.parent.and_then(|parent| document.handle(parent));
    let mut chosen = handle.parent;
    let shown = ComboBox::from_id_salt("parent")
        .selected_text(present.map_or("none", |parent| &parent.name))
        .show_ui(ui, |ui| {
            ui.selectable_value(&mut chosen, None, "none");
            for other in others {
                ui.selectable_value(&mut chosen, Some(other.id), &other.name);
            }
        });
    shown
        .response
        .labelled_by(label.id)
        .on_hover_text("When the parent moves, this handle rides along, as a hand does when the arm turns.");
    if chosen != handle.parent {
        commands.push(Command::SetParent(handle.id, chosen));
    }
    ui.end_row();
}

/// The smoothness of the joint with the handle, if the method has a choice.
fn joint(ui: &mut egui::Ui, editor: &Editor, handle: &Handle, commands: &mut Outbox) {
    let label = row_label(ui, "Border");
    let has_choice = editor.document().method().has_continuity();
    let mut value = handle.continuity.unwrap_or(*CONTINUITY_RANGE.end());
    let word = match value {
        ..0.5 => "hinge",
        0.5..1.5 => "keeps tangents",
        _ => "smooth",
    };
    ui.add_enabled_ui(has_choice, |ui| {
        ui.horizontal(|ui| {
            let hover = if has_choice {
                "Sets the smoothness of the joint with this handle: 0 folds like a hinge, 1 keeps tangents, 2 keeps \
                 curvature."
                    .to_owned()
            } else {
                let others = METHODS.iter().filter(|method| method.heeds(ConstraintKind::Continuity));
                let titles: Vec<&str> = others.map(|method| method.title).collect();
                format!(
                    "This method has one kind of joint. Methods with a choice: {}.",
                    titles.join(", ")
                )
            };
            let field = number_field(ui, &mut value, |ui, value| {
                let field = dragged(ui, value, &[]).range(CONTINUITY_RANGE).speed(0.02);
                ui.add(field.max_decimals(2))
            });
            let field = field
                .labelled_by(label.id)
                .on_hover_text(&hover)
                .on_disabled_hover_text(&hover);
            commands.adjust(&field, || Command::SetContinuity(handle.id, Some(value)));
            ui.label(RichText::new(word).weak());
        });
    });
    ui.end_row();
}

/// Whether the handle is free along the direction of sight.
fn depth(ui: &mut egui::Ui, editor: &Editor, handle: &Handle, commands: &mut Outbox) {
    let mut is_free = handle.free_along.is_some();
    let unavailable = editor.unavailable_because(&Command::FreeOrHoldDepth);
    let hover = "Drags the handle in the plane of the picture: it stays under the pointer, and the shape chooses its \
                 distance from you, as a hand that you pull aside comes round with its arm.";
    ui.add_enabled_ui(unavailable.is_none(), |ui| {
        let field = ui.checkbox(&mut is_free, "Free depth").on_hover_text(hover);
        let field = field.on_disabled_hover_text(unavailable.as_deref().unwrap_or_default());
        if field.changed() {
            commands.push(Command::FreeOrHoldDepth);
        }
    });
    ui.end_row();
}

/// Whether the handle fixes its vertices or only pulls at them, and how strongly.
fn softness(ui: &mut egui::Ui, handle: &Handle, commands: &mut Outbox) {
    let mut is_soft = handle.soft.is_some();
    let hover = "A soft handle pulls its part of the surface like a spring instead of moving it exactly.";
    if ui.checkbox(&mut is_soft, "Soft").on_hover_text(hover).changed() {
        commands.push(Command::SetSoft(handle.id, is_soft.then_some(1.0)));
    }
    if let Some(mut weight) = handle.soft {
        let speed = 0.02 * weight;
        let hover = "Sets the soft handle's weight: a larger one pulls harder, and at 1 handle and surface yield \
                     equally.";
        let field = number_field(ui, &mut weight, |ui, weight| {
            let field = dragged(ui, weight, &[]).range(SOFT_RANGE).speed(speed);
            ui.add(field)
        });
        let field = field.on_hover_text(hover);
        commands.adjust(&field, || Command::SetSoft(handle.id, Some(weight)));
    }
}

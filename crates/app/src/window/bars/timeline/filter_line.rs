//! The filter of the selected handle's way through a sequence: a choice, and its numbers.

use eframe::egui;
use pliant_editor::{Command, Editor, FilterKind, HandleFilter};

use crate::window::widgets::number_field::{dragged, number_field};
use crate::window::widgets::outbox::Outbox;

/// The choices, with their names and their effects.
const CHOICES: [(Option<FilterKind>, &str, &str); 3] = [
    (None, "Own way", "Leaves the handle's way through the frames as it is."),
    (
        Some(FilterKind::Smooth),
        "Smooth",
        "Takes quick motions off the handle's way. Its shape and turn stay.",
    ),
    (
        Some(FilterKind::Exaggerate),
        "Exaggerate",
        "Adds quick motions once more: the handle swings back before it moves, and beyond its end.",
    ),
];

/// Shows the line if a handle of a sequence is selected.
pub fn show(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    let (view, animation) = (editor.view(), editor.document().animation());
    let handle = view.selected.and_then(|id| editor.document().handle(id));
    let (Some(count), Some(handle)) = (animation.frames(), handle.filter(|handle| !handle.is_pin)) else {
        return;
    };
    let present = animation.filters().get(&handle.id).copied();
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        ui.label(egui::RichText::new(format!("Way of {}", handle.name)).weak());
        for (kind, name, effect) in CHOICES {
            let is_chosen = present.map(|filter| filter.kind) == kind;
            if ui.selectable_label(is_chosen, name).on_hover_text(effect).clicked() && !is_chosen {
                let filter = present.unwrap_or(HandleFilter::of_all(count));
                let filter = kind.map(|kind| HandleFilter { kind, ..filter });
                commands.push(Command::SetFilter(handle.id, filter));
            }
        }
        if let Some(filter) = present {
            numbers(
                ui,
                filter,
                count,
                |filter| Command::SetFilter(handle.id, Some(filter)),
                commands,
            );
        }
    });
}

/// The numbers of a filter.
fn numbers(
    ui: &mut egui::Ui,
    present: HandleFilter,
    count: usize,
    set: impl Fn(HandleFilter) -> Command,
    commands: &mut Outbox,
) {
    let mut filter = present;
    let field = number_field(ui, &mut filter.width, |ui, width| {
        let field = dragged(ui, width, &[]).range(HandleFilter::WIDTH_RANGE).speed(0.05);
        ui.add(field.prefix("Width ").suffix(" frames").max_decimals(2))
    });
    let field = field.on_hover_text("Sets the length of a motion that is quick.");
    commands.adjust(&field, || set(filter));
    let mut filter = present;
    let field = number_field(ui, &mut filter.amount, |ui, amount| {
        let field = dragged(ui, amount, &[]).range(HandleFilter::AMOUNT_RANGE).speed(0.01);
        ui.add(field.prefix("Amount ").max_decimals(2))
    });
    let field = field.on_hover_text("Sets the share of the quick motions that is taken off or added.");
    commands.adjust(&field, || set(filter));
    for (end, prefix) in ["From ", "to "].into_iter().enumerate() {
        let mut filter = present;
        let range = match end {
            0 => 0..=present.span[1],
            _ => present.span[0]..=count - 1,
        };
        let field = number_field(ui, &mut filter.span[end], |ui, frame| {
            ui.add(dragged(ui, frame, &[]).range(range).speed(0.2).prefix(prefix))
        });
        let field = field.on_hover_text("Sets the first and the last frame, which stay in place.");
        commands.adjust(&field, || set(filter));
    }
}

//! The way of the selected handle through a sequence: its own, filtered, or held by footprints, and the numbers.

use std::collections::BTreeSet;
use std::path::Path;

use eframe::egui;
use pliant_editor::{
    Command, Editor, FilterKind, GroundAxis, Handle, HandleFilter, HandleFootprints, HandleId, HandleMix, UpAxis,
};

use crate::files::names::file_name;
use crate::window::input::file_command::FileCommand;
use crate::window::widgets::number_field::{dragged, number_field};
use crate::window::widgets::outbox::Outbox;

/// The filters, with their names and their effects.
const FILTERS: [(FilterKind, &str, &str); 2] = [
    (
        FilterKind::Smooth,
        "Smooth",
        "Takes quick motions off the handle's way. Its shape and turn stay.",
    ),
    (
        FilterKind::Exaggerate,
        "Exaggerate",
        "Adds quick motions once more: the handle swings back before it moves, and beyond its end.",
    ),
];

/// The height and the speed of new footprints, as shares of the diagonal of the file's box.
const SHARES: [f64; 2] = [0.01, 0.002];

/// The frames over which new footprints fade.
const FADE: u32 = 4;

/// Shows the line if a handle of a sequence is selected.
pub fn show(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    let (view, animation) = (editor.view(), editor.document().animation());
    let handle = view.selected.and_then(|id| editor.document().handle(id));
    let (Some(count), Some(handle)) = (animation.frames(), handle.filter(|handle| !handle.is_pin)) else {
        return;
    };
    let id = handle.id;
    let filter = animation.filters().get(&id).copied();
    let footprints = animation.footprints().get(&id).copied();
    let mix = animation.mix().map(|mix| &**mix);
    let led = mix.filter(|mix| mix.leads(id));
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        ui.label(egui::RichText::new(format!("Way of {}", handle.name)).weak());
        let own = match (footprints, led) {
            (Some(_), _) => Command::SetFootprints(id, None),
            (None, Some(mix)) => Command::SetMix(Some(mix.without(id))),
            (None, None) => Command::SetFilter(id, None),
        };
        let is_own = filter.is_none() && footprints.is_none() && led.is_none();
        let effect = "Leaves the handle's way through the frames as it is.";
        choice(ui, editor, ("Own way", effect), is_own, own, commands);
        for (kind, name, effect) in FILTERS {
            let other = filter.unwrap_or(HandleFilter::of_all(count));
            let command = Command::SetFilter(id, Some(HandleFilter { kind, ..other }));
            let is_chosen = filter.is_some_and(|filter| filter.kind == kind);
            choice(ui, editor, (name, effect), is_chosen, command, commands);
        }
        let effect = "Holds the handle wherever it rests on the ground, so that it does not slide.";
        let command = Command::SetFootprints(id, Some(footprints.unwrap_or_else(|| usual_footprints(editor))));
        choice(
            ui,
            editor,
            ("Footprints", effect),
            footprints.is_some(),
            command,
            commands,
        );
        mix_choice(ui, editor, id, mix, commands);
        if let Some(mix) = led {
            mix_numbers(ui, mix, commands);
        }
        if let Some(filter) = filter {
            filter_numbers(
                ui,
                filter,
                count,
                |filter| Command::SetFilter(id, Some(filter)),
                commands,
            );
        }
        if let Some(footprints) = footprints {
            footprint_numbers(ui, footprints, handle, commands);
            if let Some(count) = editor.footprints_of(id) {
                ui.label(egui::RichText::new(format!("{count} found")).weak());
            }
        }
    });
}

/// A choice with its name and its effect.
fn choice(
    ui: &mut egui::Ui,
    editor: &Editor,
    (name, effect): (&str, &str),
    is_chosen: bool,
    command: Command,
    commands: &mut Outbox,
) {
    let why_not = editor.unavailable_because(&command);
    let button = egui::Button::selectable(is_chosen, name);
    let response = ui.add_enabled(why_not.is_none() || is_chosen, button);
    let response = response.on_hover_text(effect);
    let response = match why_not {
        Some(reason) => response.on_disabled_hover_text(reason),
        None => response,
    };
    if response.clicked() && !is_chosen {
        commands.push(command);
    }
}

/// The choice of another sequence that leads the handle.
fn mix_choice(ui: &mut egui::Ui, editor: &Editor, id: HandleId, mix: Option<&HandleMix>, commands: &mut Outbox) {
    let led = |mix: &HandleMix| Command::SetMix(Some(mix.with(id)));
    let effect = "Lets another sequence with the same vertices and faces lead the handle, which keeps its shape.";
    match mix {
        Some(mix) => choice(ui, editor, ("Mix", effect), mix.leads(id), led(mix), commands),
        None => {
            let none = HandleMix {
                sequence: String::new(),
                handles: BTreeSet::new(),
                share: 1.0,
            };
            let why_not = editor.unavailable_because(&led(&none));
            let button = ui.add_enabled(why_not.is_none(), egui::Button::selectable(false, "Mix…"));
            let button = button.on_hover_text(effect);
            let button = match why_not {
                Some(reason) => button.on_disabled_hover_text(reason),
                None => button,
            };
            if button.clicked() {
                commands.push_file(FileCommand::Mix);
            }
        }
    }
}

/// The other sequence and its share.
fn mix_numbers(ui: &mut egui::Ui, present: &HandleMix, commands: &mut Outbox) {
    let name = file_name(Path::new(&present.sequence));
    let button = ui.button(format!("{name}…"));
    let hint = format!(
        "Chooses another sequence that leads handles, in place of {}.",
        present.sequence
    );
    if button.on_hover_text(hint).clicked() {
        commands.push_file(FileCommand::Mix);
    }
    let mut share = present.share;
    let field = number_field(ui, &mut share, |ui, share| {
        let field = dragged(ui, share, &[]).range(HandleMix::SHARE_RANGE).speed(0.005);
        ui.add(field.prefix("Share ").max_decimals(2))
    });
    let field = field.on_hover_text("Sets the share of the way to where the other sequence has its handles.");
    commands.adjust(&field, || {
        Command::SetMix(Some(HandleMix {
            share,
            ..present.clone()
        }))
    });
}

/// Footprints that fit the file's size.
fn usual_footprints(editor: &Editor) -> HandleFootprints {
    let view = editor.view();
    let [height, speed] = SHARES.map(|share| share * view.camera.scale);
    HandleFootprints {
        up: match view.camera.up {
            UpAxis::Y => GroundAxis::Y,
            UpAxis::Z => GroundAxis::Z,
        },
        height,
        speed,
        fade: FADE,
    }
}

/// The numbers of footprints.
fn footprint_numbers(ui: &mut egui::Ui, present: HandleFootprints, handle: &Handle, commands: &mut Outbox) {
    let set = |footprints| Command::SetFootprints(handle.id, Some(footprints));
    let mut length = |ui: &mut egui::Ui, prefix: &str, hint: &str, of: fn(&mut HandleFootprints) -> &mut f64| {
        let mut footprints = present;
        let present = *of(&mut footprints);
        let field = number_field(ui, of(&mut footprints), |ui, length| {
            let field = dragged(ui, length, &[]).range(1e-9..=f64::MAX).speed(0.02 * present);
            ui.add(field.prefix(prefix).max_decimals(6))
        });
        let field = field.on_hover_text(hint);
        commands.adjust(&field, || set(footprints));
    };
    let hint = "Sets the height within which the handle is on the ground, in world units.";
    length(ui, "Height ", hint, |footprints| &mut footprints.height);
    let hint = "Sets the way from frame to frame up to which the handle rests, in world units.";
    length(ui, "Speed ", hint, |footprints| &mut footprints.speed);
    let mut footprints = present;
    let field = number_field(ui, &mut footprints.fade, |ui, fade| {
        ui.add(
            dragged(ui, fade, &[])
                .range(0..=1000)
                .speed(0.1)
                .prefix("Fade ")
                .suffix(" frames"),
        )
    });
    let field = field.on_hover_text("Sets the frames before and after a footprint over which the handle goes over.");
    commands.adjust(&field, || set(footprints));
}

/// The numbers of a filter.
fn filter_numbers(
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

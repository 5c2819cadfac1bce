//! The buttons and fields of the timeline: play, steps, the moment, the frame rate, and the selected keys.

use eframe::egui;
use pliant_editor::{Animation, Command, Ease, Editor, KeyId, Skins};

use crate::window::widgets::command_button::{command_button, icon_choice, play_choice};
use crate::window::widgets::icon::{self, Glyph};
use crate::window::widgets::number_field::{dragged, number_field};
use crate::window::widgets::outbox::Outbox;

/// Shows them on a line.
pub fn show(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        let mut buttons = |ui: &mut egui::Ui, some: &[(Command, Glyph, Option<&str>)]| {
            for (command, glyph, label) in some {
                if icon_choice(ui, editor, command, false, *glyph, *label) {
                    commands.push(command.clone());
                }
            }
        };
        let before = [
            (Command::KeyHere, Glyph::DiamondPlus, Some("Key here")),
            (Command::GoToKey(false), Glyph::SkipBack, None),
            (Command::StepFrames(-1), Glyph::StepBack, None),
        ];
        let after = [
            (Command::StepFrames(1), Glyph::StepForward, None),
            (Command::GoToKey(true), Glyph::SkipForward, None),
        ];
        buttons(ui, &before);
        let is_played = play_choice(ui, editor, &Command::PlayKeys, editor.view().is_animating);
        buttons(ui, &after);
        if is_played {
            commands.push(Command::PlayKeys);
        }
        moment(ui, editor, commands);
        ui.separator();
        // A single shape has no path.
        if editor.document().animation().frames().is_some() {
            path(ui, editor, commands);
        }
        skins(ui, editor, commands);
        ui.separator();
        selected(ui, editor, commands);
    });
}

/// The shown frame and the frames a second.
fn moment(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    let animation = editor.document().animation();
    let (fps, mut frame) = (animation.fps(), animation.frame_at(animation.time()));
    let field = number_field(ui, &mut frame, |ui, frame| {
        let field = dragged(ui, frame, &[]).speed(0.2).prefix("Frame ");
        ui.add(match animation.frames() {
            Some(count) => field.range(0.0..=(count - 1) as f64).max_decimals(0),
            None => field.range(0.0..=Animation::LATEST * fps).max_decimals(2),
        })
    });
    let is_dragged = field.dragged() || field.drag_stopped();
    let field = field.on_hover_text(format!("Shows a moment: {:.3} s.", animation.time()));
    commands.adjust(&field, || {
        // A drag goes from frame to frame; a typed number may be between two.
        let frame = if is_dragged { frame.round() } else { frame };
        Command::GoToTime(frame.max(0.0) / fps)
    });
    let mut rate = fps;
    let field = number_field(ui, &mut rate, |ui, rate| {
        let field = dragged(ui, rate, &[]).range(Animation::FPS_RANGE);
        ui.add(field.speed(0.2).suffix(" fps").max_decimals(3))
    });
    let field = field.on_hover_text("Sets the number of frames a second. Keys keep their times.");
    commands.adjust(&field, || Command::SetFps(rate));
}

/// The switch of the body's path.
fn path(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    let is_shown = editor.view().look.path;
    let command = Command::TogglePath;
    if icon_choice(ui, editor, &command, is_shown, Glyph::Spline, Some("Path")) {
        commands.push(command);
    }
}

/// The switch of the ghosts, and their settings.
fn skins(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    let present = editor.view().look.skins;
    if icon_choice(ui, editor, &Command::ToggleSkins, present.shown, Glyph::Ghost, None) {
        commands.push(Command::ToggleSkins);
    }
    let mut skins = present;
    let menu = ui.menu_button(icon::text(Glyph::ChevronDown, 12.0), |ui| {
        egui::Grid::new("onion skins").num_columns(3).show(ui, |ui| {
            let [before, after] = &mut skins.colours;
            let sides = [
                ("Before", &mut skins.before, before),
                ("After", &mut skins.after, after),
            ];
            for (name, count, colour) in sides {
                let label = ui.label(name);
                let field = number_field(ui, count, |ui, count| {
                    ui.add(dragged(ui, count, &[]).range(0..=Skins::MOST).speed(0.05))
                });
                field.labelled_by(label.id).on_hover_text("Sets the number of ghosts.");
                ui.color_edit_button_srgb(colour).on_hover_text("Sets their colour.");
                ui.end_row();
            }
            let label = ui.label("Every");
            let field = number_field(ui, &mut skins.spacing, |ui, spacing| {
                ui.add(dragged(ui, spacing, &[]).range(1..=1000).speed(0.1).suffix(" frames"))
            });
            field
                .labelled_by(label.id)
                .on_hover_text("Sets the frames from one ghost to the next.");
            ui.end_row();
        });
        let vertices = editor.document().rest().len();
        let wanted = usize::from(skins.before) + usize::from(skins.after);
        if wanted > Skins::most_on(vertices) {
            let most = Skins::most_on(vertices);
            ui.label(format!("The mesh is so large that only the nearest {most} are shown."));
        }
    });
    menu.response
        .on_hover_text("Sets the number, the distance and the colours of the onion skins.");
    if skins != present {
        commands.push(Command::SetSkins(skins));
    }
}

/// The ease of the selected keys, and the ways to copy and remove them.
fn selected(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    let selected = editor.view().selected_keys;
    let keys = editor.document().animation().keys().iter();
    let own = keys.filter(|key| {
        let mut rows = key.rows();
        rows.any(|row| selected.contains(&KeyId::new(row, key.time)))
    });
    let mut eases: Vec<Ease> = own.map(|key| key.ease).collect();
    eases.dedup();
    let name = match eases[..] {
        [ease] => name_of(ease),
        [] => "Ease",
        _ => "several eases",
    };
    ui.add_enabled_ui(!selected.is_empty(), |ui| {
        ui.menu_button(name, |ui| {
            for ease in [Ease::Smooth, Ease::Linear, Ease::Hold] {
                let command = Command::SetKeyEase(ease);
                if command_button(ui, editor, &command) {
                    commands.push(command);
                    ui.close();
                }
            }
        })
        .response
        .on_hover_text("Sets the way from the selected keys to the next.")
        .on_disabled_hover_text("No key is selected: click one in the timeline.");
    });
    for (command, glyph) in [
        (Command::CopyKeys, Glyph::Copy),
        (Command::PasteKeys, Glyph::ClipboardPaste),
        (Command::DeleteKeys, Glyph::Trash2),
    ] {
        if icon_choice(ui, editor, &command, false, glyph, None) {
            commands.push(command);
        }
    }
    stretch(ui, editor, commands);
}

/// The time from the first to the last selected key, which can be changed.
fn stretch(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    let times = editor.view().selected_keys.iter().map(|id| id.time());
    let (first, last) = times.fold((f64::INFINITY, 0.0_f64), |(first, last), time| {
        (first.min(time), last.max(time))
    });
    if last <= first {
        return;
    }
    let mut seconds = last - first;
    ui.label(icon::text(Glyph::MoveHorizontal, 14.0));
    let field = number_field(ui, &mut seconds, |ui, seconds| {
        ui.add(
            dragged(ui, seconds, &[("s", 1.0)])
                .range(1e-3..=Animation::LATEST)
                .suffix(" s")
                .speed(0.0),
        )
    });
    let field = field.on_hover_text("Sets the time from the first to the last selected key: type a number.");
    if field.changed() {
        commands.push(Command::StretchKeys(seconds / (last - first)));
    }
}

/// The name of an ease in the strip.
pub fn name_of(ease: Ease) -> &'static str {
    match ease {
        Ease::Smooth => "Smooth",
        Ease::Linear => "Linear",
        Ease::Hold => "Hold",
    }
}

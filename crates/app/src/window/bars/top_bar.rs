//! The bar above everything: the menus, and the open file.

use eframe::egui::{self, MenuBar, RichText};
use pliant_editor::{
    Before, Clay, Command, Editor, KeptSide, NamedView, Orbit, Projection, RegionAction, Shading, StiffnessChange,
    Tips, UpAxis,
};

use super::menu_keys;
use super::recent_menu::{self, Recent};
use crate::window::input::file_command::FileCommand;
use crate::window::input::own_keys::{MENUS, menu_key};
use crate::window::threads::message::{Ground, PictureKind};
use crate::window::widgets::command_button::{command_button, menu_choice};
use crate::window::widgets::outbox::Outbox;

/// Shows the bar, whose menus open by keys if it `takes_keys`. Commands for the editor are added to `commands`; one for
/// files is returned.
pub fn show(
    ui: &mut egui::Ui,
    editor: &Editor,
    takes_keys: bool,
    file_name: &str,
    recent: &Recent<'_>,
    commands: &mut Outbox,
) -> Option<FileCommand> {
    let mut chosen = None;
    MenuBar::new().ui(ui, |ui| {
        let [file, edit, region, mesh, view, window, help] = MENUS.map(|(name, _)| name);
        let buttons = [
            ui.menu_button(file, |ui| chosen = file_menu(ui, editor, recent)),
            ui.menu_button(edit, |ui| edit_menu(ui, editor, commands)),
            ui.menu_button(region, |ui| region_menu(ui, editor, commands)),
            ui.menu_button(mesh, |ui| mesh_menu(ui, editor, commands)),
            ui.menu_button(view, |ui| view_menu(ui, editor, commands)),
            ui.menu_button(window, |ui| file_commands(ui, &WINDOW_MENU, &mut chosen)),
            ui.menu_button(help, |ui| file_commands(ui, &HELP_MENU, &mut chosen)),
        ];
        let with_letters = buttons.into_iter().zip(MENUS).map(|(button, (_, letter))| {
            let key = ui.ctx().format_shortcut(&menu_key(letter));
            (button.response.on_hover_text(key), letter)
        });
        let buttons: Vec<_> = with_letters.collect();
        if takes_keys {
            menu_keys::follow(ui.ctx(), &buttons);
        }
        let unsaved = if editor.view().unsaved { " •" } else { "" };
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.label(RichText::new(format!("{file_name}{unsaved}")).weak());
        });
    });
    chosen
}

fn file_menu(ui: &mut egui::Ui, editor: &Editor, recent: &Recent<'_>) -> Option<FileCommand> {
    let mut chosen = None;
    let is_open = editor.view().model.is_some();
    for command in [
        FileCommand::Open,
        FileCommand::OpenSequence,
        FileCommand::NewFromSample,
        FileCommand::Save,
        FileCommand::SaveAs,
        FileCommand::SaveMorph,
        FileCommand::ShowInFolder,
        FileCommand::SaveProject,
        FileCommand::SaveProjectAs,
        FileCommand::ExportEdit,
        FileCommand::ExportAnimation,
        FileCommand::ExportFrames,
        FileCommand::ExportFlow,
        FileCommand::ApplyEdit,
        FileCommand::Quit,
    ] {
        if command == FileCommand::Quit {
            ui.add_enabled_ui(is_open, |ui| {
                ui.menu_button("Save picture", |ui| chosen = chosen.take().or(picture_menu(ui)));
            });
        }
        if matches!(
            command,
            FileCommand::Save | FileCommand::SaveProject | FileCommand::ExportEdit | FileCommand::Quit
        ) {
            ui.separator();
        }
        let always = matches!(
            command,
            FileCommand::Open | FileCommand::OpenSequence | FileCommand::NewFromSample | FileCommand::Quit
        );
        let mut button = egui::Button::new(command.name());
        if let Some(shortcut) = command.shortcut() {
            button = button.shortcut_text(ui.ctx().format_shortcut(&shortcut));
        }
        if ui.add_enabled(always || is_open, button).clicked() {
            chosen = Some(command.clone());
            ui.close();
        }
        if command == FileCommand::Open {
            chosen = chosen.take().or(recent_menu::show(ui, recent));
        }
    }
    chosen
}

fn picture_menu(ui: &mut egui::Ui) -> Option<FileCommand> {
    let kinds = [
        ("As shown…", 1, Ground::AsShown),
        ("Twice as large…", 2, Ground::AsShown),
        ("Four times as large…", 4, Ground::AsShown),
        ("Twice as large, transparent…", 2, Ground::Transparent),
    ];
    let clicked = kinds.into_iter().filter(|(name, ..)| ui.button(*name).clicked());
    let (_, scale, ground) = clicked.last()?;
    ui.close();
    Some(FileCommand::SavePicture(PictureKind { scale, ground }))
}

fn edit_menu(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    let groups: [&[Command]; 3] = [
        &[Command::Undo, Command::Redo],
        &[
            Command::NewHandle,
            Command::NextHandle,
            Command::Deselect,
            Command::DeleteHandle,
            Command::ResetHandle,
        ],
        &[
            Command::Apply,
            Command::ResetShape,
            Command::ClearRegions,
            Command::TurnInsideOut,
        ],
    ];
    command_groups(ui, editor, &groups, commands);
    ui.separator();
    if menu_choice(ui, editor, &Command::WorkPose, editor.document().is_in_work_pose()) {
        commands.push(Command::WorkPose);
        ui.close();
    }
}

fn region_menu(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    let groups: [&[RegionAction]; 4] = [
        &[
            RegionAction::Grow,
            RegionAction::Shrink,
            RegionAction::SmoothBorder,
            RegionAction::FillParts,
        ],
        &[RegionAction::Invert, RegionAction::EverythingBut],
        &[
            RegionAction::Mirror(0),
            RegionAction::Mirror(1),
            RegionAction::Mirror(2),
        ],
        &[RegionAction::ToHandle, RegionAction::ToFree, RegionAction::ToFixed],
    ];
    for group in groups {
        for action in group {
            let command = Command::Region(*action);
            if command_button(ui, editor, &command) {
                commands.push(command);
                ui.close();
            }
        }
        ui.separator();
    }
    ui.menu_button("Stiffness", |ui| {
        let changes = [
            StiffnessChange::Grow,
            StiffnessChange::Shrink,
            StiffnessChange::Blur,
            StiffnessChange::Sharpen,
        ]
        .map(Command::ChangeStiffness);
        for command in changes.into_iter().chain([Command::ClearStiffness]) {
            if command_button(ui, editor, &command) {
                commands.push(command);
                ui.close();
            }
        }
    });
    ui.separator();
    for command in [Tips::Held, Tips::ComeAlong].map(Command::SetTips) {
        if command_button(ui, editor, &command) {
            commands.push(command);
            ui.close();
        }
    }
}

fn mesh_menu(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    let groups: [&[Command]; 3] = [
        &[Command::FillHoles, Command::FillHole],
        &[Command::BridgeBorders],
        &[
            Command::DeleteRegion,
            Command::CutAlongLine(KeptSide::Positive),
            Command::CutAlongLine(KeptSide::Negative),
            Command::CutAlongLine(KeptSide::Both),
            Command::CutAlongCurve(KeptSide::Positive),
            Command::CutAlongCurve(KeptSide::Both),
        ],
    ];
    command_groups(ui, editor, &groups, commands);
    ui.separator();
    let append = FileCommand::Append;
    let why = append.unavailable_because(editor);
    let button = ui.add_enabled(why.is_none(), egui::Button::new(append.name()));
    let button = match why {
        Some(why) => button.on_disabled_hover_text(why),
        None => button.on_hover_text("Puts another file beside the shape, with a handle that moves it."),
    };
    if button.clicked() {
        commands.push_file(append);
        ui.close();
    }
    let groups: [&[Command]; 2] = [
        &[0, 1, 2].map(Command::MirrorPart),
        &[Command::Merge, Command::MergePairs],
    ];
    command_groups(ui, editor, &groups, commands);
    if ui.button(FileCommand::MergeOptions.name()).clicked() {
        commands.push_file(FileCommand::MergeOptions);
        ui.close();
    }
}

/// Groups of commands, with a line between them.
fn command_groups(ui: &mut egui::Ui, editor: &Editor, groups: &[&[Command]], commands: &mut Outbox) {
    for (number, group) in groups.iter().enumerate() {
        if number > 0 {
            ui.separator();
        }
        for command in *group {
            if command_button(ui, editor, command) {
                commands.push(command.clone());
                ui.close();
            }
        }
    }
}

/// Commands of the window in groups, with other names if those of the palette are too short.
type Groups<'a> = [&'a [(FileCommand, Option<&'static str>)]];

/// The look of the window itself.
const WINDOW_MENU: [&[(FileCommand, Option<&str>)]; 3] = [
    &[(FileCommand::Panel, None)],
    &[
        (FileCommand::NextTheme, None),
        (FileCommand::Scale(1), Some("Larger")),
        (FileCommand::Scale(-1), Some("Smaller")),
    ],
    &[(FileCommand::Memory, None)],
];

/// The window's information.
const HELP_MENU: [&[(FileCommand, Option<&str>)]; 3] = [
    &[
        (FileCommand::Manual, None),
        (FileCommand::Palette, None),
        (FileCommand::Keys, None),
        (FileCommand::Hints, None),
    ],
    &[(FileCommand::Log, None), (FileCommand::Report, None)],
    &[(FileCommand::About, None)],
];

fn file_commands(ui: &mut egui::Ui, groups: &Groups<'_>, chosen: &mut Option<FileCommand>) {
    for (number, group) in groups.iter().enumerate() {
        if number > 0 {
            ui.separator();
        }
        for (command, name) in *group {
            let mut button = egui::Button::new(name.unwrap_or(command.name()));
            if let Some(shortcut) = command.shortcut() {
                button = button.shortcut_text(ui.ctx().format_shortcut(&shortcut));
            }
            if ui.add(button).clicked() {
                *chosen = Some(command.clone());
                ui.close();
            }
        }
    }
}

fn view_menu(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    for command in [
        Command::FrameAll,
        Command::FrameSelected,
        Command::ToggleSmallShown,
        Command::ShowEverything,
    ] {
        if command_button(ui, editor, &command) {
            commands.push(command);
            ui.close();
        }
    }
    ui.separator();
    let view = editor.view();
    let look = view.look;
    let mut choice = |ui: &mut egui::Ui, command: Command, chosen: bool| {
        if menu_choice(ui, editor, &command, chosen) {
            commands.push(command);
            ui.close();
        }
    };
    ui.menu_button("From", |ui| {
        for (_, side) in NamedView::NAMES {
            choice(ui, Command::View(side), false);
        }
        choice(ui, Command::TurnAround, false);
        for steps in [[1, 0], [-1, 0], [0, 1], [0, -1]] {
            choice(ui, Command::StepView(steps), false);
        }
    });
    let is_flat = view.camera.projection == Projection::Orthographic;
    choice(ui, Command::ToggleProjection, is_flat);
    for orbit in [Orbit::Turntable, Orbit::Trackball] {
        choice(ui, Command::SetOrbit(orbit), view.orbit == orbit);
    }
    ui.separator();
    ui.menu_button("Clay", |ui| {
        for (_, clay) in Clay::NAMES {
            let chosen = look.shading == Shading::Clay && look.clay == clay;
            choice(ui, Command::SetClay(clay), chosen);
        }
    });
    choice(
        ui,
        Command::SetShading(Shading::Material),
        look.shading == Shading::Material,
    );
    ui.menu_button("Colours and stripes", |ui| {
        for shading in [
            Shading::Stretch,
            Shading::Area,
            Shading::Stiffness,
            Shading::Weights,
            Shading::Curvature,
            Shading::Zebra,
            Shading::Normals,
        ] {
            choice(ui, Command::SetShading(shading), look.shading == shading);
        }
    });
    ui.separator();
    choice(ui, Command::ToggleFlat, look.flat);
    choice(ui, Command::ToggleWireframe, look.wireframe);
    choice(ui, Command::ToggleBorders, look.borders);
    choice(ui, Command::ToggleRegions, look.regions);
    choice(ui, Command::ToggleOutlines, look.outlines);
    choice(ui, Command::ToggleGrid, look.grid);
    choice(ui, Command::ToggleShadow, look.shadow);
    choice(ui, Command::ToggleBase, look.base);
    choice(ui, Command::ToggleOriginal, look.original);
    for before in [Before::Split, Before::Ghost] {
        choice(ui, Command::ToggleBefore(before), look.before == before);
    }
    ui.separator();
    choice(ui, Command::ToggleTimeline, look.timeline);
    choice(ui, Command::ToggleSkins, look.timeline && look.skins.shown);
    choice(ui, Command::CompareMethods, editor.comparison().is_some());
    ui.separator();
    let up = view.camera.up;
    for axis in [UpAxis::Y, UpAxis::Z] {
        choice(ui, Command::SetUp(axis), up == axis);
    }
}

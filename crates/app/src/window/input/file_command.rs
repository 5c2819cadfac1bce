//! The window's own commands: on files, and on the look of the window itself.

use std::path::PathBuf;

use eframe::egui::{Key, KeyboardShortcut, Modifiers};
use pliant_deform::AttachmentKind;
use pliant_editor::{Editor, WITHOUT_EXAMPLES};
use pliant_mesh::WeldOptions;

use crate::window::threads::message::{Ground, PictureKind};

/// A command on files. It belongs to the window, because the editor knows no paths.
#[derive(Clone, PartialEq, Debug)]
pub enum FileCommand {
    /// Open a file, by dialog.
    Open,
    /// Open a sequence, by dialog.
    OpenSequence,
    /// Open this file.
    OpenPath(PathBuf),
    /// Open the built-in sample.
    NewFromSample,
    /// Save.
    Save,
    /// Save under another name.
    SaveAs,
    /// Save a copy with its mesh at rest and the present shape as a morph target.
    SaveMorph,
    /// Show the open file in its folder, in the system's file manager.
    ShowInFolder,
    /// Save the project.
    SaveProject,
    /// Save the project under another name.
    SaveProjectAs,
    /// Write the regions, handles and transforms as an edit for the command line.
    ExportEdit,
    /// Write the edit over time.
    ExportAnimation,
    /// Write the frames of the open sequence with the edit.
    ExportFrames,
    /// Write the frames of the flow that was played.
    ExportFlow,
    /// Apply an edit from a file to the open mesh.
    ApplyEdit,
    /// Weld the open mesh's vertices in another way.
    Weld(WeldOptions),
    /// Put another file beside the open shape.
    Append,
    /// Choose how parts are merged.
    MergeOptions,
    /// Choose the sequence that leads handles of the open one.
    Mix,
    /// Take a cage from a file.
    LoadCage,
    /// Take an example from a file of the same vertices.
    AddExample,
    /// Take the file's morph target of this name as an example.
    AddMorphTarget(String),
    /// Find a command by its name.
    Palette,
    /// Show the log.
    Log,
    /// Show or hide the panel beside the view.
    Panel,
    /// Show the commands' keys, to be changed.
    Keys,
    /// Choose how much memory binding may take.
    Memory,
    /// Light, dark, or the system's choice.
    NextTheme,
    /// Everything larger (above 0) or smaller, in tenths.
    Scale(i8),
    /// Show the first steps again.
    Hints,
    /// Open the manual.
    Manual,
    /// Open the page to which faults are reported.
    Report,
    /// Show the version, the licence and the graphics device.
    About,
    /// Save a picture of the view.
    SavePicture(PictureKind),
    /// Close the window.
    Quit,
}

/// The reason for which the mesh can't be changed again.
const BUSY: &str = "A change of the mesh is under way: wait until it has ended, or stop it.";

/// The reason why no flow can be exported.
const WITHOUT_FLOW: &str =
    "No flow has just been played: play it, and export it before you change or undo anything about the dye.";

impl FileCommand {
    /// The reason why it can't be done now; `None` if it can.
    pub fn unavailable_because(&self, editor: &Editor) -> Option<&'static str> {
        let takes = |kind: AttachmentKind| {
            let mut attachments = editor.document().method().declaration().attachments.iter();
            attachments.any(|own| own.kind == kind)
        };
        match self {
            Self::Append if editor.view().model.is_none() => Some("Nothing is open: open a file first."),
            Self::Append if editor.document().animation().frames().is_some() => {
                Some("A sequence is open, and a part would fit only one frame: open the frame alone.")
            }
            Self::Append if editor.view().stitching.is_some() => Some(BUSY),
            Self::Append if editor.document().is_in_work_pose() => {
                Some("This would change the shape to return to: leave the work pose first.")
            }
            Self::SaveAs | Self::SaveMorph if editor.document().animation().frames().is_some() => {
                Some("A sequence has many shapes: save the project instead.")
            }
            Self::ExportAnimation if editor.document().animation().frames().is_some() => {
                Some("A sequence is open: choose Export frames… instead.")
            }
            Self::ExportFrames if editor.document().animation().frames().is_none() => {
                Some("No sequence is open: choose Open sequence… first.")
            }
            Self::ExportFlow if editor.view().is_playing => Some("The flow plays: pause it first."),
            Self::ExportFlow => {
                let is_recorded = editor.flow_recording().is_some();
                (!is_recorded).then_some(WITHOUT_FLOW)
            }
            Self::ExportAnimation => {
                let has_keys = !editor.document().animation().keys().is_empty();
                (!has_keys).then_some("There are no keys: set some on the timeline first.")
            }
            Self::Mix if editor.document().animation().frames().is_none() => {
                Some("No sequence is open: choose Open sequence… first.")
            }
            Self::Mix => {
                let is_led = editor.document().animation().mix().is_some();
                let selected = editor.view().selected.is_some();
                (!is_led && !selected).then_some("No handle is selected: select the one that another sequence leads.")
            }
            Self::LoadCage => (!takes(AttachmentKind::ControlMesh))
                .then_some("The method takes no cage: choose the method Cage first."),
            Self::AddExample | Self::AddMorphTarget(_) => (!takes(AttachmentKind::Shapes)).then_some(WITHOUT_EXAMPLES),
            _ => None,
        }
    }

    /// The commands that have a key.
    pub const WITH_SHORTCUTS: [Self; 10] = [
        Self::SaveAs,
        Self::SaveProject,
        Self::Open,
        Self::Save,
        Self::ExportEdit,
        Self::Palette,
        Self::Panel,
        Self::Scale(1),
        Self::Scale(-1),
        Self::Quit,
    ];

    /// The key.
    pub fn shortcut(&self) -> Option<KeyboardShortcut> {
        let command = |key| Some(KeyboardShortcut::new(Modifiers::COMMAND, key));
        match self {
            Self::Open => command(Key::O),
            Self::Save => command(Key::S),
            Self::SaveAs => Some(KeyboardShortcut::new(Modifiers::COMMAND | Modifiers::SHIFT, Key::S)),
            Self::Quit => command(Key::Q),
            Self::ExportEdit => command(Key::E),
            Self::SaveProject => Some(KeyboardShortcut::new(Modifiers::COMMAND | Modifiers::ALT, Key::S)),
            Self::Palette => Some(KeyboardShortcut::new(Modifiers::NONE, Key::F1)),
            Self::Panel => Some(KeyboardShortcut::new(Modifiers::NONE, Key::N)),
            Self::Scale(1..) => command(Key::Num9),
            Self::Scale(_) => command(Key::Num0),
            Self::SaveProjectAs
            | Self::OpenSequence
            | Self::SaveMorph
            | Self::ExportAnimation
            | Self::ExportFrames
            | Self::ExportFlow
            | Self::ApplyEdit
            | Self::Weld(_)
            | Self::Append
            | Self::MergeOptions
            | Self::Mix
            | Self::LoadCage
            | Self::AddExample
            | Self::AddMorphTarget(_)
            | Self::Log
            | Self::Keys
            | Self::Memory
            | Self::NextTheme
            | Self::Hints
            | Self::Manual
            | Self::Report
            | Self::About
            | Self::NewFromSample
            | Self::ShowInFolder
            | Self::OpenPath(_)
            | Self::SavePicture(_) => None,
        }
    }

    /// All commands that need no path, in the order of the menu.
    pub const LISTED: [Self; 31] = [
        Self::Open,
        Self::OpenSequence,
        Self::NewFromSample,
        Self::Save,
        Self::SaveAs,
        Self::SaveMorph,
        Self::ShowInFolder,
        Self::SaveProject,
        Self::SaveProjectAs,
        Self::ExportEdit,
        Self::ExportAnimation,
        Self::ExportFrames,
        Self::ExportFlow,
        Self::ApplyEdit,
        Self::Append,
        Self::MergeOptions,
        Self::Mix,
        Self::LoadCage,
        Self::AddExample,
        Self::SavePicture(PictureKind {
            scale: 1,
            ground: Ground::AsShown,
        }),
        Self::Palette,
        Self::Panel,
        Self::Log,
        Self::Keys,
        Self::Memory,
        Self::NextTheme,
        Self::Hints,
        Self::Manual,
        Self::Report,
        Self::About,
        Self::Quit,
    ];

    /// Its name in a menu.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Open | Self::OpenPath(_) => "Open…",
            Self::OpenSequence => "Open sequence…",
            Self::NewFromSample => "New from sample",
            Self::ShowInFolder => "Show in folder",
            Self::Manual => "Manual",
            Self::Report => "Report a fault",
            Self::About => "About Pliant",
            Self::Save => "Save model",
            Self::SaveAs => "Save model as…",
            Self::SaveMorph => "Save as morph target…",
            Self::SaveProject => "Save project",
            Self::SaveProjectAs => "Save project as…",
            Self::Weld(_) => "Weld vertices",
            Self::Append => "Append a file…",
            Self::MergeOptions => "Merge options…",
            Self::Mix => "Mix…",
            Self::LoadCage => "Load cage…",
            Self::AddExample => "Add example from file…",
            Self::AddMorphTarget(_) => "Add a morph target",
            Self::Palette => "Find a command…",
            Self::Panel => "Panel",
            Self::Log => "Log…",
            Self::Keys => "Keys…",
            Self::Memory => "Memory…",
            Self::NextTheme => "Light or dark",
            Self::Scale(_) => "Interface size",
            Self::Hints => "Canvas hints",
            Self::ExportEdit => "Export edit…",
            Self::ExportAnimation => "Export animation…",
            Self::ExportFrames => "Export frames…",
            Self::ExportFlow => "Export flow…",
            Self::ApplyEdit => "Apply an edit…",
            Self::SavePicture(_) => "Save picture…",
            Self::Quit => "Quit",
        }
    }

    /// Its keywords, in lower case.
    pub fn keywords(&self) -> &'static str {
        match self {
            Self::Open | Self::OpenPath(_) => "load import file",
            Self::OpenSequence => "load import frames 4d scan point cache pc2 mdd animation time",
            Self::NewFromSample => "open example creature try",
            Self::ShowInFolder => "file manager explorer finder reveal directory",
            Self::Manual => "help documentation guide",
            Self::Report => "bug issue feedback",
            Self::About => "version licence license graphics device card help",
            Self::Save | Self::SaveAs => "write file",
            Self::SaveMorph => "blend shape key gltf glb write file",
            Self::SaveProject | Self::SaveProjectAs => "pliant file document",
            Self::Weld(_) => "weld merge distance doubles seams",
            Self::Append => "add import second scan part merge join combine",
            Self::MergeOptions => "join reach method fit settings",
            Self::Mix => "sequence lead motion transfer handles other second blend",
            Self::LoadCage => "open import control mesh",
            Self::AddExample | Self::AddMorphTarget(_) => "open import pose shape blend morph in-between",
            Self::Palette => "palette search",
            Self::Panel => "sidebar show hide full screen",
            Self::Log => "messages errors",
            Self::Keys => "shortcuts bindings keyboard rebind",
            Self::Memory => "ram limit budget gigabytes settings preferences",
            Self::NextTheme => "theme dark mode",
            Self::Scale(_) => "ui zoom",
            Self::Hints => "help first steps",
            Self::ExportEdit => "json command line",
            Self::ExportAnimation => "keys timeline gltf glb pc2 mdd frames video bake write",
            Self::ExportFrames => "sequence folder 4d scan point cache pc2 mdd glb write save",
            Self::ExportFlow => "fluid dye frames numbered files colours animation write save",
            Self::ApplyEdit => "json import load again scan",
            Self::SavePicture(_) => "screenshot render image png",
            Self::Quit => "exit close",
        }
    }
}

//! What menus, buttons, keys and the command palette can ask for: commands are data.
//!
//! Each command that needs no argument stands in [`Command::LISTED`] with its name, its tooltip, its shortcut and when
//! it is enabled ([`Editor::is_enabled`](crate::Editor::is_enabled)); panels send the others with their values.

use pliant_deform::{Loose, Method};

use crate::{
    BrushMetric, Depth, GizmoOrientation, HandleId, HandleTransform, Key, Modifiers, ObjectAction, PivotPlace,
    RegionAction, Shading, StiffnessBrush, StrokeShape, ToolMode,
};

/// Something to be done, with all it needs to know.
#[derive(Clone, PartialEq, Debug)]
pub enum Command {
    /// Takes back the last step.
    Undo,
    /// Does the last taken-back step again.
    Redo,
    /// Chooses what the left button does on the surface.
    SetTool(ToolMode),
    /// The next stroke of the handle brush makes a handle of its own.
    NewHandle,
    /// Selects a handle; its gizmo is shown.
    SelectHandle(HandleId),
    /// Selects no handle.
    Deselect,
    /// Selects the next handle of the list.
    NextHandle,
    /// Deletes the selected handle; its vertices are held still.
    DeleteHandle,
    /// Takes the selected handle back to where it rests.
    ResetHandle,
    /// Names a handle.
    RenameHandle(HandleId, String),
    /// Puts a handle where the transform says, about the handle's own pivot.
    SetHandleTransform(HandleId, HandleTransform),
    /// Turns a handle to these angles about x, y and z in degrees, full turns included.
    SetTurn(HandleId, glam::DVec3),
    /// How far along the surface a handle takes the surface along.
    SetReach(HandleId, Reach),
    /// Gives a handle a weight ([`SOFT_RANGE`](crate::SOFT_RANGE)), so that it only pulls; `None` makes it hard.
    SetSoft(HandleId, Option<f64>),
    /// Makes the present shape the new rest shape: every handle's transform returns to the identity.
    Apply,
    /// Takes the rest shape and every handle back to the file's shape.
    ResetShape,
    /// Holds everything still again: no handle, no region.
    ClearRegions,
    /// Chooses the method and its options.
    SetMethod(Method),
    /// Chooses what components that nothing holds do, all of them.
    SetLoose(Loose),
    /// Chooses what one of them does, by its component's number; `None` is what all do.
    SetLoosePart(u32, Option<Loose>),
    /// Comes close to a connected part, by its component's number.
    FramePart(u32),
    /// With which continuity ([`pliant_deform::CONTINUITY_RANGE`]) the surface joins a handle; `None` is the smoothest.
    SetContinuity(HandleId, Option<f64>),
    /// Sets the stiffness (0.001 to 1000; 1 is a vertex left alone) of every vertex.
    SetStiffness(Vec<f64>),
    /// Sets the brush's radius in points, clamped to what the brush allows.
    SetBrushRadius(f64),
    /// A larger brush.
    GrowBrush,
    /// A smaller brush.
    ShrinkBrush,
    /// Frames everything.
    FrameAll,
    /// Frames the selected handle and its region.
    FrameSelected,
    /// Comes close to a vertex, by the file's number.
    FrameFileVertex(u32),
    /// Looks from where one looked before.
    CameraBack,
    /// Looks from where one looked before going back.
    CameraForth,
    /// Looks from a named side.
    View(crate::NamedView),
    /// Which axis points up on the screen.
    SetUp(crate::UpAxis),
    /// How the surface is shaded.
    SetShading(Shading),
    /// Shades the surface like this clay.
    SetClay(crate::Clay),
    /// Shows each triangle flat, or normals interpolated.
    ToggleFlat,
    /// Shows or hides the wireframe.
    ToggleWireframe,
    /// Marks edges that a closed surface lacks, or not.
    ToggleBorders,
    /// Shows or hides the handles' outlines and the border of what is held.
    ToggleOutlines,
    /// Shows or hides the ground's grid.
    ToggleGrid,
    /// Changes between perspective and orthographic.
    ToggleProjection,
    /// What dragging the view does.
    SetOrbit(crate::Orbit),
    /// Turns the view by steps of 15 degrees, to the right and down.
    StepView([i8; 2]),
    /// Looks from the other side.
    TurnAround,
    /// Shows or hides the regions' colours over clay and material.
    ToggleRegions,
    /// What the gizmo offers.
    SetGizmo(crate::GizmoMode),
    /// Along which axes the gizmo stands.
    SetOrientation(GizmoOrientation),
    /// How the left button takes vertices.
    SetStrokeShape(StrokeShape),
    /// How deep a lasso or a box goes.
    SetDepth(Depth),
    /// How the brush measures its radius.
    SetBrushMetric(BrushMetric),
    /// The stiffness brush's action and numbers, clamped to what they may be.
    SetStiffnessBrush(StiffnessBrush),
    /// Makes the whole surface equally stiff.
    ClearStiffness,
    /// Changes the region in hand as a whole.
    Region(RegionAction),
    /// Widens the selected handle's reach with the pointer.
    Widen,
    /// Adds a handle to those that are selected, or takes it from them.
    ToggleSelected(HandleId),
    /// Gives a handle a colour, sRGB with alpha.
    SetHandleColour(HandleId, [u8; 4]),
    /// Shows or hides a handle's colour and gizmo.
    ToggleHandleVisible(HandleId),
    /// Keeps a handle from being moved, painted and deleted, or lets it.
    ToggleHandleLocked(HandleId),
    /// Chooses where a handle's pivot stands. The surface stays as it is.
    SetPivotPlace(HandleId, PivotPlace),
    /// The next click on the surface puts the selected handle's pivot there.
    PickPivot,
    /// Puts a handle's pivot at a point of the present shape. The surface stays as it is.
    SetPivot(HandleId, glam::DVec3),
    /// Splits the selected handle in two across its longest side: a vertex can only be in one.
    DuplicateHandle,
    /// Makes the selected handle's mirror image a handle that does the same, across axis 0, 1, 2 for x, y, z.
    MakeTwin(usize),
    /// Lets the selected handle and its twin go their own ways.
    Untwin,
    /// Takes the selected handle's vertices and its region back to the file's shape.
    ResetRegion,
    /// Hides, shows or locks objects, by their numbers in [`pliant_mesh::Model::all_objects`].
    Objects(ObjectAction, Vec<u32>),
    /// The same with the object under the pointer.
    ObjectHere(ObjectAction),
    /// Shows nothing but the connected part under the pointer; once more shows the others again.
    Isolate,
    /// Shows everything that is hidden.
    ShowEverything,
    /// Goes back or forth to the state after so many steps of the history.
    GoToStep(usize),
    /// Starts moving the selected handle with the pointer.
    Move,
    /// Starts turning the selected handle with the pointer.
    Turn,
    /// Starts scaling the selected handle with the pointer.
    Scale,
    /// Stops the jobs that run; what needs them starts them again.
    CancelJobs,
}

/// How far along the surface a handle takes the surface along.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Reach {
    /// This many of the handle's own radii (above 0).
    Radii(f64),
    /// This far in world units (0: only what is painted).
    Length(f64),
}

impl Default for Reach {
    fn default() -> Self {
        Self::Radii(3.0)
    }
}

/// A key with the modifiers that must be held.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Shortcut {
    /// Exactly these modifiers.
    pub modifiers: Modifiers,
    /// The key.
    pub key: Key,
}

impl Shortcut {
    const fn plain(key: Key) -> Self {
        Self {
            modifiers: Modifiers::NONE,
            key,
        }
    }

    const fn with(modifiers: Modifiers, key: Key) -> Self {
        Self { modifiers, key }
    }

    /// As a menu writes it: "Ctrl+Shift+Z".
    pub fn label(&self) -> String {
        let mut label = String::new();
        for (held, name) in [
            (self.modifiers.ctrl, "Ctrl+"),
            (self.modifiers.alt, "Alt+"),
            (self.modifiers.shift, "Shift+"),
        ] {
            if held {
                label.push_str(name);
            }
        }
        match self.key {
            Key::Character(character) => label.extend(character.to_uppercase()),
            Key::Escape => label.push_str("Esc"),
            Key::Enter => label.push_str("Enter"),
            Key::Backspace => label.push_str("Backspace"),
            Key::Delete => label.push_str("Delete"),
            Key::Home => label.push_str("Home"),
            Key::Tab => label.push_str("Tab"),
            Key::Numpad(digit) => label.push_str(&format!("Num {digit}")),
        }
        label
    }
}

/// A command as a menu or the palette lists it.
#[derive(Clone, PartialEq, Debug)]
pub struct Listed {
    /// What is sent.
    pub command: Command,
    /// Its name in a menu.
    pub name: &'static str,
    /// One sentence that says what it does.
    pub tooltip: &'static str,
    /// Keys that send it; the first is shown.
    pub shortcuts: &'static [Shortcut],
}

const fn listed(command: Command, name: &'static str, tooltip: &'static str, shortcuts: &'static [Shortcut]) -> Listed {
    Listed {
        command,
        name,
        tooltip,
        shortcuts,
    }
}

const fn character(character: char) -> Shortcut {
    Shortcut::plain(Key::Character(character))
}

const fn numpad(digit: u8) -> Shortcut {
    Shortcut::plain(Key::Numpad(digit))
}

const fn ctrl_numpad(digit: u8) -> Shortcut {
    Shortcut::with(Modifiers::CTRL, Key::Numpad(digit))
}

impl Command {
    /// Every command that needs no argument, in the order of a menu.
    pub const LISTED: &'static [Listed] = &[
        listed(
            Command::Undo,
            "Undo",
            "Takes back the last step.",
            &[Shortcut::with(Modifiers::CTRL, Key::Character('z'))],
        ),
        listed(
            Command::Redo,
            "Redo",
            "Does the step that was taken back again.",
            &[
                Shortcut::with(Modifiers::CTRL_SHIFT, Key::Character('z')),
                Shortcut::with(Modifiers::CTRL, Key::Character('y')),
            ],
        ),
        listed(
            Command::SetTool(ToolMode::PaintHandle),
            "Paint handle",
            "Paints what you want to move; around it a region follows along.",
            &[character('1')],
        ),
        listed(
            Command::SetTool(ToolMode::PaintFree),
            "Paint region",
            "Paints what may bend along with the handles.",
            &[character('2')],
        ),
        listed(
            Command::SetTool(ToolMode::PaintFixed),
            "Paint fixed",
            "Paints what is held still.",
            &[character('3')],
        ),
        listed(
            Command::SetTool(ToolMode::Erase),
            "Erase",
            "Takes paint away.",
            &[character('4')],
        ),
        listed(
            Command::SetTool(ToolMode::Select),
            "Select",
            "Click a handle to select it; drag it to move it in the plane of the screen.",
            &[character('5')],
        ),
        listed(
            Command::SetTool(ToolMode::PaintStiffness),
            "Paint stiffness",
            "Paints how firmly the surface keeps its shape.",
            &[character('6')],
        ),
        listed(
            Command::SetStrokeShape(StrokeShape::Brush),
            "Brush",
            "Paints with a round brush.",
            &[character('b')],
        ),
        listed(
            Command::SetStrokeShape(StrokeShape::Lasso),
            "Lasso",
            "Paints what a line drawn freely encloses.",
            &[character('l')],
        ),
        listed(
            Command::SetStrokeShape(StrokeShape::Box),
            "Box",
            "Paints what a box encloses.",
            &[character('k')],
        ),
        listed(
            Command::SetStrokeShape(StrokeShape::Component),
            "Whole part",
            "Paints the whole part of the surface that is clicked.",
            &[character('j')],
        ),
        listed(
            Command::SetBrushMetric(BrushMetric::Screen),
            "Brush as seen",
            "The brush takes what its disc on the screen covers and faces you.",
            &[],
        ),
        listed(
            Command::SetBrushMetric(BrushMetric::Surface),
            "Brush along the surface",
            "The brush takes what is near along the surface: into folds and round edges, seen or not.",
            &[],
        ),
        listed(
            Command::SetBrushMetric(BrushMetric::Through),
            "Brush through",
            "The brush takes everything that its disc on the screen covers, however far behind.",
            &[],
        ),
        listed(
            Command::SetDepth(Depth::Visible),
            "Lasso what is seen",
            "A lasso or a box takes only what faces you and is hidden by nothing.",
            &[],
        ),
        listed(
            Command::SetDepth(Depth::Through),
            "Lasso through",
            "A lasso or a box takes everything inside, to the back of the model.",
            &[],
        ),
        listed(
            Command::Region(RegionAction::Grow),
            "Grow",
            "Takes in the vertices around the region in hand.",
            &[Shortcut::with(Modifiers::CTRL, Key::Character('='))],
        ),
        listed(
            Command::Region(RegionAction::Shrink),
            "Shrink",
            "Gives up the vertices at the border of the region in hand.",
            &[Shortcut::with(Modifiers::CTRL, Key::Character('-'))],
        ),
        listed(
            Command::Region(RegionAction::SmoothBorder),
            "Smooth border",
            "Straightens the border of the region in hand.",
            &[],
        ),
        listed(
            Command::Region(RegionAction::FillParts),
            "Fill parts",
            "Takes in every part of the surface that the region in hand touches.",
            &[],
        ),
        listed(
            Command::Region(RegionAction::Invert),
            "Invert",
            "Makes the region in hand what it was not.",
            &[Shortcut::with(Modifiers::CTRL, Key::Character('i'))],
        ),
        listed(
            Command::Region(RegionAction::EverythingBut),
            "Everything but",
            "Holds still all that is not in hand; with what is held still in hand, frees all else.",
            &[],
        ),
        listed(
            Command::Region(RegionAction::Mirror(0)),
            "Mirror across x",
            "Takes in the mirror image of the region in hand, left and right.",
            &[],
        ),
        listed(
            Command::Region(RegionAction::Mirror(1)),
            "Mirror across y",
            "Takes in the mirror image of the region in hand, above and below.",
            &[],
        ),
        listed(
            Command::Region(RegionAction::Mirror(2)),
            "Mirror across z",
            "Takes in the mirror image of the region in hand, before and behind.",
            &[],
        ),
        listed(
            Command::Region(RegionAction::ToFree),
            "Make it the region",
            "Lets what is in hand bend.",
            &[],
        ),
        listed(
            Command::Region(RegionAction::ToFixed),
            "Make it fixed",
            "Holds what is in hand still.",
            &[],
        ),
        listed(
            Command::Region(RegionAction::ToHandle),
            "Make it a handle",
            "Makes what is in hand a handle of its own.",
            &[],
        ),
        listed(
            Command::ClearStiffness,
            "Clear stiffness",
            "Makes the whole surface equally stiff.",
            &[],
        ),
        listed(
            Command::Widen,
            "Widen reach",
            "Follows the pointer: how far the surface comes along with the selected handle.",
            &[character('e')],
        ),
        listed(
            Command::SetOrientation(GizmoOrientation::World),
            "World axes",
            "The gizmo stands along the world's axes.",
            &[],
        ),
        listed(
            Command::SetOrientation(GizmoOrientation::Local),
            "Own axes",
            "The gizmo turns along with its handle.",
            &[],
        ),
        listed(
            Command::SetOrientation(GizmoOrientation::View),
            "Screen axes",
            "The gizmo stands along the screen.",
            &[],
        ),
        listed(
            Command::PickPivot,
            "Pick pivot",
            "The next click on the surface is the point that the handle turns about.",
            &[Shortcut::with(Modifiers::SHIFT, Key::Character('p'))],
        ),
        listed(
            Command::DuplicateHandle,
            "Duplicate handle",
            "Splits the selected handle in two along its longest side.",
            &[Shortcut::with(Modifiers::SHIFT, Key::Character('d'))],
        ),
        listed(
            Command::MakeTwin(0),
            "Twin across x",
            "Makes the handle's mirror image a handle that does the same: drag left, right follows.",
            &[Shortcut::with(Modifiers::SHIFT, Key::Character('m'))],
        ),
        listed(
            Command::MakeTwin(1),
            "Twin across y",
            "Makes the handle's mirror image, above and below, a handle that does the same.",
            &[],
        ),
        listed(
            Command::MakeTwin(2),
            "Twin across z",
            "Makes the handle's mirror image, before and behind, a handle that does the same.",
            &[],
        ),
        listed(
            Command::Untwin,
            "Part twins",
            "Lets the selected handle and its twin go their own ways.",
            &[],
        ),
        listed(
            Command::ResetRegion,
            "Reset region",
            "Takes the selected handle and its region back to the file's shape, and nothing else.",
            &[],
        ),
        listed(
            Command::ObjectHere(ObjectAction::Hide),
            "Hide object",
            "Hides the object under the pointer: it is neither drawn nor picked nor painted, and moves along.",
            &[character('h')],
        ),
        listed(
            Command::ObjectHere(ObjectAction::Solo),
            "Show only this object",
            "Hides all objects but the one under the pointer; once more shows everything.",
            &[Shortcut::with(Modifiers::SHIFT, Key::Character('h'))],
        ),
        listed(
            Command::ObjectHere(ObjectAction::Lock),
            "Lock object",
            "Holds the object under the pointer still, whatever is painted on it.",
            &[],
        ),
        listed(
            Command::Isolate,
            "Isolate part",
            "Shows nothing but the connected part under the pointer; once more shows the others again.",
            &[character('/')],
        ),
        listed(
            Command::ShowEverything,
            "Show everything",
            "Shows all objects and parts that are hidden.",
            &[Shortcut::with(Modifiers::ALT, Key::Character('h'))],
        ),
        listed(
            Command::NewHandle,
            "New handle",
            "The next stroke of the handle brush makes a handle of its own.",
            &[character('n')],
        ),
        listed(
            Command::NextHandle,
            "Next handle",
            "Selects the next handle.",
            &[Shortcut::plain(Key::Tab)],
        ),
        listed(
            Command::Deselect,
            "Deselect",
            "Selects no handle.",
            &[Shortcut::with(Modifiers::ALT, Key::Character('a'))],
        ),
        listed(
            Command::DeleteHandle,
            "Delete handle",
            "Deletes the selected handle; the shape stays as it is.",
            &[Shortcut::plain(Key::Delete), character('x')],
        ),
        listed(
            Command::Move,
            "Move",
            "Moves the selected handle with the pointer.",
            &[character('g')],
        ),
        listed(
            Command::Turn,
            "Turn",
            "Turns the selected handle with the pointer.",
            &[character('r')],
        ),
        listed(
            Command::Scale,
            "Scale",
            "Scales the selected handle with the pointer.",
            &[character('s')],
        ),
        listed(
            Command::ResetHandle,
            "Reset handle",
            "Takes the selected handle back to where it rests.",
            &[Shortcut::with(Modifiers::ALT, Key::Character('g'))],
        ),
        listed(
            Command::Apply,
            "Apply shape",
            "Makes the present shape the new rest shape.",
            &[Shortcut::with(Modifiers::CTRL, Key::Enter)],
        ),
        listed(
            Command::ResetShape,
            "Reset shape",
            "Takes the surface back to the file's shape.",
            &[],
        ),
        listed(
            Command::ClearRegions,
            "Clear regions",
            "Removes all handles and regions; the shape stays as it is.",
            &[],
        ),
        listed(
            Command::FrameAll,
            "Frame all",
            "Shows the whole surface.",
            &[Shortcut::plain(Key::Home)],
        ),
        listed(
            Command::FrameSelected,
            "Frame selected",
            "Shows the selected handle, or the whole surface where none is selected.",
            &[character('.')],
        ),
        listed(
            Command::CameraBack,
            "View before",
            "Looks from where you looked before.",
            &[Shortcut::with(Modifiers::ALT, Key::Character('['))],
        ),
        listed(
            Command::CameraForth,
            "View after",
            "Looks from where you looked before you went back.",
            &[Shortcut::with(Modifiers::ALT, Key::Character(']'))],
        ),
        listed(
            Command::GrowBrush,
            "Larger brush",
            "Makes the brush larger.",
            &[character(']')],
        ),
        listed(
            Command::ShrinkBrush,
            "Smaller brush",
            "Makes the brush smaller.",
            &[character('[')],
        ),
        listed(
            Command::SetShading(Shading::Clay),
            "Clay",
            "Shades the surface like clay.",
            &[],
        ),
        listed(
            Command::SetShading(Shading::Material),
            "Material",
            "Shades the surface with the file's materials.",
            &[],
        ),
        listed(
            Command::SetShading(Shading::Stretch),
            "Edge stretch",
            "Colours the surface by how much longer or shorter its edges are than at rest.",
            &[],
        ),
        listed(
            Command::SetShading(Shading::Area),
            "Area change",
            "Colours the surface by how much larger or smaller it is than at rest.",
            &[],
        ),
        listed(
            Command::SetShading(Shading::Stiffness),
            "Stiffness",
            "Colours the surface by how stiff it was painted.",
            &[],
        ),
        listed(
            Command::SetShading(Shading::Curvature),
            "Curvature",
            "Colours the surface by its mean curvature: red bulges, blue is hollow.",
            &[],
        ),
        listed(
            Command::SetShading(Shading::Zebra),
            "Zebra stripes",
            "Mirrors stripes in the surface: they break at creases and kink where curvature jumps.",
            &[],
        ),
        listed(
            Command::SetShading(Shading::Normals),
            "Normals",
            "Colours the surface by the direction in which it faces.",
            &[],
        ),
        listed(
            Command::ToggleFlat,
            "Flat faces",
            "Shows each triangle flat, or normals interpolated.",
            &[],
        ),
        listed(
            Command::ToggleBorders,
            "Borders",
            "Marks edges where the surface ends, and those that more than two triangles share.",
            &[],
        ),
        listed(
            Command::ToggleOutlines,
            "Outlines",
            "Shows or hides the outlines of handles, and the line where the region meets what is held.",
            &[],
        ),
        listed(
            Command::ToggleGrid,
            "Ground grid",
            "Shows or hides the ground's grid.",
            &[],
        ),
        listed(
            Command::ToggleProjection,
            "Orthographic",
            "Changes between perspective and a view in which distance does not matter.",
            &[numpad(5)],
        ),
        listed(
            Command::SetOrbit(crate::Orbit::Turntable),
            "Turntable",
            "Dragging turns the view about the up axis; the horizon stays level.",
            &[],
        ),
        listed(
            Command::SetOrbit(crate::Orbit::Trackball),
            "Trackball",
            "Dragging rolls the view like a ball.",
            &[],
        ),
        listed(
            Command::StepView([1, 0]),
            "Turn left",
            "Turns the view by 15°.",
            &[numpad(4)],
        ),
        listed(
            Command::StepView([-1, 0]),
            "Turn right",
            "Turns the view by 15°.",
            &[numpad(6)],
        ),
        listed(
            Command::StepView([0, 1]),
            "Turn up",
            "Turns the view by 15°.",
            &[numpad(8)],
        ),
        listed(
            Command::StepView([0, -1]),
            "Turn down",
            "Turns the view by 15°.",
            &[numpad(2)],
        ),
        listed(
            Command::TurnAround,
            "Other side",
            "Looks from the other side.",
            &[numpad(9)],
        ),
        listed(
            Command::View(crate::NamedView::Front),
            "From front",
            "Looks from the front.",
            &[numpad(1)],
        ),
        listed(
            Command::View(crate::NamedView::Back),
            "From back",
            "Looks from behind.",
            &[ctrl_numpad(1)],
        ),
        listed(
            Command::View(crate::NamedView::Left),
            "From left",
            "Looks from the left.",
            &[ctrl_numpad(3)],
        ),
        listed(
            Command::View(crate::NamedView::Right),
            "From right",
            "Looks from the right.",
            &[numpad(3)],
        ),
        listed(
            Command::View(crate::NamedView::Top),
            "From top",
            "Looks from above.",
            &[numpad(7)],
        ),
        listed(
            Command::View(crate::NamedView::Bottom),
            "From bottom",
            "Looks from below.",
            &[ctrl_numpad(7)],
        ),
        listed(
            Command::View(crate::NamedView::ThreeQuarter),
            "Three-quarter",
            "Looks from the front, the right and above.",
            &[numpad(0)],
        ),
        listed(
            Command::ToggleRegions,
            "Show regions",
            "Shows or hides the regions' colours.",
            &[],
        ),
        listed(
            Command::ToggleWireframe,
            "Wireframe",
            "Shows or hides the triangles' edges.",
            &[character('w')],
        ),
        listed(Command::CancelJobs, "Stop", "Stops what is being computed.", &[]),
    ];

    /// The entry of [`Command::LISTED`] for this command.
    pub fn listed(&self) -> Option<&'static Listed> {
        Self::LISTED.iter().find(|listed| listed.command == *self)
    }
}

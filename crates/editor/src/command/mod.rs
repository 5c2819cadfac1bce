//! What menus, buttons, keys and the command palette can ask for: commands are data.
//!
//! Each command that needs no argument stands in [`Command::GROUPS`] with its name, its tooltip and its keys;
//! [`Editor::is_enabled`](crate::Editor::is_enabled) says when it can be done. Panels send the others with their values.

mod document;
mod execute;
mod handle;
mod key_map;
mod look;
mod object;
mod obstacle;
mod paint;
mod region;
mod shortcut;
mod table;
mod view;

pub use key_map::KeyMap;
pub use shortcut::Shortcut;
pub use table::{CommandGroup, Listed};

use pliant_deform::{Loose, Method};

use crate::{
    BrushMetric, Depth, GizmoOrientation, HandleId, HandleTransform, ObjectAction, PivotPlace, RegionAction, Shading,
    StiffnessBrush, StrokeShape, ToolMode,
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

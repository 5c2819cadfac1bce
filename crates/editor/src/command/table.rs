//! The table of commands.

use std::borrow::Cow;
use std::sync::LazyLock;

use glam::DVec3;
use pliant_deform::{Attachment, ExampleShape, Loose, Method};

use super::entry::{Action, Entry, Reason, Scope, State};
use super::shortcut::Shortcut;
use super::{controls, document, examples, handle, look, object, paint, pose, region, transform, view};
use crate::document::{HandleId, HandleTransform, ObjectAction, PivotPlace, Reach, SmallParts, Tips};
use crate::jobs::Symmetry;
use crate::tool::{BrushMetric, Context, CorrectionBrush, Depth, Gesture, StiffnessBrush, StrokeShape, ToolMode};
use crate::view::{Before, Clay, GizmoMode, GizmoOrientation, NamedView, Orbit, Shading, UpAxis};
use crate::workspace::{RegionAction, StiffnessChange};

/// A command as a menu or the palette lists it.
#[derive(Clone, PartialEq, Debug)]
pub struct Listed {
    /// What is sent.
    pub command: Command,
    /// Its name in a menu.
    pub name: &'static str,
    /// One sentence that says what it does.
    pub tooltip: &'static str,
    /// What else people call it, in lower case: the palette finds it by these words too.
    pub keywords: &'static str,
    /// Keys that send it; the first is shown.
    pub shortcuts: &'static [Shortcut],
}

/// What is asked of the entry of whichever command is at hand, given its values.
trait Asked {
    type Answer;

    fn ask<V: 'static>(self, entry: &Entry<V>, values: V) -> Self::Answer;
}

/// The values that a command carries, as its entry takes them: none, one, or a tuple.
macro_rules! values {
    () => { () };
    ($one:ident) => { $one };
    ($($several:ident)+) => { ($($several),+) };
}

/// Makes the enum of all commands, and the ways from each to its entry and back.
macro_rules! commands {
    ($($(#[$doc:meta])* $variant:ident $(($($value:ident: $kind:ty),+))? = $entry:path;)+) => {
        /// Something to be done, with all it needs to know.
        #[derive(Clone, PartialEq, Debug)]
        pub enum Command {
            $($(#[$doc])* $variant $(($($kind),+))?,)+
        }

        impl Command {
            /// Asks the command's entry.
            fn ask<A: Asked>(self, asked: A) -> A::Answer {
                match self {
                    $(Self::$variant $(($($value),+))? => asked.ask(&$entry, values!($($($value)+)?)),)+
                }
            }

            /// Every command as menus list it, in the order of the table.
            fn list() -> Vec<Listed> {
                let mut list = Vec::new();
                $(for item in $entry.listed {
                    let values!($($($value)+)?) = item.values.clone();
                    list.push(Listed {
                        command: Self::$variant $(($($value),+))?,
                        name: item.name,
                        tooltip: item.tooltip,
                        keywords: item.keywords,
                        shortcuts: item.shortcuts,
                    });
                })+
                list
            }
        }
    };
}

commands! {
    /// Undoes the last step.
    Undo = document::UNDO;
    /// Does the last taken-back step again.
    Redo = document::REDO;
    /// Goes back or forth to the state after so many steps of the history.
    GoToStep(steps: usize) = document::GO_TO_STEP;
    /// Makes the present shape the new rest shape: every handle's transform returns to the identity.
    Apply = document::APPLY;
    /// Takes the rest shape and every handle back to the file's shape.
    ResetShape = document::RESET_SHAPE;
    /// Shows a share (0 to 1) of the whole edit: everything that was moved, at that share of its way from rest.
    SetStrength(share: f64) = document::SET_STRENGTH;
    /// Holds everything still again: no handle, no region.
    ClearRegions = document::CLEAR_REGIONS;
    /// Chooses the method and its options.
    SetMethod(method: Method) = document::SET_METHOD;
    /// Chooses what components that nothing holds do, all of them.
    SetLoose(loose: Loose) = document::SET_LOOSE;
    /// Chooses what one of them does, by its component's number; `None` is what all do.
    SetLoosePart(part: u32, loose: Option<Loose>) = document::SET_LOOSE_PART;
    /// Takes a cage or lattice in place of the one there is.
    BringAttachment(attachment: Attachment) = controls::BRING_ATTACHMENT;
    /// Has the method make its cage or lattice, in place of the document's own.
    MakeControls = controls::MAKE_CONTROLS;
    /// Takes the control points back to where they rest.
    ResetControls = controls::RESET_CONTROLS;
    /// Selects all control points.
    SelectControls = controls::SELECT_CONTROLS;
    /// Lets go of all control points.
    DeselectControls = controls::DESELECT_CONTROLS;
    /// Keeps the present shape as one more example.
    KeepExample = examples::KEEP_EXAMPLE;
    /// Takes a shape as one more example: displacements from the file's shape, per surface vertex.
    AddExample(shape: ExampleShape) = examples::ADD_EXAMPLE;
    /// Sets the weight of an example, by its place in the list; `None` has the solver find it.
    SetExampleWeight(place: usize, weight: Option<f64>) = examples::SET_EXAMPLE_WEIGHT;
    /// Gives an example another name.
    RenameExample(place: usize, name: String) = examples::RENAME_EXAMPLE;
    /// Removes an example.
    RemoveExample(place: usize) = examples::REMOVE_EXAMPLE;
    /// Keeps where handles and control points stand under a name.
    KeepPose = pose::KEEP_POSE;
    /// Puts everything where a pose has it, by its place in the list; locked handles and pins stay.
    TakePose(place: usize) = pose::TAKE_POSE;
    /// Has a pose be what is shown now.
    RenewPose(place: usize) = pose::RENEW_POSE;
    /// Gives a pose another name.
    RenamePose(place: usize, name: String) = pose::RENAME_POSE;
    /// Removes a pose.
    RemovePose(place: usize) = pose::REMOVE_POSE;
    /// Begins to compare what the methods make of the edit, or ends it.
    CompareMethods = document::COMPARE_METHODS;
    /// Stops the jobs that run; what needs them starts them again.
    CancelJobs = document::CANCEL_JOBS;
    /// Chooses what the left button does on the surface.
    SetTool(mode: ToolMode) = paint::SET_TOOL;
    /// How the left button takes vertices.
    SetStrokeShape(shape: StrokeShape) = paint::SET_STROKE_SHAPE;
    /// How the brush measures its radius.
    SetBrushMetric(metric: BrushMetric) = paint::SET_BRUSH_METRIC;
    /// How deep a lasso or a box goes.
    SetDepth(depth: Depth) = paint::SET_DEPTH;
    /// Across which plane both sides are painted at once.
    SetSymmetry(symmetry: Symmetry) = paint::SET_SYMMETRY;
    /// Sets the brush's radius in points, clamped to what the brush allows.
    SetBrushRadius(radius_px: f64) = paint::SET_BRUSH_RADIUS;
    /// Sizes the brush with the pointer.
    SizeBrush = paint::SIZE_BRUSH;
    /// A larger brush.
    GrowBrush = paint::GROW_BRUSH;
    /// A smaller brush.
    ShrinkBrush = paint::SHRINK_BRUSH;
    /// What the correcting brush does, and how far, clamped to what it may be.
    SetCorrection(brush: CorrectionBrush) = paint::SET_CORRECTION;
    /// The stiffness brush's action and numbers, clamped to what they may be.
    SetStiffnessBrush(brush: StiffnessBrush) = paint::SET_STIFFNESS_BRUSH;
    /// Widens the selected handle's reach with the pointer.
    Widen = handle::WIDEN;
    /// What the gizmo offers.
    SetGizmo(mode: GizmoMode) = transform::SET_GIZMO;
    /// Along which axes the gizmo stands.
    SetOrientation(orientation: GizmoOrientation) = transform::SET_ORIENTATION;
    /// The next click on the surface puts the selected handle's pivot there.
    PickPivot = transform::PICK_PIVOT;
    /// Puts a handle's pivot at a point of the present shape. The surface stays as it is.
    SetPivot(id: HandleId, point: DVec3) = transform::SET_PIVOT;
    /// Chooses where a handle's pivot stands. The surface stays as it is.
    SetPivotPlace(id: HandleId, place: PivotPlace) = transform::SET_PIVOT_PLACE;
    /// Splits the selected handle in two across its longest side: a vertex can only be in one.
    DuplicateHandle = handle::DUPLICATE_HANDLE;
    /// Makes the selected handle's mirror image a handle that does the same, across axis 0, 1, 2 for x, y, z.
    MakeTwin(axis: usize) = handle::MAKE_TWIN;
    /// Lets the selected handle and its mirrored twin move separately again.
    Untwin = handle::UNTWIN;
    /// Takes the selected handle's vertices and its region back to the file's shape.
    ResetRegion = handle::RESET_REGION;
    /// The next stroke of the handle brush makes a new handle.
    NewHandle = handle::NEW_HANDLE;
    /// Selects a handle; its gizmo is shown.
    SelectHandle(id: HandleId) = handle::SELECT_HANDLE;
    /// Adds a handle to those that are selected, or takes it from them.
    ToggleSelected(id: HandleId) = handle::TOGGLE_SELECTED;
    /// Selects all handles.
    SelectAll = handle::SELECT_ALL;
    /// Selects the next handle of the list.
    NextHandle = handle::NEXT_HANDLE;
    /// Selects no handle.
    Deselect = handle::DESELECT;
    /// Deletes the selected handle; its vertices are held still.
    DeleteHandle = handle::DELETE_HANDLE;
    /// Starts moving the selected handle with the pointer.
    Move = transform::MOVE;
    /// Starts turning the selected handle with the pointer.
    Turn = transform::TURN;
    /// Starts scaling the selected handle with the pointer.
    Scale = transform::SCALE;
    /// Takes the selected handle back to where it rests.
    ResetHandle = transform::RESET_HANDLE;
    /// Makes the selected handle a pin, which stays where it is, or a pin a handle again.
    PinOrUnpin = handle::PIN;
    /// Names a handle.
    RenameHandle(id: HandleId, name: String) = handle::RENAME_HANDLE;
    /// Gives a handle a colour, sRGB with alpha.
    SetHandleColour(id: HandleId, colour: [u8; 4]) = handle::SET_HANDLE_COLOUR;
    /// Shows or hides a handle's colour and gizmo.
    ToggleHandleVisible(id: HandleId) = handle::TOGGLE_HANDLE_VISIBLE;
    /// Keeps a handle from being moved, painted and deleted, or lets it.
    ToggleHandleLocked(id: HandleId) = handle::TOGGLE_HANDLE_LOCKED;
    /// Puts a handle where the transform says, about the handle's own pivot.
    SetHandleTransform(id: HandleId, transform: HandleTransform) = transform::SET_HANDLE_TRANSFORM;
    /// Turns a handle to these angles about x, y and z in degrees, full turns included.
    SetTurn(id: HandleId, turn_deg: DVec3) = transform::SET_TURN;
    /// How far along the surface a handle takes the surface along.
    SetReach(id: HandleId, reach: Reach) = handle::SET_REACH;
    /// Gives a handle a weight ([`SOFT_RANGE`](crate::SOFT_RANGE)), so that it only pulls; `None` makes it hard.
    SetSoft(id: HandleId, soft: Option<f64>) = handle::SET_SOFT;
    /// With which continuity ([`pliant_deform::CONTINUITY_RANGE`]) the surface joins a handle; `None` is the smoothest.
    SetContinuity(id: HandleId, continuity: Option<f64>) = handle::SET_CONTINUITY;
    /// Changes the region in hand as a whole.
    Region(action: RegionAction) = region::REGION;
    /// Chooses whether the parts that a reach cuts off from the body come along.
    SetTips(tips: Tips) = region::SET_TIPS;
    /// Blurs, sharpens, grows or shrinks what is painted of stiffness.
    ChangeStiffness(change: StiffnessChange) = region::CHANGE_STIFFNESS;
    /// Makes the whole surface equally stiff.
    ClearStiffness = region::CLEAR_STIFFNESS;
    /// Sets the stiffness (0.001 to 1000; 1 is a vertex left alone) of every vertex.
    SetStiffness(field: Vec<f64>) = region::SET_STIFFNESS;
    /// The same with the object under the pointer.
    ObjectHere(action: ObjectAction) = object::OBJECT_HERE;
    /// Hides, shows or locks objects, by their numbers in [`pliant_mesh::Model::all_objects`].
    Objects(action: ObjectAction, objects: Vec<u32>) = object::OBJECTS;
    /// Says which connected parts are small, and whether they are shown and held still.
    SetSmallParts(small: SmallParts) = object::SET_SMALL_PARTS;
    /// Hides small parts, or shows them.
    ToggleSmallShown = object::TOGGLE_SMALL_SHOWN;
    /// Holds small parts still, or lets them bend.
    ToggleSmallLocked = object::TOGGLE_SMALL_LOCKED;
    /// Hides all connected parts but the one under the pointer. Again: shows the others.
    Isolate = object::ISOLATE;
    /// Swaps outside and inside of the parts that face inwards, or of all that is shown.
    TurnInsideOut = object::TURN_INSIDE_OUT;
    /// Shows everything that is hidden.
    ShowEverything = object::SHOW_EVERYTHING;
    /// Frames everything.
    FrameAll = view::FRAME_ALL;
    /// Frames the selected handle and its region.
    FrameSelected = view::FRAME_SELECTED;
    /// Comes close to a connected part, by its component's number.
    FramePart(part: u32) = view::FRAME_PART;
    /// Lights up a connected part, by its component's number, or none.
    LightPart(part: Option<u32>) = view::LIGHT_PART;
    /// Comes close to a place where the shape passes through itself, by its number in
    /// [`Intersections::places`](crate::Intersections::places).
    FrameIntersection(place: usize) = view::FRAME_INTERSECTION;
    /// Comes close to a vertex, by the file's number.
    FrameFileVertex(vertex: u32) = view::FRAME_FILE_VERTEX;
    /// Looks from where one looked before.
    CameraBack = view::CAMERA_BACK;
    /// Looks from where one looked before going back.
    CameraForth = view::CAMERA_FORTH;
    /// Which axis points up on the screen.
    SetUp(up: UpAxis) = view::SET_UP;
    /// Changes between perspective and orthographic.
    ToggleProjection = view::TOGGLE_PROJECTION;
    /// What dragging the view does.
    SetOrbit(orbit: Orbit) = view::SET_ORBIT;
    /// Turns the view by steps of 15 degrees, to the right and down.
    StepView(steps: [i8; 2]) = view::STEP_VIEW;
    /// Looks from the other side.
    TurnAround = view::TURN_AROUND;
    /// Looks from a named side.
    View(side: NamedView) = view::VIEW;
    /// Shades the surface like this clay.
    SetClay(clay: Clay) = look::SET_CLAY;
    /// How the surface is shaded.
    SetShading(shading: Shading) = look::SET_SHADING;
    /// Shows each triangle flat, or normals interpolated.
    ToggleFlat = look::TOGGLE_FLAT;
    /// Marks edges that a closed surface lacks, or not.
    ToggleBorders = look::TOGGLE_BORDERS;
    /// Shows or hides the handles' outlines and the border of what is held.
    ToggleOutlines = look::TOGGLE_OUTLINES;
    /// Shows or hides the ground's grid.
    ToggleGrid = look::TOGGLE_GRID;
    /// Shows or hides the surface's shadow on the ground.
    ToggleShadow = look::TOGGLE_SHADOW;
    /// Shows the file's own shape in place of the present one, or the present one again.
    ToggleOriginal = look::TOGGLE_ORIGINAL;
    /// Shows the file's own shape along with the present one in this way, or no longer.
    ToggleBefore(before: Before) = look::TOGGLE_BEFORE;
    /// Shows the smooth base in place of the surface, or the surface again.
    ToggleBase = look::TOGGLE_BASE;
    /// Shows or hides the regions' colours over clay and material.
    ToggleRegions = look::TOGGLE_REGIONS;
    /// Shows or hides the wireframe.
    ToggleWireframe = look::TOGGLE_WIREFRAME;
}

impl Command {
    /// Every command that menus list, room by room.
    pub fn all_listed() -> impl Iterator<Item = &'static Listed> {
        static LIST: LazyLock<Vec<Listed>> = LazyLock::new(Command::list);
        LIST.iter()
    }

    /// How this command is listed, if it is.
    pub fn listed(&self) -> Option<&'static Listed> {
        Self::all_listed().find(|listed| listed.command == *self)
    }

    /// What it concerns.
    pub(crate) fn scope(&self) -> Scope {
        struct Ask;
        impl Asked for Ask {
            type Answer = Scope;

            fn ask<V: 'static>(self, entry: &Entry<V>, _: V) -> Scope {
                entry.scope
            }
        }
        self.clone().ask(Ask)
    }

    /// Why it can't be done now; `None` where it can.
    pub(crate) fn unavailable(&self, state: &State<'_>) -> Option<Cow<'static, str>> {
        struct Ask<'a>(&'a State<'a>);
        impl Asked for Ask<'_> {
            type Answer = Option<Reason>;

            fn ask<V: 'static>(self, entry: &Entry<V>, values: V) -> Option<Reason> {
                (entry.unavailable)(self.0, &values)
            }
        }
        self.clone().ask(Ask(state))
    }

    /// Does it; the gesture that it begins, if it does.
    pub(crate) fn act(self, context: &mut Context<'_>) -> Option<Box<dyn Gesture>> {
        struct Ask<'a, 'b>(&'a mut Context<'b>);
        impl Asked for Ask<'_, '_> {
            type Answer = Option<Box<dyn Gesture>>;

            fn ask<V: 'static>(self, entry: &Entry<V>, values: V) -> Self::Answer {
                match entry.action {
                    Action::Do(act) => {
                        act(self.0, values);
                        None
                    }
                    Action::Begin(begin) => begin(self.0, values),
                }
            }
        }
        self.ask(Ask(context))
    }
}

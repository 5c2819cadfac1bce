//! The table of commands.

use std::borrow::Cow;
use std::sync::LazyLock;

use glam::DVec3;
use pliant_deform::{Attachment, ExampleShape, Loose, Method};

use super::entry::{Action, Entry, Reason, Scope, State};
use super::shortcut::Shortcut;
use super::{
    animation, controls, curves, document, examples, flow, handle, held_part, look, mesh, new_keys, object, paint,
    pose, region, transform, view, ways,
};
use crate::cut::KeptSide;
use crate::document::{
    FlowOptions, HandleFilter, HandleFootprints, HandleId, HandleMix, HandleTransform, KeyId, ObjectAction, Paint,
    PivotPlace, Reach, SmallParts, Tips,
};
use crate::ease::Ease;
use crate::jobs::Symmetry;
use crate::key_space::KeySpace;
use crate::stitching::{MergeSettings, MeshChange};
use crate::tool::{
    BrushMetric, Context, CorrectionBrush, Depth, FlowBrush, Gesture, StiffnessBrush, StrokeShape, ToolMode,
};
use crate::view::{Before, Clay, GizmoMode, GizmoOrientation, NamedView, Orbit, Shading, Skins, UpAxis};
use crate::workspace::{RegionAction, StiffnessChange};

/// A command in the list of a menu or the palette.
#[derive(Clone, PartialEq, Debug)]
pub struct Listed {
    /// The command to send.
    pub command: Command,
    /// Its name in a menu.
    pub name: &'static str,
    /// One sentence on its effect.
    pub tooltip: &'static str,
    /// Its other names, in lower case, by which the palette also finds it.
    pub keywords: &'static str,
    /// Keys that send it; the first is shown.
    pub shortcuts: &'static [Shortcut],
    /// The name of its group.
    pub group: &'static str,
}

/// The name of the group whose entries are in the module of this path.
fn group_of(entry: &str) -> &'static str {
    let module = entry.split("::").next().unwrap_or(entry).trim();
    match module {
        "document" => "Edit",
        "controls" => "Cage and lattice",
        "examples" => "Examples",
        "pose" => "Poses",
        "animation" | "ways" => "Animation",
        "paint" => "Tools and brush",
        "flow" => "Flow",
        "curves" => "Curves",
        "handle" => "Handles",
        "transform" => "Move, turn and scale",
        "region" => "Regions and stiffness",
        "object" => "Objects and parts",
        "mesh" => "Mesh",
        "view" => "View",
        "look" => "Look",
        _ => "Others",
    }
}

/// A question to the entry of any command, with the command's values.
trait Asked {
    type Answer;

    fn ask<V: 'static>(self, entry: &Entry<V>, values: V) -> Self::Answer;
}

/// The values of a command, as its entry takes them: none, one, or a tuple.
macro_rules! values {
    () => { () };
    ($one:ident) => { $one };
    ($($several:ident)+) => { ($($several),+) };
}

/// Makes the enum of all commands, and the mapping from each to its entry and back.
macro_rules! commands {
    ($($(#[$doc:meta])* $variant:ident $(($($value:ident: $kind:ty),+))? = $entry:path;)+) => {
        /// A command with all its values.
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

            /// Every command in menus, in the order of the table.
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
                        group: group_of(stringify!($entry)),
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
    /// Redoes the last undone step.
    Redo = document::REDO;
    /// Goes back or forth to the state after this many steps of the history.
    GoToStep(steps: usize) = document::GO_TO_STEP;
    /// Makes the present shape the new rest shape: every handle's transform returns to the identity.
    Apply = document::APPLY;
    /// Takes the rest shape and every handle back to the file's shape.
    ResetShape = document::RESET_SHAPE;
    /// Shows a share (0 to 1) of the whole edit: everything that was moved, at that share of its displacement from
    /// rest.
    SetStrength(share: f64) = document::SET_STRENGTH;
    /// Fixes everything again: no handle, no region.
    ClearRegions = document::CLEAR_REGIONS;
    /// Chooses the method and its options.
    SetMethod(method: Method) = document::SET_METHOD;
    /// Chooses the behaviour of all components that nothing holds.
    SetLoose(loose: Loose) = document::SET_LOOSE;
    /// Chooses the behaviour of one of them, by its component's number; `None` is the behaviour of all.
    SetLoosePart(part: u32, loose: Option<Loose>) = document::SET_LOOSE_PART;
    /// Replaces the present cage or lattice.
    BringAttachment(attachment: Attachment) = controls::BRING_ATTACHMENT;
    /// Makes the method's own cage or lattice replace the document's.
    MakeControls = controls::MAKE_CONTROLS;
    /// Takes the control points back to their rest positions.
    ResetControls = controls::RESET_CONTROLS;
    /// Selects all control points.
    SelectControls = controls::SELECT_CONTROLS;
    /// Deselects all control points.
    DeselectControls = controls::DESELECT_CONTROLS;
    /// Keeps the present shape as a further example.
    KeepExample = examples::KEEP_EXAMPLE;
    /// Adds a shape as a further example: displacements from the file's shape, per surface vertex.
    AddExample(shape: ExampleShape) = examples::ADD_EXAMPLE;
    /// Sets the weight of an example, by its place in the list; with `None` the solver finds it.
    SetExampleWeight(place: usize, weight: Option<f64>) = examples::SET_EXAMPLE_WEIGHT;
    /// Renames an example.
    RenameExample(place: usize, name: String) = examples::RENAME_EXAMPLE;
    /// Removes an example.
    RemoveExample(place: usize) = examples::REMOVE_EXAMPLE;
    /// Keeps the positions of handles and control points under a name.
    KeepPose = pose::KEEP_POSE;
    /// Moves everything to a pose, by its place in the list; locked handles and pins stay.
    TakePose(place: usize) = pose::TAKE_POSE;
    /// Replaces a pose by the shown state.
    RenewPose(place: usize) = pose::RENEW_POSE;
    /// Renames a pose.
    RenamePose(place: usize, name: String) = pose::RENAME_POSE;
    /// Removes a pose.
    RemovePose(place: usize) = pose::REMOVE_POSE;
    /// Begins a temporary pose for work on hidden places, or returns from it.
    WorkPose = pose::WORK_POSE;
    /// Shows or hides the timeline.
    ToggleTimeline = animation::TOGGLE_TIMELINE;
    /// Shows or hides ghosts of the moments around the shown one.
    ToggleSkins = animation::TOGGLE_SKINS;
    /// Chooses these ghosts.
    SetSkins(skins: Skins) = animation::SET_SKINS;
    /// Shows or hides the path of a sequence's body.
    TogglePath = ways::TOGGLE_PATH;
    /// Moves a sequence's body at a frame, by a way in world units. The first such frame brings both ends of the sequence,
    /// at which the body stays.
    BendPath(frame: usize, shift: DVec3) = ways::BEND_PATH;
    /// No longer moves a sequence's body at a frame.
    FreePath(frame: usize) = ways::FREE_PATH;
    /// Filters a handle's way through a sequence, or no longer.
    SetFilter(handle: HandleId, filter: Option<HandleFilter>) = ways::SET_FILTER;
    /// Holds a handle of a sequence wherever it rests on the ground, or no longer.
    SetFootprints(handle: HandleId, footprints: Option<HandleFootprints>) = ways::SET_FOOTPRINTS;
    /// Lets another sequence lead handles, or none.
    SetMix(mix: Option<HandleMix>) = ways::SET_MIX;
    /// Sets a key of every handle at the shown moment.
    KeyHere = new_keys::KEY_HERE;
    /// Sets a key of the selected handles at the shown moment.
    KeySelected = new_keys::KEY_SELECTED;
    /// Sets a key of the strength alone at the shown moment.
    KeyStrength = new_keys::KEY_STRENGTH;
    /// Sets a key of the weights of examples alone at the shown moment.
    KeyWeights = new_keys::KEY_WEIGHTS;
    /// Sets a key at the shown moment from a pose, by its place in the list, and shows it.
    KeyPose(place: usize) = new_keys::KEY_POSE;
    /// Shows a moment, in seconds.
    GoToTime(time: f64) = animation::GO_TO_TIME;
    /// Shows the moment so many frames later.
    StepFrames(frames: i32) = animation::STEP_FRAMES;
    /// Shows the moment of the next key, or (false) of the last one before.
    GoToKey(is_forward: bool) = animation::GO_TO_KEY;
    /// Plays the animation over and over, or pauses.
    PlayKeys = animation::PLAY_KEYS;
    /// Selects these keys and no others.
    SelectKeys(ids: Vec<KeyId>) = animation::SELECT_KEYS;
    /// Selects every key.
    SelectAllKeys = animation::SELECT_ALL_KEYS;
    /// Moves the selected keys by a time in seconds; none goes below 0.
    MoveKeys(by: f64) = animation::MOVE_KEYS;
    /// Stretches the times of the selected keys by a factor above 0, about the first of them.
    StretchKeys(factor: f64) = animation::STRETCH_KEYS;
    /// Deletes the selected keys.
    DeleteKeys = animation::DELETE_KEYS;
    /// Copies the selected keys.
    CopyKeys = animation::COPY_KEYS;
    /// Pastes the copied keys, the first of them at the shown moment.
    PasteKeys = animation::PASTE_KEYS;
    /// Gives the selected keys another way to the next.
    SetKeyEase(ease: Ease) = animation::SET_KEY_EASE;
    /// Chooses the axes in which the selected keys of a sequence stay the same.
    SetKeySpace(space: KeySpace) = animation::SET_KEY_SPACE;
    /// Changes the first and the last frame over which a key of a sequence spreads, with all keys of its span.
    SetSpan(id: KeyId, ends: [usize; 2]) = animation::SET_SPAN;
    /// Chooses the number of frames a second.
    SetFps(fps: f64) = animation::SET_FPS;
    /// Begins or ends a comparison of the methods on the edit.
    CompareMethods = document::COMPARE_METHODS;
    /// Shows a method large during a comparison, by its number; with `None` all are small.
    EnlargeMethod(number: Option<usize>) = document::ENLARGE_METHOD;
    /// Stops the running jobs; anything that needs them starts them again.
    CancelJobs = document::CANCEL_JOBS;
    /// Chooses the left button's tool on the surface.
    SetTool(mode: ToolMode) = paint::SET_TOOL;
    /// The shape in which the left button selects vertices.
    SetStrokeShape(shape: StrokeShape) = paint::SET_STROKE_SHAPE;
    /// The measure of the brush's radius.
    SetBrushMetric(metric: BrushMetric) = paint::SET_BRUSH_METRIC;
    /// The depth of a lasso or a box.
    SetDepth(depth: Depth) = paint::SET_DEPTH;
    /// The plane across which both sides are painted at once.
    SetSymmetry(symmetry: Symmetry) = paint::SET_SYMMETRY;
    /// Sets the brush's radius in points, clamped to the brush's range.
    SetBrushRadius(radius_px: f64) = paint::SET_BRUSH_RADIUS;
    /// Sizes the brush with the pointer.
    SizeBrush = paint::SIZE_BRUSH;
    /// A larger brush.
    GrowBrush = paint::GROW_BRUSH;
    /// A smaller brush.
    ShrinkBrush = paint::SHRINK_BRUSH;
    /// The action and the numbers of the correcting brush, clamped to their ranges.
    SetCorrection(brush: CorrectionBrush) = paint::SET_CORRECTION;
    /// The stiffness brush's action and numbers, clamped to their ranges.
    SetStiffnessBrush(brush: StiffnessBrush) = paint::SET_STIFFNESS_BRUSH;
    /// Lets the dye flow along the surface, or pauses it.
    PlayFlow = flow::PLAY_FLOW;
    /// Pauses the flow if it plays.
    PauseFlow = flow::PAUSE_FLOW;
    /// Lets the dye flow for one step.
    StepFlow = flow::STEP_FLOW;
    /// Makes the dye vertex colours, which are saved with the model.
    KeepDye = flow::KEEP_DYE;
    /// Removes the dye that flows, and stops the fluid.
    ClearDye = flow::CLEAR_DYE;
    /// Removes the vertex colours that were kept from the dye.
    RemoveKeptDye = flow::REMOVE_KEPT_DYE;
    /// Chooses the forces in the flow.
    SetFlowOptions(options: FlowOptions) = flow::SET_FLOW_OPTIONS;
    /// The flow brush's action, colour and numbers, clamped to their ranges.
    SetFlowBrush(brush: FlowBrush) = flow::SET_FLOW_BRUSH;
    /// Lets the points of curves follow a dragged one at their distances, or no longer.
    ToggleChain = curves::TOGGLE_CHAIN;
    /// Lets a drag of the pose brush bend a limb at all its joints, or at one.
    ToggleWholeLimb = curves::TOGGLE_WHOLE_LIMB;
    /// Adds points to the selected handle's curve: after each selected one, or between all.
    DivideCurve = curves::DIVIDE_CURVE;
    /// Removes the selected points of the selected handle's curve.
    RemoveCurvePoints = curves::REMOVE_CURVE_POINTS;
    /// Pins the selected points of the selected handle's curve, or unpins them.
    PinCurvePoints = curves::PIN_CURVE_POINTS;
    /// Sets the least and the most bend at the selected points of the curve, in degrees from 0 to 180.
    SetBendRange(range_deg: [f64; 2]) = curves::SET_BEND_RANGE;
    /// Makes the crease along the selected handle's curve sharper than at rest, or flatter: -1 is flat, 1 twice as sharp.
    SharpenCrease(sharpen: f64) = curves::SHARPEN_CREASE;
    /// Sets the width of that crease, in world units: the distance from the curve up to which the surface changes.
    SetCreaseWidth(width: f64) = curves::SET_CREASE_WIDTH;
    /// Widens the selected handle's reach with the pointer.
    Widen = handle::WIDEN;
    /// The gizmo's mode.
    SetGizmo(mode: GizmoMode) = transform::SET_GIZMO;
    /// The axes of the gizmo.
    SetOrientation(orientation: GizmoOrientation) = transform::SET_ORIENTATION;
    /// The next click on the surface moves the selected handle's pivot there.
    PickPivot = transform::PICK_PIVOT;
    /// Moves a handle's pivot to a point of the present shape. The surface does not change.
    SetPivot(id: HandleId, point: DVec3) = transform::SET_PIVOT;
    /// Chooses the place of a handle's pivot. The surface does not change.
    SetPivotPlace(id: HandleId, place: PivotPlace) = transform::SET_PIVOT_PLACE;
    /// Splits the selected handle in two across its longest side; a vertex can only be in one handle.
    DuplicateHandle = handle::DUPLICATE_HANDLE;
    /// Makes the selected handle's mirror image a handle with the mirrored motion, across axis 0, 1, 2 for x, y, z.
    MakeTwin(axis: usize) = handle::MAKE_TWIN;
    /// Lets the selected handle and its mirrored twin move separately again.
    Untwin = handle::UNTWIN;
    /// Takes the selected handle's vertices and its region back to the file's shape.
    ResetRegion = handle::RESET_REGION;
    /// The next stroke of the handle brush makes a new handle.
    NewHandle = handle::NEW_HANDLE;
    /// Selects a handle; its gizmo is shown.
    SelectHandle(id: HandleId) = handle::SELECT_HANDLE;
    /// Adds a handle to the selected ones, or removes it from them.
    ToggleSelected(id: HandleId) = handle::TOGGLE_SELECTED;
    /// Selects all handles.
    SelectAll = handle::SELECT_ALL;
    /// Selects the next handle of the list.
    NextHandle = handle::NEXT_HANDLE;
    /// Selects no handle.
    Deselect = handle::DESELECT;
    /// Deletes the selected handle; its vertices become fixed.
    DeleteHandle = handle::DELETE_HANDLE;
    /// Starts moving the selected handle with the pointer.
    Move = transform::MOVE;
    /// Starts turning the selected handle with the pointer.
    Turn = transform::TURN;
    /// Starts scaling the selected handle with the pointer.
    Scale = transform::SCALE;
    /// Takes the selected handle back to its rest position.
    ResetHandle = transform::RESET_HANDLE;
    /// Pins the selected handle, or unpins it.
    PinOrUnpin = handle::PIN;
    /// Frees the selected handle along the direction of sight, or holds it there again.
    FreeOrHoldDepth = handle::FREE_OR_HOLD_DEPTH;
    /// Names a handle.
    RenameHandle(id: HandleId, name: String) = handle::RENAME_HANDLE;
    /// Gives a handle a colour, sRGB with alpha.
    SetHandleColour(id: HandleId, colour: [u8; 4]) = handle::SET_HANDLE_COLOUR;
    /// Shows or hides a handle's colour and gizmo.
    ToggleHandleVisible(id: HandleId) = handle::TOGGLE_HANDLE_VISIBLE;
    /// Locks a handle against being moved, painted and deleted, or unlocks it.
    ToggleHandleLocked(id: HandleId) = handle::TOGGLE_HANDLE_LOCKED;
    /// Sets a handle's transform, about its own pivot.
    SetHandleTransform(id: HandleId, transform: HandleTransform) = transform::SET_HANDLE_TRANSFORM;
    /// Turns a handle to these angles about x, y and z in degrees, full turns included.
    SetTurn(id: HandleId, turn_deg: DVec3) = transform::SET_TURN;
    /// The distance along the surface within which a handle moves the surface.
    SetReach(id: HandleId, reach: Reach) = handle::SET_REACH;
    /// Gives a handle a weight ([`SOFT_RANGE`](crate::SOFT_RANGE)), so that it only pulls; `None` makes it hard.
    SetSoft(id: HandleId, soft: Option<f64>) = handle::SET_SOFT;
    /// The continuity ([`pliant_deform::CONTINUITY_RANGE`]) with which the surface joins a handle; `None` is the
    /// smoothest.
    SetContinuity(id: HandleId, continuity: Option<f64>) = handle::SET_CONTINUITY;
    /// Chooses the handle with which a handle rides along; one of its own descendants is refused.
    SetParent(id: HandleId, parent: Option<HandleId>) = handle::SET_PARENT;
    /// Changes the selected region as a whole.
    Region(action: RegionAction) = region::REGION;
    /// Changes the region of a role as a whole, whichever is selected.
    RegionOf(role: Paint, action: RegionAction) = region::REGION_OF;
    /// Chooses whether the parts that a reach cuts off from the body are free.
    SetTips(tips: Tips) = region::SET_TIPS;
    /// Blurs, sharpens, grows or shrinks the painted stiffness.
    ChangeStiffness(change: StiffnessChange) = region::CHANGE_STIFFNESS;
    /// Makes the stiffness of the whole surface even.
    ClearStiffness = region::CLEAR_STIFFNESS;
    /// Sets the stiffness (0.001 to 1000; 1 is that of an unpainted vertex) of every vertex.
    SetStiffness(field: Vec<f64>) = region::SET_STIFFNESS;
    /// The same with the object under the pointer.
    ObjectHere(action: ObjectAction) = object::OBJECT_HERE;
    /// Hides, shows or locks objects, by their numbers in [`pliant_mesh::Model::all_objects`].
    Objects(action: ObjectAction, objects: Vec<u32>) = object::OBJECTS;
    /// Sets the size below which connected parts are small, and whether they are shown and fixed.
    SetSmallParts(small: SmallParts) = object::SET_SMALL_PARTS;
    /// Hides small parts, or shows them.
    ToggleSmallShown = object::TOGGLE_SMALL_SHOWN;
    /// Fixes small parts, or lets them bend.
    ToggleSmallLocked = object::TOGGLE_SMALL_LOCKED;
    /// Hides all connected parts except the one under the pointer, or shows the others again.
    Isolate = object::ISOLATE;
    /// Swaps outside and inside of the parts that face inwards, or of all shown parts.
    TurnInsideOut = object::TURN_INSIDE_OUT;
    /// Shows everything hidden.
    ShowEverything = object::SHOW_EVERYTHING;
    /// Fills every hole.
    FillHoles = mesh::FILL_HOLES;
    /// Fills the hole whose rim the next click takes.
    FillHole = mesh::FILL_HOLE;
    /// Joins the two borders that the next clicks take by a tube.
    BridgeBorders = mesh::BRIDGE;
    /// Deletes the vertices with the paint of the selected handle or region.
    DeleteRegion = mesh::DELETE_REGION;
    /// Cuts along the line that the next drag draws; the positive side is to its left, seen along it.
    CutAlongLine(kept: KeptSide) = mesh::CUT;
    /// Cuts along the curve on the surface that the next drag draws; the positive side is to its left, seen along it.
    CutAlongCurve(kept: KeptSide) = mesh::CUT_ALONG_CURVE;
    /// Mirrors the part that the selected handle holds, across axis 0, 1, 2 of the handle for x, y, z.
    MirrorPart(axis: usize) = held_part::MIRROR_PART;
    /// Joins the part that the selected handle holds to the others, at the nearest borders.
    Merge = held_part::MERGE;
    /// Joins the part that the selected handle holds to the others, at pairs of places that the next clicks take.
    MergePairs = held_part::MERGE_PAIRS;
    /// Chooses how parts are merged; the reach is clamped to [`REACH_RANGE`](crate::REACH_RANGE).
    SetMerge(settings: MergeSettings) = held_part::SET_MERGE;
    /// Changes the mesh.
    ChangeMesh(change: MeshChange) = mesh::CHANGE_MESH;
    /// Frames everything.
    FrameAll = view::FRAME_ALL;
    /// Frames the selected handle and its region.
    FrameSelected = view::FRAME_SELECTED;
    /// Frames a connected part, by its component's number.
    FramePart(part: u32) = view::FRAME_PART;
    /// Frames the connected part under the pointer.
    FramePartHere = view::FRAME_PART_HERE;
    /// Highlights a connected part, by its component's number, or none.
    LightPart(part: Option<u32>) = view::LIGHT_PART;
    /// Frames a place where the shape passes through itself, by its number in
    /// [`Intersections::places`](crate::Intersections::places).
    FrameIntersection(place: usize) = view::FRAME_INTERSECTION;
    /// Frames a vertex, by the file's number.
    FrameFileVertex(vertex: u32) = view::FRAME_FILE_VERTEX;
    /// Goes back to the last view.
    CameraBack = view::CAMERA_BACK;
    /// Goes forth to the view before going back.
    CameraForth = view::CAMERA_FORTH;
    /// The axis that points up on the screen.
    SetUp(up: UpAxis) = view::SET_UP;
    /// Changes between perspective and orthographic.
    ToggleProjection = view::TOGGLE_PROJECTION;
    /// The effect of dragging the view.
    SetOrbit(orbit: Orbit) = view::SET_ORBIT;
    /// Turns the view by steps of 15 degrees, to the right and down.
    StepView(steps: [i8; 2]) = view::STEP_VIEW;
    /// Looks from the opposite side.
    TurnAround = view::TURN_AROUND;
    /// Looks from a named side.
    View(side: NamedView) = view::VIEW;
    /// Shades the surface like this clay.
    SetClay(clay: Clay) = look::SET_CLAY;
    /// The shading of the surface.
    SetShading(shading: Shading) = look::SET_SHADING;
    /// Shades each triangle flat, or with interpolated normals.
    ToggleFlat = look::TOGGLE_FLAT;
    /// Marks edges that a closed surface does not have, or stops marking them.
    ToggleBorders = look::TOGGLE_BORDERS;
    /// Shows or hides the handles' outlines and the border of the fixed part.
    ToggleOutlines = look::TOGGLE_OUTLINES;
    /// Shows or hides the ground's grid.
    ToggleGrid = look::TOGGLE_GRID;
    /// Shows or hides the surface's shadow on the ground.
    ToggleShadow = look::TOGGLE_SHADOW;
    /// Shows the file's own shape instead of the present one, or the present one again.
    ToggleOriginal = look::TOGGLE_ORIGINAL;
    /// Shows the file's own shape together with the present one in this way, or stops showing it.
    ToggleBefore(before: Before) = look::TOGGLE_BEFORE;
    /// Shows the smooth base instead of the surface, or the surface again.
    ToggleBase = look::TOGGLE_BASE;
    /// Shows or hides the regions' colours over clay and material.
    ToggleRegions = look::TOGGLE_REGIONS;
    /// Shows or hides the wireframe.
    ToggleWireframe = look::TOGGLE_WIREFRAME;
}

impl Command {
    /// Every command in menus, group by group.
    pub fn all_listed() -> impl Iterator<Item = &'static Listed> {
        static LIST: LazyLock<Vec<Listed>> = LazyLock::new(Command::list);
        LIST.iter()
    }

    /// Its form in menus, if it has one.
    pub fn listed(&self) -> Option<&'static Listed> {
        Self::all_listed().find(|listed| listed.command == *self)
    }

    /// Its scope.
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

    /// The reason why it can't be executed now; `None` if it can.
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

    /// Executes it; returns the gesture that it begins, if it does.
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

//! Commands on the left button's tool and its brush.

use super::entry::{Action, Entry, Scope, alt, always, character, item, shift, unless, when_open};
use crate::jobs::Symmetry;
use crate::tool::{BrushMetric, CorrectionBrush, Depth, SizeBrush, StiffnessBrush, StrokeShape, ToolMode};
use crate::workspace::set_symmetry;

/// The factor by which a key sizes the brush.
const BRUSH_STEP: f64 = 1.2;

/// Chooses the left button's tool on the surface.
pub(super) const SET_TOOL: Entry<ToolMode> = Entry {
    listed: &[
        item(
            ToolMode::PaintHandle,
            "Paint handle",
            "Paints a handle, the part that you move. A drag on the painted handle moves it, and the region around it follows.",
            "brush control",
            &[character('1')],
        ),
        item(
            ToolMode::PaintFree,
            "Paint region",
            "Paints the part that may bend along with the handles.",
            "brush free roi region of influence",
            &[character('2')],
        ),
        item(
            ToolMode::PaintFixed,
            "Paint fixed",
            "Paints the part that stays fixed.",
            "brush pin anchor hold",
            &[character('3')],
        ),
        item(
            ToolMode::Erase,
            "Erase",
            "Removes paint.",
            "unpaint rubber",
            &[character('4')],
        ),
        item(
            ToolMode::Select,
            "Select",
            "Click a handle to select it; drag it to move it in the plane of the screen. Shows a cage or lattice, and moves its points.",
            "pick cursor arrow",
            &[character('5')],
        ),
        item(
            ToolMode::PaintStiffness,
            "Paint stiffness",
            "Paints how firmly the surface keeps its shape.",
            "brush rigidity material",
            &[character('6')],
        ),
        item(
            ToolMode::Pose,
            "Pose",
            "Turns the limb that you drag about its joint. Ctrl twists it, Shift scales it. Ctrl and the wheel choose \
             another joint.",
            "bend limb arm leg joint rotate brush",
            &[character('7')],
        ),
        item(
            ToolMode::Correct,
            "Correct",
            "Smooths, relaxes or grabs the shape by hand, for example where a bend leaves a crease.",
            "sculpt brush armpit crease smooth relax grab",
            &[character('8')],
        ),
        item(
            ToolMode::Flow,
            "Flow",
            "Pours colour that flows along the surface, and pushes it with the stroke. Space plays and pauses.",
            "fluid dye paint ink rust marble liquid vertex color",
            &[character('9')],
        ),
    ],
    scope: Scope::Tool,
    unavailable: always,
    action: Action::Do(|context, mode| {
        // A press belongs to the new tool.
        context.settings.want_nothing();
        context.settings.mode = mode;
    }),
};

/// The shape in which the left button selects vertices.
pub(super) const SET_STROKE_SHAPE: Entry<StrokeShape> = Entry {
    listed: &[
        item(
            StrokeShape::Brush,
            "Brush",
            "Paints with a round brush.",
            "",
            &[character('b')],
        ),
        item(
            StrokeShape::Lasso,
            "Lasso",
            "Paints everything inside a line that you draw.",
            "freehand select",
            &[character('l')],
        ),
        item(
            StrokeShape::Box,
            "Box",
            "Paints everything inside a box.",
            "rectangle border select",
            &[character('k')],
        ),
        item(
            StrokeShape::Component,
            "Whole part",
            "Paints the connected part that you click.",
            "component connected linked",
            &[character('j')],
        ),
        item(
            StrokeShape::Curve,
            "Curve",
            "Draws a curve on the surface, which a new handle follows. Drag its points to bend it.",
            "line spline sketch",
            &[],
        ),
        item(
            StrokeShape::Spine,
            "Spine",
            "Draws a curve through the middle of a limb, which the limb follows. Drag its end to pose the limb.",
            "line skeleton chain bone spline ik",
            &[],
        ),
        item(
            StrokeShape::Crease,
            "Crease",
            "Finds the crease or border along which you draw: a new handle follows it, and it can be sharpened or flattened.",
            "feature line edge ridge valley wrinkle border rim sharpen flatten",
            &[],
        ),
        item(
            StrokeShape::Sketch,
            "Sketch",
            "Draws the outline that you see anew: draw beside a nose or a back, and it follows the line.",
            "line profile silhouette outline contour",
            &[],
        ),
    ],
    scope: Scope::Tool,
    unavailable: always,
    action: Action::Do(|context, shape| {
        let settings = &mut *context.settings;
        settings.stroke_shape = shape;
        // A box or a lasso selects the points of a cage that is shown.
        let selects_points =
            matches!(shape, StrokeShape::Lasso | StrokeShape::Box) && context.workspace.shown_controls().is_some();
        if shape.is_line() || (settings.mode == ToolMode::Select && !selects_points) {
            settings.mode = ToolMode::PaintHandle;
        }
        if shape.is_line() {
            settings.chain = shape == StrokeShape::Spine;
            // Another curve, not more of the selected handle.
            context.workspace.controls.put([]);
        }
    }),
};

/// The measure of the brush's radius.
pub(super) const SET_BRUSH_METRIC: Entry<BrushMetric> = Entry {
    listed: &[
        item(
            BrushMetric::Screen,
            "Brush visible",
            "Sets the brush to paint everything under it that faces you.",
            "screen",
            &[],
        ),
        item(
            BrushMetric::Round,
            "Brush round limbs",
            "Sets the brush to close round limbs that are thinner than it, and to fill folds.",
            "closed back fill",
            &[],
        ),
        item(
            BrushMetric::Surface,
            "Brush along surface",
            "Sets the brush to paint everything within its radius along the surface, into folds and around edges, \
             visible or not.",
            "geodesic",
            &[],
        ),
        item(
            BrushMetric::Through,
            "Brush through",
            "Sets the brush to paint everything under it, through to the back of the model.",
            "x-ray occluded",
            &[],
        ),
    ],
    scope: Scope::View,
    unavailable: always,
    action: Action::Do(|context, metric| context.settings.set_brush_metric(metric)),
};

/// The depth of a lasso or a box.
pub(super) const SET_DEPTH: Entry<Depth> = Entry {
    listed: &[
        item(
            Depth::Visible,
            "Lasso visible",
            "Sets the lasso and the box to paint only the visible surface.",
            "",
            &[],
        ),
        item(
            Depth::Through,
            "Lasso through",
            "Sets the lasso and the box to paint everything inside, through to the back of the model.",
            "",
            &[],
        ),
    ],
    scope: Scope::View,
    unavailable: always,
    action: Action::Do(|context, depth| context.settings.depth = depth),
};

/// The plane across which both sides are painted at once.
pub(super) const SET_SYMMETRY: Entry<Symmetry> = Entry {
    listed: &[
        item(
            Symmetry::Found,
            "Symmetry",
            "Paints and poses both sides at once, across the shape's own plane of symmetry.",
            "mirror both sides left right",
            &[shift('x')],
        ),
        item(
            Symmetry::Axis(0),
            "Symmetry across x",
            "Paints and poses left and right at once.",
            "mirror both sides",
            &[],
        ),
        item(
            Symmetry::Axis(1),
            "Symmetry across y",
            "Paints and poses above and below at once.",
            "mirror both sides",
            &[],
        ),
        item(
            Symmetry::Axis(2),
            "Symmetry across z",
            "Paints and poses front and back at once.",
            "mirror both sides",
            &[],
        ),
        item(
            Symmetry::None,
            "No symmetry",
            "Paints and poses one side at a time.",
            "mirror one side",
            &[alt('x')],
        ),
    ],
    scope: Scope::Tool,
    unavailable: when_open,
    action: Action::Do(|context, symmetry| set_symmetry(context.workspace, symmetry)),
};

/// Sets the brush's radius in points, clamped to the brush's range.
pub(super) const SET_BRUSH_RADIUS: Entry<f64> = Entry {
    listed: &[],
    scope: Scope::View,
    unavailable: always,
    action: Action::Do(|context, radius_px| context.settings.set_brush_radius(radius_px)),
};

/// A larger brush.
pub(super) const GROW_BRUSH: Entry<()> = Entry {
    listed: &[item(
        (),
        "Larger brush",
        "Makes the brush larger.",
        "radius size",
        &[character(']')],
    )],
    scope: Scope::View,
    unavailable: always,
    action: Action::Do(|context, ()| {
        context
            .settings
            .set_brush_radius(context.settings.brush().radius_px * BRUSH_STEP)
    }),
};

/// A smaller brush.
pub(super) const SHRINK_BRUSH: Entry<()> = Entry {
    listed: &[item(
        (),
        "Smaller brush",
        "Makes the brush smaller.",
        "radius size",
        &[character('[')],
    )],
    scope: Scope::View,
    unavailable: always,
    action: Action::Do(|context, ()| {
        context
            .settings
            .set_brush_radius(context.settings.brush().radius_px / BRUSH_STEP)
    }),
};

/// Sizes the brush with the pointer.
pub(super) const SIZE_BRUSH: Entry<()> = Entry {
    listed: &[item(
        (),
        "Size brush",
        "Sets the size of the brush with the pointer, as Ctrl and the wheel do.",
        "radius larger smaller",
        &[character('f')],
    )],
    scope: Scope::Gesture,
    unavailable: |state, ()| {
        let why = "This tool has no brush: choose a tool that paints.";
        unless(state.settings.mode.has_brush(), why)
    },
    action: Action::Begin(|context, ()| {
        let pointer_px = context.pointer.map(|pointer| pointer.position_px);
        let pointer_px = pointer_px.unwrap_or(context.view.viewport_px() * 0.5);
        Some(Box::new(SizeBrush::begin(context.settings, pointer_px)))
    }),
};

/// The action and the numbers of the correcting brush, clamped to their ranges.
pub(super) const SET_CORRECTION: Entry<CorrectionBrush> = Entry {
    listed: &[],
    scope: Scope::View,
    unavailable: always,
    action: Action::Do(|context, brush| {
        if let Some(brush) = brush.clamped() {
            context.settings.correction_brush = brush;
        }
    }),
};

/// The stiffness brush's action and numbers, clamped to their ranges.
pub(super) const SET_STIFFNESS_BRUSH: Entry<StiffnessBrush> = Entry {
    listed: &[],
    scope: Scope::View,
    unavailable: always,
    action: Action::Do(|context, brush| {
        if let Some(brush) = brush.clamped() {
            context.settings.stiffness_brush = brush;
        }
    }),
};

//! The status line: the program's activity, and the next possible actions.

use crate::jobs::{Activity, JobKind};
use crate::region::Counts;
use crate::tool::{Gesture, Overlay, PointedRim, RimUse, StrokeShape, ToolMode, ToolSettings, cut_hint};
use crate::view::View;
use crate::workspace::{Workspace, selected_curve};

/// The whole line.
pub(crate) fn status(
    gesture: Option<&dyn Gesture>,
    workspace: &Workspace,
    view: &View,
    settings: &ToolSettings,
    overlay: &Overlay,
) -> String {
    let Some(model) = workspace.model() else {
        return "Open a mesh, or drop one here".to_owned();
    };
    if model.surface.positions.is_empty() {
        return "This file has no triangle and no point: open another file".to_owned();
    }
    if let Err(refused) = workspace.document.method().check_bends(&model.surface) {
        return format!("This file has only points: {refused}");
    }
    let now = gesture.and_then(|gesture| gesture.status(workspace, view));
    let now = now.or_else(|| {
        let hint = rim_hint(settings.wants_rim?, overlay.rim.as_ref());
        Some(match settings.pair_numbers(workspace).len() {
            0 => hint,
            1 => format!("{hint}; Ctrl+Z takes the last place back"),
            _ => format!("{hint}; Enter joins at the pairs, Ctrl+Z takes the last place back"),
        })
    });
    let now = now.or_else(|| settings.wants_cut.map(cut_hint));
    let now = now.or_else(|| {
        let frame = overlay.pointed_frame?;
        let path = workspace.document.animation().path();
        Some(match path.is_some_and(|path| path.has(frame)) {
            true => format!("The path at frame {frame}: drag it, or remove this point with Ctrl and a click"),
            false => format!("The path at frame {frame}: drag it to bend the way of the whole body"),
        })
    });
    let now = now.unwrap_or_else(|| hint(workspace, settings));
    let is_dragging = gesture.is_some_and(|gesture| gesture.activity() == Activity::Dragging);
    let parts = [
        working(workspace, is_dragging),
        descent(workspace),
        crossing(workspace),
        Some(now),
    ];
    parts.into_iter().flatten().collect::<Vec<_>>().join(" · ")
}

/// The rim under the pointer, and the effect of a click.
fn rim_hint(wanted: RimUse, rim: Option<&PointedRim>) -> String {
    let effect = match wanted {
        RimUse::Fill => "fills it",
        RimUse::Bridge { first: None } => "begins the bridge there",
        RimUse::Bridge { first: Some(_) } => "leads the bridge there",
        RimUse::Merge { first: None } => "begins a pair there",
        RimUse::Merge { first: Some(_) } => "ends the pair there",
    };
    match rim {
        Some(rim) => format!(
            "A rim of {} edges, {:.4} long: a click {effect}",
            thousands(rim.edges()),
            rim.length
        ),
        None => match wanted {
            RimUse::Fill => "Click near the rim of a hole",
            RimUse::Bridge { first: None } => "Click near the first of two rims",
            RimUse::Bridge { first: Some(_) } => "Click near the second rim",
            RimUse::Merge { first: None } => "Click a place of a border, Enter to join",
            RimUse::Merge { first: Some(_) } => "Click the place of the other border that belongs to it",
        }
        .to_owned(),
    }
}

/// The progress of the shape's descent, if its method is iterative.
fn descent(workspace: &Workspace) -> Option<String> {
    let document = &workspace.document;
    let descent = workspace.descent.filter(|_| document.is_displaced())?;
    let said = match document.is_settled() {
        false => "Settling",
        true if descent.converged => "Settled",
        true if descent.finished => "Stopped at the step limit",
        true => return None,
    };
    Some(said.to_owned())
}

/// A note that bending has put the surface through itself; the panel says more, but may be scrolled away.
fn crossing(workspace: &Workspace) -> Option<String> {
    let found = workspace.intersections()?;
    (!found.is_empty()).then(|| "The shape passes through itself".to_owned())
}

/// The possible actions without an active gesture, and the number of vertices of each role.
fn hint(workspace: &Workspace, settings: &ToolSettings) -> String {
    let document = &workspace.document;
    let is_sketching = settings.mode == ToolMode::PaintHandle && settings.stroke_shape == StrokeShape::Sketch;
    let hint = if settings.mode == ToolMode::Flow {
        let fluid = document.fluid();
        match workspace.flow.is_playing() {
            true => "Pour and push, or press Space to pause",
            false if fluid.kept.is_some() && fluid.dye.is_none() => {
                "The kept colours are saved with the model, as vertex colours; pour on, and press Space to play"
            }
            false => "Pour and push, and press Space to play; Ctrl washes, Shift only pushes",
        }
    } else if is_sketching {
        "Draw the outline anew beside the one that you see; a drag with Alt turns the view"
    } else if settings.draws_curves() && workspace.controls.is_empty() {
        match selected_curve(workspace) {
            Some(_) => "Drag a point of the curve, R twists and S scales the surface around it, or draw another",
            None if settings.stroke_shape == StrokeShape::Crease => {
                "Draw along a crease or a border that the brush covers, then sharpen it in the handle's numbers"
            }
            None if settings.stroke_shape == StrokeShape::Spine => {
                "Draw through a limb, from the body to its tip, and drag its points"
            }
            None => "Draw a curve on the surface and drag its points",
        }
    } else if !workspace.controls.is_empty() {
        "Drag the gizmo, or press G, R or S to move, turn or scale the points"
    } else if document.handles().is_empty() && document.examples().is_some() && document.bends_without_handles() {
        "Drag an example's weight, or paint a handle (1)"
    } else if document.handles().is_empty() && document.bends_without_handles() {
        match settings.mode {
            ToolMode::Select => "Click a point of the cage or lattice and drag it, or paint a handle (1)",
            _ => "Press 5 to see the points of the cage or lattice and drag them, or paint a handle (1)",
        }
    } else if document.handles().is_empty() {
        match settings.mode {
            ToolMode::PaintHandle => "Paint the part that you want to move",
            ToolMode::PaintFree => "Paint the part that may bend, then a handle (1)",
            ToolMode::PaintFixed => "Paint the part that stays fixed, then a handle (1)",
            ToolMode::Pose => {
                "Drag a limb to turn it about its joint; Ctrl twists it, Shift scales it, Ctrl and the wheel choose its joint"
            }
            ToolMode::Correct => "Brush over the shape to correct it",
            ToolMode::Erase | ToolMode::Select | ToolMode::PaintStiffness | ToolMode::Flow => {
                "Press 1 and paint the part that you want to move"
            }
        }
    } else if settings.wants_pivot {
        "Click the pivot about which the handle turns"
    } else if workspace.selection.wants_new_handle {
        "Paint the new handle"
    } else if workspace.selection.selected().is_none() {
        "Press Tab to select a handle, or paint a new one"
    } else if document.is_displaced() {
        "Drag the handle or its gizmo, paint on from this shape, or save"
    } else {
        "Drag the handle or its gizmo, or press G, R or S to move, turn or scale"
    };
    let Counts { fixed, free, handle } = workspace.computed().region.counts;
    let [handle, free, fixed] = [handle, free, fixed].map(thousands);
    format!("{hint} · {handle} handle, {free} free, {fixed} fixed vertices")
}

/// The background computation for which a person waits.
fn working(workspace: &Workspace, is_dragging: bool) -> Option<String> {
    let (jobs, document) = (&workspace.jobs, &workspace.document);
    if jobs.has_given_up_binding() && !document.handles().is_empty() {
        return Some("The method is not bound: only handles move until the regions change".to_owned());
    }
    let (kind, fraction) = jobs.running().into_iter().rfind(|(kind, _)| match kind {
        JobKind::Pick => workspace.computed().pickable().is_none(),
        JobKind::Order => !document.handles().is_empty(),
        kind => kind.is_named(),
    })?;
    let doing = kind.doing();
    let waits = is_dragging || !document.is_settled();
    let doing = if waits && kind != JobKind::Pick {
        format!("{doing}; the surface follows soon")
    } else {
        doing.to_owned()
    };
    Some(if fraction > 0.0 {
        format!("{doing} {:.0}%", fraction * 100.0)
    } else {
        doing
    })
}

/// A count with separated thousands: 48 485.
pub fn thousands(count: usize) -> String {
    let digits = count.to_string();
    let mut spaced = String::with_capacity(digits.len() + digits.len() / 3);
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            spaced.push('\u{202f}');
        }
        spaced.push(digit);
    }
    spaced
}

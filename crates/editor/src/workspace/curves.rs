//! Changes of the control points of the selected handle's curve: more of them or fewer, their pins and their limits.

use super::state::Workspace;
use crate::document::{
    Crease, FREE_BEND_DEG, Handle, HandleCurve, HandleId, HandleLine, SHARPEN_RANGE, is_bend_range_deg, put_curve,
};

/// The most control points of a curve that is drawn and divided by hand.
const MOST_POINTS: usize = 64;

/// Adds a control point in the middle of the spans after the selected points, or of all spans if none is selected.
/// The curve stays near where it was.
pub(crate) fn divide_curve(workspace: &mut Workspace) {
    let Some((handle, curve)) = selected_curve(workspace) else {
        return;
    };
    let motion = curve.motion_at(1.0);
    let count = curve.rest().points().len();
    let selected = &workspace.controls;
    let is_divided = |point: usize| selected.is_empty() || selected.contains(point as u32);
    let (rest_places, moved_places) = (curve.rest().point_places(), motion.moved().point_places());
    let mut lists = Lists::of(&curve);
    for point in 0..count {
        lists.copy(&curve, point);
        let is_last = point + 1 == count;
        if !is_divided(point) || (is_last && !curve.rest().is_closed()) {
            continue;
        }
        let middle =
            |places: &[f64], whole: f64| 0.5 * (places[point] + if is_last { whole } else { places[point + 1] });
        let rest = middle(&rest_places, curve.rest().length());
        let moved = middle(&moved_places, motion.moved().length());
        let next = (point + 1) % count;
        lists.bends_deg.push(FREE_BEND_DEG);
        lists.points.push(curve.rest().position(rest));
        lists.moved.push(motion.moved().position(moved));
        lists
            .twist_deg
            .push(0.5 * (curve.twist_deg()[point] + curve.twist_deg()[next]));
        lists.scale.push((curve.scale()[point] * curve.scale()[next]).sqrt());
    }
    if lists.points.len() > MOST_POINTS {
        workspace.refuse(format!(
            "A curve has at most {MOST_POINTS} points: select the spans to divide."
        ));
        return;
    }
    lists.put(workspace, "Add curve points", handle, curve.rest().is_closed());
}

/// Removes the selected control points.
pub(crate) fn remove_curve_points(workspace: &mut Workspace) {
    let Some((handle, curve)) = selected_curve(workspace) else {
        return;
    };
    let selected = &workspace.controls;
    let mut lists = Lists::of(&curve);
    for point in (0..curve.rest().points().len()).filter(|point| !selected.contains(*point as u32)) {
        lists.copy(&curve, point);
    }
    let least = if curve.rest().is_closed() { 3 } else { 2 };
    if lists.points.len() < least {
        workspace.refuse(format!("A curve needs {least} points: delete the handle instead."));
        return;
    }
    lists.put(workspace, "Delete curve points", handle, curve.rest().is_closed());
}

/// Pins the selected control points, or unpins them if all of them are pinned.
pub(crate) fn pin_or_unpin_curve_points(workspace: &mut Workspace) {
    let Some((handle, curve)) = selected_curve(workspace) else {
        return;
    };
    let selected = workspace.controls.points();
    let mut pinned = curve.pinned().to_vec();
    let are_pinned = selected.iter().all(|point| pinned.contains(point));
    let name = if are_pinned {
        "Unpin curve points"
    } else {
        "Pin curve points"
    };
    match are_pinned {
        true => pinned.retain(|point| !selected.contains(point)),
        false => pinned.extend(selected),
    }
    change_joints(workspace, name, handle, |curve| curve.pinned_at(pinned.clone()));
}

/// Gives the selected control points of a curve, or the joint of a handle without one, the least and the most bend, in
/// degrees. Nothing moves until the chain or the limb is pulled.
pub(crate) fn set_bend_range(workspace: &mut Workspace, range_deg: [f64; 2]) {
    if !is_bend_range_deg(range_deg) {
        workspace.refuse("The bend is out of range: enter 0° to 180°, the least first.");
        return;
    }
    let Some((handle, curve)) = selected_curve(workspace) else {
        if let Some(handle) = workspace.selected().map(|handle| handle.id) {
            change_both(workspace, "Limit the bend", handle, |handle| {
                handle.bend_deg = range_deg
            });
        }
        return;
    };
    let points = 0..curve.rest().points().len();
    let selected = &workspace.controls;
    let bend = |point: usize| match selected.contains(point as u32) {
        true => range_deg,
        false => curve.bend_deg(point),
    };
    let bends_deg: Vec<[f64; 2]> = points.map(bend).collect();
    change_joints(workspace, "Limit the bend", handle, |curve| {
        curve.bent_within(bends_deg.clone())
    });
}

/// Makes the crease along the curve sharper or flatter than at rest.
pub(crate) fn sharpen_crease(workspace: &mut Workspace, sharpen: f64) {
    let Some((handle, curve)) = selected_curve(workspace).filter(|(_, curve)| curve.crease().is_some()) else {
        return;
    };
    if !SHARPEN_RANGE.contains(&sharpen) {
        let (flat, sharp) = (SHARPEN_RANGE.start(), SHARPEN_RANGE.end());
        workspace.refuse(format!("The crease is out of range: enter {flat} (flat) to {sharp}."));
        return;
    }
    workspace.change("Sharpen the crease", |document| {
        put_curve(document, handle, curve.sharpened(sharpen));
    });
}

/// Changes the joints of a handle's curve and of its twin's.
fn change_joints(workspace: &mut Workspace, name: &str, handle: HandleId, change: impl Fn(HandleCurve) -> HandleCurve) {
    change_both(workspace, name, handle, |handle| {
        let curve = handle.line.as_ref().and_then(HandleLine::curve).cloned();
        handle.line = curve
            .map(|curve| HandleLine::Curve(change(curve)))
            .or(handle.line.take());
    });
}

/// Changes a handle and its twin in the same way.
fn change_both(workspace: &mut Workspace, name: &str, handle: HandleId, change: impl Fn(&mut Handle)) {
    let twin = workspace.document.handle(handle).and_then(|handle| handle.twin);
    workspace.change(name, |document| {
        for id in std::iter::once(handle).chain(twin.map(|twin| twin.handle)) {
            document.change_handle(id, &change);
        }
    });
}

/// The selected handle with its curve.
pub(crate) fn selected_curve(workspace: &Workspace) -> Option<(HandleId, HandleCurve)> {
    let handle = workspace.selected()?;
    Some((handle.id, handle.line.as_ref()?.curve()?.clone()))
}

/// The lists of a curve's numbers.
#[derive(Debug, Default)]
struct Lists {
    points: Vec<glam::DVec3>,
    moved: Vec<glam::DVec3>,
    twist_deg: Vec<f64>,
    scale: Vec<f64>,
    pinned: Vec<u32>,
    bends_deg: Vec<[f64; 2]>,
    crease: Option<Crease>,
}

impl Lists {
    /// Those without a point, of the crease along a curve.
    fn of(curve: &HandleCurve) -> Self {
        Self {
            crease: curve.crease(),
            ..Self::default()
        }
    }

    fn copy(&mut self, curve: &HandleCurve, point: usize) {
        if curve.pinned().contains(&(point as u32)) {
            self.pinned.push(self.points.len() as u32);
        }
        self.bends_deg.push(curve.bend_deg(point));
        self.points.push(curve.rest().points()[point]);
        self.moved.push(curve.moved()[point]);
        self.twist_deg.push(curve.twist_deg()[point]);
        self.scale.push(curve.scale()[point]);
    }

    /// Makes them a handle's curve.
    fn put(self, workspace: &mut Workspace, name: &str, handle: HandleId, is_closed: bool) {
        let curve = HandleCurve::new(self.points, is_closed, self.moved, self.twist_deg, self.scale);
        let Ok(curve) = curve else { return };
        workspace.controls.put([]);
        let curve = curve
            .pinned_at(self.pinned)
            .bent_within(self.bends_deg)
            .creased(self.crease);
        workspace.change(name, |document| put_curve(document, handle, curve));
    }
}

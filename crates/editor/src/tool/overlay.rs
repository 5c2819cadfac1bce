//! The overlay: the brush's ring, the gizmo, and the method's cage or lattice.
//!
//! While a brush is active the gizmo is faded and strokes pass through it: only the part under a resting pointer is
//! highlighted, and a press grabs it.

use glam::{DVec2, DVec3};
use pliant_mesh::Joint;

use super::brush::ring;
use super::hidden_points::HiddenPoints;
use super::intersections::intersection_shapes;
use super::mode::{StrokeShape, ToolMode};
use super::path_places::PathPlaces;
use super::pose::{Limb, joint_shapes, limb_under};
use super::rim::{PointedRim, RimUse, Rims};
use super::settings::ToolSettings;
use super::symmetry::{closed, symmetry_shapes};
use super::taken_handle::is_taken_along;
use crate::document::HandleTransform;
use crate::input::Pointer;
use crate::view::{
    Camera, ControlLines, ControlShape, GizmoAxes, GizmoPart, GizmoShape, NetSides, ShownPoint, View, control_at,
    control_shapes, gizmo_shapes, hit_gizmo,
};
use crate::workspace::{ControlSource, ShownLines, Workspace, middle};

/// The shown part of the overlay, by the active gesture.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Lit {
    /// Without a gesture: the gizmo, with the part under the pointer highlighted, or else the brush's ring.
    Pointed,
    /// The gizmo, with this part highlighted.
    Gizmo(Option<GizmoPart>),
    /// The brush's ring.
    Ring,
    /// The selected handle's pivot.
    Pivot,
}

/// The shown overlay.
#[derive(Debug, Default)]
pub(crate) struct Overlay {
    pub(crate) ring: Vec<DVec3>,
    pub(crate) gizmo: Vec<GizmoShape>,
    /// The part of the gizmo under the pointer, without a gesture.
    pub(crate) hovered: Option<GizmoPart>,
    pub(crate) is_over_surface: bool,
    /// Whether a press would take the painted handle under the pointer along.
    pub(crate) takes_handle: bool,
    pub(crate) revision: u64,
    /// The method's cage or lattice, and its points one by one.
    pub(crate) controls: Vec<ControlShape>,
    pub(crate) control_points: Vec<ShownPoint>,
    /// The control point that a press takes.
    pub(crate) pointed_control: Option<u32>,
    /// The joint of the limb under the pointer, and the shapes of a gesture.
    pub(crate) shapes: Vec<ControlShape>,
    /// The positions and the view of the last test of hidden control points.
    hidden: HiddenPoints,
    /// The part under a resting pointer.
    rested: Option<GizmoPart>,
    /// The rims of the mesh while one is wanted, and the one that a press takes.
    rims: Rims,
    pub(crate) rim: Option<PointedRim>,
    /// The frame of the body's path that a press takes.
    pub(crate) pointed_frame: Option<usize>,
}

/// The colour of the ring at which a soft brush has half of its strength.
const INNER_RING: [u8; 4] = [255, 255, 255, 130];

/// The share of its colour that the gizmo keeps while a brush is active.
const FADED: f64 = 0.4;

impl Overlay {
    /// Returns true if a press takes a part of the gizmo, a control point or a place of the path.
    pub(crate) fn takes_press(&self) -> bool {
        self.hovered.is_some() || self.pointed_control.is_some() || self.pointed_frame.is_some()
    }

    /// The part of the gizmo that a press at a point of the viewport grabs.
    pub(crate) fn grabbed(&self, position_px: DVec2, view: &View, settings: &ToolSettings) -> Option<GizmoPart> {
        let part = self.hit(&self.gizmo, position_px, view);
        part.filter(|part| settings.mode == ToolMode::Select || self.rested == Some(*part))
    }

    /// The part of this gizmo under a point of the viewport. The square of a control point that is not selected is
    /// before it, so that a curve's neighbouring points can be taken through the gizmo of one.
    fn hit(&self, gizmo: &[GizmoShape], position_px: DVec2, view: &View) -> Option<GizmoPart> {
        let (camera, viewport_px) = (view.camera(), view.viewport_px());
        let others = self.control_points.iter().filter(|point| !point.is_selected);
        let mut covering = others.filter(|point| point.covers(position_px, camera, viewport_px));
        match covering.next() {
            Some(_) => None,
            None => hit_gizmo(gizmo, position_px, camera, viewport_px),
        }
    }

    /// The pointer rests at a point of the viewport. Squares and the centre cover vertices of the next stroke, so a
    /// rest counts only on lines.
    pub(crate) fn rest(&mut self, pointer_px: Option<DVec2>, view: &View) {
        let part = pointer_px.and_then(|px| self.hit(&self.gizmo, px, view));
        self.rested = part.filter(|part| !matches!(part, GizmoPart::Centre | GizmoPart::Square(_)));
    }

    /// Computes the overlay again, with the shapes of a gesture; its revision grows if it looks different.
    pub(crate) fn renew(
        &mut self,
        (lit, mut shapes): (Lit, Vec<ControlShape>),
        workspace: &Workspace,
        view: &View,
        settings: &ToolSettings,
        pointer: Option<Pointer>,
    ) {
        let (camera, viewport_px) = (view.camera(), view.viewport_px());
        let pointer_px = pointer.map(|pointer| pointer.position_px);
        let gizmo_of = |part| gizmo(lit, workspace, camera, viewport_px, settings, part).unwrap_or_default();
        let mut gizmo = gizmo_of(None);
        let lines = self.place_controls(workspace, view, settings);
        let highlighted = match (lit, pointer_px) {
            (Lit::Pointed, Some(pointer_px)) if !settings.waits_for_press() => self.hit(&gizmo, pointer_px, view),
            (Lit::Gizmo(part), _) => part,
            _ => None,
        };
        let is_painting = settings.mode != ToolMode::Select && lit == Lit::Pointed;
        // A pointer that leaves the part, or any other action, ends the rest.
        self.rested = self
            .rested
            .filter(|part| lit == Lit::Pointed && highlighted == Some(*part));
        let highlighted = if is_painting { self.rested } else { highlighted };
        if highlighted.is_some() {
            gizmo = gizmo_of(highlighted);
        }
        if is_painting {
            for shape in gizmo.iter_mut().filter(|shape| Some(shape.part) != highlighted) {
                shape.colour[3] = (f64::from(shape.colour[3]) * FADED) as u8;
            }
        }
        let (mut line, mut is_over_surface, mut takes_handle) = (Vec::new(), false, false);
        if let (Some(pointer), Some(picking)) = (pointer, workspace.picking(view))
            && !matches!(lit, Lit::Gizmo(_) | Lit::Pivot)
            && highlighted.is_none()
            && let Some(pick) = picking.at(pointer.position_px)
        {
            is_over_surface = true;
            takes_handle = lit == Lit::Pointed && is_taken_along(workspace, settings, &pick, pointer.modifiers);
            let has_ring = !matches!(settings.mode, ToolMode::Select | ToolMode::Pose)
                && matches!(settings.stroke_shape, StrokeShape::Brush | StrokeShape::Crease);
            if has_ring && !settings.waits_for_press() && !takes_handle {
                line = ring(&picking, pointer.position_px, &pick, &settings.brush());
                if let Some(share) = settings.soft_share() {
                    let inner = settings.brush().scaled(share);
                    let inner = ring(&picking, pointer.position_px, &pick, &inner);
                    shapes.push(ControlShape::lines(INNER_RING, closed(&inner)));
                }
            }
        }
        self.hovered = highlighted.filter(|_| lit == Lit::Pointed);
        self.is_over_surface = is_over_surface;
        self.takes_handle = takes_handle;
        let takes_points = lit == Lit::Pointed && highlighted.is_none();
        // Points of a drawn curve lie on the surface.
        let is_in_front = settings.mode == ToolMode::Select || settings.draws_curves() || !is_over_surface;
        let control_px = pointer_px.filter(|_| takes_points && is_in_front);
        let controls = self.draw_controls(lines, control_px, view);
        let path = PathPlaces::of(workspace, view);
        let path_px = control_px.filter(|_| self.pointed_control.is_none() && !settings.waits_for_press());
        self.pointed_frame = path_px.and_then(|px| path.as_ref()?.at(px, view));
        shapes.extend(path.map_or_else(Vec::new, |path| path.shapes(self.pointed_frame, view)));
        let joint_px = pointer_px.filter(|_| highlighted.is_none());
        shapes.extend(joint(lit, workspace, view, settings, joint_px));
        let rim_px = pointer_px.filter(|_| lit == Lit::Pointed);
        shapes.extend(self.renew_rims(workspace, view, settings.wants_rim, rim_px));
        shapes.extend(intersection_shapes(workspace, view));
        shapes.extend(symmetry_shapes(workspace, &line));
        if self.ring != line || self.gizmo != gizmo || self.controls != controls || self.shapes != shapes {
            self.ring = line;
            self.shapes = shapes;
            self.gizmo = gizmo;
            self.controls = controls;
            self.revision += 1;
        }
    }

    /// The rims, and the one under the pointer, while one is wanted.
    fn renew_rims(
        &mut self,
        workspace: &Workspace,
        view: &View,
        wanted: Option<RimUse>,
        pointer_px: Option<DVec2>,
    ) -> Vec<ControlShape> {
        self.rims.follow(workspace, wanted);
        self.rim = pointer_px.and_then(|px| self.rims.pointed(workspace, view, px));
        self.rims.shapes(workspace, view, wanted, self.rim.as_ref())
    }

    /// Finds the visible control points; returns the lines between them. A net around the model would be in the way of
    /// every tool but the one that moves its points.
    fn place_controls(&mut self, workspace: &Workspace, view: &View, settings: &ToolSettings) -> Option<ControlLines> {
        self.control_points.clear();
        let shown = workspace
            .shown_controls()
            .filter(|shown| settings.shows(&shown.source))?;
        self.hidden.look(&shown.positions, workspace, view);
        let (pinned, sides) = match &shown.source {
            ControlSource::Curve(_, curve, _) => (curve.pinned(), None),
            ControlSource::Attachment(_, net) => {
                let sides = NetSides::of(&shown.positions, &net.outside(), view.camera());
                (&[][..], Some(sides))
            }
        };
        let points = shown.positions.iter().zip(self.hidden.are_hidden()).zip(0..);
        self.control_points
            .extend(points.map(|((&position, &is_hidden), number)| ShownPoint {
                position,
                is_hidden,
                is_selected: workspace.controls.contains(number),
                is_pinned: pinned.contains(&number),
                is_back: sides.as_ref().is_some_and(|sides| sides.is_back(number)),
                is_pointed_at: false,
            }));
        let edges = match shown.lines {
            ShownLines::Curve(lines) => return Some(ControlLines::Curve(lines)),
            ShownLines::Net(edges) => edges,
        };
        let is_back = |edge: &[u32; 2]| sides.as_ref().is_some_and(|sides| sides.is_back_edge(*edge));
        let (back, front): (Vec<[u32; 2]>, Vec<[u32; 2]>) = edges.iter().partition(|edge| is_back(edge));
        let line = |edge: [u32; 2]| edge.map(|end| shown.positions[end as usize]);
        Some(ControlLines::Net {
            front: front.into_iter().map(line).collect(),
            back: back.into_iter().map(line).collect(),
        })
    }

    /// The shapes of the control points with their lines; `pointer_px` is the pointer's place if it may take a point.
    fn draw_controls(
        &mut self,
        lines: Option<ControlLines>,
        pointer_px: Option<DVec2>,
        view: &View,
    ) -> Vec<ControlShape> {
        let (camera, viewport_px) = (view.camera(), view.viewport_px());
        let is_curve = lines.as_ref().is_some_and(ControlLines::is_curve);
        let near = |px| control_at(&self.control_points, is_curve, px, camera, viewport_px);
        self.pointed_control = pointer_px.and_then(near);
        if let Some(point) = self.pointed_control {
            self.control_points[point as usize].is_pointed_at = true;
        }
        let drawn = lines.map(|lines| control_shapes(&self.control_points, lines, camera, viewport_px));
        drawn.unwrap_or_default()
    }
}

/// The joint that the pose brush takes, or about which it turns.
fn joint(
    lit: Lit,
    workspace: &Workspace,
    view: &View,
    settings: &ToolSettings,
    pointer_px: Option<DVec2>,
) -> Vec<ControlShape> {
    let shapes =
        |centre, joint: Option<(&Joint, DVec3)>| joint_shapes(centre, joint, view.camera(), view.viewport_px());
    let of_handle = |id| {
        let handle = workspace.document.handle(id);
        handle.map_or_else(Vec::new, |handle| shapes(handle.centre(), None))
    };
    if lit == Lit::Pivot {
        return workspace.selection.selected().map_or_else(Vec::new, of_handle);
    }
    let is_hovering = settings.mode == ToolMode::Pose && matches!(lit, Lit::Pointed | Lit::Ring);
    let pick = pointer_px
        .filter(|_| is_hovering)
        .and_then(|px| workspace.pick(view, px));
    match pick.map(|pick| limb_under(workspace, &pick, settings.whole_limb)) {
        Some(Limb::Untouched(limb)) => {
            let joints = std::iter::once(&limb.joint).chain(workspace.computed().inner_joints());
            let joints: Vec<_> = joints.collect();
            let ends = joints[1..].iter().map(|next| next.centre).chain([limb.joint.tip]);
            let bones = joints.iter().zip(ends);
            bones
                .flat_map(|(joint, end)| shapes(joint.centre, Some((joint, end))))
                .collect()
        }
        Some(Limb::Posed(id)) => of_handle(id),
        Some(Limb::Unknown | Limb::None) | None => Vec::new(),
    }
}

/// The gizmo of the selected control points, or else of the selected handle, if it is shown.
fn gizmo(
    lit: Lit,
    workspace: &Workspace,
    camera: &Camera,
    viewport_px: DVec2,
    settings: &ToolSettings,
    highlighted: Option<GizmoPart>,
) -> Option<Vec<GizmoShape>> {
    let is_shown = !matches!(lit, Lit::Ring | Lit::Pivot);
    if is_shown
        && !workspace.controls.is_empty()
        && let Some(shown) = workspace.shown_controls()
        && settings.shows(&shown.source)
    {
        let points = workspace.controls.points().iter();
        let seen: Vec<DVec3> = points
            .filter_map(|point| shown.positions.get(*point as usize).copied())
            .collect();
        let axes = GizmoAxes::of(&HandleTransform::IDENTITY, settings.orientation, camera);
        let centre = middle(seen.into_iter());
        return Some(gizmo_shapes(
            settings.gizmo_mode,
            centre,
            axes,
            camera,
            viewport_px,
            highlighted,
        ));
    }
    // The gizmo of a handle would be over the surface that these tools drag, until a key moves the handle.
    if settings.mode.drags_surface() && !matches!(lit, Lit::Gizmo(_)) {
        return None;
    }
    let handle = workspace.selected()?;
    // The points of a curve that was just drawn are wanted, and the gizmo of the whole would be over them.
    if settings.draws_curves() && handle.line.is_some() {
        return None;
    }
    if !is_shown || !handle.visible || handle.locked || handle.is_pin {
        return None;
    }
    let axes = GizmoAxes::of(&handle.transform, settings.orientation, camera);
    let (mode, centre) = (settings.gizmo_mode, handle.centre());
    Some(gizmo_shapes(mode, centre, axes, camera, viewport_px, highlighted))
}

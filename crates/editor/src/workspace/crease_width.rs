//! The width of the crease along the selected handle's curve, and the vertices of its handle that follow from it.

use glam::DVec3;
use pliant_mesh::{Model, SurfaceVertex};

use super::curves::selected_curve;
use super::painting::members;
use super::state::Workspace;
use crate::crease;
use crate::document::{Aspect, Crease, Document, HandleCurve, HandleId, HandleLine, Paint, Reach, put_curve};

/// The line along which a crease was found is not quite its curve, so a handle has vertices up to this many widths away.
const SLACK: f64 = 1.3;

/// The edges at about as many vertices are measured.
const MEASURED: usize = 256;

/// A crease that is wider than this many edges has vertices beside its line.
const WIDE: f64 = 2.0;

/// Makes the crease along the curve wider or narrower, and its twin's: vertices that come beside it are the handle's, those
/// that are no longer beside it are bare. What was painted by hand stays. While a widget is dragged, all follows from the
/// state before, so that a way there and back changes nothing.
pub(crate) fn set_crease_width(workspace: &mut Workspace, width: f64) {
    let (Some((handle, curve)), Some(model)) = (selected_curve(workspace), workspace.model().cloned()) else {
        return;
    };
    let Some(present) = curve.crease() else { return };
    let crease = match Crease::new(width, present.sharpen()) {
        Ok(crease) if crease == present => return,
        Ok(crease) => crease,
        Err(why) => return workspace.refuse(format!("The crease {}.", why.replace('`', ""))),
    };
    let before = workspace.before_adjusting().clone();
    let twin = before.handle(handle).and_then(|handle| handle.twin);
    let mut wanted: Vec<(SurfaceVertex, Paint)> = Vec::new();
    let mut distances = std::mem::take(&mut workspace.crease_distances);
    for id in std::iter::once(handle).chain(twin.map(|twin| twin.handle)) {
        let Some(curve) = curve_of(&before, id) else { continue };
        let old = curve.crease().map_or(width, |own| own.width());
        let limit = if width < old { SLACK * old } else { width };
        let near = distances.within(id, limit, |limit| {
            let position = |vertex: SurfaceVertex| -> DVec3 {
                model.surface.positions[vertex.index()] + before.rest()[vertex.index()]
            };
            let under = crease::under(&model.topology, position, &members(&before, id), curve.rest());
            crease::distances(&model.surface, &model.topology, position, under.into_iter(), limit)
        });
        let found = beside(&before, &model, id, near, [old, width]).into_iter();
        wanted.extend(found.filter(|(vertex, _)| workspace.vertex_access.may_be_painted(vertex.index())));
    }
    if workspace.is_adjusting() {
        workspace.crease_distances = distances;
    }
    let mut paint = before.paint().to_vec();
    for (vertex, own) in wanted {
        paint[vertex.index()] = own;
    }
    workspace.step("Widen the crease", |workspace| {
        let document = &mut workspace.document;
        let pairs = paint.into_iter().zip(document.paint()).zip(0..);
        let changes = pairs.filter_map(|((new, old), vertex)| (new != *old).then_some((SurfaceVertex(vertex), new)));
        let changes: Vec<(SurfaceVertex, Paint)> = changes.collect();
        document.paint_vertices(changes);
        put_curve(document, handle, curve.creased(Some(crease)));
        for id in std::iter::once(handle).chain(twin.map(|twin| twin.handle)) {
            // A reach that nobody has changed is as far as the crease is wide.
            document.change_handle(id, |handle| {
                if handle.reach == Reach::Length(present.width()) {
                    handle.reach = Reach::Length(width);
                }
            });
        }
    });
}

/// Compares the selected handle's crease with the edges beside it, once for each width and version of the paint: the window
/// asks at every frame.
pub(super) fn measure_crease(workspace: &mut Workspace) {
    let selected = selected_curve(workspace).and_then(|(handle, curve)| Some((handle, curve.crease()?.width(), curve)));
    let version = workspace.document.versions().of(Aspect::Paint);
    let of = selected.as_ref().map(|(handle, width, _)| (*handle, *width, version));
    if workspace.narrow_crease.1 == of {
        return;
    }
    let is_narrow = |(handle, width, curve): (HandleId, f64, HandleCurve)| {
        let model = workspace.model()?;
        let position = |vertex: SurfaceVertex| -> DVec3 {
            model.surface.positions[vertex.index()] + workspace.document.rest()[vertex.index()]
        };
        let members = members(&workspace.document, handle);
        let measured = members.iter().step_by(1 + members.len() / MEASURED);
        let edges =
            measured.flat_map(|vertex| model.topology.neighbours(*vertex).iter().map(|other| (*vertex, *other)));
        let (sum, count) = edges.fold((0.0, 0_u32), |(sum, count), (one, other)| {
            (sum + position(one).distance(position(other)), count + 1)
        });
        let edge = sum / f64::from(count.max(1));
        // A wide crease has too many vertices to ask them all, and more than its line.
        let is_beside = |vertex: &SurfaceVertex| {
            let position = position(*vertex);
            let place = curve.rest().nearest(position);
            (0.5 * edge..width).contains(&position.distance(curve.rest().position(place)))
        };
        Some(width < WIDE * edge && !members.iter().any(is_beside))
    };
    workspace.narrow_crease = (selected.and_then(is_narrow).unwrap_or(false), of);
}

fn curve_of(document: &Document, handle: HandleId) -> Option<HandleCurve> {
    document
        .handle(handle)?
        .line
        .as_ref()
        .and_then(HandleLine::curve)
        .cloned()
}

/// The vertices of a handle that its crease has no longer, and those that it gets, when its width changes.
fn beside(
    document: &Document,
    model: &Model,
    handle: HandleId,
    near: &[(SurfaceVertex, f64)],
    [old, new]: [f64; 2],
) -> Vec<(SurfaceVertex, Paint)> {
    let within = |width: f64| {
        let near = near.iter().take_while(|(_, distance)| *distance <= width);
        crease::with_rings(&model.topology, near.map(|(vertex, _)| *vertex))
    };
    let (is_old, is_new) = (within(old), within(new));
    let is_former = if new < old { within(SLACK * old) } else { is_old.clone() };
    let paint = document.paint();
    let change = |vertex: usize| {
        let change = match paint[vertex] {
            Paint::Handle(own) if own == handle && is_former[vertex] && !is_new[vertex] => Paint::Bare,
            Paint::Bare | Paint::Free if is_new[vertex] && !is_old[vertex] => Paint::Handle(handle),
            _ => return None,
        };
        Some((SurfaceVertex(vertex as u32), change))
    };
    (0..paint.len()).filter_map(change).collect()
}

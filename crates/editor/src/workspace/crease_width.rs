//! The width of the crease along the selected handle's curve, and the vertices of its handle that follow from it.

use std::collections::BTreeSet;

use glam::DVec3;
use pliant_mesh::{Model, SurfaceVertex};

use super::curves::selected_curve;
use super::painting::members;
use super::state::Workspace;
use crate::crease;
use crate::document::{Crease, Document, HandleCurve, HandleId, HandleLine, Paint, Reach, put_curve};

/// The line along which a crease was found is not quite its curve, so a handle has vertices up to this many widths away.
const SLACK: f64 = 1.3;

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
    for id in std::iter::once(handle).chain(twin.map(|twin| twin.handle)) {
        let Some(curve) = curve_of(&before, id) else { continue };
        let found = beside(
            &before,
            &model,
            id,
            &curve,
            [curve.crease().map_or(width, |own| own.width()), width],
        );
        wanted.extend(found.filter(|(vertex, _)| workspace.vertex_access.may_be_painted(vertex.index())));
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
    curve: &HandleCurve,
    [old, new]: [f64; 2],
) -> impl Iterator<Item = (SurfaceVertex, Paint)> + use<> {
    let position =
        |vertex: SurfaceVertex| -> DVec3 { model.surface.positions[vertex.index()] + document.rest()[vertex.index()] };
    let under = crease::under(&model.topology, position, &members(document, handle), curve.rest());
    let widths = [old, SLACK * old, new];
    let found = crease::beside(&model.surface, &model.topology, position, under.into_iter(), widths);
    let is_narrower = new < old;
    let [old, about_old, new] = found.map(BTreeSet::from_iter);
    let former = if is_narrower { about_old } else { old.clone() };
    let paint = document.paint();
    let left = former
        .difference(&new)
        .filter(|vertex| paint[vertex.index()] == Paint::Handle(handle));
    let may_get = |vertex: &&SurfaceVertex| matches!(paint[vertex.index()], Paint::Bare | Paint::Free);
    let got = new.difference(&old).filter(may_get);
    let left: Vec<(SurfaceVertex, Paint)> = left.map(|vertex| (*vertex, Paint::Bare)).collect();
    let got: Vec<(SurfaceVertex, Paint)> = got.map(|vertex| (*vertex, Paint::Handle(handle))).collect();
    left.into_iter().chain(got)
}

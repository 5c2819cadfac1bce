//! What the list of handles does: select several, choose pivots, split, mirror, reset a region.

use std::sync::Arc;

use glam::{DQuat, DVec3};
use pliant_deform::Role;
use pliant_mesh::SurfaceVertex;

use crate::document::{Handle, HandleId, MirrorPlane, Paint, PivotPlace, Twin};
use crate::editor::Editor;
use crate::tool::{border_middle, tidy_handles};
use crate::workspace::Purpose;
use crate::{GizmoAxes, GizmoOrientation, HandleTransform};

impl Editor {
    /// Selects a handle and keeps those that are selected along with it, if it is one of them.
    pub(crate) fn select(&mut self, id: HandleId) {
        if let Some(before) = self.selected
            && before != id
            && let Some(place) = self.companions.iter().position(|&companion| companion == id)
        {
            self.companions[place] = before;
        }
        self.selected = Some(id);
    }

    pub(crate) fn toggle_selected(&mut self, id: HandleId) {
        if self.selected == Some(id) {
            self.selected = self.companions.pop();
        } else if let Some(place) = self.companions.iter().position(|&companion| companion == id) {
            self.companions.remove(place);
        } else if let Some(before) = self.selected.replace(id) {
            self.companions.push(before);
        }
    }

    /// The axes of a handle's gizmo.
    pub(crate) fn gizmo_axes(&self, handle: &Handle) -> GizmoAxes {
        let own = match handle.transform {
            HandleTransform::Trs { rotation, .. } => rotation,
            HandleTransform::Matrix(_) => DQuat::IDENTITY,
        };
        GizmoAxes {
            own,
            basis: match self.orientation {
                GizmoOrientation::World => DQuat::IDENTITY,
                GizmoOrientation::Local => own,
                GizmoOrientation::View => DQuat::from_mat3(&self.camera.axes()),
            },
        }
    }

    /// Changes a handle in one step.
    pub(crate) fn change_handle(&mut self, name: &str, id: HandleId, change: impl FnOnce(&mut Handle)) {
        self.change(name, |document| {
            if let Some(handle) = document.handle_mut(id) {
                change(handle);
            }
        });
    }

    /// Chooses where a pivot stands, and puts it there.
    pub(crate) fn set_pivot_place(&mut self, id: HandleId, place: PivotPlace) {
        let Some(model) = self.engine.model.clone() else { return };
        let document = &self.document;
        let position = |vertex: usize| model.surface.positions[vertex] + document.rest[vertex];
        let members = (0..document.paint.len()).filter(|&vertex| document.paint[vertex] == Paint::Handle(id));
        let (mut sum, mut count) = (DVec3::ZERO, 0.0);
        for vertex in members {
            sum += position(vertex);
            count += 1.0;
        }
        let pivot = match place {
            PivotPlace::Centroid => (count > 0.0).then(|| sum / count),
            PivotPlace::Border => border_middle(id, &document.paint, &model, &position),
            PivotPlace::Picked => None,
        };
        self.change_handle("Choose pivot", id, |handle| {
            handle.pivot_place = place;
            if let Some(pivot) = pivot {
                move_pivot(handle, pivot);
            }
        });
    }

    /// Puts a pivot at a point of the present shape.
    pub(crate) fn set_pivot(&mut self, id: HandleId, point: DVec3) {
        if !point.is_finite() {
            self.problem = Some("The pivot is not finite: enter other numbers.".to_owned());
            return;
        }
        self.change_handle("Put pivot", id, |handle| {
            let affine = handle.affine();
            let inverse = affine.inverse();
            // A handle that was scaled to nothing has no way back: the pivot's way along is all there is.
            let rest = if inverse.is_finite() {
                inverse.transform_point3(point)
            } else {
                handle.pivot + (point - handle.centre())
            };
            handle.pivot_place = PivotPlace::Picked;
            move_pivot(handle, rest);
        });
    }

    /// Splits the selected handle in two across its longest side.
    pub(crate) fn split_selected(&mut self) {
        let (Some(id), Some(model)) = (self.selected, self.engine.model.clone()) else {
            return;
        };
        let members: Vec<usize> = (0..self.document.paint.len())
            .filter(|&vertex| self.document.paint[vertex] == Paint::Handle(id))
            .collect();
        let positions: Vec<DVec3> = members
            .iter()
            .map(|&vertex| model.surface.positions[vertex] + self.document.from_file[vertex])
            .collect();
        let Some(bounds) = pliant_mesh::bounding_box(&positions) else {
            return;
        };
        let extent = bounds.extent();
        let axis = (0..3).fold(0, |best, axis| if extent[axis] > extent[best] { axis } else { best });
        let middle = bounds.centre()[axis];
        let target = Paint::Handle(HandleId(self.document.next_handle));
        let changes: Vec<(usize, Paint)> = members
            .iter()
            .zip(&positions)
            .filter(|(_, position)| position[axis] > middle)
            .map(|(&vertex, _)| (vertex, target))
            .collect();
        if changes.is_empty() || changes.len() == members.len() {
            self.problem = Some("A handle of one point can't be split: paint more of it.".to_owned());
            return;
        }
        self.repaint("Split handle".to_owned(), Paint::Handle(id), target, changes);
    }

    /// Makes the selected handle's mirror image a handle that does the same.
    pub(crate) fn make_twin(&mut self, axis: usize) {
        if let Some(id) = self.selected {
            self.mirror(Purpose::Twin(id), axis);
        }
    }

    /// Makes an image of a handle's vertices its twin.
    pub(crate) fn twin_of(&mut self, id: HandleId, image: &[usize], plane: MirrorPlane) {
        let image: Vec<usize> = image
            .iter()
            .copied()
            .filter(|&vertex| self.masks.may_be_painted(vertex))
            .filter(|&vertex| !matches!(self.document.paint[vertex], Paint::Handle(_)))
            .collect();
        if image.is_empty() {
            self.problem = Some(
                "The handle has no mirror image on the surface that is free: choose another axis, or paint it."
                    .to_owned(),
            );
            return;
        }
        self.engine.drop_solves();
        self.change("Make twin", |document| {
            document.apply_shape();
            let other = document.add_handle();
            let painted = Arc::make_mut(&mut document.paint);
            for &vertex in &image {
                painted[vertex] = Paint::Handle(other);
            }
            let Some(first) = document.handle_mut(id) else { return };
            first.twin = Some(Twin { handle: other, plane });
            let (name, pivot, reach) = (format!("{} twin", first.name), first.pivot, first.reach);
            if let Some(second) = document.handle_mut(other) {
                second.name = name;
                second.reach = reach;
                second.pivot = plane.mirrored(pivot);
                // Mirrored motion needs mirrored pivots.
                second.pivot_place = PivotPlace::Picked;
                second.twin = Some(Twin { handle: id, plane });
            }
        });
        self.repainted = true;
    }

    /// Parts the selected handle from its twin.
    pub(crate) fn untwin(&mut self) {
        let Some(id) = self.selected else { return };
        self.change("Part twins", |document| {
            let other = document.handle_mut(id).and_then(|handle| handle.twin.take());
            if let Some(other) = other.and_then(|twin| document.handle_mut(twin.handle)) {
                other.twin = None;
            }
        });
    }

    /// Takes the selected handle's vertices and what is free around them back to the file's shape.
    pub(crate) fn reset_region(&mut self) {
        let (Some(id), Some(model)) = (self.selected, self.engine.model.clone()) else {
            return;
        };
        // The free vertices that hang together with the handle's.
        let is_own = |vertex: usize| self.document.paint[vertex] == Paint::Handle(id);
        let mut taken: Vec<bool> = (0..self.document.paint.len()).map(is_own).collect();
        let mut stack: Vec<usize> = (0..taken.len()).filter(|&vertex| taken[vertex]).collect();
        while let Some(vertex) = stack.pop() {
            for neighbour in model.topology.neighbours(SurfaceVertex(vertex as u32)) {
                let next = neighbour.index();
                if !taken[next] && self.engine.region.roles.get(next) == Some(&Role::Free) {
                    taken[next] = true;
                    stack.push(next);
                }
            }
        }
        self.engine.drop_solves();
        self.step("Reset region", |editor| {
            let before = editor.document.clone();
            let document = &mut editor.document;
            document.apply_shape();
            let rest = Arc::make_mut(&mut document.rest);
            for vertex in (0..taken.len()).filter(|&vertex| taken[vertex]) {
                rest[vertex] = DVec3::ZERO;
            }
            document.refresh_from_file();
            let positions = |vertex: usize| model.surface.positions[vertex] + document.rest[vertex];
            let members: Vec<usize> = (0..taken.len())
                .filter(|&vertex| document.paint[vertex] == Paint::Handle(id))
                .collect();
            let middle = members.iter().map(|&vertex| positions(vertex)).sum::<DVec3>() / members.len().max(1) as f64;
            if let Some(handle) = document.handle_mut(id)
                && handle.pivot_place != PivotPlace::Picked
            {
                handle.pivot = middle;
            }
            tidy_handles(editor, &before);
        });
    }
}

/// Puts a pivot at a point of the rest shape; the map of positions stays the same.
fn move_pivot(handle: &mut Handle, pivot: DVec3) {
    let affine = handle.affine();
    if let HandleTransform::Trs { translation, .. } = &mut handle.transform
        && *translation != affine.transform_point3(pivot) - pivot
    {
        *translation = affine.transform_point3(pivot) - pivot;
    }
    handle.pivot = pivot;
}

//! What is done with objects: hidden, shown alone, locked, by the list or under the pointer; and what follows from that
//! for triangles and handles.

use std::sync::Arc;

use pliant_mesh::SurfaceVertex;

use crate::document::{Access, Masks, ObjectAction, object_name};
use crate::document::{HandleId, Paint};
use crate::editor::Editor;

impl Editor {
    /// Which of [`pliant_mesh::Drawn::triangles`] are shown; `None` is all of them. Another allocation when it changed.
    pub fn shown_triangles(&self) -> Option<&Arc<Vec<bool>>> {
        self.masks.drawn.as_ref()
    }

    /// Whether a triangle of the surface is shown.
    pub(crate) fn is_triangle_shown(&self, surface_triangle: u32) -> bool {
        let shown = self.masks.triangles.as_ref();
        shown.is_none_or(|shown| shown.binary_search(&surface_triangle).is_ok())
    }

    /// Draws the conclusions from what is hidden and locked.
    pub(crate) fn refresh_masks(&mut self) {
        let Some(model) = &self.engine.model else { return };
        let access = &self.document.access;
        let is_same = self
            .masked
            .as_ref()
            .is_some_and(|(of, masked)| Arc::ptr_eq(of, model) && masked == access);
        if is_same {
            return;
        }
        let had = self.masks.triangles.is_some();
        self.masks = Masks::of(access, model);
        self.rims_revision += 1;
        self.masked = Some((Arc::clone(model), Arc::clone(access)));
        if had || self.masks.triangles.is_some() {
            self.engine.show_triangles(self.masks.triangles.clone());
        }
    }

    pub(crate) fn act_on_objects(&mut self, action: ObjectAction, objects: &[u32]) {
        let Some(model) = self.engine.model.clone() else { return };
        let all = model.all_objects();
        if objects.iter().any(|&object| object as usize >= all.len()) {
            self.problem = Some("The file has no such object: choose one of the list.".to_owned());
            return;
        }
        let access = self.document.access.after(action, objects, all.len() as u32);
        let what = match objects {
            [one] => object_name(&all[*one as usize].name, *one),
            several => format!("{} objects", several.len()),
        };
        let name = match action {
            ObjectAction::Solo if access.shows_all() => "Show everything".to_owned(),
            _ => format!("{} {what}", action.name()),
        };
        self.set_access(name, access);
    }

    /// Shows everything there is.
    pub(crate) fn show_everything(&mut self) {
        let locked = self.document.access.locked.clone();
        let access = Access {
            locked,
            ..Access::default()
        };
        self.set_access("Show everything".to_owned(), access);
    }

    /// Shows nothing but the connected part under the pointer, or everything else again.
    pub(crate) fn isolate(&mut self) {
        let access = (*self.document.access).clone();
        if access.isolated.is_some() {
            let isolated = None;
            return self.set_access("Show the other parts".to_owned(), Access { isolated, ..access });
        }
        let Some(vertex) = self.vertex_under_pointer() else {
            return;
        };
        let Some(model) = &self.engine.model else { return };
        let isolated = Some(model.topology.component(vertex));
        self.set_access("Isolate part".to_owned(), Access { isolated, ..access });
    }

    /// Does something with the object under the pointer.
    pub(crate) fn act_on_object_here(&mut self, action: ObjectAction) {
        let object = self
            .pointer
            .and_then(|pointer| self.pick(pointer.position_px))
            .and_then(|pick| {
                let object = self.engine.model.as_ref()?.object_of(pick.triangle)?;
                Some(object as u32)
            });
        match object {
            Some(object) => self.act_on_objects(action, &[object]),
            None => self.problem = Some(NOTHING_HERE.to_owned()),
        }
    }

    fn vertex_under_pointer(&mut self) -> Option<SurfaceVertex> {
        let pick = self.pointer.and_then(|pointer| self.pick(pointer.position_px));
        if pick.is_none() {
            self.problem = Some(NOTHING_HERE.to_owned());
        }
        pick.map(|pick| pick.vertex)
    }

    fn set_access(&mut self, name: String, access: Access) {
        if *self.document.access == access {
            return;
        }
        // What is held still is part of the problem, and no change of that moves anything.
        let relocked = access.locked != self.document.access.locked;
        if relocked {
            self.engine.drop_solves();
        }
        self.change(name, |document| {
            if relocked {
                document.apply_shape();
            }
            document.access = Arc::new(access);
        });
    }

    /// Why a handle can't be moved, if it can't.
    pub(crate) fn held_because(&self, id: HandleId) -> Option<String> {
        let handle = self.document.handle(id)?;
        if handle.locked {
            return Some(format!("{} is locked: unlock it in the list to move it.", handle.name));
        }
        let mut members = (0..self.document.paint.len()).filter(|&v| self.document.paint[v] == Paint::Handle(id));
        let is_held = self.masks.lock_some() && members.all(|vertex| self.masks.is_locked(vertex));
        is_held.then(|| {
            format!(
                "{} lies on a locked object: unlock that in the list of objects to move it.",
                handle.name
            )
        })
    }
}

const NOTHING_HERE: &str = "There is nothing under the pointer: put it over a part of the surface and press the key.";

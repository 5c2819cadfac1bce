//! What of the file may be seen and touched: objects that are hidden or locked, and the part that is isolated.
//!
//! What is hidden is neither drawn nor picked nor painted, but moves along; what is locked is held still, whatever was
//! painted on it, and its paint stays. Both belong to the document.

use std::collections::BTreeSet;
use std::sync::Arc;

use pliant_mesh::{Model, SurfaceVertex};

use crate::document::{HandleId, Paint};
use crate::editor::Editor;

/// Objects by their number in [`Model::all_objects`], parts by their component's.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Access {
    /// Objects that are not shown.
    pub hidden: BTreeSet<u32>,
    /// Objects that are held still.
    pub locked: BTreeSet<u32>,
    /// The one connected part that is shown, if only one is.
    pub isolated: Option<u32>,
}

/// What is done with objects.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
pub enum ObjectAction {
    /// Hides them.
    Hide,
    /// Shows them.
    Show,
    /// Hides all others; once more shows everything.
    Solo,
    /// Holds them still.
    Lock,
    /// Lets them bend again.
    Unlock,
}

impl ObjectAction {
    fn name(self) -> &'static str {
        match self {
            Self::Hide => "Hide",
            Self::Show => "Show",
            Self::Solo => "Show only",
            Self::Lock => "Lock",
            Self::Unlock => "Unlock",
        }
    }
}

impl Access {
    /// The same after an action on some of `count` objects.
    fn after(&self, action: ObjectAction, objects: &[u32], count: u32) -> Self {
        let mut access = self.clone();
        let own = || objects.iter().copied();
        match action {
            ObjectAction::Hide => access.hidden.extend(own()),
            ObjectAction::Show => {
                access.hidden.retain(|object| !objects.contains(object));
                access.isolated = None;
            }
            ObjectAction::Solo => {
                let others: BTreeSet<u32> = (0..count).filter(|object| !objects.contains(object)).collect();
                let is_alone = self.hidden == others && self.isolated.is_none();
                access.hidden = if is_alone { BTreeSet::new() } else { others };
                access.isolated = None;
            }
            ObjectAction::Lock => access.locked.extend(own()),
            ObjectAction::Unlock => access.locked.retain(|object| !objects.contains(object)),
        }
        access
    }

    /// Whether everything is shown.
    pub fn shows_all(&self) -> bool {
        self.hidden.is_empty() && self.isolated.is_none()
    }

    /// Which of [`pliant_mesh::Drawn::triangles`] are shown; `None` is all of them.
    fn shown_triangles(&self, model: &Model) -> Option<Vec<bool>> {
        if self.shows_all() {
            return None;
        }
        let mut shown = model.triangles_of_objects(|object| !self.hidden.contains(&(object as u32)));
        if let Some(part) = self.isolated {
            for (shown, [corner, ..]) in shown.iter_mut().zip(model.drawn_triangles()) {
                let vertex = model.drawn.surface_vertex(corner);
                *shown &= vertex.is_some_and(|vertex| model.topology.component(vertex) == part);
            }
        }
        Some(shown)
    }

    /// Which surface vertices are held still by a lock; `None` is none.
    pub(crate) fn locked_vertices(&self, model: &Model) -> Option<Vec<bool>> {
        if self.locked.is_empty() {
            return None;
        }
        let chosen = model.triangles_of_objects(|object| self.locked.contains(&(object as u32)));
        Some(model.vertices_of_triangles(&chosen))
    }
}

/// What follows from an [`Access`] on a model; `None` where it changes nothing.
#[derive(Debug, Default)]
pub(crate) struct Masks {
    /// Of each drawn triangle, whether it is shown.
    pub(crate) drawn: Option<Arc<Vec<bool>>>,
    /// The surface's triangles that are shown, ascending.
    pub(crate) triangles: Option<Arc<Vec<u32>>>,
    /// Of each surface vertex, whether some triangle shows it.
    shown: Option<Vec<bool>>,
    /// Of each surface vertex, whether a lock holds it.
    locked: Option<Vec<bool>>,
}

impl Masks {
    fn of(access: &Access, model: &Model) -> Self {
        let drawn = access.shown_triangles(model);
        let triangles = drawn.as_ref().map(|drawn| {
            let of_surface = model.drawn.triangle_of_surface().iter().zip(0..);
            let shown = of_surface.filter(|(triangle, _)| drawn[**triangle as usize]);
            Arc::new(shown.map(|(_, number)| number).collect::<Vec<u32>>())
        });
        Self {
            shown: drawn.as_ref().map(|drawn| model.vertices_of_triangles(drawn)),
            locked: access.locked_vertices(model),
            triangles,
            drawn: drawn.map(Arc::new),
        }
    }

    /// Whether a vertex is to be seen.
    pub(crate) fn is_shown(&self, vertex: usize) -> bool {
        self.shown.as_ref().is_none_or(|shown| shown[vertex])
    }

    /// Whether a lock holds a vertex.
    pub(crate) fn is_locked(&self, vertex: usize) -> bool {
        self.locked.as_ref().is_some_and(|locked| locked[vertex])
    }

    /// Whether a vertex may be painted.
    pub(crate) fn may_be_painted(&self, vertex: usize) -> bool {
        self.is_shown(vertex) && !self.is_locked(vertex)
    }

    /// Whether every vertex may be.
    pub(crate) fn are_open(&self) -> bool {
        self.shown.is_none() && self.locked.is_none()
    }
}

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
        let is_held = self.masks.locked.is_some() && members.all(|vertex| self.masks.is_locked(vertex));
        is_held.then(|| {
            format!(
                "{} lies on a locked object: unlock that in the list of objects to move it.",
                handle.name
            )
        })
    }
}

const NOTHING_HERE: &str = "There is nothing under the pointer: put it over a part of the surface and press the key.";

/// What an object is called where the file has no name for it.
pub fn object_name(name: &str, number: u32) -> String {
    if name.is_empty() {
        format!("object {}", number + 1)
    } else {
        name.to_owned()
    }
}

//! The accessible part of the file: hidden or locked objects and small parts, and the isolated part.
//!
//! A hidden part is neither drawn nor picked nor painted, but still moves; a locked part is fixed, independent of its
//! paint, which stays. Both belong to the document.

use std::collections::BTreeSet;

use pliant_mesh::{LOOSE_BIT, Model, SurfaceVertex};

/// Objects by their number in [`Model::all_objects`], parts by their component's number.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Access {
    /// Hidden objects.
    pub hidden: BTreeSet<u32>,
    /// Fixed objects.
    pub locked: BTreeSet<u32>,
    /// The only shown connected part, if one is isolated.
    pub isolated: Option<u32>,
    /// Parts that count as small, and their treatment.
    pub small: SmallParts,
}

/// Connected parts with few vertices, like the debris of a scan.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct SmallParts {
    /// Parts with less than this share (0 to 1) of the largest part's vertices are small.
    pub share: f64,
    /// True if they are hidden.
    pub hidden: bool,
    /// True if they are fixed.
    pub locked: bool,
}

impl Default for SmallParts {
    fn default() -> Self {
        Self {
            share: LOOSE_BIT,
            hidden: false,
            locked: false,
        }
    }
}

/// An action on objects.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
pub enum ObjectAction {
    /// Hides them.
    Hide,
    /// Shows them.
    Show,
    /// Hides all others; a second time shows everything.
    Solo,
    /// Fixes them.
    Lock,
    /// Lets them bend again.
    Unlock,
}

impl ObjectAction {
    pub(crate) fn name(self) -> &'static str {
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
    /// The access after an action on some of `count` objects.
    pub(crate) fn after(&self, action: ObjectAction, objects: &[u32], count: u32) -> Self {
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

    /// Returns true if everything is shown.
    pub fn shows_all(&self) -> bool {
        self.hidden.is_empty() && self.isolated.is_none() && !self.small.hidden
    }

    /// Returns true if anything is fixed.
    pub(crate) fn locks_any(&self) -> bool {
        self.small.locked || !self.locked.is_empty()
    }

    /// The fixed objects and parts: equal for two that fix the same.
    pub(crate) fn locks(&self) -> (&BTreeSet<u32>, Option<f64>) {
        (&self.locked, self.small.locked.then_some(self.small.share))
    }

    /// The shown ones among [`pliant_mesh::Drawn::triangles`]; `None` is all of them.
    pub(crate) fn shown_triangles(&self, model: &Model) -> Option<Vec<bool>> {
        if self.shows_all() {
            return None;
        }
        let mut shown = model.triangles_of_objects(|object| !self.hidden.contains(&(object as u32)));
        let part_of = |vertex: SurfaceVertex| model.topology.component(vertex);
        let mut hide_unless = |is_shown: &dyn Fn(Option<SurfaceVertex>) -> bool| {
            for (shown, [corner, ..]) in shown.iter_mut().zip(model.drawn_triangles()) {
                *shown &= is_shown(model.drawn.surface_vertex(corner));
            }
        };
        if let Some(part) = self.isolated {
            hide_unless(&|vertex| vertex.is_some_and(|vertex| part_of(vertex) == part));
        }
        if self.small.hidden {
            let is_small = model.small_parts(self.small.share);
            hide_unless(&|vertex| vertex.is_none_or(|vertex| !is_small[part_of(vertex) as usize]));
        }
        Some(shown)
    }

    /// The surface vertices that a lock fixes; `None` is none.
    pub(crate) fn locked_vertices(&self, model: &Model) -> Option<Vec<bool>> {
        if !self.locks_any() {
            return None;
        }
        let chosen = model.triangles_of_objects(|object| self.locked.contains(&(object as u32)));
        let mut locked = model.vertices_of_triangles(&chosen);
        if self.small.locked {
            let is_small = model.small_parts(self.small.share);
            for (vertex, is_locked) in (0..).zip(&mut locked) {
                *is_locked |= is_small[model.topology.component(SurfaceVertex(vertex)) as usize];
            }
        }
        Some(locked)
    }
}

/// The name of an object to which the file gives none.
pub fn object_name(name: &str, number: u32) -> String {
    if name.is_empty() {
        format!("object {}", number + 1)
    } else {
        name.to_owned()
    }
}

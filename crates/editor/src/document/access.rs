//! What of the file may be seen and touched: objects and small parts that are hidden or locked, and the part that is
//! isolated.
//!
//! What is hidden is neither drawn nor picked nor painted, but moves along; what is locked is held still, whatever was
//! painted on it, and its paint stays. Both belong to the document.

use std::collections::BTreeSet;

use pliant_mesh::{LOOSE_BIT, Model, SurfaceVertex};

/// Objects by their number in [`Model::all_objects`], parts by their component's.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Access {
    /// Objects that are not shown.
    pub hidden: BTreeSet<u32>,
    /// Objects that are held still.
    pub locked: BTreeSet<u32>,
    /// The one connected part that is shown, if only one is.
    pub isolated: Option<u32>,
    /// Parts that count as small, and what is done with them.
    pub small: SmallParts,
}

/// Connected parts with few vertices, as the debris of a scan has.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct SmallParts {
    /// Parts with less than this share (0 to 1) of the largest part's vertices are small.
    pub share: f64,
    /// Whether they are not shown.
    pub hidden: bool,
    /// Whether they are held still.
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
    /// The same after an action on some of `count` objects.
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

    /// Whether everything is shown.
    pub fn shows_all(&self) -> bool {
        self.hidden.is_empty() && self.isolated.is_none() && !self.small.hidden
    }

    /// Whether anything is held still.
    pub(crate) fn locks_any(&self) -> bool {
        self.small.locked || !self.locked.is_empty()
    }

    /// What is held still: the same in two of these if both hold the same.
    pub(crate) fn locks(&self) -> (&BTreeSet<u32>, Option<f64>) {
        (&self.locked, self.small.locked.then_some(self.small.share))
    }

    /// Which of [`pliant_mesh::Drawn::triangles`] are shown; `None` is all of them.
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

    /// Which surface vertices are held still by a lock; `None` is none.
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

/// What an object is called where the file has no name for it.
pub fn object_name(name: &str, number: u32) -> String {
    if name.is_empty() {
        format!("object {}", number + 1)
    } else {
        name.to_owned()
    }
}

//! What of the file may be seen and touched: objects that are hidden or locked, and the part that is isolated.
//!
//! What is hidden is neither drawn nor picked nor painted, but moves along; what is locked is held still, whatever was
//! painted on it, and its paint stays. Both belong to the document.

use std::collections::BTreeSet;

use pliant_mesh::Model;

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
        self.hidden.is_empty() && self.isolated.is_none()
    }

    /// Which of [`pliant_mesh::Drawn::triangles`] are shown; `None` is all of them.
    pub(super) fn shown_triangles(&self, model: &Model) -> Option<Vec<bool>> {
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

/// What an object is called where the file has no name for it.
pub fn object_name(name: &str, number: u32) -> String {
    if name.is_empty() {
        format!("object {}", number + 1)
    } else {
        name.to_owned()
    }
}

//! Which handles are selected: one, and others along with it.

use crate::document::{Document, HandleId};

/// The handles that commands, the gizmo and the handle brush speak of.
#[derive(Clone, Debug, Default)]
pub(crate) struct HandleSelection {
    selected: Option<HandleId>,
    companions: Vec<HandleId>,
    /// Whether the next stroke of the handle brush makes a handle of its own.
    pub(crate) wants_new_handle: bool,
}

impl HandleSelection {
    /// The selected handle.
    pub(crate) fn selected(&self) -> Option<HandleId> {
        self.selected
    }

    /// The handles that are selected along with it.
    pub(crate) fn companions(&self) -> &[HandleId] {
        &self.companions
    }

    /// Selects a handle, or none, and keeps those that are selected along with the one before.
    pub(crate) fn put(&mut self, id: Option<HandleId>) {
        self.selected = id;
    }

    /// Selects a handle, or none, alone.
    pub(crate) fn put_alone(&mut self, id: Option<HandleId>) {
        self.companions.clear();
        self.selected = id;
    }

    /// Selects a handle that was clicked: those that are selected along with it stay so.
    pub(crate) fn click(&mut self, id: HandleId) {
        if !self.companions.contains(&id) {
            self.companions.clear();
        }
        if let Some(before) = self.selected
            && before != id
            && let Some(place) = self.companions.iter().position(|&companion| companion == id)
        {
            self.companions[place] = before;
        }
        self.selected = Some(id);
    }

    /// Adds a handle to those that are selected, or takes it from them.
    pub(crate) fn toggle(&mut self, id: HandleId) {
        if self.selected == Some(id) {
            self.selected = self.companions.pop();
        } else if let Some(place) = self.companions.iter().position(|&companion| companion == id) {
            self.companions.remove(place);
        } else if let Some(before) = self.selected.replace(id) {
            self.companions.push(before);
        }
    }

    /// Selects all handles; the selected one stays it.
    pub(crate) fn put_all(&mut self, document: &Document) {
        let ids = || document.handles().iter().map(|handle| handle.id);
        self.selected = self.selected.or_else(|| ids().next());
        self.companions = ids().filter(|&id| self.selected != Some(id)).collect();
    }

    /// Selects the next handle of the list.
    pub(crate) fn put_next(&mut self, document: &Document) {
        let handles = document.handles();
        let present = self
            .selected
            .and_then(|id| handles.iter().position(|handle| handle.id == id));
        let next = present.map_or(0, |index| (index + 1) % handles.len().max(1));
        self.selected = handles.get(next).map(|handle| handle.id);
    }

    /// Lets go of handles that are gone; in place of the selected one the last of the list is selected.
    pub(super) fn drop_lost(&mut self, document: &Document) {
        if self.selected.is_some_and(|id| document.handle(id).is_none()) {
            self.selected = document.handles().last().map(|handle| handle.id);
        }
        let selected = self.selected;
        self.companions
            .retain(|&id| document.handle(id).is_some() && selected != Some(id));
    }
}

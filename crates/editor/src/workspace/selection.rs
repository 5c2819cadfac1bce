//! The selected handles: one, and others in addition.

use crate::document::{Document, HandleId};

/// The handles for commands, the gizmo and the handle brush.
#[derive(Clone, Debug, Default)]
pub(crate) struct HandleSelection {
    selected: Option<HandleId>,
    companions: Vec<HandleId>,
    /// True if the next stroke of the handle brush makes a new handle.
    pub(crate) wants_new_handle: bool,
}

impl HandleSelection {
    /// The selected handle.
    pub(crate) fn selected(&self) -> Option<HandleId> {
        self.selected
    }

    /// The other selected handles.
    pub(crate) fn companions(&self) -> &[HandleId] {
        &self.companions
    }

    /// Selects a handle, or none, and keeps the other selected ones.
    pub(crate) fn put(&mut self, id: Option<HandleId>) {
        self.selected = id;
    }

    /// Selects a handle, or none, alone.
    pub(crate) fn put_alone(&mut self, id: Option<HandleId>) {
        self.companions.clear();
        self.selected = id;
    }

    /// Selects a clicked handle: others in its selection stay selected.
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

    /// Adds a handle to the selected ones, or removes it from them.
    pub(crate) fn toggle(&mut self, id: HandleId) {
        if self.selected == Some(id) {
            self.selected = self.companions.pop();
        } else if let Some(place) = self.companions.iter().position(|&companion| companion == id) {
            self.companions.remove(place);
        } else if let Some(before) = self.selected.replace(id) {
            self.companions.push(before);
        }
    }

    /// Selects all handles; the selected one stays the main one.
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

    /// Deselects handles that no longer exist; the last of the list replaces the selected one.
    pub(super) fn drop_lost(&mut self, document: &Document) {
        if self.selected.is_some_and(|id| document.handle(id).is_none()) {
            self.selected = document.handles().last().map(|handle| handle.id);
        }
        let selected = self.selected;
        self.companions
            .retain(|&id| document.handle(id).is_some() && selected != Some(id));
    }
}

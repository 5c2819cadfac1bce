//! An editor that follows another: the same document, solved by another method, to compare both on the same drag.
//!
//! It has jobs of its own and a shape of its own; everything else comes from the one that it follows. Nothing comes
//! back, and nothing of it is undone or saved.

use std::sync::Arc;

use pliant_deform::Method;

use crate::Event;
use crate::editor::Editor;
use crate::workspace::is_other_problem;

impl Editor {
    /// Takes over what the other editor has, but for the method. Its jobs go to this editor's own executor.
    pub fn follow(&mut self, leader: &Self, method: &Method) {
        let Some(model) = &leader.engine.model else { return };
        let is_open = self.engine.model.as_ref().is_some_and(|own| Arc::ptr_eq(own, model));
        if !is_open {
            self.handle(Event::Opened {
                model: Arc::clone(model),
                name: leader.file_name.clone(),
                beginning: None,
            });
            self.followed = None;
        }
        let theirs = &leader.document;
        let is_known = self.document.method == *method
            && self.followed.as_ref().is_some_and(|known| {
                !is_other_problem(known, theirs) && known.handles == theirs.handles && known.access == theirs.access
            });
        if !is_known {
            let (rest, from_rest) = (Arc::clone(&self.document.rest), Arc::clone(&self.document.from_rest));
            self.document = theirs.clone();
            self.document.method = method.clone();
            if Arc::ptr_eq(&rest, &theirs.rest) {
                // What this method made of the last targets is shown until it has made something of the new ones.
                self.document.from_rest = from_rest;
            }
            self.document.refresh_from_file();
            self.document.settled = false;
            self.followed = Some(theirs.clone());
        }
        self.camera = leader.camera;
        self.is_framed = false;
        (self.look, self.mode, self.gizmo_mode) = (leader.look, leader.mode, leader.gizmo_mode);
        (self.selected, self.orientation) = (leader.selected, leader.orientation);
        self.conclude();
        self.refresh_overlay();
    }
}

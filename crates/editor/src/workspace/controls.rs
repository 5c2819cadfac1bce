//! The control points of the method's cage or lattice: their display, their input and their moves.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;
use pliant_deform::Attachment;

use super::options::at_rest;
use super::state::Workspace;
use crate::document::Document;
use crate::jobs::BoundControls;

impl Workspace {
    /// The cage or lattice, with the visible positions of its points: those of the binding, moved at once by
    /// later moves of the hand, or the document's own if it has no binding.
    pub(super) fn shown_attachment(&self) -> Option<BoundControls> {
        let document = &self.document;
        let method = document.method();
        let own = document.attachment();
        let bound = self.computed().controls();
        let bound = bound.filter(|bound| method.declaration().attachment(bound.name).is_some());
        let Some((name, attachment)) = own else {
            return bound.cloned();
        };
        if let Some(bound) = bound.filter(|bound| bound.attachment.rests_as(attachment)) {
            let places = bound.positions.iter().zip(bound.attachment.moved()?.iter());
            let moved = attachment.moved()?.iter();
            let positions = places.zip(moved).map(|((seen, before), now)| *seen + (*now - *before));
            return Some(BoundControls {
                positions: Arc::new(positions.collect()),
                attachment: attachment.clone(),
                ..bound.clone()
            });
        }
        Some(BoundControls {
            name,
            edges: Arc::new(attachment.edges()),
            positions: Arc::clone(attachment.moved()?),
            attachment: attachment.clone(),
        })
    }
}

/// Puts an attachment of the present method, with its points moved by a drag, into the document.
pub(crate) fn put_attachment(document: &mut Document, name: &'static str, attachment: Attachment) {
    let mut attachments = Arc::clone(&document.attachments);
    if attachments.get(name) != Some(&attachment) {
        Arc::make_mut(&mut attachments).insert(name, attachment);
        document.unsettle();
        document.set_attachments(attachments);
    }
}

/// Replaces the present cage or lattice by a person's.
pub(crate) fn bring(workspace: &mut Workspace, attachment: Attachment) {
    let declaration = workspace.document.method().declaration();
    let declared = declaration.attachments.iter().find(|own| own.kind == attachment.kind());
    let Some(declared) = declared else {
        let why = format!("{} has no such input: choose another method first.", declaration.title);
        workspace.refuse(why);
        return;
    };
    let checked = workspace.document.method().check_attachment(declared.name, &attachment);
    if let Err(refused) = checked {
        workspace.refuse(format!("The {} {refused}.", declared.title));
        return;
    }
    workspace.controls.put([]);
    workspace.change(format!("Load {}", declared.title), |document| {
        let mut attachments = Arc::clone(&document.attachments);
        Arc::make_mut(&mut attachments).insert(declared.name, attachment);
        put_other(document, attachments);
    });
}

/// Removes the document's cage or lattice: the method makes one.
pub(crate) fn make(workspace: &mut Workspace) {
    let Some((name, _)) = workspace.document.attachment() else {
        return;
    };
    workspace.controls.put([]);
    workspace.change(format!("Make {name}"), |document| {
        let mut attachments = Arc::clone(&document.attachments);
        Arc::make_mut(&mut attachments).remove(name);
        put_other(document, attachments);
    });
}

/// Takes the control points back to their rest positions.
pub(crate) fn reset(workspace: &mut Workspace) {
    workspace.change("Reset points", |document| {
        let rested = at_rest(document);
        document.unsettle();
        document.set_attachments(rested);
    });
}

/// Sets another cage or lattice: the shape is solved again, from the rest shape alone.
fn put_other(document: &mut Document, attachments: Arc<BTreeMap<&'static str, Attachment>>) {
    document.unsettle_if_displaced();
    document.set_attachments(attachments);
    document.unsettle_if_displaced();
}

/// The middle of some points.
pub(crate) fn middle(points: impl ExactSizeIterator<Item = DVec3>) -> DVec3 {
    let count = points.len().max(1) as f64;
    points.sum::<DVec3>() / count
}

//! The conversion between the document and the edit file that the command line reads.

use std::sync::Arc;

use glam::DVec3;
use pliant_deform::{Attachment, CONTINUITY_RANGE, Role};
use pliant_mesh::Model;

use super::attachment::AttachmentEntry;
use super::document_keys;
use super::examples::entries_of;
use super::path::PathEntry;
use super::pivoted::{with_pivot, without_pivot};
use super::project::StoredKept;
use crate::document::{
    Content, Document, FREE_BEND_DEG, Handle, HandleId, HandleLine, Paint, PivotPlace, Reach, followed,
};
use crate::region::{FileContacts, Region, region_input};
use crate::{EditError, EditFile, FieldEntry, HandleEntry, HandleTransform, Selector};

/// The reason why a document can't be written as an edit.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ExportError {
    /// No file is open.
    #[error("no file is open: open one before saving an edit")]
    NoFile,
    /// The rest shape differs from the file's.
    #[error(
        "the document has an applied shape, but an edit starts from the file's shape: save the mesh and open it, then \
         bend it further"
    )]
    Applied,
    /// A file vertex is drawn twice, and its two places have different roles.
    #[error("{count} vertices are shown by two nodes and are painted differently there: paint both places alike")]
    SharedVertices {
        /// The number of surface vertices that come out differently.
        count: usize,
    },
    /// The written edit can't be read.
    #[error(transparent)]
    Edit(#[from] EditError),
}

/// The document as an edit of its file.
pub(crate) fn export(document: &Document, model: &Arc<Model>) -> Result<EditFile, ExportError> {
    if document.applied {
        return Err(ExportError::Applied);
    }
    let is_keyed = !document.animation().keys().is_empty();
    // Frames of an animation don't begin at the shape of one of them.
    let kept = match is_keyed {
        true => document.kept.clone(),
        false => document.to_go_on_from(),
    };
    // An edit counts no full turns: values that depend on them are written as shown.
    // Keys have no full values, unless the strength has keys: they are then instead of the edit's own.
    let has_strength = document.animation().has_strength();
    let in_full = Some(document.in_full());
    let in_full = in_full.filter(|document| has_strength || (!is_keyed && document.goes_the_short_way()));
    let strength = match in_full.is_some() && !has_strength {
        true => document.strength(),
        false => 1.0,
    };
    // Handles have their shown places then, and curves their full way.
    let curve_share = if in_full.is_some() { 1.0 } else { document.strength() };
    let document = in_full.as_ref().unwrap_or(document);
    let region = Region::measure(
        &region_input(&**model, document, &FileContacts::default()),
        &pliant_mesh::Cancel::new(),
    )
    .unwrap_or_else(|_| Region::still(document.paint.len()));
    let ranges = |role: Role| Selector::of_surface(model, |vertex| region.roles[vertex.index()] == role);
    let parent_place = |parent: Option<HandleId>| {
        let place = region.handles.iter().position(|id| Some(*id) == parent)?;
        Some(place as u32)
    };
    let mut handles = Vec::new();
    for (index, &id) in region.handles.iter().enumerate() {
        if let Some(handle) = document.handle(id) {
            handles.push(HandleEntry {
                name: handle.name.clone(),
                select: Some(ranges(Role::Handle(index as u16))),
                pose: None,
                transform: with_pivot(handle),
                free_along: handle.freedom(),
                curve: handle
                    .line
                    .as_ref()
                    .and_then(HandleLine::curve)
                    .map(|curve| curve.part(curve_share)),
                sketch: handle.line.as_ref().and_then(HandleLine::sketch).cloned(),
                soft: handle.soft,
                continuity: handle.continuity,
                parent: parent_place(handle.parent),
                bend: Some(handle.bend_deg).filter(|range| *range != FREE_BEND_DEG),
            });
        }
    }
    let field = |field: &Option<Arc<Vec<f64>>>, default: f64| -> Vec<FieldEntry> {
        let entry = field
            .as_ref()
            .map(|field| FieldEntry::of_surface(field, default, model));
        entry.into_iter().collect()
    };
    let edit = EditFile {
        method: document.method.clone(),
        attachments: document
            .attachment()
            .into_iter()
            .map(|(name, attachment)| match attachment {
                Attachment::Shapes(examples) => (name, AttachmentEntry::Examples(entries_of(examples, model))),
                other => (name, AttachmentEntry::Given(other.clone())),
            })
            .collect(),
        region: ranges(Role::Free),
        fixed: Selector::None,
        handles,
        stiffness: field(&document.stiffness, 1.0),
        continuity: field(&document.continuity, *CONTINUITY_RANGE.end()),
        loose: document.loose,
        loose_parts: document
            .loose_parts
            .iter()
            .map(|(part, loose)| (Selector::Component(*part), *loose))
            .collect(),
        inside_out: match document.inside_out.is_empty() {
            true => Selector::None,
            false => Selector::Union(document.inside_out.iter().copied().map(Selector::Component).collect()),
        },
        kept: kept.map(|kept| {
            let place = |id: HandleId| region.handles.iter().position(|other| *other == id);
            let stored = StoredKept::of(&kept, model).renumbered(|id| place(id).map(|place| place as u32));
            stored.by(&document.method)
        }),
        strength,
        keys: document_keys::entries(document, &region.handles),
        filter: document_keys::filters(document, &region.handles),
        footprints: document_keys::footprints(document, &region.handles),
        path: document.animation().path().map(|path| PathEntry::of(path)),
        mix: document_keys::mix(document, &region.handles),
        weld: model.weld.distance,
        places: None,
    };
    let setup = edit.resolve(model)?;
    let differing = setup
        .roles
        .iter()
        .zip(region.roles.iter())
        .filter(|(read, meant)| read != meant)
        .count();
    if differing > 0 {
        return Err(ExportError::SharedVertices { count: differing });
    }
    Ok(edit)
}

/// A document from an edit: every vertex's role in the edit is painted.
pub(crate) fn import(edit: &EditFile, model: &Model) -> Result<Document, EditError> {
    let placed = edit.placed(model)?;
    let edit = placed.as_ref().map_or(edit, |placed| &placed.edit);
    let in_full = EditFile {
        strength: 1.0,
        ..edit.clone()
    };
    let setup = in_full.resolve(model)?;
    let mut document = Content::new(model.surface.positions.len());
    document.paint = Arc::new(
        setup
            .roles
            .iter()
            .map(|role| match *role {
                Role::Fixed => Paint::Fixed,
                Role::Free => Paint::Free,
                Role::Handle(index) => Paint::Handle(HandleId(index)),
            })
            .collect(),
    );
    for (index, handle) in setup.handles.iter().enumerate() {
        let id = HandleId(index as u16);
        let transform = without_pivot(handle.transform);
        document.handles.push(Handle {
            turn_deg: match transform {
                HandleTransform::Trs { rotation, .. } => followed(DVec3::ZERO, rotation),
                HandleTransform::Matrix(_) => DVec3::ZERO,
            },
            transform,
            pivot: handle.pivot,
            free_along: handle.free_along.and_then(DVec3::try_normalize),
            pivot_place: PivotPlace::Picked,
            reach: Reach::Length(0.0),
            soft: setup.soft[index],
            continuity: edit.handles[index].continuity,
            parent: edit.handles[index].parent.map(|place| HandleId(place as u16)),
            bend_deg: edit.handles[index].bend.unwrap_or(FREE_BEND_DEG),
            line: handle.line.clone(),
            ..Handle::new(id, handle.name.clone())
        });
        document.next_handle = id.0.saturating_add(1);
    }
    document.stiffness = setup
        .stiffness
        .iter()
        .any(|&stiffness| stiffness != 1.0)
        .then(|| Arc::new(setup.stiffness.clone()));
    let continuity = edit.painted_continuity(model)?;
    document.continuity = (!continuity.is_empty()).then(|| Arc::new(continuity));
    document.loose_parts = Arc::new(setup.loose_parts.iter().copied().collect());
    document.inside_out = Arc::new(setup.inside_out.clone());
    document.method = setup.method.clone();
    document.attachments = Arc::new(setup.attachments.iter().cloned().collect());
    document.loose = setup.loose;
    let mut document = Document::from(document);
    document.take_part(edit.part_before_keys());
    if !edit.keys.is_empty() || edit.member_of_sequences().is_some() {
        document_keys::take_keys(&mut document, edit, &setup)?;
    }
    if let Some(kept) = edit.kept.as_ref().and_then(|kept| kept.taken_by(&edit.method)) {
        document.go_on_from(kept.on(model, "kept")?);
    }
    if document.is_moved() {
        document.unsettle();
    }
    Ok(document)
}

//! A project's document on its mesh.

use std::sync::Arc;

use pliant_deform::{AttachmentKind, CONTINUITY_RANGE, METHODS};
use pliant_mesh::{Cancel, Model};

use super::examples::read_examples;
use super::mesh_reference::geometry_hash;
use super::objects::access;
use super::poses::StoredPose;
use super::{Project, StoredTips};
use crate::STIFFNESS_RANGE;
use crate::document::{Content, Document, Handle, HandleId, Paint, Tips, is_within};
use crate::format::attachment::read_stored_attachments;
use crate::format::edit_error::EditError;
use crate::format::method::read_method;
use crate::format::setup::Setup;
use crate::format::stored_field::{Ranges, for_each_drawn};
use crate::format::strength::strength_kind;
use crate::region::{FileContacts, Region, region_input};
use crate::warning::shortened;

impl Project {
    /// The document as it was shown: in its work pose, if it was in one.
    ///
    /// # Errors
    /// Those of [`Self::document`].
    pub(crate) fn shown_document(&self, model: &Model) -> Result<Document, EditError> {
        let mut document = self.document(model)?;
        if let Some(pose) = &self.work_pose {
            document.enter_work_pose();
            document.take_pose(&pose.pose(), |_| true);
        }
        Ok(document)
    }

    /// The document on its mesh.
    ///
    /// # Errors
    /// Another mesh; invalid values.
    pub(crate) fn document(&self, model: &Model) -> Result<Document, EditError> {
        let found = geometry_hash(model);
        if found != self.mesh.geometry {
            return Err(EditError::OtherMesh {
                name: "the given one".to_owned(),
                found: hash_shown(&found),
                expected: hash_shown(&self.mesh.geometry),
            });
        }
        let mut document = Content::new(model.surface.positions.len());
        let (method, _) = read_method(&self.method).map_err(|error| error.under("method"))?;
        let attachments = read_stored_attachments(&method, &self.attachments);
        let mut attachments = attachments.map_err(|error| error.under("attachments"))?;
        for declared in METHODS.iter().flat_map(|declaration| declaration.attachments) {
            if let Some(stored) = self.attachments.get(declared.name)
                && declared.kind == AttachmentKind::Shapes
            {
                let examples = read_examples(stored, model);
                let examples = examples.map_err(|error| error.under(declared.name).under("attachments"))?;
                attachments.insert(declared.name, examples);
            }
        }
        document.attachments = Arc::new(attachments);
        document.method = method;
        document.loose = self.loose.into();
        document.tips = match self.tips {
            Some(StoredTips::Held) => Tips::Held,
            None | Some(StoredTips::ComeAlong) => Tips::ComeAlong,
        };
        document.inside_out = Arc::new(self.inside_out.clone());
        document.loose_parts = Arc::new(
            self.loose_parts
                .iter()
                .map(|(part, loose)| (*part, (*loose).into()))
                .collect(),
        );
        self.read_paint_and_handles(model, &mut document)?;
        document.next_handle = self.next_handle;
        document.access = Arc::new(access(&self.objects, self.isolated, self.small_parts, model)?);
        let is_rigid = |value: f64| value == f64::INFINITY;
        let stiffness = self.stiffness.as_ref();
        document.stiffness = stiffness
            .map(|field| field.numbers("stiffness", model, 1.0, STIFFNESS_RANGE, is_rigid))
            .transpose()?;
        let (continuity, highest) = (self.continuity.as_ref(), *CONTINUITY_RANGE.end());
        document.continuity = continuity
            .map(|field| field.numbers("continuity", model, highest, CONTINUITY_RANGE, |_| false))
            .transpose()?;
        document.applied = self.applied;
        if let Some(rest) = &self.rest {
            document.applied = true;
            document.rest = rest.displacements("rest", model)?;
        }
        if let Some(shape) = &self.shape {
            document.from_rest = shape.displacements("shape", model)?;
        }
        if let Some(kept) = &self.kept {
            document.kept = Some(Arc::new(kept.on(model, "kept")?));
        }
        document.settled = self.settled;
        if let Some(flow) = &self.flow {
            document.flow_options = flow.options()?;
            document.fluid = flow.fluid(model)?;
        }
        document.poses = Arc::new(self.poses.iter().map(StoredPose::pose).collect());
        if let Some(animation) = &self.animation {
            document.animation = animation.animation()?;
        }
        let mut document = Document::from(document);
        if let Some(strength) = self.strength {
            strength_kind()
                .check(strength)
                .map_err(|error| error.under("strength"))?;
            document.take_part(strength);
        }
        if !document.is_moved() && !document.settled {
            // This method moves nothing, so the other method's shape is dropped.
            match document.kept {
                Some(_) => document.settle(),
                None => document.unbend(),
            }
        }
        if document.animation().keys().is_empty() {
            // Frames of an animation don't begin at the shape of one of them.
            document.keep_way();
        }
        Ok(document)
    }

    fn read_paint_and_handles(&self, model: &Model, document: &mut Content) -> Result<(), EditError> {
        let paint = Arc::make_mut(&mut document.paint);
        let mut put = |ranges: &Ranges, name: &str, value: Paint| {
            for_each_drawn(ranges, name, model, |vertex| {
                if let Some(vertex) = vertex {
                    paint[vertex.index()] = value;
                }
                Ok(())
            })
        };
        put(&self.region, "region", Paint::Free)?;
        put(&self.fixed, "fixed", Paint::Fixed)?;
        for stored in &self.handles {
            let id = HandleId(stored.id);
            if document.handles.iter().any(|handle| handle.id == id) || stored.id >= self.next_handle {
                return Err(EditError::Project(format!(
                    "the handle `{}` has the number {}, which is taken or too large: give each handle its own number \
                     below `next_handle`",
                    shortened(&stored.name),
                    stored.id
                )));
            }
            put(
                &stored.vertices,
                &format!("handles: {}", shortened(&stored.name)),
                Paint::Handle(id),
            )?;
            document.handles.push(stored.handle()?);
        }
        let handles = &document.handles;
        let is_wrong = |handle: &&Handle| {
            let parent = handle
                .parent
                .filter(|parent| handles.iter().any(|other| other.id == *parent));
            handle.parent.is_some() && parent.is_none_or(|parent| is_within(handles, parent, handle.id))
        };
        match handles.iter().find(is_wrong) {
            Some(handle) => Err(EditError::Project(format!(
                "the parent of the handle `{}` is missing or rides along with it: remove its `parent`",
                shortened(&handle.name)
            ))),
            None => Ok(()),
        }
    }

    /// The solver's input: the document's regions, from its own rest shape.
    pub(crate) fn resolve(&self, model: &Model) -> Result<Setup, EditError> {
        let document = self.document(model)?;
        let input = region_input(model, &document, &FileContacts::default());
        let region = Region::measure(&input, &Cancel::new()).unwrap_or_else(|_| Region::still(document.paint.len()));
        Ok(Setup::of_document(&document, &region, &model.surface))
    }
}

/// A part of a hash that is long enough to distinguish it from others.
fn hash_shown(hash: &str) -> String {
    hash.chars().take(19).chain("…".chars()).collect()
}

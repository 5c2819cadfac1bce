//! The present document as a project.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;
use pliant_deform::{Attachment, CONTINUITY_RANGE};
use pliant_mesh::Model;

use super::animation::StoredAnimation;
use super::camera::StoredCamera;
use super::examples::stored_examples;
use super::flow::StoredFlow;
use super::handle::StoredHandle;
use super::mesh_reference::MeshReference;
use super::objects::{StoredSmallParts, stored_objects};
use super::poses::StoredPose;
use super::{PROJECT_VERSION, Project, StoredTips};
use crate::Camera;
use crate::document::{Document, Paint, Tips, bits_equal};
use crate::format::attachment::stored_attachments;
use crate::format::kept::StoredKept;
use crate::format::method::method_to_value;
use crate::format::stored_field::{Field, ranges_where};

impl Project {
    /// The present document.
    pub fn of(document: &Document, model: &Model, camera: Option<&Camera>, mesh: MeshReference) -> Self {
        let painted = |paint: Paint| ranges_where(model, |vertex| document.paint[vertex.index()] == paint);
        let displacements = |field: &Arc<Vec<DVec3>>| {
            let field = Arc::clone(field);
            Field::of(model, move |vertex| {
                let value = field[vertex.index()];
                (!bits_equal(value, DVec3::ZERO)).then_some(value.to_array())
            })
        };
        let numbers = |field: &Option<Arc<Vec<f64>>>, default: f64| {
            let field = field.as_ref()?;
            Field::of(model, |vertex| {
                let value = field[vertex.index()];
                (value != default).then_some([value])
            })
        };
        let in_full = document.in_full();
        let mut attachments = stored_attachments(&document.method, &in_full.attachments);
        for (name, attachment) in &*in_full.attachments {
            if let Attachment::Shapes(examples) = attachment {
                attachments.insert((*name).to_owned(), stored_examples(examples, model));
            }
        }
        Self {
            version: PROJECT_VERSION,
            mesh,
            method: method_to_value(&document.method, &BTreeMap::new()),
            attachments,
            inside_out: (*document.inside_out).clone(),
            loose: document.loose.into(),
            loose_parts: document
                .loose_parts
                .iter()
                .map(|(part, loose)| (*part, (*loose).into()))
                .collect(),
            tips: (document.tips == Tips::Held).then_some(StoredTips::Held),
            region: painted(Paint::Free),
            fixed: painted(Paint::Fixed),
            handles: in_full
                .handles
                .iter()
                .map(|handle| StoredHandle::of(handle, painted(Paint::Handle(handle.id))))
                .collect(),
            next_handle: document.next_handle,
            objects: stored_objects(&document.access, model),
            isolated: document.access.isolated,
            small_parts: StoredSmallParts::of(document.access.small),
            stiffness: numbers(&document.stiffness, 1.0),
            continuity: numbers(&document.continuity, *CONTINUITY_RANGE.end()),
            rest: document.applied.then(|| displacements(&document.rest)).flatten(),
            applied: document.applied,
            shape: displacements(&document.from_rest),
            // Data that opening makes again from the shape are not stored twice.
            kept: document
                .kept
                .as_ref()
                .filter(|_| !document.keeps_way_alone())
                .map(|kept| StoredKept::of(kept, model)),
            settled: document.settled,
            weld: model.weld.distance,
            strength: document.strength.as_ref().map(|strength| strength.share),
            poses: document.poses.iter().map(StoredPose::of).collect(),
            work_pose: None,
            animation: StoredAnimation::of(document.animation()),
            sequence: None,
            own_key_times: false,
            flow: StoredFlow::of(&document.fluid, &document.flow_options, model),
            mesh_colours: None,
            camera: camera.map(StoredCamera::of),
        }
    }
}

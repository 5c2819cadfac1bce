//! A `.pliant` project: the document, its mesh, and the camera.
//!
//! JSON, with a version. The mesh is named by its path (for finding it) and by a hash of its geometry (for recognising
//! it): the hash covers the meaning of vertex numbers (positions, triangles and the file's order), so the kept original
//! of a file that was saved over is recognised under any name. Regions are ranges of the file's drawn vertices; only
//! fields of numbers are base64 ([`field`]).

mod animation;
mod camera;
mod examples;
mod flow;
mod handle;
mod objects;
mod place;
mod poses;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use glam::DVec3;
use pliant_deform::{Attachment, AttachmentKind, CONTINUITY_RANGE, METHODS, Method};
use pliant_mesh::{Cancel, Model, WeldOptions};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use sha2::{Digest, Sha256};

use self::animation::StoredAnimation;
use self::camera::StoredCamera;
use self::examples::{are_weighed, read_examples, stored_examples};
use self::flow::StoredFlow;
use self::handle::StoredHandle;
use self::objects::{StoredObject, StoredSmallParts, access, stored_objects};
use self::poses::StoredPose;
use super::attachment::{read_stored_attachments, stored_attachments};
use super::digest::hexadecimal;
use super::edit_error::EditError;
use super::json::parse;
use super::loose::StoredLoose;
use super::method::{method_to_value, read_method};
use super::reader::read;
use super::setup::Setup;
use super::strength::strength_kind;
use crate::document::{Content, Document, Handle, HandleId, Paint, Pose, Tips, bits_equal, is_within};
pub use crate::format::kept::StoredKept;
use crate::format::stored_field::{Field, Ranges, for_each_drawn, ranges_where};
use crate::region::{FileContacts, Region, region_input};
use crate::warning::shortened;
use crate::{Camera, Dye, STIFFNESS_RANGE};

/// The version of the project format for reading and writing.
const PROJECT_VERSION: u64 = 1;

/// A project, as stored.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Project {
    version: u64,
    mesh: MeshReference,
    method: Value,
    /// The methods' inputs beside handles, by declared name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    attachments: BTreeMap<String, Value>,
    loose: StoredLoose,
    /// The behaviour of single parts instead of that, by their component's number.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    loose_parts: BTreeMap<u32, StoredLoose>,
    /// The state of the tips; without it, they are free.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    tips: Option<StoredTips>,
    /// Painted free.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    region: Ranges,
    /// Painted fixed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    fixed: Ranges,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    handles: Vec<StoredHandle>,
    #[serde(default)]
    next_handle: u16,
    /// The connected parts that are turned inside out, by their component's number.
    #[serde(default, skip_serializing_if = "BTreeSet::is_empty")]
    inside_out: BTreeSet<u32>,
    /// Objects that are hidden or locked.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    objects: Vec<StoredObject>,
    /// The isolated connected part, by its number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    isolated: Option<u32>,
    /// The size of small parts, and their treatment.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    small_parts: Option<StoredSmallParts>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    stiffness: Option<Field>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    continuity: Option<Field>,
    /// The rest shape's displacements from the file's, once a shape was applied.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    rest: Option<Field>,
    #[serde(default)]
    applied: bool,
    /// The present shape's displacements from the rest shape.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    shape: Option<Field>,
    /// The shape when the constraints last changed, from which the next drag begins.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    kept: Option<StoredKept>,
    /// True if that is the final solution for the handles' transforms; if not, it is computed on opening.
    settled: bool,
    /// The distance within which the mesh's vertices are joined; without it, it follows from the mesh.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    weld: Option<f64>,
    /// The shown share of handles and attachments, which are stored in full; without it, all of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    strength: Option<f64>,
    /// The kept poses.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    poses: Vec<StoredPose>,
    /// The work pose that was shown, from which a person returns to the rest of this.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    work_pose: Option<StoredPose>,
    /// The edit over time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    animation: Option<StoredAnimation>,
    /// The sequence of whose frames the mesh is one, by its path, as the mesh's own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    sequence: Option<String>,
    /// True if every key of a glTF's animation is a frame; if not, there are 24 frames a second.
    #[serde(default, skip_serializing_if = "is_false")]
    own_key_times: bool,
    /// The fluid on the surface, and the forces in its flow.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    flow: Option<StoredFlow>,
    /// The [`digest`] of the mesh's own vertex colours, under dye that was kept.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    mesh_colours: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    camera: Option<StoredCamera>,
}

/// [`Tips`] by its name.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", expecting = "\"come-along\" or \"held\"")]
enum StoredTips {
    ComeAlong,
    Held,
}

/// The mesh of a project.
#[derive(Clone, PartialEq, Eq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeshReference {
    /// Its path, relative to the project's folder if it is below that; `None` is the built-in sample.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub path: Option<String>,
    /// Its name, if its path doesn't give it: for a copy that was kept because the file was saved over.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Its [`geometry_hash`].
    pub geometry: String,
}

/// `sha256:` and the digest of the meaning of vertex numbers: the drawn positions' bits, the triangles and the file's
/// vertices behind the drawn ones.
pub fn geometry_hash(model: &Model) -> String {
    let mut hash = Sha256::new();
    let drawn = model.rest();
    for count in [drawn.positions.len(), drawn.triangles.len(), drawn.file_vertex_count] {
        hash.update((count as u64).to_le_bytes());
    }
    for position in &drawn.positions {
        hash.update(position.to_array().map(f64::to_le_bytes).as_flattened());
    }
    for triangle in &drawn.triangles {
        hash.update(triangle.map(|vertex| vertex.0.to_le_bytes()).as_flattened());
    }
    for vertex in &drawn.file_vertex {
        hash.update(vertex.0.to_le_bytes());
    }
    hexadecimal(hash)
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes by reference")]
fn is_false(value: &bool) -> bool {
    !value
}

impl Project {
    /// Reads a project's JSON text.
    ///
    /// # Errors
    /// Members that the format does not have, by name and place.
    pub fn parse(text: &str) -> Result<Self, EditError> {
        let value = parse(text).map_err(|error| match error {
            EditError::Json(error) => EditError::Project(error),
            error => error.at("the project"),
        })?;
        Self::from_value(&value)
    }

    /// Reads a project from a JSON value.
    pub(crate) fn from_value(value: &Value) -> Result<Self, EditError> {
        // The version comes first: another one may have members that this one lacks.
        match value.get("version") {
            Some(version) if version.as_u64() == Some(PROJECT_VERSION) => {}
            Some(version) => return Err(EditError::ProjectVersion(shortened(&version.to_string()))),
            None => return Err(EditError::Project("it has no `version`: add it".to_owned())),
        }
        read(value).map_err(|error| error.at("the project"))
    }

    /// The project as JSON text with a newline at its end.
    pub fn to_json(&self) -> String {
        // Plain data with text keys always serialises.
        let mut text = serde_json::to_string_pretty(self).unwrap_or_default();
        text.push('\n');
        text
    }

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

    /// The joining of its mesh's vertices.
    pub fn weld_options(&self) -> WeldOptions {
        WeldOptions {
            distance: self.weld.filter(|distance| *distance >= 0.0),
        }
    }

    /// Its mesh.
    pub fn mesh(&self) -> &MeshReference {
        &self.mesh
    }

    /// The path of the sequence of whose frames the mesh is one, as the mesh's own.
    pub fn sequence(&self) -> Option<&str> {
        self.sequence.as_deref()
    }

    /// Returns true if every key of the glTF's animation, which is the sequence, is a frame; if not, there are 24 frames a
    /// second.
    pub fn has_own_key_times(&self) -> bool {
        self.own_key_times
    }

    /// The same of a glTF's animation of which every key is a frame.
    #[must_use]
    pub fn with_own_key_times(self) -> Self {
        Self {
            own_key_times: true,
            ..self
        }
    }

    /// The other sequence that leads handles, by its path.
    pub fn mixed_sequence(&self) -> Option<&str> {
        let mix = self.animation.as_ref()?.mix.as_ref()?;
        Some(&mix.sequence)
    }

    /// The same with another path of the sequence that leads handles, if there is one.
    #[must_use]
    pub fn mixed_with(mut self, path: String) -> Self {
        if let Some(mix) = self.animation.as_mut().and_then(|animation| animation.mix.as_mut()) {
            mix.sequence = path;
        }
        self
    }

    /// The same of a sequence at this path.
    #[must_use]
    pub fn of_sequence(self, path: Option<String>) -> Self {
        Self { sequence: path, ..self }
    }

    /// The same with the [digest](crate::digest) of the mesh's own vertex colours, over which its kept dye lies.
    #[must_use]
    pub fn over_colours(self, colours: String) -> Self {
        Self {
            mesh_colours: Some(colours),
            ..self
        }
    }

    /// The same, shown in a work pose.
    #[must_use]
    pub(crate) fn in_work_pose(self, pose: Option<&Pose>) -> Self {
        Self {
            work_pose: pose.map(StoredPose::of),
            ..self
        }
    }

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

    /// That digest, if it is known.
    pub fn mesh_colours(&self) -> Option<&str> {
        self.mesh_colours.as_deref()
    }

    /// The dye that was kept as vertex colours, of each surface vertex of its mesh.
    ///
    /// # Errors
    /// A fluid that can't be read.
    pub fn kept_dye(&self, model: &Model) -> Result<Option<Arc<Vec<Dye>>>, EditError> {
        let fluid = self.flow.as_ref().map(|flow| flow.fluid(model)).transpose()?;
        Ok(fluid.and_then(|fluid| fluid.kept))
    }

    /// A digest of the document in it, independent of the mesh's path, the camera and a work pose.
    pub fn document_hash(&self) -> String {
        let document = Self {
            camera: None,
            work_pose: None,
            mesh_colours: None,
            mesh: MeshReference {
                path: None,
                ..self.mesh.clone()
            },
            ..self.clone()
        };
        hexadecimal(Sha256::new().chain_update(document.to_json()))
    }

    /// The camera, if it is a valid view.
    pub(crate) fn camera(&self) -> Option<Camera> {
        self.camera.map(StoredCamera::camera).filter(Camera::is_usable)
    }

    /// The name of its method; empty if it has none that can be read.
    pub(crate) fn method_name(&self) -> &str {
        self.method["name"].as_str().unwrap_or_default()
    }

    pub(crate) fn set_method(&mut self, method: &Method) {
        self.method = method_to_value(method, &BTreeMap::new());
        // The shape is another method's; the corrections by hand are not.
        self.kept = self.kept.take().and_then(StoredKept::for_another_method);
        self.settled = false;
    }

    /// Returns true if the shape is the file's.
    pub(crate) fn changes_nothing(&self) -> bool {
        let moves = |attachment: &Value| attachment.get("moved").is_some() || are_weighed(attachment);
        let own = |name: &str| {
            METHODS
                .iter()
                .any(|method| method.name == self.method_name() && method.attachment(name).is_some())
        };
        let has_moved = self
            .attachments
            .iter()
            .any(|(name, attachment)| own(name) && moves(attachment));
        if self.kept.is_some() && !self.handles.is_empty() {
            return false;
        }
        let is_at_rest = !has_moved && self.handles.iter().all(StoredHandle::is_at_rest);
        self.rest.is_none() && (is_at_rest || self.strength == Some(0.0))
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

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
mod mesh_reference;
mod objects;
mod place;
mod poses;
mod reading;
mod writing;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use pliant_deform::{METHODS, Method};
use pliant_mesh::{Model, WeldOptions};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use sha2::{Digest, Sha256};

use self::animation::StoredAnimation;
use self::camera::StoredCamera;
use self::examples::are_weighed;
use self::flow::StoredFlow;
use self::handle::StoredHandle;
pub use self::mesh_reference::{MeshReference, geometry_hash};
use self::objects::{StoredObject, StoredSmallParts};
use self::poses::StoredPose;
use super::digest::hexadecimal;
use super::edit_error::EditError;
use super::json::parse;
use super::loose::StoredLoose;
use super::method::method_to_value;
use super::reader::read;
use crate::document::Pose;
pub use crate::format::kept::StoredKept;
use crate::format::stored_field::{Field, Ranges};
use crate::warning::shortened;
use crate::{Camera, Dye};

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
}

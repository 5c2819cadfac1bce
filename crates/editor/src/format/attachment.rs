//! A method's inputs beside handles, in both formats: a cage as its numbers or a file's name, a lattice as its numbers,
//! examples as a list.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;
use pliant_deform::{
    Attachment, AttachmentDeclaration, AttachmentKind, AttachmentRefused, ControlLattice, ControlMesh, METHODS, Method,
};
use pliant_mesh::Model;
use serde::de::Error;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::edit_error::EditError;
use super::examples::{ExampleEntry, examples_to_value, read_examples, resolved};
use super::reader::read;
use super::transform::Numbers;

/// An attachment in an edit.
#[derive(Clone, PartialEq, Debug)]
pub enum AttachmentEntry {
    /// A mesh in a file that must still be read; its name is relative to the edit's folder.
    File {
        /// The name.
        file: String,
        /// The moved positions of its points, if they are moved.
        moved: Option<Vec<DVec3>>,
    },
    /// Its numbers.
    Given(Attachment),
    /// Examples, whose files must still be read and which depend on the model.
    Examples(Vec<ExampleEntry>),
}

/// The attachments of a method, by their declared names.
pub(crate) type AttachmentEntries = BTreeMap<&'static str, AttachmentEntry>;

/// The members of a control mesh in the file.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StoredMesh {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    file: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    vertices: Option<Vec<Numbers<3>>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    triangles: Option<Vec<[u32; 3]>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    moved: Option<Vec<Numbers<3>>>,
}

/// The members of a control lattice.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StoredLattice {
    counts: [u32; 3],
    r#box: StoredBox,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    moved: Option<Vec<Numbers<3>>>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StoredBox {
    min: Numbers<3>,
    max: Numbers<3>,
}

/// Reads an attachment of a method; refusals name their place within the value.
pub(super) fn read_attachment(
    declared: &AttachmentDeclaration,
    method: &Method,
    value: &Value,
) -> Result<AttachmentEntry, EditError> {
    let attachment = match declared.kind {
        AttachmentKind::ControlMesh => match read_mesh(value)? {
            AttachmentEntry::Given(mesh) => mesh,
            entry => return Ok(entry),
        },
        AttachmentKind::ControlLattice => read_lattice(method, declared.name, value)?,
        AttachmentKind::Shapes => return read_examples(value).map(AttachmentEntry::Examples),
    };
    let checked = method.check_attachment(declared.name, &attachment);
    checked.map_err(|refused| sentence(&refused))?;
    Ok(AttachmentEntry::Given(attachment))
}

/// An attachment in both formats; unmoved points are left out.
pub(crate) fn attachment_to_value(method: &Method, entry: &AttachmentEntry) -> Value {
    let numbers = |points: &[DVec3]| points.iter().map(|point| Numbers(point.to_array())).collect();
    match entry {
        AttachmentEntry::File { file, moved } => json!(StoredMesh {
            file: Some(file.clone()),
            vertices: None,
            triangles: None,
            moved: moved.as_deref().map(numbers),
        }),
        AttachmentEntry::Examples(examples) => examples_to_value(examples),
        AttachmentEntry::Given(attachment) => {
            let rest = method.control_rest(attachment);
            let moved = attachment.moved().filter(|moved| ***moved != rest);
            let moved = moved.map(|moved| numbers(moved));
            match attachment {
                Attachment::Mesh(mesh) => json!(StoredMesh {
                    file: None,
                    vertices: Some(numbers(&mesh.rest)),
                    triangles: Some(mesh.triangles.to_vec()),
                    moved,
                }),
                Attachment::Lattice(lattice) => json!(StoredLattice {
                    counts: lattice.counts,
                    r#box: StoredBox {
                        min: Numbers(lattice.low.to_array()),
                        max: Numbers(lattice.high.to_array()),
                    },
                    moved,
                }),
                // An edit and a project list them by the model's vertices.
                Attachment::Shapes(_) => Value::Null,
            }
        }
    }
}

/// The attachments of a document, for any methods: all that a project stores except examples. The rest positions of
/// lattices are those of the document's own method, or of another one with its defaults.
pub(crate) fn stored_attachments(
    method: &Method,
    attachments: &BTreeMap<&'static str, Attachment>,
) -> BTreeMap<String, Value> {
    let stored = attachments.iter().filter_map(|(name, attachment)| {
        let (declared, owner) = owner(method, name)?;
        if declared.kind == AttachmentKind::Shapes {
            return None;
        }
        let entry = AttachmentEntry::Given(attachment.clone());
        Some(((*name).to_owned(), attachment_to_value(&owner, &entry)))
    });
    stored.collect()
}

/// Reads the value of [`stored_attachments`].
pub(crate) fn read_stored_attachments(
    method: &Method,
    stored: &BTreeMap<String, Value>,
) -> Result<BTreeMap<&'static str, Attachment>, EditError> {
    let mut attachments = BTreeMap::new();
    for (name, value) in stored {
        let names: Vec<&str> = METHODS
            .iter()
            .flat_map(|declaration| declaration.attachments.iter().map(|attachment| attachment.name))
            .collect();
        let (declared, owner) = owner(method, name).ok_or_else(|| EditError::unknown_member(name, &names))?;
        if declared.kind != AttachmentKind::Shapes {
            let entry = read_attachment(declared, &owner, value).map_err(|error| error.under(name))?;
            attachments.insert(declared.name, given(declared.name, entry)?);
        }
    }
    Ok(attachments)
}

/// The attachment in numbers.
///
/// # Errors
/// Its file was not read.
fn given(name: &'static str, entry: AttachmentEntry) -> Result<Attachment, EditError> {
    let file = match entry {
        AttachmentEntry::Given(attachment) => return Ok(attachment),
        AttachmentEntry::File { file, .. } => file,
        AttachmentEntry::Examples(_) => String::new(),
    };
    let unread = EditError::custom(format!(
        "names the file {file:?}, which can't be read here: give its numbers"
    ));
    Err(unread.under(name))
}

/// The attachment on a model.
///
/// One of its files was not read, or an example does not fit the model.
/// A file of it was not read, or an example does not fit the model.
pub(super) fn on_model(name: &'static str, entry: &AttachmentEntry, model: &Model) -> Result<Attachment, EditError> {
    match entry {
        AttachmentEntry::Examples(examples) => {
            let examples = resolved(name, examples, model).map_err(|error| error.under(name))?;
            Ok(Attachment::Shapes(examples))
        }
        other => given(name, other.clone()),
    }
}

/// A control mesh from a file, which replaces the file's name.
pub(super) fn of_file(
    method: &Method,
    name: &'static str,
    (rest, triangles): (Vec<DVec3>, Vec<[u32; 3]>),
    moved: Option<Vec<DVec3>>,
) -> Result<Attachment, EditError> {
    let rest = Arc::new(rest);
    let attachment = Attachment::Mesh(ControlMesh {
        moved: moved.map_or_else(|| Arc::clone(&rest), Arc::new),
        rest,
        triangles: Arc::new(triangles),
    });
    let checked = method.check_attachment(name, &attachment);
    checked.map_err(|refused| sentence(&refused).under(name))?;
    Ok(attachment)
}

/// The declaration of this name, with the method that reads it: the present one if it declares it.
fn owner(method: &Method, name: &str) -> Option<(&'static AttachmentDeclaration, Method)> {
    if let Some(declared) = method.declaration().attachment(name) {
        return Some((declared, method.clone()));
    }
    METHODS.iter().find_map(|declaration| {
        let declared = declaration.attachment(name)?;
        Some((declared, (declaration.default)()))
    })
}

fn read_mesh(value: &Value) -> Result<AttachmentEntry, EditError> {
    let stored: StoredMesh = read(value)?;
    let moved = stored.moved.map(points);
    let missing = |member| EditError::missing_field(member);
    match (stored.file, stored.vertices, stored.triangles) {
        (Some(file), None, None) => Ok(AttachmentEntry::File { file, moved }),
        (Some(_), vertices, _) => Err(EditError::custom(format!(
            "has both `file` and `{}`: keep one of them",
            if vertices.is_some() { "vertices" } else { "triangles" }
        ))),
        (None, None, None) => Err(EditError::custom(
            "has neither a `file` nor `vertices` and `triangles`: give one of them",
        )),
        (None, None, Some(_)) => Err(missing("vertices")),
        (None, Some(_), None) => Err(missing("triangles")),
        (None, Some(vertices), Some(triangles)) => {
            let rest = Arc::new(points(vertices));
            Ok(AttachmentEntry::Given(Attachment::Mesh(ControlMesh {
                moved: moved.map_or_else(|| Arc::clone(&rest), Arc::new),
                rest,
                triangles: Arc::new(triangles),
            })))
        }
    }
}

fn read_lattice(method: &Method, name: &str, value: &Value) -> Result<Attachment, EditError> {
    let stored: StoredLattice = read(value)?;
    let moved = stored.moved.map(points);
    let lattice = ControlLattice {
        counts: stored.counts,
        low: DVec3::from_array(stored.r#box.min.0),
        high: DVec3::from_array(stored.r#box.max.0),
        moved: Arc::new(moved.clone().unwrap_or_default()),
    };
    let attachment = Attachment::Lattice(lattice);
    if moved.is_some() {
        return Ok(attachment);
    }
    // Only a valid lattice has rest positions.
    match method.check_attachment(name, &attachment) {
        Err(AttachmentRefused::MovedCount { .. }) => {}
        checked => checked.map_err(|refused| sentence(&refused))?,
    }
    Ok(attachment.with_moved(Arc::new(method.control_rest(&attachment))))
}

fn points(numbers: Vec<Numbers<3>>) -> Vec<DVec3> {
    numbers
        .into_iter()
        .map(|numbers| DVec3::from_array(numbers.0))
        .collect()
}

fn sentence(refused: &AttachmentRefused) -> EditError {
    EditError::custom(refused)
}

//! The hidden and locked parts in a project.

use pliant_mesh::Model;
use serde::{Deserialize, Serialize};

use crate::{Access, EditError, SmallParts};

/// A hidden or locked object.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StoredObject {
    /// Its number, from the file's names of nodes and materials.
    object: u32,
    /// Its name, for a person.
    name: String,
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    hidden: bool,
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    locked: bool,
}

/// The size of small parts, and their treatment.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StoredSmallParts {
    /// Less than this share (0 to 1) of the largest part's vertices.
    share: f64,
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    hidden: bool,
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    locked: bool,
}

impl StoredSmallParts {
    pub(super) fn of(small: SmallParts) -> Option<Self> {
        let SmallParts { share, hidden, locked } = small;
        (small != SmallParts::default()).then_some(Self { share, hidden, locked })
    }
}

pub(super) fn stored_objects(access: &Access, model: &Model) -> Vec<StoredObject> {
    let all = model.all_objects();
    access
        .hidden
        .union(&access.locked)
        .map(|&object| StoredObject {
            object,
            name: all
                .get(object as usize)
                .map_or(String::new(), |found| found.name.clone()),
            hidden: access.hidden.contains(&object),
            locked: access.locked.contains(&object),
        })
        .collect()
}

/// A project's entries about objects, the isolated part and small parts, on its mesh.
pub(super) fn access(
    objects: &[StoredObject],
    isolated: Option<u32>,
    small: Option<StoredSmallParts>,
    model: &Model,
) -> Result<Access, EditError> {
    let refused = |what: &str, number: u32, count: usize| {
        EditError::Project(format!(
            "`{what}` names number {number}, but the mesh has {count}: save it again"
        ))
    };
    let count = model.all_objects().len();
    let mut access = Access::default();
    for stored in objects {
        if stored.object as usize >= count {
            return Err(refused("objects", stored.object, count));
        }
        if stored.hidden {
            access.hidden.insert(stored.object);
        }
        if stored.locked {
            access.locked.insert(stored.object);
        }
    }
    let parts = model.topology.components().len();
    if let Some(part) = isolated.filter(|&part| part as usize >= parts) {
        return Err(refused("isolated", part, parts));
    }
    access.isolated = isolated;
    if let Some(StoredSmallParts { share, hidden, locked }) = small {
        if !(0.0..=1.0).contains(&share) {
            return Err(EditError::Project(format!(
                "`small_parts` has the share {share}, which is not from 0 to 1: save it again"
            )));
        }
        access.small = SmallParts { share, hidden, locked };
    }
    Ok(access)
}

//! An edit in `EDIT.json`: regions, handles, stiffness and method, described so that they fit any mesh.

use std::collections::BTreeMap;

use glam::DVec3;
use pliant_deform::{Loose, Method};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::attachment::{AttachmentEntries, AttachmentEntry, of_file};
use super::edit_error::EditError;
use super::examples::ExampleEntry;
use super::field::{FieldEntry, FieldKind};
use super::filters::{FilterEntry, check_filters};
use super::footprints::{FootprintEntry, check_footprints};
use super::handle_entry::{HandleEntry, check_parents, continuity_kind};
use super::json::parse;
use super::keys::{KeyEntry, check_keys};
use super::loose::{OneOrList, StoredLoose};
use super::method::{method_to_value, read_method};
use super::mix::MixEntry;
use super::path::PathEntry;
use super::places::Places;
use super::project::StoredKept;
use super::reader::read;
use super::selector::Selector;
use super::strength::strength_kind;
use super::text::text_of;
use super::version::{EDIT_VERSION, check_version};

/// The smallest and the largest stiffness of an edit.
pub const STIFFNESS_RANGE: std::ops::RangeInclusive<f64> = 0.001..=1000.0;

/// An edit, as stored.
#[derive(Clone, PartialEq, Debug)]
pub struct EditFile {
    /// The method and its options.
    pub method: Method,
    /// The method's inputs beside handles, by declared name; the method makes those that are missing.
    pub attachments: BTreeMap<&'static str, AttachmentEntry>,
    /// The vertices that may move; those outside are fixed.
    pub region: Selector,
    /// The fixed vertices; they have priority over `region`.
    pub fixed: Selector,
    /// The handles; they have priority over both.
    pub handles: Vec<HandleEntry>,
    /// Painted stiffness; the later entry has priority, and it is 1 without an entry.
    pub stiffness: Vec<FieldEntry>,
    /// The continuity with which the free surface joins fixed vertices and handles (0 to 2); the later entry has
    /// priority, and it is 2 without an entry.
    pub continuity: Vec<FieldEntry>,
    /// The behaviour of components that nothing holds.
    pub loose: Loose,
    /// The behaviour of single ones instead: those with a selected vertex; the later entry has priority.
    pub loose_parts: Vec<(Selector, Loose)>,
    /// The connected parts with a selected vertex are inside out and are saved the other way round: their faces'
    /// corners in reverse order, their normals pointing the other way. This bends nothing.
    pub inside_out: Selector,
    /// The visible shape at the last change of the constraints or correction by hand, with the handles' positions at
    /// that time, by their place in the list: later shapes begin from it.
    pub kept: Option<StoredKept>,
    /// The share of the edit that is made, in 0 to 1: handles, control points and weights that bend the surface move by
    /// this share ([`HandleTransform::part`](crate::HandleTransform::part)).
    pub strength: f64,
    /// Transforms of handles at times, for animations ([`EditFile::timeline`]); a single bent file has no use for them.
    pub keys: Vec<KeyEntry>,
    /// Filters of handles' trajectories, for sequences ([`EditFile::sequence_timeline`]).
    pub filter: Vec<FilterEntry>,
    /// Handles that are held where they rest on the ground, for sequences.
    pub footprints: Vec<FootprintEntry>,
    /// The bent path of the whole body, for sequences ([`EditFile::body_motions`]).
    pub path: Option<PathEntry>,
    /// Another sequence that leads handles, for sequences.
    pub mix: Option<MixEntry>,
    /// The distance within which the mesh's vertices are joined before it is bent, in world units, at least 0; with
    /// `None` it follows from the mesh ([`pliant_mesh::WeldOptions`]).
    pub weld: Option<f64>,
    /// The mesh whose vertex numbers the edit has, so that another mesh finds its sets by place ([`EditFile::placed`]).
    pub places: Option<Places>,
}

/// The members in the file.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StoredEdit {
    version: u64,
    method: Value,
    #[serde(default = "everything")]
    region: Selector,
    #[serde(default = "nothing")]
    fixed: Selector,
    #[serde(default)]
    handles: Vec<HandleEntry>,
    #[serde(default)]
    stiffness: Vec<FieldEntry>,
    #[serde(skip_serializing_if = "Option::is_none")]
    continuity: Option<OneOrList<f64, FieldEntry>>,
    #[serde(default = "follow")]
    loose: OneOrList<StoredLoose, LooseEntry>,
    #[serde(default = "nothing", skip_serializing_if = "is_nothing")]
    inside_out: Selector,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    kept: Option<StoredKept>,
    #[serde(default = "all_of_it", skip_serializing_if = "is_all")]
    strength: f64,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    keys: Vec<KeyEntry>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    filter: Vec<FilterEntry>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    footprints: Vec<FootprintEntry>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    path: Option<PathEntry>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    mix: Option<MixEntry>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    weld: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    places: Option<Places>,
}

/// The behaviour of the loose parts of a selection.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct LooseEntry {
    select: Selector,
    value: StoredLoose,
}

fn everything() -> Selector {
    Selector::All
}

fn nothing() -> Selector {
    Selector::None
}

fn follow() -> OneOrList<StoredLoose, LooseEntry> {
    OneOrList::One(StoredLoose::Follow)
}

fn all_of_it() -> f64 {
    1.0
}

fn is_nothing(selector: &Selector) -> bool {
    *selector == Selector::None
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes by reference")]
fn is_all(strength: &f64) -> bool {
    *strength == 1.0
}

impl Default for EditFile {
    /// The edit with only a version and a method.
    fn default() -> Self {
        Self {
            method: Method::default(),
            attachments: AttachmentEntries::new(),
            region: everything(),
            fixed: nothing(),
            handles: Vec::new(),
            stiffness: Vec::new(),
            continuity: Vec::new(),
            loose: Loose::Follow,
            loose_parts: Vec::new(),
            inside_out: nothing(),
            kept: None,
            strength: 1.0,
            keys: Vec::new(),
            filter: Vec::new(),
            footprints: Vec::new(),
            path: None,
            mix: None,
            weld: None,
            places: None,
        }
    }
}

impl EditFile {
    /// Reads an edit's JSON text.
    ///
    /// # Errors
    /// Members that the format does not have are refused by name and place.
    pub fn parse(text: &str) -> Result<Self, EditError> {
        let value = parse(text).map_err(|error| error.at("the edit"))?;
        Self::from_value(&value)
    }

    /// Reads an edit from a JSON value.
    ///
    /// # Errors
    /// Those of [`EditFile::parse`].
    pub fn from_value(value: &Value) -> Result<Self, EditError> {
        check_version(value)?;
        read(value)
            .and_then(Self::of_stored)
            .map_err(|error| error.at("the edit"))
    }

    /// Checks beyond serde's: options of the method, and values that are out of range or exclude each other.
    fn of_stored(stored: StoredEdit) -> Result<Self, EditError> {
        let (method, attachments) = read_method(&stored.method).map_err(|error| error.under("method"))?;
        stored.region.check().map_err(|error| error.under("region"))?;
        stored.fixed.check().map_err(|error| error.under("fixed"))?;
        let inside_out = stored.inside_out.check();
        inside_out.map_err(|error| error.under("inside_out"))?;
        let mut handles = stored.handles;
        for (index, handle) in handles.iter_mut().enumerate() {
            if handle.name.is_empty() {
                handle.name = format!("handle {}", index + 1);
            }
            handle
                .check()
                .map_err(|error| error.under(&format!("handles[{index}]")))?;
        }
        check_parents(&handles)?;
        let stiffness = FieldKind {
            name: "a stiffness",
            range: STIFFNESS_RANGE,
            may_be_rigid: true,
        };
        stiffness
            .check_all(&stored.stiffness)
            .map_err(|error| error.under("stiffness"))?;
        let continuity = match stored.continuity {
            Some(OneOrList::One(value)) => {
                continuity_kind()
                    .check(value)
                    .map_err(|error| error.under("continuity"))?;
                let select = Selector::All;
                vec![FieldEntry::Select { select, value }]
            }
            Some(OneOrList::List(entries)) => entries,
            None => Vec::new(),
        };
        continuity_kind()
            .check_all(&continuity)
            .map_err(|error| error.under("continuity"))?;
        strength_kind()
            .check(stored.strength)
            .map_err(|error| error.under("strength"))?;
        check_keys(&stored.keys)?;
        check_filters(&stored.filter)?;
        check_footprints(&stored.footprints)?;
        stored.path.as_ref().map_or(Ok(()), PathEntry::check)?;
        stored.mix.as_ref().map_or(Ok(()), MixEntry::check)?;
        if let Some(weld) = stored.weld {
            WELD.check(weld).map_err(|error| error.under("weld"))?;
        }
        let (mut loose, mut loose_parts) = (Loose::Follow, Vec::new());
        match stored.loose {
            OneOrList::One(does) => loose = does.into(),
            OneOrList::List(entries) => {
                for (index, LooseEntry { select, value }) in entries.into_iter().enumerate() {
                    select
                        .check()
                        .map_err(|error| error.under(&format!("loose[{index}].select")))?;
                    if select == Selector::All {
                        // Some checks repeat earlier ones.
                        loose = value.into();
                        loose_parts.clear();
                    } else {
                        loose_parts.push((select, value.into()));
                    }
                }
            }
        }
        Ok(Self {
            method,
            attachments,
            region: stored.region,
            fixed: stored.fixed,
            handles,
            stiffness: stored.stiffness,
            continuity,
            loose,
            loose_parts,
            inside_out: stored.inside_out,
            kept: stored.kept,
            strength: stored.strength,
            keys: stored.keys,
            filter: stored.filter,
            footprints: stored.footprints,
            path: stored.path,
            mix: stored.mix,
            weld: stored.weld,
            places: stored.places,
        })
    }

    /// The edit as a JSON value; reading it back gives an equal edit.
    pub fn to_value(&self) -> Value {
        let entry = |select: &Selector, loose: Loose| LooseEntry {
            select: select.clone(),
            value: loose.into(),
        };
        let stored = StoredEdit {
            version: EDIT_VERSION,
            method: method_to_value(&self.method, &self.attachments),
            region: self.region.clone(),
            fixed: self.fixed.clone(),
            handles: self.handles.clone(),
            stiffness: self.stiffness.clone(),
            continuity: (!self.continuity.is_empty()).then(|| OneOrList::List(self.continuity.clone())),
            loose: match self.loose_parts.is_empty() {
                true => OneOrList::One(self.loose.into()),
                false => {
                    let parts = self.loose_parts.iter().map(|(select, loose)| entry(select, *loose));
                    OneOrList::List(
                        std::iter::once(entry(&Selector::All, self.loose))
                            .chain(parts)
                            .collect(),
                    )
                }
            },
            inside_out: self.inside_out.clone(),
            kept: self.kept.clone(),
            strength: self.strength,
            keys: self.keys.clone(),
            filter: self.filter.clone(),
            footprints: self.footprints.clone(),
            path: self.path.clone(),
            mix: self.mix.clone(),
            weld: self.weld,
            places: self.places.clone(),
        };
        json!(stored)
    }

    /// The edit as JSON text with a newline at its end.
    pub fn to_json(&self) -> String {
        text_of(&self.to_value())
    }

    /// Returns true if no handle of the edit, no control point moved by hand and no example's weight moves anything, or
    /// the share is 0.
    pub fn changes_nothing(&self) -> bool {
        // Without handles nothing is solved: the kept shape is the result.
        if self.kept.is_some() && !self.handles.is_empty() {
            return false;
        }
        self.strength == 0.0 || self.is_at_rest()
    }

    /// The same for the whole edit, of which the strength is a share.
    pub fn changes_nothing_in_full(&self) -> bool {
        (self.kept.is_none() || self.handles.is_empty()) && self.is_at_rest()
    }

    fn is_at_rest(&self) -> bool {
        let own = self.attachments.iter();
        let own = own.filter(|(name, _)| self.method.declaration().attachment(name).is_some());
        let are_at_rest = own.map(|(_, entry)| match entry {
            AttachmentEntry::File { moved, .. } => moved.is_none(),
            AttachmentEntry::Examples(examples) => {
                let mut weights = examples.iter().filter_map(|example| example.weight);
                weights.all(|weight| weight == 0.0)
            }
            AttachmentEntry::Given(attachment) => {
                let rest = self.method.control_rest(attachment);
                attachment.moved().is_none_or(|moved| **moved == rest)
            }
        });
        are_at_rest.into_iter().all(|is| is) && self.handles.iter().all(HandleEntry::is_at_rest)
    }

    /// The files that attachments name: each attachment's name, and the file's, relative to the edit's folder.
    pub fn attachment_files(&self) -> Vec<(&'static str, String)> {
        let entries = self.attachments.iter();
        let files = entries.filter_map(|(name, entry)| match entry {
            AttachmentEntry::File { file, .. } => Some((*name, file.clone())),
            AttachmentEntry::Given(_) | AttachmentEntry::Examples(_) => None,
        });
        files.collect()
    }

    /// Its examples, into which the files and the morph targets that they name are put.
    pub fn examples_mut(&mut self) -> impl Iterator<Item = &mut ExampleEntry> {
        let entries = self.attachments.values_mut();
        let examples = entries.filter_map(|entry| match entry {
            AttachmentEntry::Examples(examples) => Some(examples),
            AttachmentEntry::Given(_) | AttachmentEntry::File { .. } => None,
        });
        examples.flatten()
    }

    /// Puts a mesh, its vertices and triangles, in place of the file that an attachment names.
    ///
    /// # Errors
    /// The fault of the mesh, or of the moved points beside the file's name.
    pub fn bring(&mut self, name: &'static str, mesh: (Vec<DVec3>, Vec<[u32; 3]>)) -> Result<(), EditError> {
        if let Some(AttachmentEntry::File { moved, .. }) = self.attachments.get(name) {
            let attachment = of_file(&self.method, name, mesh, moved.clone());
            let attachment = attachment.map_err(|error| error.under("method"))?;
            self.attachments.insert(name, AttachmentEntry::Given(attachment));
        }
        Ok(())
    }
}

/// The range of a weld distance.
const WELD: FieldKind = FieldKind {
    name: "a distance",
    range: 0.0..=1e9,
    may_be_rigid: false,
};

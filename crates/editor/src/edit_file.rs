//! An edit as it stands in `EDIT.json`: regions, handles, stiffness and method, described so that they fit any mesh.
//!
//! The members are read by hand from JSON's values rather than derived, because every refusal must name the member or
//! value that it speaks of, where it stands and what would be right.

use pliant_deform::{CONTINUITY_RANGE, Loose, Method};
use serde_json::{Value, json};

use crate::HandleTransform;
use crate::edit_error::EditError;
use crate::edit_node::{Members, Node, ROOT};
use crate::field_form::{FieldEntry, FieldKind};
use crate::method_form::{method_to_value, read_method};
use crate::selector::Selector;

/// The version of the edit format that is read and written.
pub const EDIT_VERSION: u64 = 1;

/// The smallest and the largest stiffness that an edit may give.
pub const STIFFNESS_RANGE: std::ops::RangeInclusive<f64> = 0.001..=1000.0;

/// The smallest and the largest weight of a soft handle.
pub const SOFT_RANGE: std::ops::RangeInclusive<f64> = 1e-6..=1e6;

/// An edit, as stored.
#[derive(Clone, PartialEq, Debug)]
pub struct EditFile {
    /// The method and its options.
    pub method: Method,
    /// The vertices that may move; those outside are fixed.
    pub region: Selector,
    /// The vertices that are held still; they win over `region`.
    pub fixed: Selector,
    /// The handles; they win over both.
    pub handles: Vec<HandleEntry>,
    /// Painted stiffness; the later entry wins, and it is 1 where no entry speaks.
    pub stiffness: Vec<FieldEntry>,
    /// With which continuity the free surface joins what is fixed and the handles (0 to 2); the later entry wins, and it
    /// is 2 where no entry speaks.
    pub continuity: Vec<FieldEntry>,
    /// What components that nothing holds do.
    pub loose: Loose,
    /// What some of them do in place of that: those with a selected vertex; the later entry wins.
    pub loose_parts: Vec<(Selector, Loose)>,
}

/// A handle: which vertices move, and how.
#[derive(Clone, PartialEq, Debug)]
pub struct HandleEntry {
    /// Its name, for a person. An edit that gives none gets "handle 1", "handle 2", ..
    pub name: String,
    /// Its vertices.
    pub select: Selector,
    /// How they move.
    pub transform: HandleTransform,
    /// Its weight, in [`SOFT_RANGE`], if it only pulls at its vertices.
    pub soft: Option<f64>,
    /// The continuity of its own border, over whatever [`EditFile::continuity`] says.
    pub continuity: Option<f64>,
}

impl Default for EditFile {
    /// The edit with nothing but a version and a method.
    fn default() -> Self {
        Self {
            method: Method::default(),
            region: Selector::All,
            fixed: Selector::None,
            handles: Vec::new(),
            stiffness: Vec::new(),
            continuity: Vec::new(),
            loose: Loose::Follow,
            loose_parts: Vec::new(),
        }
    }
}

impl EditFile {
    /// Reads an edit's JSON text.
    ///
    /// # Errors
    /// Whatever the format does not have is refused by its name and place.
    pub fn parse(text: &str) -> Result<Self, EditError> {
        // Some editors put a byte order mark in front.
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let value: Value = serde_json::from_str(text).map_err(|error| EditError::Json(error.to_string()))?;
        Self::from_value(&value)
    }

    /// Reads an edit from a JSON value.
    ///
    /// # Errors
    /// As [`EditFile::parse`].
    pub fn from_value(value: &Value) -> Result<Self, EditError> {
        const KNOWN: [&str; 8] = [
            "version",
            "method",
            "region",
            "fixed",
            "handles",
            "stiffness",
            "continuity",
            "loose",
        ];
        let root = Node::new(value, ROOT);
        // The version first: another one may have members that this one lacks.
        if let Some(found) = value.get("version")
            && found.as_u64() != Some(EDIT_VERSION)
        {
            return Err(EditError::Version {
                found: found.to_string(),
            });
        }
        let members = root.object("an object with `version` and `method`", &KNOWN)?;
        members.require("version")?;
        let stiffness = FieldKind {
            name: "a stiffness",
            range: STIFFNESS_RANGE,
        };
        let (loose, loose_parts) = match members.get("loose") {
            Some(loose) => read_loose(&loose)?,
            None => (Loose::Follow, Vec::new()),
        };
        Ok(Self {
            method: read_method(&members.require("method")?)?,
            region: read_selector(&members, "region", Selector::All)?,
            fixed: read_selector(&members, "fixed", Selector::None)?,
            handles: match members.get("handles") {
                Some(handles) => handles
                    .elements("a list of handles")?
                    .enumerate()
                    .map(|(i, node)| read_handle(i, &node))
                    .collect(),
                None => Ok(Vec::new()),
            }?,
            stiffness: match members.get("stiffness") {
                Some(entries) => entries
                    .elements("a list of stiffness entries")?
                    .map(|node| stiffness.read(&node))
                    .collect(),
                None => Ok(Vec::new()),
            }?,
            continuity: match members.get("continuity") {
                Some(continuity) => read_continuity(&continuity)?,
                None => Vec::new(),
            },
            loose,
            loose_parts,
        })
    }

    /// The edit as a JSON value; reading it back gives an equal edit.
    pub fn to_value(&self) -> Value {
        let mut value = json!({
            "version": EDIT_VERSION,
            "method": method_to_value(&self.method),
            "region": self.region.to_value(),
            "fixed": self.fixed.to_value(),
            "handles": self.handles.iter().map(HandleEntry::to_value).collect::<Vec<_>>(),
            "stiffness": self.stiffness.iter().map(FieldEntry::to_value).collect::<Vec<_>>(),
            "loose": loose_name(self.loose),
        });
        if !self.loose_parts.is_empty() {
            let entry = |select: &Selector, loose| json!({ "select": select.to_value(), "value": loose_name(loose) });
            let all = entry(&Selector::All, self.loose);
            let parts = self.loose_parts.iter().map(|(select, loose)| entry(select, *loose));
            value["loose"] = std::iter::once(all).chain(parts).collect();
        }
        if !self.continuity.is_empty() {
            value["continuity"] = self.continuity.iter().map(FieldEntry::to_value).collect();
        }
        value
    }

    /// The edit as JSON text with a newline at its end.
    pub fn to_json(&self) -> String {
        format!("{:#}\n", self.to_value())
    }

    /// Whether no handle of the edit moves anything.
    pub fn changes_nothing(&self) -> bool {
        self.handles.iter().all(|handle| handle.transform.is_identity())
    }
}

fn read_selector(members: &Members<'_>, name: &str, default: Selector) -> Result<Selector, EditError> {
    members.get(name).map_or(Ok(default), |node| Selector::read(&node))
}

fn read_handle(index: usize, node: &Node<'_>) -> Result<HandleEntry, EditError> {
    let members = node.object(
        "a handle: an object with `name`, `select` and `transform`",
        &["name", "select", "transform", "soft", "continuity"],
    )?;
    let soft = FieldKind {
        name: "a weight",
        range: SOFT_RANGE,
    };
    Ok(HandleEntry {
        name: match members.get("name") {
            Some(name) => name.string("a name")?.to_owned(),
            None => format!("handle {}", index + 1),
        },
        select: Selector::read(&members.require("select")?)?,
        transform: match members.get("transform") {
            Some(transform) => HandleTransform::read(&transform)?,
            None => HandleTransform::IDENTITY,
        },
        soft: members.get("soft").map(|node| soft.value(&node)).transpose()?,
        continuity: members
            .get("continuity")
            .map(|node| continuity_kind().value(&node))
            .transpose()?,
    })
}

impl HandleEntry {
    fn to_value(&self) -> Value {
        let mut value = json!({
            "name": self.name, "select": self.select.to_value(), "transform": self.transform.to_value(),
        });
        for (name, number) in [("soft", self.soft), ("continuity", self.continuity)] {
            if let Some(number) = number {
                value[name] = json!(number);
            }
        }
        value
    }
}

/// Continuities: a list of entries, or one number for whatever is held.
fn read_continuity(node: &Node<'_>) -> Result<Vec<FieldEntry>, EditError> {
    let kind = continuity_kind();
    if node.value().is_number() {
        let value = kind.value(node)?;
        let select = Selector::All;
        return Ok(vec![FieldEntry::Select { select, value }]);
    }
    node.elements("a number from 0 to 2, or a list of selections with one each")?
        .map(|node| kind.read(&node))
        .collect()
}

fn continuity_kind() -> FieldKind {
    FieldKind {
        name: "a continuity",
        range: CONTINUITY_RANGE,
    }
}

/// One word for all, or a list of selections with one each.
fn read_loose(node: &Node<'_>) -> Result<(Loose, Vec<(Selector, Loose)>), EditError> {
    if !node.value().is_array() {
        return Ok((read_loose_name(node)?, Vec::new()));
    }
    let entries = node.elements("a list of selections with what loose parts do")?;
    let mut loose = Loose::Follow;
    let mut parts: Vec<(Selector, Loose)> = Vec::new();
    for entry in entries {
        let members = entry.object("an object with `select` and `value`", &["select", "value"])?;
        let select = Selector::read(&members.require("select")?)?;
        let does = read_loose_name(&members.require("value")?)?;
        if select == Selector::All {
            // What was said of some before is said anew.
            loose = does;
            parts.clear();
        } else {
            parts.push((select, does));
        }
    }
    Ok((loose, parts))
}

fn read_loose_name(node: &Node<'_>) -> Result<Loose, EditError> {
    match node.string("\"follow\", \"rest\" or \"bend\"")? {
        "follow" => Ok(Loose::Follow),
        "rest" => Ok(Loose::Rest),
        "bend" => Ok(Loose::Bend),
        name => Err(node.unknown_name(name, &["follow", "rest", "bend"])),
    }
}

pub(crate) fn loose_name(loose: Loose) -> &'static str {
    match loose {
        Loose::Follow => "follow",
        Loose::Rest => "rest",
        Loose::Bend => "bend",
    }
}

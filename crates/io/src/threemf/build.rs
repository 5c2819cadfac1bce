//! The model parts that the build list shows, which may name objects of other parts.

use std::collections::{BTreeMap, VecDeque};

use super::model::{Component, Fault, Model, parse};
use super::resources::Resources;
use super::stored::Part;
use super::xml::{Step, walk};
use crate::archive::Archive;
use crate::source::Source;
use crate::{Bytes, Format, ReadError};

/// The most model parts that are read.
const MOST_PARTS: usize = 10_000;

/// The parts of a file; the first is the one with the build list.
pub(super) struct Parts {
    pub parts: Vec<Part>,
    /// The resources of each part.
    pub resources: Vec<Resources>,
    pub items: Vec<Component>,
    /// The number of a part by its path in lower case.
    pub number: BTreeMap<String, usize>,
    /// The images of all parts by their paths.
    pub images: BTreeMap<String, Option<Bytes>>,
    pub has_other_groups: bool,
}

/// A path as parts are known by.
pub(super) fn known_path(path: &str) -> String {
    path.trim_start_matches('/').to_ascii_lowercase()
}

/// Reads the parts that hold the geometry.
pub(super) fn parts(source: &Source<'_>) -> Result<Parts, ReadError> {
    let malformed = |reason: String| source.malformed(Format::Threemf, reason);
    let mut archive = Archive::open(source.bytes).map_err(malformed)?;
    let root = root(&mut archive).map_err(malformed)?;
    let mut found = Parts {
        parts: Vec::new(),
        resources: Vec::new(),
        items: Vec::new(),
        number: BTreeMap::new(),
        images: BTreeMap::new(),
        has_other_groups: false,
    };
    let mut wanted = VecDeque::from([root]);
    while let Some(path) = wanted.pop_front() {
        if found.number.contains_key(&known_path(&path)) {
            continue;
        }
        if found.parts.len() == MOST_PARTS {
            return Err(malformed(format!("it has more than {MOST_PARTS} model parts")));
        }
        let part = archive.part(&path).map_err(malformed)?;
        let model = parse(&part.bytes, source.cancel).map_err(|fault| match fault {
            Fault::Malformed(reason) => malformed(format!("its part {}: {reason}", crate::quoted(&path))),
            Fault::Stopped(stopped) => stopped,
        })?;
        wanted.extend(paths(&model));
        for texture in model.resources.textures.values() {
            let images = &mut found.images;
            images
                .entry(known_path(texture))
                .or_insert_with(|| archive.part(texture).ok().map(|part| part.bytes.into()));
        }
        found.number.insert(known_path(&path), found.parts.len());
        if found.parts.is_empty() {
            found.items = model.items;
        }
        found.has_other_groups |= model.has_other_groups;
        found.resources.push(model.resources);
        found.parts.push(Part {
            place: part.place,
            bytes: part.bytes,
            objects: model.objects,
        });
        source.cancel.check()?;
    }
    Ok(found)
}

/// The other parts that a model names.
fn paths(model: &Model) -> Vec<String> {
    let of_objects = model.objects.iter().flat_map(|object| &object.components);
    let all = model.items.iter().chain(of_objects);
    all.filter_map(|component| component.path.clone()).collect()
}

/// The path of the part with the build list.
fn root(archive: &mut Archive<'_>) -> Result<String, String> {
    const USUAL: &str = "3D/3dmodel.model";
    let Ok(relations) = archive.part("_rels/.rels") else {
        return Ok(USUAL.to_owned());
    };
    let mut root = None;
    walk::<String>(&relations.bytes, |step| {
        if let Step::Open(element) = step {
            let kind = element.text("Type").unwrap_or_default();
            if kind.to_ascii_lowercase().ends_with("/3dmodel") && root.is_none() {
                root = element.text("Target");
            }
        }
        Ok(())
    })
    .map_err(|reason| format!("its part _rels/.rels: {reason}"))?;
    Ok(root.unwrap_or_else(|| USUAL.to_owned()))
}

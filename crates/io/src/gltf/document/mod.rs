//! A glTF as read: its JSON, its buffers, and the places of its objects in the text.
//!
//! The `gltf` crate's types read accessors, buffer views, materials, textures, samplers and images, each section for
//! itself and without validation. Nodes, meshes and scenes are read from the text: node transforms as f64 (the crate
//! has f32, which moves scans at geographic coordinates by half a metre), attributes with any names, and scenes without
//! nodes, which the crate refuses.

pub(crate) mod accessor;
mod budgets;
mod buffers;
pub(crate) mod container;
pub(crate) mod fault;
mod fetch;
pub(crate) mod json;
pub(crate) mod layout;
mod origin;
pub(crate) mod uri;

use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

use ::gltf::json::{self as schema, Accessor, Material, Texture, texture::Sampler};

use crate::Format;
use crate::gltf::uv_sets::MaterialMaps;
use crate::quote::quoted;
use crate::source::Source;
use crate::source::notes::Notes;
use container::Container;
use fault::Fault;
use json::{At, Json};
use layout::Layout;
pub(crate) use origin::{Buffer, ImageFile};

/// A glTF as read.
#[derive(Debug)]
pub(crate) struct Document {
    /// The whole file.
    pub file: Arc<Vec<u8>>,
    /// The spans of a GLB's parts in it; `None` for a `.gltf`.
    pub container: Option<Container>,
    /// A byte-order mark in front of a `.gltf`'s text.
    pub has_mark: bool,
    pub json: Json,
    pub buffers: Vec<Buffer>,
    pub images: Vec<ImageFile>,
    pub accessors: Vec<Accessor>,
    pub views: Vec<schema::buffer::View>,
    pub materials: Vec<Material>,
    pub textures: Vec<Texture>,
    pub samplers: Vec<Sampler>,
    /// The place of each object, by section.
    pub accessors_at: Vec<At>,
    pub views_at: Vec<At>,
    pub meshes_at: Vec<At>,
    pub nodes_at: Vec<At>,
    pub buffers_at: Vec<At>,
    pub images_at: Vec<At>,
    pub materials_at: Vec<At>,
    /// Missing data that was not needed, as sentences.
    pub notes: Notes,
    /// Compressed buffer views without bytes, and their faults.
    pub undecoded_views: BTreeMap<usize, String>,
    /// Compressed primitives whose accessors have no bytes, and their faults.
    pub undecoded_primitives: BTreeMap<At, String>,
    /// The number of bytes that were read in all, neighbours included, each once.
    pub loaded_bytes: usize,
    /// The sets of texture coordinates of each material's images.
    pub material_maps: Vec<MaterialMaps>,
    /// Each accessor's layout, cached because checking it visits all its sparse elements.
    pub layouts: Vec<OnceLock<Result<Layout, String>>>,
}

impl Document {
    /// Splits the container, parses the JSON and fetches the neighbours.
    pub fn read(source: &Source<'_>, format: Format) -> Result<Self, Fault> {
        let file = Arc::clone(source.bytes);
        let container = match format {
            Format::Glb => Some(container::split(&file)?),
            _ if container::is_glb(&file) => Some(container::split(&file)?),
            _ => None,
        };
        let text = container.as_ref().map_or(&file[..], |parts| &file[parts.json.clone()]);
        let has_mark = text.starts_with(b"\xef\xbb\xbf");
        let json = Json::parse(text[if has_mark { 3 } else { 0 }..].to_vec())?;
        source.cancel.check()?;
        if json
            .path(json.root(), &["asset", "version"])
            .and_then(|at| json.string(at))
            .is_none()
        {
            return Err("its JSON has no asset.version, so it is not glTF".to_owned().into());
        }
        let section = |key: &str| objects(&json, key);
        let (accessors_at, views_at, meshes_at) = (section("accessors")?, section("bufferViews")?, section("meshes")?);
        let (nodes_at, buffers_at, images_at) = (section("nodes")?, section("buffers")?, section("images")?);
        let materials_at = section("materials")?;
        let accessors = typed(&json, &accessors_at, "accessor")?;
        let views = typed(&json, &views_at, "buffer view")?;
        let mut notes = Notes::default();
        let materials = (materials_at.iter().enumerate())
            .map(|(number, &at)| {
                json.typed(at)
                    .unwrap_or_else(|error| dropped(number, &error, &mut notes))
            })
            .collect();
        let textures = typed(&json, &section("textures")?, "texture")?;
        let samplers = typed(&json, &section("samplers")?, "sampler")?;
        let mut document = Self {
            file,
            container,
            has_mark,
            buffers: Vec::new(),
            images: Vec::new(),
            accessors,
            views,
            materials,
            textures,
            samplers,
            accessors_at,
            views_at,
            meshes_at,
            nodes_at,
            buffers_at,
            images_at,
            materials_at,
            notes,
            undecoded_views: BTreeMap::new(),
            undecoded_primitives: BTreeMap::new(),
            loaded_bytes: 0,
            material_maps: Vec::new(),
            layouts: Vec::new(),
            json,
        };
        document.layouts.resize_with(document.accessors.len(), OnceLock::new);
        document.fetch_buffers(source)?;
        document.fetch_images(source)?;
        document.loaded_bytes = document.count_loaded_bytes();
        Ok(document)
    }

    /// An object's member that is an index below `count`; `what` names the object in an error.
    pub fn index(
        &self,
        object: At,
        key: &str,
        count: usize,
        what: impl Fn() -> String,
    ) -> Result<Option<usize>, String> {
        let Some(at) = self.json.member(object, key) else {
            return Ok(None);
        };
        self.index_at(at, count, || format!("{} names {key}", what())).map(Some)
    }

    /// A value that is an index below `count`; `what` describes the reference in an error.
    pub fn index_at(&self, at: At, count: usize, what: impl Fn() -> String) -> Result<usize, String> {
        let number = self
            .json
            .number(at)
            .filter(|number| number.fract() == 0.0 && *number >= 0.0);
        match number {
            Some(number) if number < count as f64 => Ok(number as usize),
            _ => {
                let raw = quoted(&String::from_utf8_lossy(self.json.raw(at)));
                Err(format!("{} {raw}, but there are {count}", what()))
            }
        }
    }

    /// A node by its number and name, for messages.
    pub fn called(&self, node: usize) -> String {
        let name = self.name(self.nodes_at[node]);
        if name.is_empty() {
            format!("node {node}")
        } else {
            format!("node {node} ({})", quoted(&name))
        }
    }

    /// A node's, mesh's or image's name; empty if it has none.
    pub fn name(&self, object: At) -> String {
        self.json
            .member(object, "name")
            .and_then(|at| self.json.string(at))
            .unwrap_or_default()
    }
}

/// The places of a section's objects; an error if it is not a list of objects.
fn objects(json: &Json, section: &str) -> Result<Vec<At>, String> {
    let Some(list) = json.member(json.root(), section) else {
        return Ok(Vec::new());
    };
    let objects: Vec<At> = json.elements(list).collect();
    let is_sound = json.raw(list).starts_with(b"[") && objects.iter().all(|&at| json.raw(at).starts_with(b"{"));
    if is_sound {
        Ok(objects)
    } else {
        Err(format!("its {section} are not a list of objects"))
    }
}

/// The plain material that replaces one that can't be read; the file keeps its own.
fn dropped(number: usize, error: &str, notes: &mut Notes) -> Material {
    let error = quoted(error);
    let note = format!("Material {number} is broken ({error}), so its parts are drawn plain.");
    notes.add("materials", Some(note));
    Material::default()
}

/// A section's objects as types of the `gltf` crate.
fn typed<T: serde::de::DeserializeOwned>(json: &Json, section: &[At], what: &str) -> Result<Vec<T>, String> {
    let one = |(number, &at): (usize, &At)| {
        json.typed(at)
            .map_err(|error| format!("{what} {number} is broken: {}", quoted(&error)))
    };
    section.iter().enumerate().map(one).collect()
}

//! A glTF as read: its JSON, its buffers, and where its objects stand in the text.
//!
//! The `gltf` crate's types read accessors, buffer views, materials, textures, samplers and images, each section for
//! itself and without validation. Nodes, meshes and scenes are read from the text: node transforms as f64 (the crate
//! has f32, which moves scans at geographic coordinates by half a metre), attributes with whatever names, and scenes
//! without nodes, which the crate refuses.

pub(crate) mod accessor;
pub(crate) mod container;
pub(crate) mod fault;
pub(crate) mod json;
pub(crate) mod layout;
pub(crate) mod uri;

use std::collections::{BTreeMap, HashSet};
use std::ops::Range;
use std::sync::{Arc, OnceLock};

use ::gltf::json::validation::USize64;
use ::gltf::json::{self as schema, Accessor, Material, Texture, texture::Sampler};

use crate::gltf::appearance::uv_sets::MaterialMaps;
use crate::quote::quoted;
use crate::source::Source;
use crate::source::notes::Notes;
use crate::{Bytes, Format};
use container::Container;
use fault::Fault;
use json::{At, Json};
use layout::Layout;
use uri::Address;

/// A glTF as read.
#[derive(Debug)]
pub(crate) struct Document {
    /// The whole file.
    pub file: Arc<Vec<u8>>,
    /// Where a GLB's parts stand in it; `None` for a `.gltf`.
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
    /// Where each object stands, by section.
    pub accessors_at: Vec<At>,
    pub views_at: Vec<At>,
    pub meshes_at: Vec<At>,
    pub nodes_at: Vec<At>,
    pub buffers_at: Vec<At>,
    pub images_at: Vec<At>,
    pub materials_at: Vec<At>,
    /// What was missing but not needed, as sentences.
    pub notes: Notes,
    /// Compressed buffer views without bytes, and what is wrong with them.
    pub undecoded_views: BTreeMap<usize, String>,
    /// Compressed primitives whose accessors have no bytes, and what is wrong with them.
    pub undecoded_primitives: BTreeMap<At, String>,
    /// How many bytes were read in all, neighbours included, each once.
    pub loaded_bytes: usize,
    /// Which texture coordinates each material's images take.
    pub material_maps: Vec<MaterialMaps>,
    /// Each accessor's layout once it was asked for: checking it looks at all its sparse elements.
    pub layouts: Vec<OnceLock<Result<Layout, String>>>,
}

/// A buffer's bytes and where they came from.
#[derive(Debug)]
pub(crate) enum Buffer {
    /// The GLB's BIN chunk: a range of the file.
    Bin(Range<usize>),
    /// A data URI.
    Data(Bytes),
    /// A file beside this one, by its decoded path.
    Neighbour { path: String, bytes: Bytes },
    /// None at all: a placeholder that an extension fills.
    Absent,
    /// What a compressed buffer view or accessor holds: no buffer of the file. These stand behind the file's own.
    Decoded(Bytes),
}

/// An image's bytes and where they came from.
#[derive(Debug)]
pub(crate) enum ImageFile {
    /// A buffer view.
    View(usize),
    /// A data URI.
    Data(Bytes),
    /// A file beside this one, by its decoded path; no bytes where it is missing.
    Neighbour { path: String, bytes: Option<Bytes> },
    /// Nowhere that is read.
    Absent,
}

/// How many bytes of geometry a byte of the file may become.
pub(crate) const MOST_GROWTH: usize = 64;

/// How many bytes of the drawn set a byte of geometry may become.
const MOST_DRAWN: usize = 16;

/// What the drawn set of the smallest of files may take: five million triangles.
const DRAWN_ANYWAY: usize = 64 << 20;

/// What compressed geometry may become in the smallest of files.
const DECODED_ANYWAY: usize = 1 << 20;

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
        let materials = typed(&json, &materials_at, "material")?;
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
            notes: Notes::default(),
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

    /// The bytes of a buffer.
    pub fn buffer(&self, buffer: usize) -> &[u8] {
        match self.buffers.get(buffer) {
            Some(Buffer::Bin(range)) => &self.file[range.clone()],
            Some(Buffer::Data(bytes) | Buffer::Neighbour { bytes, .. } | Buffer::Decoded(bytes)) => bytes,
            Some(Buffer::Absent) | None => &[],
        }
    }

    /// The bytes of a buffer view; `None` where they are not all there.
    pub fn view(&self, view: usize) -> Option<&[u8]> {
        let (buffer, range) = self.place_of_view(view)?;
        self.buffer(buffer).get(range)
    }

    /// The encoded bytes of an image, shared with what holds them; `None` where they are missing.
    pub fn image(&self, image: usize) -> Option<Bytes> {
        match self.images.get(image)? {
            ImageFile::View(view) => {
                let (buffer, range) = self.place_of_view(*view)?;
                match self.buffers.get(buffer)? {
                    Buffer::Bin(bin) => Bytes::from(Arc::clone(&self.file)).slice(bin.clone())?.slice(range),
                    Buffer::Data(bytes) | Buffer::Neighbour { bytes, .. } | Buffer::Decoded(bytes) => {
                        bytes.slice(range)
                    }
                    Buffer::Absent => None,
                }
            }
            ImageFile::Data(bytes) => Some(bytes.clone()),
            ImageFile::Neighbour { bytes, .. } => bytes.clone(),
            ImageFile::Absent => None,
        }
    }

    fn place_of_view(&self, view: usize) -> Option<(usize, Range<usize>)> {
        let view = self.views.get(view)?;
        let start = usize::try_from(view.byte_offset.map_or(0, |offset| offset.0)).ok()?;
        let length = usize::try_from(view.byte_length.0).ok()?;
        Some((view.buffer.value(), start..start.checked_add(length)?))
    }

    fn count_loaded_bytes(&self) -> usize {
        let of_buffers = self.buffers.iter().filter_map(|buffer| match buffer {
            Buffer::Data(bytes) | Buffer::Neighbour { bytes, .. } => Some(bytes),
            Buffer::Bin(_) | Buffer::Absent | Buffer::Decoded(_) => None,
        });
        let of_images = self.images.iter().filter_map(|image| match image {
            ImageFile::Data(bytes) | ImageFile::Neighbour { bytes: Some(bytes), .. } => Some(bytes),
            _ => None,
        });
        let mut counted = HashSet::new();
        let fresh = of_buffers
            .chain(of_images)
            .filter(|bytes| counted.insert(bytes.place()));
        self.file.len() + fresh.map(|bytes| bytes.len()).sum::<usize>()
    }

    /// How many bytes compressed geometry may become in all.
    pub fn decoding_budget(&self) -> usize {
        self.loaded_bytes.saturating_mul(MOST_GROWTH).max(DECODED_ANYWAY)
    }

    /// How many bytes of memory the drawn set may take: what the bytes justify, and small files with many instances.
    ///
    /// No accessor seen through one node takes more than sixteen times its bytes (a strip of byte indices takes twelve).
    /// Welding takes eight times the drawn set again.
    pub fn drawing_budget(&self) -> usize {
        let decoded = self.buffers.iter().map(|buffer| match buffer {
            Buffer::Decoded(bytes) => bytes.len(),
            _ => 0,
        });
        let bytes = self.loaded_bytes.saturating_add(decoded.sum());
        bytes.saturating_mul(MOST_DRAWN).saturating_add(DRAWN_ANYWAY)
    }

    /// Lets a buffer view of the file point at bytes that were decoded from it.
    pub fn redirect_view(&mut self, view: usize, bytes: Vec<u8>, stride: Option<usize>) {
        let (buffer, length) = (self.buffers.len() as u32, bytes.len() as u64);
        let Some(view) = self.views.get_mut(view) else { return };
        view.buffer = schema::Index::new(buffer);
        view.byte_offset = None;
        view.byte_length = USize64(length);
        view.byte_stride = stride.map(schema::buffer::Stride);
        self.buffers.push(Buffer::Decoded(bytes.into()));
    }

    /// Gives an accessor bytes of its own, elements tightly packed, in a buffer view that the file does not have.
    pub fn fill_accessor(&mut self, accessor: usize, bytes: Vec<u8>) {
        let Some(accessor) = self.accessors.get_mut(accessor) else {
            return;
        };
        accessor.buffer_view = Some(schema::Index::new(self.views.len() as u32));
        accessor.byte_offset = None;
        self.views.push(schema::buffer::View {
            buffer: schema::Index::new(self.buffers.len() as u32),
            byte_length: USize64(bytes.len() as u64),
            byte_offset: None,
            byte_stride: None,
            name: None,
            target: None,
            extensions: None,
            extras: Default::default(),
        });
        self.buffers.push(Buffer::Decoded(bytes.into()));
    }

    /// Whether an accessor's bytes came out of a compressed primitive.
    pub fn is_filled(&self, accessor: usize) -> bool {
        let view = self.accessors.get(accessor).and_then(|accessor| accessor.buffer_view);
        view.is_some_and(|view| view.value() >= self.views_at.len())
    }

    /// An object's member that is an index below `count`, by name; `what` names the object in an error.
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

    /// A value that is an index below `count`; `what` says who names what in an error.
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

    /// A node's, mesh's or image's name; empty where it has none.
    pub fn name(&self, object: At) -> String {
        self.json
            .member(object, "name")
            .and_then(|at| self.json.string(at))
            .unwrap_or_default()
    }

    fn fetch_buffers(&mut self, source: &Source<'_>) -> Result<(), Fault> {
        for (number, &at) in self.buffers_at.iter().enumerate() {
            source.cancel.check()?;
            let uri = self.json.member(at, "uri").and_then(|at| self.json.string(at));
            let bin = self.container.as_ref().and_then(|parts| parts.bin.clone());
            let buffer = match (uri, bin) {
                (None, Some(bin)) if number == 0 => Buffer::Bin(bin),
                (None, _) => Buffer::Absent,
                (Some(uri), _) => match uri::address(&uri).map_err(|reason| format!("buffer {number} is {reason}"))? {
                    Address::Data(bytes) => Buffer::Data(bytes.into()),
                    Address::Neighbour(path) => match source.resolver.read(&path) {
                        Ok(bytes) => {
                            self.notes
                                .add("buffers of other folders", outside_note("Buffer", &path));
                            Buffer::Neighbour { path, bytes }
                        }
                        Err(reason) => return Err(Fault::Neighbour { uri, reason }),
                    },
                    Address::Elsewhere => {
                        let reason = "it is an address that is not a file's".to_owned();
                        return Err(Fault::Neighbour { uri, reason });
                    }
                },
            };
            self.buffers.push(buffer);
        }
        Ok(())
    }

    fn fetch_images(&mut self, source: &Source<'_>) -> Result<(), Fault> {
        for (number, &at) in self.images_at.iter().enumerate() {
            source.cancel.check()?;
            let uri = self.json.member(at, "uri").and_then(|at| self.json.string(at));
            let view = self.index(at, "bufferView", self.views.len(), || format!("image {number}"))?;
            let image = match (view, uri.as_deref().map(uri::address)) {
                (Some(view), _) => ImageFile::View(view),
                (None, Some(Ok(Address::Data(bytes)))) => ImageFile::Data(bytes.into()),
                (None, Some(Ok(Address::Neighbour(path)))) => {
                    let bytes = match source.resolver.read(&path) {
                        Ok(bytes) => {
                            self.notes.add("images of other folders", outside_note("Image", &path));
                            Some(bytes)
                        }
                        Err(reason) => {
                            let path = quoted(&path);
                            let note = format!("Image {path} is not shown: it could not be read ({reason}).");
                            self.notes.add("images", Some(note));
                            None
                        }
                    };
                    ImageFile::Neighbour { path, bytes }
                }
                (None, _) => {
                    let note = format!("Image {number} is not shown: it has neither bytes nor a file's name.");
                    self.notes.add("images", Some(note));
                    ImageFile::Absent
                }
            };
            self.images.push(image);
        }
        Ok(())
    }
}

/// A sentence about a neighbour outside the file's folder.
fn outside_note(what: &str, path: &str) -> Option<String> {
    uri::inside(path)
        .is_none()
        .then(|| format!("{what} {} was read from outside the file's own folder.", quoted(path)))
}

/// Where a section's objects stand; in words what is wrong where it is no list of objects.
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

/// A section's objects as types of the `gltf` crate.
fn typed<T: serde::de::DeserializeOwned>(json: &Json, section: &[At], what: &str) -> Result<Vec<T>, String> {
    let one = |(number, &at): (usize, &At)| {
        json.typed(at)
            .map_err(|error| format!("{what} {number} is broken: {}", quoted(&error)))
    };
    section.iter().enumerate().map(one).collect()
}

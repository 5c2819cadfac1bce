//! Primitives under `KHR_draco_mesh_compression`: their accessors have no bytes of their own, and get them here.
//!
//! They are then read like all others. If a file has plain bytes beside the compressed ones, the plain ones are used.
//! An edit writes the mesh's accessors out uncompressed and removes the extension from its primitives (`patch.rs`).

use std::collections::{BTreeMap, BTreeSet};

use ::gltf::json::accessor::ComponentType;
use ::gltf::json::validation::Checked;
use draco_core::{AttributeValueIndex, DataType, DecodeLimits, DecoderBuffer, Mesh, MeshDecoder, PointIndex};
use pliant_mesh::{Cancel, Cancelled};
use rayon::prelude::*;

use crate::gltf::document::Document;
use crate::gltf::document::accessor::lanes_of;
use crate::gltf::document::json::At;
use crate::gltf::geometry::primitive::{Mode, Primitive};

pub(crate) const EXTENSION: &str = "KHR_draco_mesh_compression";

/// The place of a primitive's compression.
pub(crate) fn extension_of(document: &Document, primitive: &Primitive) -> Option<At> {
    document.json.path(primitive.at, &["extensions", EXTENSION])
}

/// The accessors that a primitive's compressed data fills: its indices first, then the attributes with their numbers
/// in the data.
pub(crate) struct Filled {
    pub indices: Option<usize>,
    pub attributes: Vec<(usize, u32)>,
}

impl Filled {
    pub fn of(document: &Document, primitive: &Primitive, extension: At) -> Self {
        let json = &document.json;
        let numbers = json.member(extension, "attributes");
        let attributes = numbers.into_iter().flat_map(|at| json.members(at));
        let attributes = attributes.filter_map(|(name, number)| {
            let accessor = json.path(primitive.at, &["attributes", &json.string(name)?])?;
            let accessor = json.number(accessor).filter(|&number| number >= 0.0)? as usize;
            let number = json.number(number).filter(|&number| number >= 0.0)? as u32;
            (accessor < document.accessors.len()).then_some((accessor, number))
        });
        Self {
            indices: primitive.indices,
            attributes: attributes.collect(),
        }
    }

    pub fn accessors(&self) -> impl Iterator<Item = usize> + '_ {
        let attributes = self.attributes.iter().map(|&(accessor, _)| accessor);
        self.indices.into_iter().chain(attributes)
    }
}

/// Decodes every primitive whose accessors have no bytes. Failures are noted, and reported if the primitive is drawn.
pub(crate) fn decode(document: &mut Document, meshes: &[Vec<Primitive>], cancel: &Cancel) -> Result<(), Cancelled> {
    let lacking: Vec<(&Primitive, At, Filled)> = meshes
        .iter()
        .flatten()
        .filter_map(|primitive| {
            let extension = extension_of(document, primitive)?;
            let filled = Filled::of(document, primitive, extension);
            let lacks = |accessor: usize| document.accessors[accessor].buffer_view.is_none();
            let is_lacking = filled.accessors().any(lacks);
            is_lacking.then_some((primitive, extension, filled))
        })
        .collect();
    // Primitives may share their data; each is decoded once, and all of them within one budget, by their sizes.
    let mut by_view: BTreeMap<Option<usize>, Vec<usize>> = BTreeMap::new();
    for (place, &(_, extension, _)) in lacking.iter().enumerate() {
        let view = document.json.member(extension, "bufferView");
        let number = view
            .and_then(|at| document.json.number(at))
            .map(|number| number as usize);
        by_view.entry(number).or_default().push(place);
    }
    let size = |view: Option<usize>| view.and_then(|view| document.view(view)).map_or(0, <[u8]>::len);
    let all: usize = by_view.keys().map(|&view| size(view)).sum();
    let budget = document.decoding_budget() as f64 / all.max(1) as f64;
    let decoded: Vec<Vec<(usize, DecodedPrimitive)>> = by_view
        .par_iter()
        .map(|(&view, places)| {
            if cancel.is_cancelled() {
                return Vec::new();
            }
            let mut left = (budget * size(view) as f64) as usize;
            let mesh = decoded_mesh(document, lacking[places[0]].1, left);
            let mut done = BTreeSet::new();
            let of_primitive = |&place: &usize| {
                let (primitive, _, filled) = &lacking[place];
                let wanted = filled.accessors().filter(|&accessor| done.insert(accessor)).collect();
                let bytes = (mesh.as_ref().map_err(Clone::clone))
                    .and_then(|mesh| bytes_of_accessors(document, primitive, mesh, filled, &wanted, &mut left));
                (place, bytes)
            };
            places.iter().map(of_primitive).collect()
        })
        .collect();
    cancel.check()?;
    for (place, decoded) in decoded.into_iter().flatten() {
        let (primitive, ..) = &lacking[place];
        match decoded {
            Ok(accessors) => {
                for (accessor, bytes) in accessors {
                    // Primitives may share accessors; then their data are the same.
                    if document.accessors[accessor].buffer_view.is_none() {
                        document.fill_accessor(accessor, bytes);
                    }
                }
            }
            Err(reason) => {
                document.undecoded_primitives.insert(primitive.at, reason);
            }
        }
    }
    Ok(())
}

/// An accessor and its bytes.
type FilledBytes = (usize, Vec<u8>);

/// A primitive's accessors with their bytes, or the fault.
type DecodedPrimitive = Result<Vec<FilledBytes>, String>;

/// The contents of a primitive's compressed data, if they take no more than `budget` bytes.
fn decoded_mesh(document: &Document, extension: At, budget: usize) -> Result<Mesh, String> {
    let view = document.index(extension, "bufferView", document.views.len(), || {
        "its Draco data".to_owned()
    })?;
    let source = view.and_then(|view| document.view(view)).ok_or("missing Draco data")?;
    let budget = budget as u64;
    let limits = DecodeLimits::default()
        .with_max_decoded_bytes(budget)
        .with_max_faces(budget / 12)
        .with_max_points(budget / 12);
    let mut mesh = Mesh::new();
    MeshDecoder::new()
        .decode(&mut DecoderBuffer::new(source).with_limits(limits), &mut mesh)
        .map_err(|error| format!("Draco data that can't be decoded ({error})"))?;
    Ok(mesh)
}

/// The bytes of each accessor that is `wanted`, elements tightly packed in the accessor's own type, while there is room
/// `left` for them.
fn bytes_of_accessors(
    document: &Document,
    primitive: &Primitive,
    mesh: &Mesh,
    filled: &Filled,
    wanted: &BTreeSet<usize>,
    left: &mut usize,
) -> Result<Vec<FilledBytes>, String> {
    if primitive.mode != Some(Mode::Triangles) {
        return Err("Draco data of a primitive that is not a list of triangles".to_owned());
    }
    let mut out: Vec<FilledBytes> = Vec::new();
    let mut keep = |accessor: usize, bytes: Vec<u8>| -> Result<(), String> {
        let room = left.checked_sub(bytes.len());
        *left = room.ok_or("Draco data that decodes to more than a file of its size can hold")?;
        out.push((accessor, bytes));
        Ok(())
    };
    if let Some(accessor) = filled.indices.filter(|accessor| wanted.contains(accessor)) {
        keep(accessor, index_bytes(document, accessor, mesh)?)?;
    }
    for &(accessor, number) in filled
        .attributes
        .iter()
        .filter(|(accessor, _)| wanted.contains(accessor))
    {
        keep(accessor, attribute_bytes(document, accessor, number, mesh)?)?;
    }
    Ok(out)
}

fn index_bytes(document: &Document, accessor: usize, mesh: &Mesh) -> Result<Vec<u8>, String> {
    let corners = mesh.faces().iter().flatten().map(|&PointIndex(point)| point);
    let told = &document.accessors[accessor];
    if told.count.0 != 3 * mesh.num_faces() as u64 {
        return Err(format!(
            "Draco data with {} triangles, but accessor {accessor} has {} corners",
            mesh.num_faces(),
            told.count.0
        ));
    }
    let most = corners.clone().max().unwrap_or(0);
    match told.component_type {
        Checked::Valid(kind) if kind.0 == ComponentType::U32 => Ok(corners.flat_map(u32::to_le_bytes).collect()),
        Checked::Valid(kind) if kind.0 == ComponentType::U16 && most <= u32::from(u16::MAX) => {
            Ok(corners.flat_map(|point| (point as u16).to_le_bytes()).collect())
        }
        Checked::Valid(kind) if kind.0 == ComponentType::U8 && most <= u32::from(u8::MAX) => {
            Ok(corners.map(|point| point as u8).collect())
        }
        _ => Err(format!("Draco data with indices that accessor {accessor} can't hold")),
    }
}

fn attribute_bytes(document: &Document, accessor: usize, number: u32, mesh: &Mesh) -> Result<Vec<u8>, String> {
    let told = &document.accessors[accessor];
    let attribute = mesh
        .attribute_by_unique_id(number)
        .ok_or_else(|| format!("Draco data without its declared attribute {number}"))?;
    let points = mesh.num_points();
    let (Checked::Valid(component), Some(lanes)) = (told.component_type, lanes_of(told)) else {
        return Err(format!("accessor {accessor}, which has an unknown type"));
    };
    if told.count.0 != points as u64 || usize::from(attribute.num_components()) != lanes {
        return Err(format!(
            "Draco data with {points} points of {} numbers, but accessor {accessor} has {} of {lanes}",
            attribute.num_components(),
            told.count.0
        ));
    }
    let stored = match attribute.data_type() {
        DataType::Int8 => Some(ComponentType::I8),
        DataType::Uint8 => Some(ComponentType::U8),
        DataType::Int16 => Some(ComponentType::I16),
        DataType::Uint16 => Some(ComponentType::U16),
        DataType::Uint32 => Some(ComponentType::U32),
        DataType::Float32 => Some(ComponentType::F32),
        _ => None,
    };
    if stored != Some(component.0) {
        return Err(format!("Draco data of another type than its accessor {accessor}"));
    }
    let size = lanes * component.0.size();
    let stride = usize::try_from(attribute.byte_stride()).unwrap_or(0);
    let values = attribute.buffer().data();
    let mut bytes = Vec::with_capacity(points * size);
    for point in 0..points as u32 {
        let AttributeValueIndex(value) = attribute.mapped_index(PointIndex(point));
        let start = value as usize * stride;
        let value = values.get(start..start + size);
        bytes.extend_from_slice(value.ok_or("Draco data that points beyond its own values")?);
    }
    Ok(bytes)
}

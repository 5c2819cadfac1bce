//! A mesh prim: points, faces, and the attributes that change with points or with corners.

use std::ops::Range;

use glam::DVec3;

use super::fault::Fault;
use super::layer::Prim;
use super::values::{each_number, indices, metadatum, vectors};

/// A mesh as its prim has it.
#[derive(Debug, Default)]
pub(super) struct Mesh {
    /// In the prim's own space. f32 where the layer says `point3f`, as for every reader of USD.
    pub points: Vec<DVec3>,
    /// The place of each point's first number.
    pub point_at: Vec<usize>,
    /// True if points are stored in f32.
    pub is_single: bool,
    /// The number of corners of each face.
    pub counts: Vec<u32>,
    /// The points at the corners of all faces.
    pub corners: Vec<u32>,
    /// The place of the corners' value.
    pub corners_value: Range<usize>,
    pub normals: Option<Attribute<3>>,
    /// The place of each normal's first number.
    pub normal_at: Vec<usize>,
    pub uvs: Option<Attribute<2>>,
    pub colours: Option<Attribute<3>>,
}

/// Values of an attribute, and the elements that they belong to.
#[derive(Debug)]
pub(super) struct Attribute<const N: usize> {
    pub values: Vec<[f32; N]>,
    indices: Option<Vec<u32>>,
    pub of: Of,
}

/// The elements that an attribute has values for.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Of {
    Mesh,
    Faces,
    Points,
    Corners,
}

/// A corner of a face.
#[derive(Clone, Copy)]
pub(super) struct Corner {
    pub face: usize,
    pub corner: usize,
    pub point: u32,
}

impl<const N: usize> Attribute<N> {
    /// The number of the value at a corner, if there is one.
    pub fn place(&self, corner: Corner) -> Option<usize> {
        let element = match self.of {
            Of::Mesh => 0,
            Of::Faces => corner.face,
            Of::Points => corner.point as usize,
            Of::Corners => corner.corner,
        };
        let place = match &self.indices {
            Some(indices) => *indices.get(element)? as usize,
            None => element,
        };
        (place < self.values.len()).then_some(place)
    }

    /// True if each point or corner has a value of its own, which can be changed by itself.
    pub fn is_separate(&self) -> bool {
        self.indices.is_none() && matches!(self.of, Of::Points | Of::Corners)
    }
}

/// Reads a mesh prim.
///
/// # Errors
/// Values that do not fit together; a shape that changes with time or with a skeleton.
pub(super) fn mesh(text: &[u8], prim: &Prim) -> Result<Mesh, Fault> {
    for (name, what) in [
        ("points.timeSamples", "points that change with time"),
        ("faceVertexIndices.timeSamples", "faces that change with time"),
        ("primvars:skel:jointIndices", "a mesh that a skeleton bends"),
    ] {
        if prim.properties.contains_key(name) {
            return Err(Fault::Unsupported {
                feature: what.to_owned(),
                remedy: "export it as a plain mesh, or as .glb".to_owned(),
            });
        }
    }
    let mut mesh = Mesh::default();
    let value = |name: &str| prim.properties.get(name);
    let wrong = |why: &str| Fault::Malformed(format!("its mesh {} {why}", crate::quoted(&prim.name)));
    if let Some(points) = value("points") {
        mesh.is_single = points.kind != "point3d[]" && points.kind != "double3[]";
        let mut place = 0;
        each_number(text, &points.value, |number, range| {
            let number = if mesh.is_single {
                f64::from(number as f32)
            } else {
                number
            };
            if place == 0 {
                mesh.points.push(DVec3::ZERO);
                mesh.point_at.push(range.start);
            }
            if let Some(point) = mesh.points.last_mut() {
                point[place] = number;
            }
            place = (place + 1) % 3;
        })?;
        if place != 0 {
            return Err(wrong("has an incomplete point"));
        }
    }
    if let (Some(counts), Some(corners)) = (value("faceVertexCounts"), value("faceVertexIndices")) {
        mesh.counts = indices(text, &counts.value)?;
        mesh.corners = indices(text, &corners.value)?;
        mesh.corners_value = corners.value.clone();
    }
    let counted = mesh.counts.iter().map(|&count| u64::from(count)).sum::<u64>();
    if counted != mesh.corners.len() as u64 {
        return Err(wrong("has faces whose corners are too few or too many"));
    }
    if mesh.corners.iter().any(|&point| point as usize >= mesh.points.len()) {
        return Err(wrong("has a face with a point that it does not have"));
    }
    mesh.normals = match value("primvars:normals").is_some() {
        true => attribute(text, prim, "primvars:normals")?,
        false => attribute(text, prim, "normals")?,
    };
    if let Some(normals) = value("primvars:normals").or_else(|| value("normals")) {
        let mut place = 0;
        each_number(text, &normals.value, |_, range| {
            if place % 3 == 0 {
                mesh.normal_at.push(range.start);
            }
            place += 1;
        })?;
    }
    mesh.uvs = attribute(text, prim, "primvars:st")?;
    mesh.colours = attribute(text, prim, "primvars:displayColor")?;
    Ok(mesh)
}

fn attribute<const N: usize>(text: &[u8], prim: &Prim, name: &str) -> Result<Option<Attribute<N>>, Fault> {
    let Some(property) = prim.properties.get(name) else {
        return Ok(None);
    };
    let values = vectors(text, &property.value)?;
    let indices = match prim.properties.get(&format!("{name}:indices")) {
        Some(property) => Some(indices(text, &property.value)?),
        None => None,
    };
    let of = match metadatum(text, property, "interpolation")?.as_deref() {
        Some("faceVarying") => Of::Corners,
        Some("vertex" | "varying") => Of::Points,
        Some("uniform") => Of::Faces,
        // The normals of a mesh are its points', all other attributes the mesh's.
        _ if name == "normals" => Of::Points,
        _ => Of::Mesh,
    };
    Ok((!values.is_empty()).then_some(Attribute { values, indices, of }))
}

//! The drawn set of meshes.
//!
//! A point whose corners have several normals, colours or texture coordinates is drawn once for each.

use std::collections::HashMap;

use glam::{DAffine3, DVec3};
use pliant_mesh::{Cancel, Drawn, DrawnVertex, FileVertex};

use super::fault::Fault;
use super::layer::{Layer, Prim};
use super::looks::Looks;
use super::mesh::{Corner, Mesh, mesh};
use super::stored::Instance;
use super::values::{indices, word};
use crate::appearance::Group;
use crate::appearance::colour::short;
use crate::convert::Polygons;
use crate::polygon::diagonals::Diagonals;
use crate::polygon::triangulate;
use crate::save::bits::placed;
use crate::save::turned::wound_back;

/// Corners between two checks for cancelling.
const CORNERS_BETWEEN_LOOKS: usize = 1 << 14;

/// The normal, texture coordinates and colour of a drawn vertex, by their bits.
type Look = [u32; 8];

/// The drawn set and its looks.
pub(super) struct Placed<'a> {
    pub drawn: Drawn,
    pub instances: Vec<Instance>,
    /// Every drawn face.
    pub polygons: Polygons,
    pub looks: Looks<'a>,
    normals: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
    colours: Vec<[u16; 4]>,
    has: [bool; 3],
}

impl<'a> Placed<'a> {
    /// Nothing yet.
    pub fn new(looks: Looks<'a>) -> Self {
        Self {
            drawn: Drawn::default(),
            instances: Vec::new(),
            polygons: Polygons {
                offsets: vec![0],
                ..Polygons::default()
            },
            looks,
            normals: Vec::new(),
            uvs: Vec::new(),
            colours: Vec::new(),
            has: [false; 3],
        }
    }

    /// Adds a mesh prim.
    ///
    /// # Errors
    /// It can't be read; soon after `cancel` is raised.
    pub fn mesh(
        &mut self,
        text: &[u8],
        layer: &Layer,
        number: usize,
        transform: DAffine3,
        cancel: &Cancel,
    ) -> Result<(), Fault> {
        let prim = &layer.prims[number];
        let mesh = mesh(text, prim)?;
        let materials = self.materials(text, layer, number, mesh.counts.len())?;
        let is_left_handed = word(text, prim, "orientation")?.as_deref() == Some("leftHanded");
        let is_mirrored = (transform.matrix3.determinant() < 0.0) != is_left_handed;
        let first = self.drawn.positions.len() as u32;
        let first_file_vertex = self.drawn.file_vertex_count as u32;
        for (point, &position) in mesh.points.iter().enumerate() {
            self.vertex(placed(transform, position), first_file_vertex + point as u32);
        }
        self.drawn.file_vertex_count += mesh.points.len();
        let corners = self.corners(&mesh, transform, (first, first_file_vertex), cancel)?;
        let diagonals = Diagonals::of(&mesh.points);
        let mut start = 0_usize;
        for (face, &count) in mesh.counts.iter().enumerate() {
            if start.is_multiple_of(CORNERS_BETWEEN_LOOKS) {
                cancel.check().map_err(|stopped| Fault::Stopped(stopped.into()))?;
            }
            let end = start + count as usize;
            let position = |k: usize| mesh.points[mesh.corners[start + k] as usize];
            triangulate(count as usize, position, &diagonals, |triangle| {
                let [a, b, c] = triangle.map(|k| DrawnVertex(corners[start + k]));
                let triangle = if is_mirrored { [a, c, b] } else { [a, b, c] };
                self.triangle(triangle, materials.as_ref().map_or(0, |of| of[face]), prim);
            });
            if count > 2 {
                self.polygon(&corners[start..end], is_mirrored);
            }
            start = end;
        }
        self.instances.push(Instance {
            name: prim.name.clone(),
            mesh,
            transform,
            first_file_vertex,
            vertices: first..self.drawn.positions.len() as u32,
            corners,
        });
        Ok(())
    }

    /// The material of each face; `None` if no face has one.
    fn materials(
        &mut self,
        text: &[u8],
        layer: &Layer,
        number: usize,
        face_count: usize,
    ) -> Result<Option<Vec<usize>>, Fault> {
        let own = self.looks.material_of(number)?;
        let mut of_faces = vec![own; face_count];
        for &child in &layer.prims[number].children {
            let subset = &layer.prims[child];
            if subset.kind != "GeomSubset" || !subset.properties.contains_key("material:binding") {
                continue;
            }
            let material = self.looks.material_of(child)?;
            if let Some(faces) = subset.properties.get("indices") {
                for face in indices(text, &faces.value)? {
                    if let Some(slot) = of_faces.get_mut(face as usize) {
                        *slot = material;
                    }
                }
            }
        }
        Ok(of_faces.iter().any(|&material| material > 0).then_some(of_faces))
    }

    /// The drawn vertex at each corner.
    fn corners(
        &mut self,
        mesh: &Mesh,
        transform: DAffine3,
        (first, first_file_vertex): (u32, u32),
        cancel: &Cancel,
    ) -> Result<Vec<u32>, Fault> {
        self.has[0] |= mesh.normals.is_some();
        self.has[1] |= mesh.uvs.is_some();
        self.has[2] |= mesh.colours.is_some();
        // Normals turn by the inverse transpose.
        let of_normals = transform.matrix3.inverse().transpose();
        let mut looks: Vec<Option<Look>> = vec![None; mesh.points.len()];
        let mut others: HashMap<(u32, Look), u32> = HashMap::new();
        let mut drawn = Vec::with_capacity(mesh.corners.len());
        let faces = mesh
            .counts
            .iter()
            .enumerate()
            .flat_map(|(face, &count)| (0..count).map(move |_| face));
        for (corner, (face, &point)) in faces.zip(&mesh.corners).enumerate() {
            if corner.is_multiple_of(CORNERS_BETWEEN_LOOKS) {
                cancel.check().map_err(|stopped| Fault::Stopped(stopped.into()))?;
            }
            let place = Corner { face, corner, point };
            let normal = mesh.normals.as_ref().and_then(|of| Some(of.values[of.place(place)?]));
            let uv = mesh.uvs.as_ref().and_then(|of| Some(of.values[of.place(place)?]));
            let colour = mesh.colours.as_ref().and_then(|of| Some(of.values[of.place(place)?]));
            let ([nx, ny, nz], [u, v]) = (normal.unwrap_or_default(), uv.unwrap_or_default());
            let [red, green, blue] = colour.unwrap_or([1.0; 3]);
            let look = [nx, ny, nz, u, v, red, green, blue].map(f32::to_bits);
            let own = first + point;
            let slot = &mut looks[point as usize];
            let vertex = match slot {
                None => {
                    *slot = Some(look);
                    own
                }
                Some(known) if *known == look => {
                    drawn.push(own);
                    continue;
                }
                Some(_) => match others.get(&(point, look)) {
                    Some(&known) => {
                        drawn.push(known);
                        continue;
                    }
                    None => {
                        let position = self.drawn.positions[own as usize];
                        let fresh = self.vertex(position, first_file_vertex + point);
                        others.insert((point, look), fresh);
                        fresh
                    }
                },
            };
            let world = of_normals * DVec3::new(nx.into(), ny.into(), nz.into());
            self.normals[vertex as usize] = world.normalize_or_zero().as_vec3().to_array();
            self.uvs[vertex as usize] = [u, 1.0 - v];
            let [red, green, blue] = [red, green, blue].map(|channel| short(channel.clamp(0.0, 1.0)));
            self.colours[vertex as usize] = [red, green, blue, u16::MAX];
            drawn.push(vertex);
        }
        Ok(drawn)
    }

    fn vertex(&mut self, world: DVec3, file_vertex: u32) -> u32 {
        self.drawn.positions.push(world);
        self.drawn.file_vertex.push(FileVertex(file_vertex));
        self.normals.push([0.0; 3]);
        self.uvs.push([0.0; 2]);
        self.colours.push([u16::MAX; 4]);
        self.drawn.positions.len() as u32 - 1
    }

    fn triangle(&mut self, corners: [DrawnVertex; 3], material: usize, prim: &Prim) {
        let number = self.drawn.triangles.len() as u32;
        self.drawn.triangles.push(corners);
        let groups = &mut self.looks.look.groups;
        match groups.last_mut() {
            Some(last) if last.material == material && last.node_name == prim.name => last.triangles.end = number + 1,
            _ => groups.push(Group {
                triangles: number..number + 1,
                material,
                node_name: prim.name.clone(),
            }),
        }
    }

    /// Adds a face, wound as its triangles are.
    fn polygon(&mut self, corners: &[u32], is_mirrored: bool) {
        let own = &mut self.polygons.corners;
        match is_mirrored {
            true => own.extend(wound_back(corners).copied().map(DrawnVertex)),
            false => own.extend(corners.iter().copied().map(DrawnVertex)),
        }
        self.polygons.offsets.push(own.len() as u32);
    }

    /// The drawn set with its looks.
    pub fn finished(mut self) -> Self {
        let [has_normals, has_uvs, has_colours] = self.has;
        let look = &mut self.looks.look;
        look.normals = has_normals.then(|| std::mem::take(&mut self.normals));
        look.uvs = has_uvs.then(|| std::mem::take(&mut self.uvs));
        look.colours = has_colours.then(|| std::mem::take(&mut self.colours));
        self
    }
}

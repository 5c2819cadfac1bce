//! The drawn set: every object with a mesh at the places where the build list shows it.
//!
//! A vertex whose triangles give it several colours or texture coordinates is drawn once for each.

use std::collections::{BTreeMap, HashMap};

use glam::{DAffine3, DVec3};
use pliant_mesh::{Cancel, Cancelled, Drawn, DrawnVertex, FileVertex};

use super::build::{Parts, known_path};
use super::model::{Component, Triangle};
use super::resources::Resources;
use super::stored::Instance;
use crate::appearance::colour::linear_colour;
use crate::appearance::{Appearance, Group, Image, Material, Origin};
use crate::quote::quoted;
use crate::save::bits;

/// The depth to which objects may consist of objects.
const DEPTH: usize = 64;

/// The bytes of the drawn set allowed for each byte of the archive and its parts.
const MOST_DRAWN: usize = 16;

/// The allowance for the drawn set of the smallest files.
const DRAWN_ANYWAY: usize = 64 << 20;

/// The bytes of a drawn vertex and of a drawn triangle.
const VERTEX_BYTES: usize = 64;
const TRIANGLE_BYTES: usize = 16;

/// The geometry and its look.
#[derive(Default)]
pub(super) struct Placed {
    pub drawn: Drawn,
    pub instances: Vec<Instance>,
    pub look: Appearance,
    pub notes: Vec<String>,
}

/// A place in the build: an object, and its transform to world space.
#[derive(Clone, Copy)]
struct Place {
    part: usize,
    object: usize,
    transform: DAffine3,
}

/// The drawn set of the build list, or the reason why there is none.
pub(super) fn placed(parts: &Parts, file_bytes: usize, cancel: &Cancel) -> Result<Result<Placed, String>, Cancelled> {
    let mut gathering = Gathering::new(parts, file_bytes);
    for item in &parts.items {
        cancel.check()?;
        if let Err(reason) = gathering.component(item, 0, DAffine3::IDENTITY, 0, cancel) {
            cancel.check()?;
            return Ok(Err(reason));
        }
    }
    Ok(Ok(gathering.finish()))
}

struct Gathering<'a> {
    parts: &'a Parts,
    /// For each part, an object's place by its number, and the number of its first vertex in the file.
    known: Vec<HashMap<u32, (usize, u32)>>,
    file_vertex_count: usize,
    left: usize,
    placed: Placed,
    /// The material of each property group or base material.
    materials: HashMap<(usize, u32, u32), usize>,
    images: BTreeMap<String, usize>,
    /// The look of each drawn vertex.
    uvs: Vec<[f32; 2]>,
    colours: Vec<[u16; 4]>,
    has_uvs: bool,
    has_colours: bool,
}

impl<'a> Gathering<'a> {
    fn new(parts: &'a Parts, file_bytes: usize) -> Self {
        let mut next = 0_u32;
        let known = parts.parts.iter().map(|part| {
            let objects = part.objects.iter().enumerate().map(|(place, object)| {
                let first = next;
                next = next.saturating_add(object.vertices.len() as u32);
                (object.id, (place, first))
            });
            objects.collect()
        });
        let known = known.collect();
        let bytes = parts.parts.iter().map(|part| part.bytes.len()).sum::<usize>() + file_bytes;
        Self {
            parts,
            known,
            file_vertex_count: next as usize,
            left: bytes.saturating_mul(MOST_DRAWN).saturating_add(DRAWN_ANYWAY),
            placed: Placed {
                look: Appearance {
                    materials: vec![Material::plain("")],
                    ..Appearance::default()
                },
                ..Placed::default()
            },
            materials: HashMap::new(),
            images: BTreeMap::new(),
            uvs: Vec::new(),
            colours: Vec::new(),
            has_uvs: false,
            has_colours: false,
        }
    }

    /// Adds an object and those that it consists of.
    fn component(
        &mut self,
        component: &Component,
        own_part: usize,
        to_world: DAffine3,
        depth: usize,
        cancel: &Cancel,
    ) -> Result<(), String> {
        let stopped = |_| "the caller stopped".to_owned();
        cancel.check().map_err(stopped)?;
        if depth == DEPTH {
            return Err(format!("object {} consists of itself, or too deeply", component.object));
        }
        // Many places of small objects take time, too.
        self.spend(1, VERTEX_BYTES)?;
        let part = match &component.path {
            None => own_part,
            Some(path) => *(self.parts.number.get(&known_path(path)))
                .ok_or_else(|| format!("it names the part {}, which it does not have", quoted(path)))?,
        };
        let (object, _) = *(self.known[part].get(&component.object))
            .ok_or_else(|| format!("it shows object {}, which it does not have", component.object))?;
        let transform = to_world * component.transform;
        let parts = self.parts;
        let found = &parts.parts[part].objects[object];
        if !found.vertices.is_empty() {
            self.mesh(Place {
                part,
                object,
                transform,
            })?;
        }
        for inner in &found.components {
            self.component(inner, part, transform, depth + 1, cancel)?;
        }
        Ok(())
    }

    fn spend(&mut self, count: usize, bytes_each: usize) -> Result<(), String> {
        let left = count
            .checked_mul(bytes_each)
            .and_then(|bytes| self.left.checked_sub(bytes));
        self.left = left.ok_or_else(|| {
            "it shows its objects more often than a file of its size can hold: it is damaged, so export it again"
                .to_owned()
        })?;
        Ok(())
    }

    /// Adds a mesh at a place.
    fn mesh(&mut self, place: Place) -> Result<(), String> {
        let Place {
            part,
            object,
            transform,
        } = place;
        let parts = self.parts;
        let found = &parts.parts[part].objects[object];
        let (_, first_file_vertex) = self.known[part].get(&found.id).copied().unwrap_or_default();
        self.spend(found.vertices.len() + found.triangles.len(), VERTEX_BYTES)?;
        self.spend(found.triangles.len(), TRIANGLE_BYTES)?;
        let first = self.placed.drawn.positions.len();
        for (number, &vertex) in found.vertices.iter().enumerate() {
            let world = bits::placed(transform, vertex);
            self.vertex(world, first_file_vertex + number as u32);
        }
        // A vertex gets the look of its first triangle; another look makes another vertex.
        let mut looks: Vec<Option<(u32, u32)>> = vec![None; found.vertices.len()];
        let mut others: HashMap<(u32, (u32, u32)), u32> = HashMap::new();
        let first_triangle = self.placed.drawn.triangles.len() as u32;
        let is_mirrored = transform.matrix3.determinant() < 0.0;
        for triangle in &found.triangles {
            let material = self.material(part, triangle);
            let mut corners = [0; 3];
            // In the order of the vertices, so that a triangle that is turned makes the same ones.
            let mut order = [0, 1, 2];
            order.sort_by_key(|&place| {
                (
                    triangle.corners[place],
                    triangle.property.map(|(_, indices)| indices[place]),
                )
            });
            for place in order {
                let vertex = triangle.corners[place];
                let own = first as u32 + vertex;
                corners[place] = match self.look(part, triangle, place) {
                    None => own,
                    Some(look) if *looks[vertex as usize].get_or_insert(look) == look => {
                        self.dress(part, own, look);
                        own
                    }
                    Some(look) => match others.get(&(vertex, look)) {
                        Some(&known) => known,
                        None => {
                            let world = self.placed.drawn.positions[own as usize];
                            let drawn = self.vertex(world, first_file_vertex + vertex);
                            self.dress(part, drawn, look);
                            others.insert((vertex, look), drawn);
                            drawn
                        }
                    },
                };
            }
            if is_mirrored {
                corners.swap(1, 2);
            }
            self.triangle(corners.map(DrawnVertex), material, &found.name);
        }
        self.placed.instances.push(Instance {
            part,
            object,
            first_file_vertex,
            transform,
            vertices: first as u32..self.placed.drawn.positions.len() as u32,
            triangles: first_triangle..self.placed.drawn.triangles.len() as u32,
        });
        Ok(())
    }

    fn vertex(&mut self, world: DVec3, file_vertex: u32) -> u32 {
        let drawn = &mut self.placed.drawn;
        drawn.positions.push(world);
        drawn.file_vertex.push(FileVertex(file_vertex));
        self.uvs.push([0.0; 2]);
        self.colours.push([u16::MAX; 4]);
        drawn.positions.len() as u32 - 1
    }

    fn triangle(&mut self, corners: [DrawnVertex; 3], material: usize, name: &str) {
        let number = self.placed.drawn.triangles.len() as u32;
        self.placed.drawn.triangles.push(corners);
        let groups = &mut self.placed.look.groups;
        let begins = self
            .placed
            .instances
            .last()
            .is_some_and(|last| last.triangles.end == number);
        match groups.last_mut() {
            Some(last) if last.material == material && last.node_name == name && !begins => {
                last.triangles.end = number + 1;
            }
            _ => groups.push(Group {
                triangles: number..number + 1,
                material,
                node_name: name.to_owned(),
            }),
        }
    }

    /// The colour or texture coordinate at a corner, which the vertex must have.
    fn look(&self, part: usize, triangle: &Triangle, corner: usize) -> Option<(u32, u32)> {
        let (group, indices) = triangle.property?;
        let Resources {
            colours, coordinates, ..
        } = &self.parts.resources[part];
        let count = match (colours.get(&group), coordinates.get(&group)) {
            (Some(colours), _) => colours.len(),
            (_, Some((_, coordinates))) => coordinates.len(),
            _ => 0,
        };
        ((indices[corner] as usize) < count).then_some((group, indices[corner]))
    }

    /// Gives a drawn vertex its colour or texture coordinate.
    fn dress(&mut self, part: usize, drawn: u32, (group, index): (u32, u32)) {
        let Resources {
            colours, coordinates, ..
        } = &self.parts.resources[part];
        if let Some(colours) = colours.get(&group) {
            let colour = colours[index as usize].map(|channel| f32::from(channel) / 255.0);
            self.colours[drawn as usize] = linear_colour(colour);
            self.has_colours = true;
        } else if let Some((_, coordinates)) = coordinates.get(&group) {
            let [u, v] = coordinates[index as usize];
            self.uvs[drawn as usize] = [u, 1.0 - v];
            self.has_uvs = true;
        }
    }

    /// The number of a triangle's material.
    fn material(&mut self, part: usize, triangle: &Triangle) -> usize {
        let Some((group, [index, ..])) = triangle.property else {
            return 0;
        };
        let resources = &self.parts.resources[part];
        let (key, material) = if let Some((texture, _)) = resources.coordinates.get(&group) {
            let key = (part, group, 0);
            if let Some(&known) = self.materials.get(&key) {
                return known;
            }
            let image = resources.textures.get(texture).map(|path| self.image(path));
            let plain = Material {
                base_colour_image: image,
                ..Material::plain("")
            };
            (key, plain)
        } else if let Some(base) = resources.bases.get(&group).and_then(|bases| bases.get(index as usize)) {
            let key = (part, group, index);
            if let Some(&known) = self.materials.get(&key) {
                return known;
            }
            let [red, green, blue, alpha] = base.colour.map(|channel| f32::from(channel) / 255.0);
            let [red, green, blue] = [red, green, blue].map(crate::appearance::colour::linear_of_srgb);
            let material = Material {
                base_colour: [red, green, blue, alpha],
                ..Material::plain(&base.name)
            };
            (key, material)
        } else {
            return 0;
        };
        let materials = &mut self.placed.look.materials;
        materials.push(material);
        self.materials.insert(key, materials.len() - 1);
        materials.len() - 1
    }

    /// The number of an image of the archive.
    fn image(&mut self, path: &str) -> usize {
        let path = known_path(path);
        let images = &mut self.placed.look.images;
        *self.images.entry(path.clone()).or_insert_with(|| {
            let bytes = self.parts.images.get(&path).cloned().flatten();
            if bytes.is_none() {
                let note = format!(
                    "The image {} is missing, so its surface is drawn without it.",
                    quoted(&path)
                );
                self.placed.notes.push(note);
            }
            images.push(Image {
                name: path.rsplit('/').next().unwrap_or(&path).to_owned(),
                encoded: bytes.unwrap_or_default(),
                origin: Origin::Inside,
            });
            images.len() - 1
        })
    }

    fn finish(mut self) -> Placed {
        self.placed.drawn.file_vertex_count = self.file_vertex_count;
        self.placed.look.uvs = self.has_uvs.then_some(self.uvs);
        self.placed.look.colours = self.has_colours.then_some(self.colours);
        if self.parts.has_other_groups {
            let note = "Its composite and multiple materials are kept but not shown.";
            self.placed.notes.push(note.to_owned());
        }
        self.placed
    }
}

//! The appearance of a shape that was put together: attributes, groups, materials and polygons from its sources.

use std::collections::BTreeSet;
use std::ops::Range;

use glam::{DVec3, Vec3};
use pliant_io::{Appearance, Group, Image, Material, ObjNames, OriginalMaterial, Placement, Polygons, UnsavedShape};
use pliant_mesh::{Drawn, DrawnVertex, Model, vertex_normals};
use pliant_stitch::{Age, Attributes, NewShape, Part, VertexSource};

use crate::loading::Loaded;

/// A file that a shape is made of.
pub(super) struct Source<'a> {
    /// The file's surface.
    pub model: &'a Model,
    /// Its drawn vertices.
    pub drawn: &'a Drawn,
    /// Its appearance.
    pub look: Appearance,
    /// Its polygons.
    polygons: Option<Polygons>,
}

impl<'a> Source<'a> {
    /// A file that was read. `drawn` is its model's.
    pub fn of(loaded: &'a Loaded, drawn: &'a Drawn) -> Self {
        Self {
            model: &loaded.model,
            drawn,
            look: loaded.scene.appearance_with_originals(),
            polygons: loaded.scene.polygons(),
        }
    }

    /// The group of a drawn triangle.
    pub fn group(&self, triangle: u32) -> u32 {
        let groups = &self.look.groups;
        groups.partition_point(|group| group.triangles.end <= triangle) as u32
    }

    /// The stored normal of a drawn vertex.
    pub fn normal(&self, vertex: DrawnVertex) -> DVec3 {
        let normals = self.look.normals.as_ref();
        normals.map_or(DVec3::ZERO, |normals| Vec3::from(normals[vertex.index()]).as_dvec3())
    }

    /// Calls `work` with the file as a part of a new shape, whose vertices have these channels.
    pub fn with_part<T>(&self, channels: Channels, work: impl FnOnce(&Part<'_>) -> T) -> T {
        let value = |vertex, channel| channels.value(&self.look, vertex, channel);
        let group = |triangle| self.group(triangle);
        let normal = |vertex| self.normal(vertex);
        work(&Part {
            model: self.model,
            drawn: self.drawn,
            group: &group,
            attributes: channels.attributes(&value),
            normals: self.look.normals.is_some().then_some(&normal as _),
        })
    }

    /// Whether a drawn vertex belongs to triangles that are shown flat.
    fn is_flat(&self, vertex: DrawnVertex) -> bool {
        let ranges: &[Range<u32>] = &self.look.flat;
        let next = ranges.partition_point(|range| range.end <= vertex.0);
        ranges.get(next).is_some_and(|range| range.contains(&vertex.0))
    }

    /// The normals of its drawn vertices: the stored ones, or else the surface's.
    pub fn normals(&self) -> Vec<[f32; 3]> {
        if let Some(normals) = &self.look.normals {
            return normals.clone();
        }
        let mut of_surface: Vec<DVec3> = Vec::new();
        let surface = &self.model.surface;
        vertex_normals(
            &surface.triangles,
            &self.model.topology,
            &surface.positions,
            &mut of_surface,
        );
        let of_drawn = self.model.drawn.surface_vertices();
        // f32 begins here: normals are displayed and saved as f32 in every kind of file.
        let normal = |v: Option<pliant_mesh::SurfaceVertex>| v.map_or(DVec3::ZERO, |v| of_surface[v.index()]);
        of_drawn.map(|v| normal(v).as_vec3().to_array()).collect()
    }
}

/// The attributes that at least one source has, as channels: texture coordinates, second ones, colours.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Channels {
    uvs: bool,
    second_uvs: bool,
    colours: bool,
}

impl Channels {
    /// Those of these sources.
    pub fn of(sources: &[Source<'_>]) -> Self {
        let any = |has: &dyn Fn(&Appearance) -> bool| sources.iter().any(|source| has(&source.look));
        Self {
            uvs: any(&|look| look.uvs.is_some()),
            second_uvs: any(&|look| look.second_uvs.is_some()),
            colours: any(&|look| look.colours.is_some()),
        }
    }

    fn charted(self) -> usize {
        2 * (usize::from(self.uvs) + usize::from(self.second_uvs))
    }

    fn blended(self) -> usize {
        4 * usize::from(self.colours)
    }

    /// The number of a source's vertex in a channel.
    pub fn value(self, look: &Appearance, vertex: DrawnVertex, channel: usize) -> f64 {
        let v = vertex.index();
        if channel >= self.charted() {
            let colours = look.colours.as_ref();
            return colours.map_or(f64::from(u16::MAX), |colours| {
                f64::from(colours[v][channel - self.charted()])
            });
        }
        let uvs = if self.uvs && channel < 2 {
            &look.uvs
        } else {
            &look.second_uvs
        };
        uvs.as_ref().map_or(0.0, |uvs| f64::from(uvs[v][channel % 2]))
    }

    /// The same for stitching; `value` is [`Self::value`] of a source.
    pub fn attributes(self, value: &(dyn Fn(DrawnVertex, usize) -> f64 + Sync)) -> Attributes<'_> {
        Attributes {
            charted: self.charted(),
            blended: self.blended(),
            value,
        }
    }
}

/// The shape with the appearance of its sources, its triangles in the order of their groups.
pub(super) struct Dressed {
    triangles: Vec<[DrawnVertex; 3]>,
    polygons: Option<Polygons>,
    appearance: Appearance,
}

impl Dressed {
    /// Dresses a shape, and brings its triangles into the order of their groups.
    pub fn of(shape: &mut NewShape, sources: &[Source<'_>], channels: Channels) -> Self {
        let mut appearance = Appearance::default();
        let mut first_groups = Vec::new();
        for source in sources {
            first_groups.push(appearance.groups.len() as u32);
            add_groups(&mut appearance, &source.look);
        }
        let group_of = |place: usize| {
            let source = &shape.triangle_sources[place];
            let part = usize::from(source.part);
            first_groups[part] + sources[part].group(source.triangle)
        };
        let mut order: Vec<u32> = (0..shape.triangles.len() as u32).collect();
        let groups: Vec<u32> = (0..shape.triangles.len()).map(group_of).collect();
        order.sort_by_key(|&place| groups[place as usize]);
        let (mut start, mut next) = (0, 0);
        for (number, group) in (0..).zip(&mut appearance.groups) {
            while next < order.len() && groups[order[next] as usize] <= number {
                next += 1;
            }
            group.triangles = start..next as u32;
            start = next as u32;
        }
        shape.triangles = order.iter().map(|&place| shape.triangles[place as usize]).collect();
        shape.triangle_sources = order
            .iter()
            .map(|&place| shape.triangle_sources[place as usize])
            .collect();
        dress_vertices(&mut appearance, shape, sources, channels);
        appearance.obj = obj_names(sources);
        let polygons = polygons(shape, sources);
        Self {
            triangles: std::mem::take(&mut shape.triangles),
            polygons,
            appearance,
        }
    }

    /// The shape to write, at a place relative to the first source.
    pub fn unsaved<'a>(&'a self, shape: &'a NewShape, place: Placement) -> UnsavedShape<'a> {
        let mut appearance = self.appearance.clone();
        if let Some(names) = &mut appearance.obj {
            // In the same folder, everything that the libraries name is there.
            names.names_other_maps &= place == Placement::OtherFolder;
        }
        UnsavedShape {
            positions: &shape.positions,
            triangles: &self.triangles,
            polygons: self.polygons.clone(),
            file_vertex: &shape.file_vertices,
            file_vertex_count: shape.file_vertex_count,
            appearance,
        }
    }

    /// Whether a new OBJ gets the libraries and names of its sources.
    pub fn has_obj_names(&self) -> bool {
        self.appearance.obj.is_some()
    }

    /// Its triangles.
    pub fn triangles(&self) -> &[[DrawnVertex; 3]] {
        &self.triangles
    }
}

/// The names of OBJ sources, if all are such files and no name gets another meaning.
fn obj_names(sources: &[Source<'_>]) -> Option<ObjNames> {
    let mut all: Option<ObjNames> = None;
    let mut used: Vec<&str> = Vec::new();
    for source in sources {
        let look = &source.look;
        let own = look.obj.as_ref()?;
        let materials: BTreeSet<usize> = look.groups.iter().map(|group| group.material).collect();
        let names: Vec<&str> = materials.iter().map(|&place| &*look.materials[place].name).collect();
        all = Some(match all {
            None => own.clone(),
            Some(all) => all.joined(&used, own, &names)?,
        });
        used.extend(names);
    }
    all
}

/// Adds a source's groups, materials and images; those that are there already are not doubled.
fn add_groups(all: &mut Appearance, look: &Appearance) {
    let is_same = |a: &Image, b: &Image| a.name == b.name && a.origin == b.origin && a.encoded[..] == b.encoded[..];
    let images: Vec<usize> = look
        .images
        .iter()
        .map(|image| {
            let known = all.images.iter().position(|other| is_same(other, image));
            known.unwrap_or_else(|| {
                all.images.push(image.clone());
                all.images.len() - 1
            })
        })
        .collect();
    let materials: Vec<usize> = look
        .materials
        .iter()
        .map(|material| {
            let mut own: Material = material.clone();
            own.base_colour_image = own.base_colour_image.map(|image| images[image]);
            let maps = [
                &mut own.metallic_roughness_map,
                &mut own.normal_map,
                &mut own.occlusion_map,
                &mut own.emissive_map,
            ];
            maps.into_iter().flatten().for_each(|map| map.image = images[map.image]);
            let originals = own.original.iter_mut().flat_map(OriginalMaterial::images_mut);
            originals.for_each(|image| *image = images[*image]);
            let known = all.materials.iter().position(|other| *other == own);
            known.unwrap_or_else(|| {
                all.materials.push(own);
                all.materials.len() - 1
            })
        })
        .collect();
    all.groups.extend(look.groups.iter().map(|group| Group {
        triangles: 0..0,
        material: materials[group.material],
        node_name: group.node_name.clone(),
    }));
}

/// Fills the attributes of the shape's vertices.
fn dress_vertices(out: &mut Appearance, shape: &NewShape, sources: &[Source<'_>], channels: Channels) {
    let width = channels.charted() + channels.blended();
    let value = |vertex: &VertexSource, channel: usize| match *vertex {
        VertexSource::Old { part, vertex } => channels.value(&sources[usize::from(part)].look, vertex, channel),
        VertexSource::New { row, .. } => shape.values[row as usize * width + channel],
    };
    // f32 and u16 begin here: attributes are displayed and saved as such in every kind of file.
    let pair = |first: usize| {
        let vertices = shape.vertices.iter();
        vertices
            .map(|vertex| [0, 1].map(|k| value(vertex, first + k) as f32))
            .collect()
    };
    out.uvs = channels.uvs.then(|| pair(0));
    out.second_uvs = channels.second_uvs.then(|| pair(2 * usize::from(channels.uvs)));
    out.colours = channels.colours.then(|| {
        let rounded = |number: f64| number.round().clamp(0.0, f64::from(u16::MAX)) as u16;
        let colour = |vertex| [0, 1, 2, 3].map(|k| rounded(value(vertex, channels.charted() + k)));
        let mut colours: Vec<[u16; 4]> = shape.vertices.iter().map(colour).collect();
        for (vertex, row) in &shape.blended {
            colours[vertex.index()] = [0, 1, 2, 3].map(|k| rounded(row[k]));
        }
        colours
    });
    let like = |vertex: &VertexSource| match *vertex {
        VertexSource::Old { part, vertex } => (usize::from(part), vertex),
        VertexSource::New { part, like, .. } => (usize::from(part), like),
    };
    let is_flat = shape.vertices.iter().map(|vertex| {
        let (part, like) = like(vertex);
        sources[part].is_flat(like)
    });
    let is_flat: Vec<bool> = is_flat.collect();
    if sources.iter().any(|source| source.look.normals.is_some()) {
        let of_sources: Vec<Vec<[f32; 3]>> = sources.iter().map(Source::normals).collect();
        let normal = |vertex: &VertexSource| {
            let (part, like) = like(vertex);
            of_sources[part][like.index()]
        };
        let mut normals: Vec<[f32; 3]> = shape.vertices.iter().map(normal).collect();
        for (vertex, normal) in &shape.normals {
            if !is_flat[vertex.index()] {
                normals[vertex.index()] = normal.as_vec3().to_array();
            }
        }
        out.normals = Some(normals);
    }
    out.flat = ranges(&is_flat);
}

/// The ranges of vertices with a set flag.
fn ranges(flags: &[bool]) -> Vec<Range<u32>> {
    let mut ranges: Vec<Range<u32>> = Vec::new();
    for (number, _) in (0..).zip(flags).filter(|(_, flag)| **flag) {
        match ranges.last_mut() {
            Some(last) if last.end == number => last.end += 1,
            _ => ranges.push(number..number + 1),
        }
    }
    ranges
}

/// The faces, if a source has polygons: those of which every triangle is left, and triangles.
fn polygons(shape: &NewShape, sources: &[Source<'_>]) -> Option<Polygons> {
    sources.iter().find(|source| source.polygons.is_some())?;
    let number_of: Vec<Vec<DrawnVertex>> = (0..sources.len())
        .map(|part| {
            let mut number = vec![DrawnVertex(u32::MAX); sources[part].drawn.positions.len()];
            for (own, vertex) in (0..).zip(&shape.vertices) {
                if let VertexSource::Old { part: of, vertex } = *vertex
                    && usize::from(of) == part
                {
                    number[vertex.index()] = DrawnVertex(own);
                }
            }
            number
        })
        .collect();
    // For each source, the face that begins at each of its triangles.
    let faces: Vec<Vec<(u32, usize)>> = sources
        .iter()
        .map(|source| {
            let mut first = 0;
            let faces = source
                .polygons
                .iter()
                .flat_map(|polygons| (0..polygons.len()).map(move |face| (polygons, face)));
            let faces = faces.map(|(polygons, face)| {
                let start = first;
                first += polygons.face(face).len().saturating_sub(2) as u32;
                (start, face)
            });
            faces.collect()
        })
        .collect();
    let mut out = Polygons::default();
    out.offsets.push(0);
    let mut place = 0;
    while let Some(source) = shape.triangle_sources.get(place) {
        let part = usize::from(source.part);
        let whole = sources[part].polygons.as_ref().and_then(|polygons| {
            let starts = &faces[part];
            let found = starts
                .partition_point(|(start, _)| *start <= source.triangle)
                .checked_sub(1)?;
            let (start, face) = starts[found];
            let corners = polygons.face(face);
            let count = corners.len().saturating_sub(2);
            let own = shape.triangle_sources.get(place..place + count)?;
            let is_whole = start == source.triangle
                && own.iter().zip(start..).all(|(own, number)| {
                    own.age == Age::Old && usize::from(own.part) == part && own.triangle == number
                });
            let numbers = corners.iter().map(|corner| number_of[part][corner.index()]);
            is_whole.then(|| (count.max(1), numbers.collect::<Vec<_>>()))
        });
        let (count, corners) = whole.unwrap_or_else(|| (1, shape_corners(shape, place)));
        out.corners.extend(corners);
        out.offsets.push(out.corners.len() as u32);
        place += count;
    }
    Some(out)
}

fn shape_corners(shape: &NewShape, place: usize) -> Vec<DrawnVertex> {
    shape
        .triangles
        .get(place)
        .map(|corners| corners.to_vec())
        .unwrap_or_default()
}

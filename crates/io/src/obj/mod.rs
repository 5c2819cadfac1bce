//! Wavefront OBJ, read with the place of every number, so that saving changes the moved vertices' `v` lines (and the
//! `vn` lines around them) and no other byte.
//!
//! The reader is our own, because `tobj` renumbers vertices, drops unused ones and keeps f32. `tobj` reads the
//! materials. Every `v` line is a file vertex; [`corners`] describes the drawing of corners with texture coordinates
//! and normals.

mod coloured;
mod corners;
mod faces;
mod materials;
mod normals;
mod patch;
mod rename;
mod smoothing;
mod statements;
mod stored;
mod turned;
mod write;

use std::ops::Range;

use pliant_mesh::{Drawn, DrawnVertex, Object};

use crate::appearance::colour::linear_colour;
use crate::appearance::{Group, Material, ranges};
use crate::convert::Polygons;
use crate::save::OutputFile;
use crate::save::course::Course;
use crate::save::moved::Moved;
use crate::source::Source;
use crate::summary::Summary;
use crate::text::line_of;
use crate::{Appearance, ObjNames, ReadError, SaveError, objects};
use materials::Materials;
use statements::{NONE, Statements};

pub(crate) use rename::{library_renamed, texture_renamed};
pub(crate) use stored::Stored;
pub(crate) use write::write_new;

/// Reads an OBJ file and asks for its material libraries and textures.
pub(crate) fn read(source: &Source<'_>) -> Result<(Stored, Drawn), ReadError> {
    let mut statements = statements::parse(source)?;
    let corners = corners::draw(&statements, source.cancel)?;
    let libraries: Vec<&[u8]> = statements
        .libraries
        .iter()
        .map(|span| &source.bytes[span.clone()])
        .collect();
    let mut materials = materials::look_up(source, &libraries, &statements.material_names);
    let groups = groups(&statements, &corners, &mut materials);
    let mut notes = std::mem::take(&mut materials.notes).sentences();
    let flat = flat(&statements, &corners);
    notes.extend(left_out(source, &statements));
    let has_polygons = corners.drawn.triangles.len() != statements.face_ends.len();
    statements.positions = Vec::new();
    statements.corners = Vec::new();
    let face_ends = std::mem::take(&mut statements.face_ends);
    let polygons = has_polygons.then(|| Polygons {
        offsets: [0].into_iter().chain(face_ends.iter().map(|&end| end as u32)).collect(),
        corners: corners.drawn_of_corner.iter().copied().map(DrawnVertex).collect(),
    });
    let stored = Stored {
        bytes: source.bytes.clone(),
        statements,
        uv: corners.uv,
        normal: corners.normal,
        polygons,
        position: corners.drawn.file_vertex.iter().map(|vertex| vertex.0).collect(),
        groups,
        flat,
        materials,
        notes,
    };
    Ok((stored, corners.drawn))
}

/// One group a run; faces without a material get a plain one after the named ones.
fn groups(statements: &Statements, corners: &corners::Corners, materials: &mut Materials) -> Vec<Group> {
    let ends = corners
        .run_triangles
        .iter()
        .skip(1)
        .copied()
        .chain([corners.drawn.triangles.len() as u32]);
    let plain = materials.materials.len();
    if statements.runs.iter().any(|run| run.material.is_none()) {
        materials.materials.push(Material::plain(""));
    }
    let spans = corners.run_triangles.iter().zip(ends);
    statements
        .runs
        .iter()
        .zip(spans)
        .map(|(run, (&start, end))| Group {
            triangles: start..end,
            material: run.material.unwrap_or(plain),
            node_name: run.object().to_owned(),
        })
        .collect()
}

/// The drawn vertices that belong only to flat faces, in a file without normals.
fn flat(statements: &Statements, corners: &corners::Corners) -> Vec<Range<u32>> {
    let is_flat = &statements.smoothing.flat_faces;
    if is_flat.is_empty() || !statements.normals.is_empty() {
        return Vec::new();
    }
    let mut wanted = vec![None; corners.drawn.positions.len()];
    let mut start = 0;
    for (face, &end) in statements.face_ends.iter().enumerate() {
        let is_flat = is_flat.get(face).copied().unwrap_or(false);
        for &vertex in &corners.drawn_of_corner[start..end] {
            let known = wanted[vertex as usize].get_or_insert(is_flat);
            *known &= is_flat;
        }
        start = end;
    }
    ranges(wanted.into_iter().map(|is_flat| is_flat == Some(true)))
}

/// Sentences about data of the file that can't be drawn.
fn left_out(source: &Source<'_>, statements: &Statements) -> Vec<String> {
    let mut notes = Vec::new();
    let line = |at| line_of(source.bytes, at);
    let plural = |count: usize, one: &str| {
        if count == 1 {
            format!("1 {one}")
        } else {
            format!("{count} {one}s")
        }
    };
    if let (count @ 1.., at) = statements.left_out {
        notes.push(format!(
            "{} with fewer than three corners left out of the surface (the first in line {}); the file keeps them.",
            plural(count, "face"),
            line(at)
        ));
    }
    let smoothing = &statements.smoothing;
    let is_all_flat =
        smoothing.flat_faces.len() == statements.face_ends.len() && smoothing.flat_faces.iter().all(|is_flat| *is_flat);
    let is_divided = smoothing.has_several() || (smoothing.has_flat() && !is_all_flat);
    if statements.normals.is_empty() && is_divided {
        notes.push(
            "The file has smoothing groups ('s') but no normals, so edges between groups are drawn and converted as \
             smooth."
                .to_owned(),
        );
    }
    if let (count @ 1.., at) = statements.dangling {
        notes.push(format!(
            "{} drawn without a texture coordinate or normal, because the file lacks the named one (the first in line \
             {}).",
            plural(count, "face corner"),
            line(at)
        ));
    }
    notes
}

impl Stored {
    pub(crate) fn notes(&self) -> &[String] {
        &self.notes
    }

    pub(crate) fn summary(&self) -> Summary {
        let objects = self.groups.chunk_by(|a, b| a.node_name == b.node_name).count();
        Summary {
            meshes: objects,
            primitives: self.groups.len(),
            nodes: objects,
            materials: self.statements.material_names.len(),
            images: self.materials.images.len(),
            ..Summary::default()
        }
    }

    pub(crate) fn objects(&self) -> Vec<Object> {
        objects::gathered(self.groups.iter().map(|group| objects::TriangleRun {
            key: (&group.node_name, group.material),
            name: group.node_name.clone(),
            material: objects::short_name(&self.materials.materials[group.material].name),
            triangles: group.triangles.clone(),
        }))
    }

    pub(crate) fn appearance(&self) -> Appearance {
        let count = self.position.len();
        let statements = &self.statements;
        let look_up = |table: &[u32], v: usize| table.get(v).copied().filter(|&index| index != NONE);
        let uvs = (!self.uv.is_empty()).then(|| {
            (0..count)
                .map(|v| look_up(&self.uv, v).map_or([0.0; 2], |index| statements.uvs[index as usize]))
                .map(|[u, v]| [u, 1.0 - v])
                .collect()
        });
        let normals = (!self.normal.is_empty()).then(|| {
            let unit = |index: u32| statements.normals[index as usize].try_normalize().unwrap_or_default();
            // f32: normals are displayed and saved as f32 in every other kind of file.
            (0..count)
                .map(|v| look_up(&self.normal, v).map_or([0.0; 3], |index| unit(index).as_vec3().to_array()))
                .collect()
        });
        Appearance {
            normals,
            uvs,
            second_uvs: None,
            colours: self.colours(),
            flat: self.flat.clone(),
            groups: self.groups.clone(),
            materials: self.materials.materials.clone(),
            images: self.materials.images.clone(),
            obj: None,
        }
    }

    /// The same with the names that a new OBJ file gets again.
    pub(crate) fn appearance_with_names(&self) -> Appearance {
        let mut appearance = self.appearance();
        let (mut groups, mut names) = (Vec::new(), Vec::new());
        for (group, run) in appearance.groups.iter().zip(&self.statements.runs) {
            let [object, group_name] = &run.names;
            for (triangles, smoothing) in self.statements.smoothing.parts(&group.triangles) {
                groups.push(Group {
                    triangles,
                    ..group.clone()
                });
                names.push([object.clone(), group_name.clone(), smoothing.to_owned()]);
            }
        }
        appearance.groups = groups;
        appearance.obj = Some(ObjNames {
            groups: names,
            ..materials::names_of(&self.materials)
        });
        appearance
    }

    /// A sentence about the smoothing groups that other formats than OBJ do not have.
    pub(crate) fn smoothing_lost(&self) -> Option<String> {
        let smoothing = &self.statements.smoothing;
        let is_divided = smoothing.has_several() || smoothing.is_partly_flat();
        is_divided.then(|| "The new shape leaves out smoothing groups ('s'): keep the .obj for them.".to_owned())
    }

    /// Colours after the positions: sRGB from 0 to 1, or to 255 if one is larger than 1.
    fn colours(&self) -> Option<Vec<[u16; 4]>> {
        let colours = &self.statements.colours;
        if colours.is_empty() {
            return None;
        }
        let most = colours
            .iter()
            .flatten()
            .fold(1.0f32, |most, &channel| most.max(channel));
        let scale = if most > 1.0 { 1.0 / 255.0 } else { 1.0 };
        let drawn = |&position: &u32| {
            let [r, g, b] = colours[position as usize].map(|channel| channel * scale);
            linear_colour([r, g, b, 1.0])
        };
        Some(self.position.iter().map(drawn).collect())
    }

    pub(crate) fn polygons(&self) -> Option<Polygons> {
        self.polygons.clone()
    }

    /// The libraries and textures that a copy in another folder needs beside it, and warnings.
    pub(crate) fn neighbours(&self) -> (Vec<OutputFile>, Vec<String>) {
        materials::neighbours(&materials::names_of(&self.materials))
    }

    /// A warning that names the parts of the materials that a file of another format does not have.
    pub(crate) fn materials_lost(&self, kind: &str) -> Option<String> {
        materials::unread_lost(&self.materials, kind)
    }

    /// The file with another colour for each of its vertices, in sRGB.
    pub(crate) fn write_coloured(&self, colours: &[Option<[u8; 4]>]) -> Vec<u8> {
        coloured::coloured(self, colours)
    }

    /// The file with the moved vertices' numbers changed, and warnings.
    pub(crate) fn write(&self, moved: &Moved<'_>, course: &Course<'_>) -> Result<(Vec<u8>, Vec<String>), SaveError> {
        let patched = patch::patched(self, moved, course)?;
        if !moved.turns_any() {
            return Ok((patched.bytes, Vec::new()));
        }
        // For each `vn` line, whether turned parts use it, and whether others do.
        let mut uses = vec![(false, false); patched.normal_count];
        for (v, &normal) in patched.normal.iter().enumerate().filter(|(_, normal)| **normal != NONE) {
            let (by_turned, by_others) = &mut uses[normal as usize];
            match moved.turns(DrawnVertex(v as u32)) {
                true => *by_turned = true,
                false => *by_others = true,
            }
        }
        let kept = uses.iter().filter(|uses| **uses == (true, true)).count();
        let warning = (kept > 0).then(|| {
            format!(
                "{kept} normals ('vn' lines) were not reversed, because parts that were not turned inside out share \
                 them."
            )
        });
        let normals: Vec<bool> = uses.iter().map(|uses| *uses == (true, false)).collect();
        let bytes = turned::turned(&patched.bytes, &moved.turned_of_file(), &normals);
        Ok((bytes, warning.into_iter().collect()))
    }
}

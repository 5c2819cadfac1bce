//! Checks that a file that was read back shows the intended result.

use std::ops::Range;

use glam::DVec3;
use pliant_mesh::{Drawn, DrawnVertex};

use crate::convert::Polygons;
use crate::save::bits::bit_equal;
use crate::save::turned::{triangle_wound_back, wound_back};
use crate::scene::reading::SceneAndDrawn;
use crate::scene::stored::{Scene, Stored};
use crate::scene::unsaved::UnsavedShape;
use crate::{Format, MorphTarget, Save};

impl Scene {
    /// Compares `back`, which was read from the bytes of a save of this scene, with the request `save`. `triangles` is
    /// the save's own [`triangles`](crate::Saved::triangles). With `morph` the edit is visible in proportion to the
    /// target's weight.
    ///
    /// A save in the file's own format keeps its vertices and their order, so each vertex is compared. Another format
    /// may renumber them, so there every corner of every face is compared. Positions are compared in the format's own
    /// precision: for glTF to a few roundings to f32 in the node's space, elsewhere to the bit.
    ///
    /// # Errors
    /// The first difference, in words.
    pub fn check_read_back(
        &self,
        save: &Save<'_>,
        morph: Option<&MorphTarget<'_>>,
        triangles: Option<&[u32]>,
        back: &SceneAndDrawn,
    ) -> Result<(), String> {
        let wanted = |vertex: usize| {
            let (rest, new) = (save.drawn.positions[vertex], save.positions[vertex]);
            match morph {
                Some(morph) if !bit_equal(rest, new) => rest + (new - rest) * morph.weight,
                Some(_) => rest,
                None => new,
            }
        };
        let stored = Precision::of(back);
        let is_turned = |vertex: DrawnVertex| save.turned.get(vertex.index()).is_some_and(|is_turned| *is_turned);
        let wound = |triangle: [DrawnVertex; 3]| match is_turned(triangle[0]) {
            true => triangle_wound_back(triangle),
            false => triangle,
        };
        match (self.stored(), save.format) {
            (Stored::Gltf(_), Format::Glb | Format::Gltf) | (Stored::Threemf(_), Format::Threemf) => {
                same_count("vertices", back.drawn.positions.len(), save.drawn.positions.len())?;
                let vertices = 0..save.drawn.positions.len();
                each(vertices.map(|vertex| (vertex, wanted(vertex))), back, &stored)?;
                if back
                    .drawn
                    .triangles
                    .iter()
                    .copied()
                    .eq(save.drawn.triangles.iter().copied().map(wound))
                {
                    Ok(())
                } else {
                    Err("its triangles have other vertices".to_owned())
                }
            }
            // An STL's corners are its vertices: those of a turned facet change places.
            (_, format) if format == self.format() && !(format == Format::Stl && save.turned.contains(&true)) => {
                same_count("vertices", back.drawn.file_vertex_count, save.drawn.file_vertex_count)?;
                same_count("triangles", back.drawn.triangles.len(), save.drawn.triangles.len())?;
                let wanted = of_file_vertices(save.drawn, wanted);
                let of_file = back.drawn.file_vertex.iter().enumerate();
                each(of_file.map(|(v, file)| (v, wanted[file.index()])), back, &stored)?;
                same_windings(self, save, back, is_turned)
            }
            (_, format) if has_only_triangles(format) => {
                let count = triangles.map_or(save.drawn.triangles.len(), <[u32]>::len);
                same_count("triangles", back.drawn.triangles.len(), count)?;
                let source = |place: usize| triangles.map_or(place, |triangles| triangles[place] as usize);
                let corners = back.drawn.triangles.iter().enumerate().flat_map(|(place, triangle)| {
                    let from = wound(save.drawn.triangles[source(place)]);
                    triangle.iter().zip(from).map(|(v, from)| (v.index(), from.index()))
                });
                each(corners.map(|(v, from)| (v, wanted(from))), back, &stored)
            }
            _ => {
                let (of_save, of_back) = (Faces::of(self, save.drawn), Faces::of(&back.scene, &back.drawn));
                let (mut of_save, mut of_back) = (of_save.iter(), of_back.iter());
                for face in 0.. {
                    match (of_save.next(), of_back.next()) {
                        (None, None) => break,
                        (Some(from), Some(corners)) if from.len() == corners.len() => {
                            let corners = corners.iter().zip(as_wound(from, &is_turned));
                            let corners = corners.map(|(v, from)| (v.index(), wanted(from.index())));
                            each(corners, back, &stored)?;
                        }
                        _ => return Err(format!("face {face} has another number of corners")),
                    }
                }
                Ok(())
            }
        }
    }
}

/// Returns true if new files of a format have no polygons.
fn has_only_triangles(format: Format) -> bool {
    matches!(
        format,
        Format::Glb | Format::Gltf | Format::Stl | Format::Threemf | Format::Usdz
    )
}

/// A face's corners with their final winding.
fn as_wound(face: &[DrawnVertex], is_turned: impl Fn(DrawnVertex) -> bool) -> impl Iterator<Item = &DrawnVertex> {
    let is_turned = face.first().is_some_and(|first| is_turned(*first));
    let (turned, as_read) = match is_turned {
        true => (Some(wound_back(face)), None),
        false => (None, Some(face.iter())),
    };
    let corners = turned.into_iter().flatten();
    corners.chain(as_read.into_iter().flatten())
}

/// Compares the corners of every face by the file's own numbers.
fn same_windings(
    scene: &Scene,
    save: &Save<'_>,
    back: &SceneAndDrawn,
    is_turned: impl Fn(DrawnVertex) -> bool,
) -> Result<(), String> {
    let (of_save, of_back) = (Faces::of(scene, save.drawn), Faces::of(&back.scene, &back.drawn));
    let mut pairs = of_save.iter().zip(of_back.iter());
    let wrong = pairs.position(|(from, found)| {
        let wanted = as_wound(from, &is_turned).map(|corner| save.drawn.file_vertex[corner.index()]);
        !wanted.eq(found.iter().map(|corner| back.drawn.file_vertex[corner.index()]))
    });
    wrong.map_or(Ok(()), |face| Err(format!("face {face} has other vertices")))
}

impl UnsavedShape<'_> {
    /// Compares `back`, which was read from the bytes of this shape, with it: every corner of every face. `triangles`
    /// is the save's own [`triangles`](crate::Saved::triangles).
    ///
    /// # Errors
    /// The first difference, in words.
    pub fn check_read_back(
        &self,
        format: Format,
        triangles: Option<&[u32]>,
        back: &SceneAndDrawn,
    ) -> Result<(), String> {
        let stored = Precision::of(back);
        if has_only_triangles(format) {
            let count = triangles.map_or(self.triangles.len(), <[u32]>::len);
            same_count("triangles", back.drawn.triangles.len(), count)?;
            let source = |place: usize| triangles.map_or(place, |triangles| triangles[place] as usize);
            let corners = back.drawn.triangles.iter().enumerate().flat_map(|(place, triangle)| {
                let from = self.triangles[source(place)];
                triangle.iter().zip(from).map(|(v, from)| (v.index(), from.index()))
            });
            return each(corners.map(|(v, from)| (v, self.positions[from])), back, &stored);
        }
        let own = match &self.polygons {
            Some(polygons) => Faces::Polygons(polygons.clone()),
            None => Faces::Triangles(self.triangles),
        };
        let of_back = Faces::of(&back.scene, &back.drawn);
        same_count("faces", of_back.iter().count(), own.iter().count())?;
        for (face, (from, corners)) in own.iter().zip(of_back.iter()).enumerate() {
            if from.len() != corners.len() {
                return Err(format!("face {face} has another number of corners"));
            }
            let corners = corners.iter().zip(from);
            let wanted = corners.map(|(v, from)| (v.index(), self.positions[from.index()]));
            each(wanted, back, &stored)?;
        }
        Ok(())
    }
}

/// The precision of positions in the format of a file that was read back.
enum Precision<'a> {
    /// Ranges of drawn vertices, ascending, and the largest error of each of their coordinates.
    Within(Vec<(Range<u32>, DVec3)>),
    /// Each coordinate as the nearest number of its type, which may depend on the axis.
    Nearest(&'a Scene),
}

impl<'a> Precision<'a> {
    fn of(back: &'a SceneAndDrawn) -> Self {
        match back.scene.stored() {
            Stored::Gltf(stored) => Self::Within(stored.roundings(&back.drawn)),
            Stored::Threemf(stored) => Self::Within(stored.roundings(&back.drawn)),
            Stored::Usdz(stored) => Self::Within(stored.roundings(&back.drawn)),
            _ => Self::Nearest(&back.scene),
        }
    }

    /// Returns true if drawn vertex `v`, read back at `found`, is `wanted` to the format's precision.
    fn holds(&self, v: usize, found: DVec3, wanted: DVec3) -> bool {
        let lanes = found.to_array().into_iter().zip(wanted.to_array());
        match self {
            Self::Within(ranges) => {
                let range = ranges.partition_point(|(range, _)| range.end as usize <= v);
                let within = ranges.get(range).map_or(DVec3::ZERO, |(_, within)| *within);
                (lanes.zip(within.to_array()))
                    .all(|((found, wanted), within)| is_equal(found, wanted) || (found - wanted).abs() <= within)
            }
            Self::Nearest(scene) => (lanes.enumerate()).all(|(axis, (found, wanted))| {
                is_equal(found, wanted) || is_equal(found, scene.nearest_stored(axis, wanted))
            }),
        }
    }
}

/// Equality in which NaN equals NaN.
fn is_equal(a: f64, b: f64) -> bool {
    a == b || (a.is_nan() && b.is_nan())
}

fn same_count(what: &str, found: usize, wanted: usize) -> Result<(), String> {
    if found == wanted {
        Ok(())
    } else {
        Err(format!("it has {found} {what} instead of {wanted}"))
    }
}

/// Compares drawn vertices of `back`, each with its expected position.
fn each(
    mut wanted: impl Iterator<Item = (usize, DVec3)>,
    back: &SceneAndDrawn,
    stored: &Precision<'_>,
) -> Result<(), String> {
    let wrong = wanted.find(|&(v, wanted)| !stored.holds(v, back.drawn.positions[v], wanted));
    match wrong {
        None => Ok(()),
        Some((v, wanted)) => {
            let [found, wanted] = [back.drawn.positions[v], wanted].map(|p| format!("({}, {}, {})", p.x, p.y, p.z));
            let vertex = back.drawn.file_vertex[v].0;
            Err(format!("vertex {vertex} is at {found} instead of {wanted}"))
        }
    }
}

/// The expected place of each file vertex: that of its first moved drawn vertex, or the rest position.
fn of_file_vertices(drawn: &Drawn, wanted: impl Fn(usize) -> DVec3) -> Vec<DVec3> {
    let mut out: Vec<Option<DVec3>> = vec![None; drawn.file_vertex_count];
    let mut has_moved = vec![false; drawn.file_vertex_count];
    for (v, file) in drawn.file_vertex.iter().enumerate() {
        let (file, wanted) = (file.index(), wanted(v));
        let moves = !bit_equal(wanted, drawn.positions[v]);
        if out[file].is_none() || (moves && !has_moved[file]) {
            out[file] = Some(wanted);
        }
        has_moved[file] |= moves;
    }
    out.into_iter().map(Option::unwrap_or_default).collect()
}

/// A file's own faces.
pub(crate) enum Faces<'a> {
    Triangles(&'a [[DrawnVertex; 3]]),
    Polygons(Polygons),
}

impl<'a> Faces<'a> {
    pub(crate) fn of(scene: &Scene, drawn: &'a Drawn) -> Self {
        let polygons = scene.polygons().map(Self::Polygons);
        polygons.unwrap_or(Self::Triangles(&drawn.triangles))
    }

    /// The faces that are drawn; those with fewer than three corners are not.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &[DrawnVertex]> {
        let (triangles, polygons): (&[[DrawnVertex; 3]], _) = match self {
            Self::Triangles(triangles) => (triangles, None),
            Self::Polygons(polygons) => (&[], Some(polygons)),
        };
        let polygons = polygons.into_iter();
        let polygons = polygons.flat_map(|polygons| (0..polygons.len()).map(|face| polygons.face(face)));
        let triangles = triangles.iter().map(<[DrawnVertex; 3]>::as_slice);
        triangles.chain(polygons.filter(|face| face.len() > 2))
    }
}

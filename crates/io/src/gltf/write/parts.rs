//! The division of triangles into nodes, and their order.

use std::collections::{BTreeMap, HashMap};

use glam::Vec3;
use pliant_mesh::{Cancelled, DrawnVertex};

use crate::convert::{NewMesh, Parting};
use crate::save::course::Course;

/// More parts than this are joined: viewers draw each separately.
const MOST_PARTS: usize = 1024;

/// The content of a node.
pub(super) struct NamedPart<'a> {
    pub(super) name: &'a str,
    /// The numbers of its triangles, by material.
    pub(super) triangles: BTreeMap<usize, Vec<u32>>,
}

impl NamedPart<'_> {
    /// The vertices that it uses, ascending.
    pub(super) fn vertices(&self, mesh: &NewMesh<'_>) -> Vec<u32> {
        let mut vertices: Vec<u32> = self.corners(mesh).map(|corner| corner.0).collect();
        vertices.sort_unstable();
        vertices.dedup();
        vertices
    }

    /// The corners of its triangles.
    pub(super) fn corners<'a>(&'a self, mesh: &'a NewMesh<'_>) -> impl Iterator<Item = DrawnVertex> + 'a {
        let triangles = self.triangles.values().flatten();
        triangles.flat_map(|&triangle| mesh.triangles[triangle as usize])
    }
}

/// The triangles in the order of the parts; `None` if that is the mesh's own order, with none left out.
pub(super) fn order(parts: &[NamedPart<'_>], count: usize) -> Option<Vec<u32>> {
    let written = || parts.iter().flat_map(|part| part.triangles.values().flatten().copied());
    let is_old = written().eq(0..count as u32);
    (!is_old).then(|| written().collect())
}

/// The parts in the order in which the file first names them, without triangles with a vertex that glTF can't hold.
pub(super) fn parts<'a>(
    mesh: &'a NewMesh<'_>,
    positions: &[Vec3],
    warnings: &mut Vec<String>,
    course: &Course<'_>,
) -> Result<Vec<NamedPart<'a>>, Cancelled> {
    let groups = &mesh.appearance.groups;
    let mut names: Vec<&str> = Vec::new();
    let mut place_of: HashMap<&str, usize> = HashMap::new();
    for group in groups {
        place_of.entry(&group.node_name).or_insert_with(|| {
            names.push(&group.node_name);
            names.len() - 1
        });
    }
    let is_parted = mesh.parting == Parting::ByName && names.len() <= MOST_PARTS;
    if !is_parted {
        let lost = (names.len() > 1).then(|| {
            format!(
                "The file's {} groups became one mesh: save as .obj to keep them apart.",
                names.len()
            )
        });
        warnings.extend(lost);
        names.truncate(usize::from(names.len() == 1));
    }
    if names.is_empty() {
        names.push("");
    }
    let mut parts: Vec<NamedPart<'_>> = names
        .into_iter()
        .map(|name| NamedPart {
            name,
            triangles: BTreeMap::new(),
        })
        .collect();
    let mut left_out = 0;
    let grouped = groups.iter().map(|group| {
        let place = if is_parted {
            place_of[group.node_name.as_str()]
        } else {
            0
        };
        (place, group.material, group.triangles.clone())
    });
    let ungrouped = groups
        .is_empty()
        .then_some((0, usize::MAX, 0..mesh.triangles.len() as u32));
    for (place, material, range) in grouped.chain(ungrouped) {
        let (start, end) = (range.start as usize, range.end as usize);
        for (number, triangle) in (start..).zip(&mesh.triangles[start..end]) {
            course.pass(number, mesh.triangles.len())?;
            if triangle.iter().all(|corner| positions[corner.index()].is_finite()) {
                parts[place].triangles.entry(material).or_default().push(number as u32);
            } else {
                left_out += 1;
            }
        }
    }
    if left_out > 0 {
        warnings.push(format!(
            "glTF output leaves out {left_out} triangles with a vertex that is not finite."
        ));
    }
    parts.retain(|part| !part.triangles.is_empty());
    if parts.len() > 1 {
        let mut is_used = vec![false; positions.len()];
        let corners = parts.iter().flat_map(|part| part.corners(mesh));
        corners.for_each(|corner| is_used[corner.index()] = true);
        let unused = is_used.iter().filter(|is_used| !**is_used).count();
        if unused > 0 {
            warnings.push(format!(
                "glTF output leaves out the vertices that no triangle uses ({unused}): save as .obj to keep them."
            ));
        }
    }
    Ok(parts)
}

//! The objects of a file, gathered from its runs of triangles.

use std::collections::HashMap;
use std::hash::Hash;
use std::ops::Range;

use pliant_mesh::Object;

use crate::Appearance;

/// The longest name, in characters, of which each run of triangles gets a copy: a readable length. The file keeps the
/// whole name.
const LONGEST_NAME: usize = 120;

/// A name shortened for display.
pub(crate) fn short_name(name: &str) -> String {
    name.chars().take(LONGEST_NAME).collect()
}

/// A run of triangles with its key and its names.
pub(crate) struct TriangleRun<Key> {
    /// Runs with equal keys are one object.
    pub(crate) key: Key,
    /// The node's name.
    pub(crate) name: String,
    /// The material's name.
    pub(crate) material: String,
    /// Range of the drawn triangles.
    pub(crate) triangles: Range<u32>,
}

/// The objects of groups: the triangles of one node in one material.
pub(crate) fn of_groups(look: &Appearance) -> Vec<Object> {
    gathered(look.groups.iter().map(|group| TriangleRun {
        key: (&group.node_name, group.material),
        name: short_name(&group.node_name),
        material: short_name(&look.materials[group.material].name),
        triangles: group.triangles.clone(),
    }))
}

/// The objects, in the order in which the runs first name them. Runs without triangles make no object.
pub(crate) fn gathered<Key: Eq + Hash>(runs: impl Iterator<Item = TriangleRun<Key>>) -> Vec<Object> {
    let mut known: HashMap<Key, usize> = HashMap::new();
    let mut objects: Vec<Object> = Vec::new();
    for run in runs.filter(|run| !run.triangles.is_empty()) {
        let TriangleRun {
            key,
            name,
            material,
            triangles,
        } = run;
        let next = objects.len();
        let number = *known.entry(key).or_insert(next);
        match objects.get_mut(number) {
            Some(object) => object.triangles.push(triangles),
            None => objects.push(Object {
                name,
                material,
                triangles: vec![triangles],
            }),
        }
    }
    objects
}

//! The objects of a mesh matched to those of another whose vertices are matched.

use std::collections::{BTreeMap, HashMap};

use pliant_mesh::{Model, SurfaceVertex};

/// For each object of the new mesh, the old object to which most of its triangles between matched vertices belong; the
/// first of several. `of_new` has the old vertex of each new one.
pub(super) fn matched_objects(old: &Model, new: &Model, of_new: &[Option<u32>]) -> Vec<Option<u32>> {
    let old_objects = old.all_objects().len();
    let new_objects = new.all_objects().len();
    if old_objects == 1 {
        return vec![Some(0); new_objects];
    }
    let old_object_of: HashMap<[u32; 3], u32> = objects_of_triangles(old)
        .map(|(corners, object)| (sorted(corners.map(|corner| corner.0)), object))
        .collect();
    let mut votes: Vec<BTreeMap<u32, usize>> = vec![BTreeMap::new(); new_objects];
    for (corners, object) in objects_of_triangles(new) {
        let [Some(a), Some(b), Some(c)] = corners.map(|corner| of_new[corner.index()]) else {
            continue;
        };
        if let Some(old) = old_object_of.get(&sorted([a, b, c])) {
            *votes[object as usize].entry(*old).or_default() += 1;
        }
    }
    let most = |votes: &BTreeMap<u32, usize>| {
        let votes = votes.iter().rev();
        votes.max_by_key(|(_, count)| **count).map(|(object, _)| *object)
    };
    votes.iter().map(most).collect()
}

/// The surface's triangles, each with the number of its object.
fn objects_of_triangles(model: &Model) -> impl Iterator<Item = ([SurfaceVertex; 3], u32)> {
    let mut object_of_drawn = vec![0; model.drawn.triangle_count()];
    for (number, object) in (0..).zip(model.all_objects()) {
        for run in object.triangles {
            object_of_drawn[run.start as usize..run.end as usize].fill(number);
        }
    }
    let triangles = model.surface.triangles.iter().zip(model.drawn.triangle_of_surface());
    triangles.map(move |(corners, drawn)| (*corners, object_of_drawn[*drawn as usize]))
}

fn sorted(mut corners: [u32; 3]) -> [u32; 3] {
    corners.sort_unstable();
    corners
}

//! The names of the parts of two files that became one.

use std::fs;
use std::path::Path;

use glam::DVec3;
use pliant_editor::MeshChange;
use pliant_engine::load;
use pliant_engine::stitching::{Present, remake};
use pliant_engine::watch::Watch;
use pliant_mesh::WeldOptions;

use crate::made::{paths, textured_sphere};

#[test]
fn appended_nodes_without_names_get_their_files() {
    let (_folder, [first, second]) = paths(["coat.obj", "horn.obj"]);
    textured_sphere(&first, 0.7);
    textured_sphere(&second, 0.6);
    let unnamed = |path: &Path| {
        let text = fs::read_to_string(path).unwrap().replace("o ball\n", "");
        fs::write(path, text).unwrap();
    };
    // A name that is there already is numbered, and two unnamed files differ.
    for (is_unnamed, wanted) in [
        ([false, false], ["ball", "ball 2"]),
        ([false, true], ["ball", "horn"]),
        ([true, true], ["coat", "horn"]),
    ] {
        for (path, is_unnamed) in [&first, &second].into_iter().zip(is_unnamed) {
            if is_unnamed {
                unnamed(path);
            }
        }
        let [one, other] =
            [&first, &second].map(|path| load(path, &WeldOptions::default(), &Watch::default()).unwrap());
        let rests = vec![DVec3::ZERO; one.model.surface.positions.len()];
        let present = Present {
            loaded: &one,
            displacements: &rests,
            inside_out: &std::collections::BTreeSet::new(),
        };
        let append = MeshChange::Append("horn".to_owned());
        let both = remake(&present, &append, Some(&other), &Watch::default()).unwrap();
        let mut names: Vec<String> = both
            .loaded
            .model
            .all_objects()
            .iter()
            .map(|object| object.name.clone())
            .collect();
        names.dedup();
        assert_eq!(names, wanted);
    }
}

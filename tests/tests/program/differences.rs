//! `pliant diff`, and saving an edit as a morph target, from the command line.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::Path;

use pliant_mesh::shapes;
use pliant_tests::{Folder, bare_edit, bend, data, diagonal, largest_distance, open, run};
use serde_json::{Value, json};

fn diff(a: &Path, b: &Path) -> String {
    run(["diff".as_ref(), a.as_os_str(), b.as_os_str()]).done().out
}

#[test]
fn files_that_hold_the_same_have_no_difference_whatever_holds_them() {
    for path in data(&["gltf"]) {
        assert_eq!(diff(&path, &path), "no difference\n", "{}", path.display());
    }
    let folder = Folder::new();
    let mesh = folder.write_mesh("mesh.off", &shapes::torus(12, 8));
    let (glb, gltf) = (folder.at("a.glb"), folder.at("b.gltf"));
    folder.apply(&mesh, &bare_edit(), &glb, &[]).done();
    folder.apply(&glb, &bare_edit(), &gltf, &[]).done();
    assert_eq!(diff(&glb, &gltf), "no difference\n");
}

#[test]
fn an_edit_is_told_as_what_it_changed() {
    let folder = Folder::new();
    let mesh = folder.write_mesh("mesh.off", &shapes::torus(12, 8));
    for kind in ["glb", "gltf", "obj", "ply", "stl", "off"] {
        let (before, after) = (folder.at(&format!("a.{kind}")), folder.at(&format!("b.{kind}")));
        folder.apply(&mesh, &bare_edit(), &before, &[]).done();
        folder
            .apply(&before, &bend(&json!({ "translation": [0, 0, 1] })), &after, &[])
            .done();
        let said = diff(&before, &after);
        let wanted = if kind.starts_with("gl") {
            "mesh 0, primitive 0, POSITION: "
        } else {
            "positions: "
        };
        assert!(said.contains(wanted), "{kind}: {said}");
        assert!(!said.contains("beside the shape"), "{kind}: {said}");
        let json = run([
            "diff".as_ref(),
            before.as_os_str(),
            after.as_os_str(),
            "--json".as_ref(),
        ])
        .done();
        let json: Value = serde_json::from_str(&json.out).unwrap();
        assert_eq!(json["differences"].as_array().unwrap().len(), said.lines().count());
    }
    let other = folder.write_mesh("other.off", &shapes::grid(3, 3));
    assert!(diff(&mesh, &other).contains("drawn vertices: 96 in the first, 16 in the second"));
}

#[test]
fn an_edit_becomes_a_morph_target() {
    let folder = Folder::new();
    let mesh = folder.write_mesh("mesh.off", &shapes::torus(12, 8));
    let before = folder.at("before.glb");
    folder.apply(&mesh, &bare_edit(), &before, &[]).done();
    let edit = bend(&json!({ "translation": [0, 0, 1] }));
    let bent = folder.at("bent.glb");
    folder.apply(&before, &edit, &bent, &[]).done();
    for (source, out) in [(&before, "morph.glb"), (&before, "morph.gltf"), (&mesh, "other.glb")] {
        let out = folder.at(out);
        folder.apply(source, &edit, &out, &["--as-morph", "lean"]).done();
        let (shown, wanted) = (open(&out), open(&bent));
        let positions = [&shown, &wanted].map(|loaded| loaded.model.rest_positions());
        assert!(largest_distance(&positions[0], &positions[1]) < 1e-6 * diagonal(&positions[1]));
        assert_eq!(shown.scene.summary().morph_targets, 1);
    }
    let hidden = folder.at("hidden.glb");
    folder
        .apply(&before, &edit, &hidden, &["--as-morph", "--morph-weight", "0"])
        .done();
    let [at_rest, before_it] = [&hidden, &before].map(|file| open(file).model.rest_positions());
    assert_eq!(at_rest, before_it);
    assert!(diff(&before, &hidden).contains("mesh 0, primitive 0, targets: only in the second"));
    folder
        .apply(&before, &edit, &folder.at("out.ply"), &["--as-morph"])
        .refused(1, &["morph target", ".glb"]);
    folder
        .apply(
            &before,
            &edit,
            &folder.at("out.glb"),
            &["--as-morph", "x", "--morph-weight", "2"],
        )
        .refused(2, &["--morph-weight"]);
}

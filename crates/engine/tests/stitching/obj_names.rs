//! An OBJ that is filled, cut or joined keeps its libraries, materials, names and groups, byte for byte where it can.

use std::fs;
use std::path::Path;

use glam::DVec3;
use pliant_editor::MeshChange;
use pliant_engine::files::Staging;
use pliant_engine::load;
use pliant_engine::saving::{SaveAs, stage};
use pliant_engine::stitching::{Holes, Present, Replace, remake};
use pliant_engine::watch::Watch;
use pliant_mesh::{Cancel, Progress, WeldOptions};

use crate::made::{filled, paths};

/// Two sheets of quads with a hole each, in two objects with groups, of materials whose names have blanks, with a
/// library that has more than a picture shows.
fn two_sheets(path: &Path) {
    let mut text = "mtllib look.mtl\n".to_owned();
    let mut first = 1;
    for (object, group, materials) in [
        ("coat", "left upper", ["Red cloth", "Blue"]),
        ("hat", "brim", ["Red cloth", "Felt.1"]),
    ] {
        text += &format!("o {object}\ng {group}\ns 1\n");
        for place in 0..64 {
            let (x, y) = (place / 8, place % 8);
            let ball = 0.02 * f64::from((x - 3) * (x - 3) + (y - 4) * (y - 4));
            text += &format!(
                "v {} {y} {ball}\nvt {} {}\n",
                x + 10 * first,
                f64::from(x) / 7.0,
                f64::from(y) / 7.0
            );
        }
        for (half, material) in materials.iter().enumerate() {
            text += &format!("usemtl {material}\n");
            for place in 0..49 {
                let (x, y) = (place / 7, place % 7);
                if (x < 4) == (half == 0) && !((3..5).contains(&x) && (3..5).contains(&y)) {
                    let corners = [8 * x + y, 8 * x + 8 + y, 8 * x + 9 + y, 8 * x + y + 1].map(|v| v + first);
                    let corners = corners.map(|v| format!("{v}/{v}"));
                    text += &format!("f {}\n", corners.join(" "));
                }
            }
        }
        first += 64;
    }
    fs::write(path, text).unwrap();
    let library = "newmtl Red cloth\nKd 0.8 0.1 0.1\nKs 0.5 0.5 0.5\nmap_Bump bumps.png\nnewmtl Blue\nKd 0 0 1\nd 0.5\nnewmtl Felt.1\nPr 0.8\n";
    fs::write(path.with_file_name("look.mtl"), library).unwrap();
}

/// The statements that name something, with the number of quads and triangles after each.
fn names(path: &Path) -> Vec<(String, [usize; 2])> {
    let text = fs::read_to_string(path).unwrap();
    let mut found: Vec<(String, [usize; 2])> = Vec::new();
    for line in text.lines() {
        match line.split(' ').next() {
            Some("mtllib" | "o" | "g" | "s" | "usemtl") => found.push((line.to_owned(), [0; 2])),
            Some("f") => {
                let is_triangle = line.split(' ').count() == 4;
                found.last_mut().unwrap().1[usize::from(is_triangle)] += 1;
            }
            _ => {}
        }
    }
    found
}

fn words(names: &[(String, [usize; 2])]) -> Vec<&str> {
    names.iter().map(|(line, _)| &**line).collect()
}

#[test]
fn a_filled_obj_has_its_own_libraries_names_and_groups_again() {
    let (folder, [file, beside]) = paths(["scan.obj", "closed.obj"]);
    two_sheets(&file);
    let before = names(&file);
    let elsewhere = folder.path().join("other");
    fs::create_dir(&elsewhere).unwrap();
    for output in [beside, elsewhere.join("closed.obj")] {
        let warnings = filled(&file, &output, Holes::Every, Replace::Never).unwrap().join(" ");
        let after = names(&output);
        let once = |names: &[(String, [usize; 2])]| {
            let mut words: Vec<String> = words(names).into_iter().map(str::to_owned).collect();
            words.retain(|line| line != "s 1");
            words
        };
        assert_eq!(once(&after), once(&before));
        assert_eq!(after.iter().filter(|(line, _)| line == "s 1").count(), 1);
        let quads = |names: &[(String, [usize; 2])]| names.iter().map(|(_, count)| count[0]).sum::<usize>();
        assert_eq!(quads(&after), quads(&before), "faces that stay are quads again");
        let is_elsewhere = output.starts_with(&elsewhere);
        assert_eq!(warnings.contains("copy them yourself"), is_elsewhere, "{warnings}");
        assert!(!warnings.contains("leaves out the material library"), "{warnings}");
        let library = output.with_file_name("look.mtl");
        assert_eq!(
            fs::read(library).unwrap(),
            fs::read(file.with_file_name("look.mtl")).unwrap()
        );
        assert!(!output.with_file_name("closed.mtl").exists());
    }
}

#[test]
fn an_obj_that_is_filled_in_the_window_stays_one_and_is_saved_with_its_names() {
    let (_folder, [file, output]) = paths(["scan.obj", "closed.obj"]);
    two_sheets(&file);
    let loaded = load(&file, &WeldOptions::default(), &Watch::default()).unwrap();
    let rests = vec![DVec3::ZERO; loaded.model.surface.positions.len()];
    let present = Present {
        loaded: &loaded,
        displacements: &rests,
        inside_out: &std::collections::BTreeSet::new(),
    };
    let remade = remake(&present, &MeshChange::FillAll, None, &Watch::default()).unwrap();
    assert_eq!(remade.loaded.path, file);
    let warnings = remade.warnings.join(" ");
    assert!(!warnings.contains("leaves out"), "{warnings}");
    let positions = remade.loaded.model.rest_positions();
    let saved = stage(
        &remade.loaded,
        &SaveAs::shape(&positions, &output),
        &Staging::default(),
        &Progress::new(),
        &Cancel::new(),
    );
    saved.unwrap().staged.commit().unwrap();
    let by_command = file.with_file_name("by-command.obj");
    filled(&file, &by_command, Holes::Every, Replace::Never).unwrap();
    assert_eq!(fs::read(&output).unwrap(), fs::read(&by_command).unwrap());
}

#[test]
fn a_part_whose_materials_have_other_meanings_gets_a_library_of_both() {
    let (folder, [file]) = paths(["scan.obj"]);
    two_sheets(&file);
    let other = folder.path().join("other");
    fs::create_dir(&other).unwrap();
    let second = other.join("second.obj");
    two_sheets(&second);
    for is_same in [true, false] {
        if !is_same {
            fs::write(other.join("look.mtl"), "newmtl Red cloth\nKd 0 1 0\n").unwrap();
        }
        let [first, second] =
            [&file, &second].map(|path| load(path, &WeldOptions::default(), &Watch::default()).unwrap());
        let rests = vec![DVec3::ZERO; first.model.surface.positions.len()];
        let present = Present {
            loaded: &first,
            displacements: &rests,
            inside_out: &std::collections::BTreeSet::new(),
        };
        let append = MeshChange::Append("second".to_owned());
        let remade = remake(&present, &append, Some(&second), &Watch::default()).unwrap();
        let extension = remade.loaded.path.extension().unwrap().to_owned();
        assert_eq!(extension, if is_same { "obj" } else { "glb" });
        let warnings = remade.warnings.join(" ");
        assert_eq!(
            warnings.contains("leaves out the material library's statements Ks"),
            !is_same,
            "{warnings}"
        );
    }
}

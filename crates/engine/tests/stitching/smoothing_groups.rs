//! A changed OBJ keeps its smoothing groups.

use std::fs;
use std::path::Path;

use glam::DVec3;
use pliant_engine::stitching::{CutAlong, Holes, Keep, Plane, Replace};

use crate::made::{cut_along, filled, paths, textured_sphere};

/// The faces of an OBJ: the positions of their corners in order, their material and their smoothing group.
fn faces(path: &Path) -> Vec<(Vec<[i64; 3]>, String, String)> {
    let (mut points, mut faces) = (Vec::new(), Vec::new());
    let [mut material, mut group] = [String::new(), String::new()];
    for line in fs::read_to_string(path).unwrap().lines() {
        let (keyword, rest) = line.split_once(' ').unwrap_or((line, ""));
        match keyword {
            "v" => {
                let mut numbers = rest.split(' ').map(|number| number.parse::<f64>().unwrap());
                let point: [f64; 3] = std::array::from_fn(|_| numbers.next().unwrap());
                points.push(point.map(|number| (number * 1e6).round() as i64));
            }
            "usemtl" => rest.clone_into(&mut material),
            "s" => rest.clone_into(&mut group),
            "f" => {
                let number = |corner: &str| corner.split('/').next().unwrap().parse::<usize>().unwrap();
                let corners = rest.split(' ').map(|corner| points[number(corner) - 1]);
                faces.push((corners.collect(), material.clone(), group.clone()));
            }
            _ => {}
        }
    }
    faces
}

#[test]
fn faces_keep_their_smoothing_groups_and_new_ones_take_a_neighbours() {
    let (_folder, [file, closed, half]) = paths(["ball.obj", "closed.obj", "half.obj"]);
    textured_sphere(&file, 0.7);
    // Every face gets an `s` line: one material is flat, the other has two groups.
    let group_of = |corners: &[[i64; 3]], material: &str| match material {
        "other" => "off",
        _ if corners.iter().map(|corner| corner[1]).sum::<i64>() > 0 => "3",
        _ => "4",
    };
    let mut known = faces(&file);
    let mut groups = known.iter_mut().map(|(corners, material, group)| {
        group_of(corners, material).clone_into(group);
        group.clone()
    });
    let text = fs::read_to_string(&file).unwrap();
    let lines = text.lines().map(|line| match line.starts_with("f ") {
        true => format!("s {}\n{line}\n", groups.next().unwrap()),
        false => format!("{line}\n"),
    });
    let text: String = lines.collect();
    fs::write(&file, text).unwrap();
    assert!(faces(&file) == known);
    let plane = Plane::of(DVec3::new(0.3, 1.0, 0.2), 0.1).unwrap();
    let mut said = filled(&file, &closed, Holes::Every, Replace::Never).unwrap();
    said.extend(cut_along(&file, CutAlong::Plane(plane, Keep::Both), &half).unwrap());
    assert!(!said.iter().any(|warning| warning.contains("smoothing")), "{said:?}");
    for output in [&closed, &half] {
        let all = faces(output);
        let (mut kept, mut new) = (0, [0; 3]);
        for (corners, material, group) in &all {
            assert_eq!(material == "other", group == "off", "{material} {group}");
            let place = ["3", "4", "off"].iter().position(|known| known == group).unwrap();
            match known.iter().find(|(own, ..)| own == corners) {
                Some((_, _, before)) => {
                    assert_eq!(group, before);
                    kept += 1;
                }
                None => new[place] += 1,
            }
        }
        assert!(
            kept > all.len() / 2 && new.iter().all(|count| *count > 0),
            "{kept} {new:?}"
        );
    }
}

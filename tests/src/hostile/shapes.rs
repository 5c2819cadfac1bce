//! The shapes that models show, and whether two are the same.

use std::collections::BTreeMap;
use std::panic::catch_unwind;
use std::path::{Path, PathBuf};

use glam::DVec3;

use super::case::Case;

/// The corners of a model's triangles.
pub type Shape = Vec<[DVec3; 3]>;

/// Returns true if two shapes are the same to the bit, so that a NaN equals itself.
pub fn is_same(a: &Shape, b: &Shape) -> bool {
    let bits = |p: &DVec3| p.to_array().map(f64::to_bits);
    a.as_flattened().iter().map(bits).eq(b.as_flattened().iter().map(bits))
}

/// A model's shape, or `None` if it can't be read.
pub fn shape(path: &Path) -> Option<Shape> {
    let opened = catch_unwind(|| pliant_engine::open(path, &Default::default()).ok()).ok()??;
    let drawn = opened.drawn;
    let corners = |triangle: &[pliant_mesh::DrawnVertex; 3]| triangle.map(|vertex| drawn.positions[vertex.index()]);
    Some(drawn.triangles.iter().map(corners).collect())
}

/// The shape of every model in a folder that has one.
pub fn of_folder(case: &Case, root: &Path) -> BTreeMap<PathBuf, Shape> {
    let is_model = |place: &&PathBuf| pliant_io::Format::of_name(&place.to_string_lossy()).is_ok();
    let paths = case.entries.keys().filter(is_model).map(|place| root.join(place));
    paths.filter_map(|path| Some((path.clone(), shape(&path)?))).collect()
}

/// Returns true if a file may have faces with more than three corners. The lines of an OBJ or an OFF show it, except
/// continued ones; a PLY may always have them.
pub fn may_hold_polygons(path: &Path) -> bool {
    let kind = crate::extension(path).to_lowercase();
    let text = || String::from_utf8_lossy(&std::fs::read(path).unwrap_or_default()).into_owned();
    match &*kind {
        "obj" => text().split(['\n', '\r']).any(|line| {
            let mut words = line.split_whitespace();
            words.next() == Some("f") && words.count() > 3 || line.ends_with('\\')
        }),
        "off" => text().split(['\n', '\r']).any(|line| {
            let mut words = line.split_whitespace();
            let count = words.next().and_then(|word| word.parse::<usize>().ok());
            count.is_some_and(|count| count > 3 && words.count() >= count)
        }),
        kind => kind == "ply",
    }
}

/// Two coordinates of triangles' centres that should be equal but differ by more than the tolerance. Formats order
/// triangles differently, so the coordinates are sorted and compared axis by axis.
pub fn farthest(one: &Shape, two: &Shape, tolerance: f64) -> Option<(f64, f64)> {
    let sorted = |shape: &Shape, axis: usize| {
        let mut middles: Vec<f64> = shape.iter().map(|t| (t[0] + t[1] + t[2])[axis] / 3.0).collect();
        middles.sort_by(f64::total_cmp);
        middles
    };
    (0..3).find_map(|axis| {
        let mut pairs = sorted(one, axis).into_iter().zip(sorted(two, axis));
        pairs.find(|(a, b)| (a - b).abs() > tolerance)
    })
}

/// A coordinate of a corner in one shape that no corner of the other has, and the nearest one there.
pub fn stray_corner(one: &Shape, two: &Shape, tolerance: f64) -> Option<(f64, f64)> {
    let sorted = |shape: &Shape, axis: usize| {
        let mut corners: Vec<f64> = shape.as_flattened().iter().map(|p| p[axis]).collect();
        corners.sort_by(f64::total_cmp);
        corners
    };
    let stray = |corners: &[f64], others: &[f64]| {
        corners.iter().find_map(|&corner| {
            let place = others.partition_point(|other| *other < corner);
            let near = [place.checked_sub(1), Some(place)].into_iter().flatten();
            let near = near.filter_map(|place| others.get(place).copied());
            let nearest = near.min_by(|a, b| (a - corner).abs().total_cmp(&(b - corner).abs()))?;
            ((nearest - corner).abs() > tolerance).then_some((corner, nearest))
        })
    };
    (0..3).find_map(|axis| {
        let (one, two) = (sorted(one, axis), sorted(two, axis));
        stray(&one, &two).or_else(|| stray(&two, &one))
    })
}

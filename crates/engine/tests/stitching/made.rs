//! Files that the tests work on, and the three operations with their usual options.

use std::fs;
use std::path::{Path, PathBuf};

use pliant_engine::files::Staging;
use pliant_engine::stitching::{
    Cut, CutAlong, Fill, Holes, Merge, Remaking, Replace, ReportTo, Stitched, cut, fill, merge, read_joins,
    read_selector,
};
use pliant_engine::watch::Watch;
use pliant_engine::{EngineError, load};
use pliant_mesh::{Model, WeldOptions, shapes};

/// A sphere as an OBJ with texture coordinates, normals and two materials, without the faces whose middle is above
/// `height`.
pub fn textured_sphere(path: &Path, height: f64) {
    let sphere = shapes::uv_sphere(24, 36);
    let mut text = String::from("mtllib two.mtl\no ball\n");
    for p in &sphere.positions {
        text += &format!(
            "v {} {} {}\nvt {} {}\nvn {} {} {}\n",
            p.x,
            p.y,
            p.z,
            0.5 + 0.4 * p.x,
            0.5 + 0.4 * p.y,
            p.x,
            p.y,
            p.z
        );
    }
    for half in [false, true] {
        text += if half { "usemtl one\n" } else { "usemtl other\n" };
        for corners in &sphere.triangles {
            let middle = corners.iter().map(|v| sphere.positions[v.index()]).sum::<glam::DVec3>() / 3.0;
            if middle.z <= height && (middle.x > 0.0) == half {
                let [a, b, c] = corners.map(|v| v.0 + 1);
                text += &format!("f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}\n");
            }
        }
    }
    fs::write(path, text).unwrap();
    let library = "newmtl one\nKd 1 0 0\nnewmtl other\nKd 0 0 1\n";
    fs::write(path.with_file_name("two.mtl"), library).unwrap();
}

/// Fills a file, with a report beside OUT, and gives the warnings.
pub fn filled(file: &Path, output: &Path, holes: Holes, replace: Replace) -> Result<Vec<String>, EngineError> {
    filled_watched(file, output, holes, replace, &Watch::default())
}

/// The same under a watch that may stop it.
pub fn filled_watched(
    file: &Path,
    output: &Path,
    holes: Holes,
    replace: Replace,
    watch: &Watch,
) -> Result<Vec<String>, EngineError> {
    let report = output.with_extension("json");
    let job = Fill {
        remaking: Remaking {
            report: ReportTo::File(&report),
            replace,
            ..remaking(file, output)
        },
        holes,
    };
    committed(fill(&job, watch, &Staging::default()))
}

/// Cuts a file, and gives the warnings.
pub fn cut_out(file: &Path, delete: &Path, output: &Path) -> Result<Vec<String>, EngineError> {
    let selector = read_selector(delete, &Watch::default())?;
    cut_along(file, CutAlong::Selector(&selector, delete), output)
}

/// Cuts a file in any way, and gives the warnings.
pub fn cut_along(file: &Path, along: CutAlong<'_>, output: &Path) -> Result<Vec<String>, EngineError> {
    let job = Cut {
        remaking: remaking(file, output),
        along,
    };
    committed(cut(&job, &Watch::default(), &Staging::default()))
}

/// Joins two files, and gives the warnings.
pub fn merged([first, second]: [&Path; 2], joins: &Path, output: &Path) -> Result<Vec<String>, EngineError> {
    let job = Merge {
        remaking: remaking(first, output),
        second,
        joins: &read_joins(joins, &Watch::default())?,
        joins_path: joins,
    };
    committed(merge(&job, &Watch::default(), &Staging::default()))
}

fn remaking<'a>(file: &'a Path, output: &'a Path) -> Remaking<'a> {
    Remaking {
        file,
        output,
        report: ReportTo::Nobody,
        replace: Replace::Never,
        weld: WeldOptions::default(),
    }
}

fn committed(stitched: Result<Stitched, EngineError>) -> Result<Vec<String>, EngineError> {
    let stitched = stitched?;
    let warnings = stitched.warnings.clone();
    stitched.commit(None)?;
    Ok(warnings)
}

/// The model of a file.
pub fn model(path: &Path) -> std::sync::Arc<Model> {
    load(path, &WeldOptions::default(), &Watch::default()).unwrap().model
}

/// True if a surface is closed and turned consistently.
pub fn is_closed(model: &Model) -> bool {
    let topology = &model.topology;
    topology.is_closed() && topology.non_manifold_edges() + topology.misoriented_edges() == 0
}

/// A folder for the test alone, and paths in it.
pub fn paths<const N: usize>(names: [&str; N]) -> (tempfile::TempDir, [PathBuf; N]) {
    let folder = tempfile::tempdir().unwrap();
    let paths = names.map(|name| folder.path().join(name));
    (folder, paths)
}

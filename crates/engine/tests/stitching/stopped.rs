//! A change of the triangles that is stopped anywhere gives no shape, and leaves no file behind.

use std::collections::BTreeSet;
use std::path::Path;

use glam::DVec3;
use pliant_editor::{CutPlane, KeptSide, MergeChange, MergeSettings, MeshChange};
use pliant_engine::stitching::{Holes, Present, Replace, remake};
use pliant_engine::watch::Watch;
use pliant_engine::{EngineError, Loaded, load};
use pliant_mesh::{Cancel, SurfaceVertex, WeldOptions};

use crate::made::{filled_watched, paths, textured_sphere};

/// Stops `work` after ever more looks at the flag, until it ends by itself. Returns how often it was stopped.
fn stopped_everywhere<T>(work: impl Fn(&Watch) -> Result<T, EngineError>, left: impl Fn()) -> usize {
    let mut stops = 0;
    for looks in (0..200).map(|step| step + step * step / 2) {
        match work(&Watch::cancelled_by(&Cancel::after_looks(looks))) {
            Ok(_) => return stops,
            Err(EngineError::Interrupted) => stops += 1,
            Err(other) => panic!("after {looks} looks: {other}"),
        }
        left();
    }
    panic!("it never ends");
}

fn opened(path: &Path) -> Loaded {
    load(path, &WeldOptions::default(), &Watch::default()).unwrap()
}

#[test]
fn every_change_in_the_window_stops_without_a_shape() {
    let (_folder, [first, second]) = paths(["first.obj", "second.obj"]);
    textured_sphere(&first, 0.7);
    textured_sphere(&second, 0.6);
    let loaded = opened(&first);
    let count = loaded.model.surface.positions.len();
    let rests = vec![DVec3::ZERO; count];
    let none = BTreeSet::new();
    let present = Present {
        loaded: &loaded,
        displacements: &rests,
        inside_out: &none,
    };
    let other = opened(&second);
    let append = MeshChange::Append("second".to_owned());
    let both = remake(&present, &append, Some(&other), &Watch::default())
        .unwrap()
        .loaded;
    let both_rest = vec![DVec3::ZERO; both.model.surface.positions.len()];
    let appended = Present {
        loaded: &both,
        displacements: &both_rest,
        inside_out: &none,
    };
    let part = (0..both_rest.len() as u32).map(SurfaceVertex);
    let part = part
        .filter(|vertex| both.model.topology.component(*vertex) == 1)
        .collect();
    let plane = CutPlane {
        normal: DVec3::X,
        distance: 0.1,
    };
    let merge = MergeChange {
        part,
        pairs: Vec::new(),
        settings: MergeSettings::default(),
    };
    let changes = [
        (&present, MeshChange::FillAll),
        (&present, MeshChange::Delete(vec![SurfaceVertex(count as u32 / 2)])),
        (&present, MeshChange::Cut(plane, KeptSide::Positive, Vec::new())),
        (&present, append),
        (&appended, MeshChange::Merge(merge)),
    ];
    for (present, change) in changes {
        let work = |watch: &Watch| remake(present, &change, Some(&other), watch);
        let stops = stopped_everywhere(work, || {});
        assert!(stops > 2, "{}: {stops}", change.name());
    }
}

#[test]
fn a_stopped_command_leaves_the_folder_as_it_was() {
    let (folder, [file, output]) = paths(["ball.obj", "closed.obj"]);
    textured_sphere(&file, 0.7);
    let names = || {
        let entries = folder
            .path()
            .read_dir()
            .unwrap()
            .map(|entry| entry.unwrap().file_name());
        entries.collect::<BTreeSet<_>>()
    };
    let before = names();
    let work = |watch: &Watch| filled_watched(&file, &output, Holes::Every, Replace::Never, watch);
    let stops = stopped_everywhere(work, || assert_eq!(names(), before));
    assert!(stops > 2, "{stops}");
    assert!(names().len() > before.len());
}

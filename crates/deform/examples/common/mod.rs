//! The common code of the examples: meshes and edits from files, the edit that peers are timed on, and a stop-watch.
#![allow(dead_code, reason = "no example needs all of it")]

use std::path::Path;
use std::time::Instant;

use glam::{DAffine3, DMat3, DVec3};
use pliant_deform::{Loose, Method, OptionValue, Problem, Role};
use pliant_mesh::{Cancel, Drawn, DrawnVertex, Model, Progress, SurfaceVertex, Vectors, WeldOptions};
use rayon::{ThreadPool, ThreadPoolBuilder};

/// A pool of this many threads. The environment variable `PLIANT_VECTORS` names the vectors that loops use from now on
/// (`avx512`, `avx2`, `baseline`); without it they are the widest that the processor has.
pub fn pool(threads: usize) -> ThreadPool {
    if let Ok(name) = std::env::var("PLIANT_VECTORS") {
        let vectors = Vectors::from_name(&name).unwrap_or_else(|| panic!("there are no vectors {name}"));
        assert!(vectors.choose(), "this processor has no {name}");
    }
    ThreadPoolBuilder::new().num_threads(threads).build().unwrap()
}

/// The mesh of an OFF file of triangles.
pub fn read(off: &Path) -> Model {
    let text = std::fs::read_to_string(off).unwrap_or_else(|error| panic!("{}: {error}", off.display()));
    let mut numbers = text.split_ascii_whitespace().skip(1);
    let mut next = || numbers.next().unwrap();
    let (vertices, triangles): (usize, usize) = (next().parse().unwrap(), next().parse().unwrap());
    next();
    let positions = (0..vertices)
        .map(|_| [(); 3].map(|()| next().parse().unwrap()).into())
        .collect();
    let triangles = (0..triangles)
        .map(|_| {
            next();
            [(); 3].map(|()| DrawnVertex(next().parse().unwrap()))
        })
        .collect();
    let drawn = Drawn::once(positions, triangles);
    Model::weld(drawn, &WeldOptions::default(), &Progress::new(), &Cancel::new()).unwrap()
}

/// A problem with one handle, and defaults for missing inputs.
pub fn one_handle<'a>(model: &'a Model, roles: &'a [Role], stiffness: &'a [f64], method: &'a Method) -> Problem<'a> {
    Problem {
        loose: Loose::Rest,
        ..Problem::new((&model.surface, &model.topology), roles, stiffness, method)
    }
}

/// The method that a word names: `METHOD[:OPTION=VALUE,..]`.
pub fn chosen_method(word: &str) -> Method {
    let (name, options) = word.split_once(':').unwrap_or((word, ""));
    let mut method = Method::from_name(name).unwrap();
    for option in options.split(',').filter(|option| !option.is_empty()) {
        let (option, text) = option.split_once('=').unwrap();
        method = method.with([(option, value(&method, option, text))]).unwrap();
    }
    method
}

/// The value that a text gives for one of the method's options.
fn value(method: &Method, option: &str, text: &str) -> OptionValue {
    let own = method.value(option).unwrap();
    match own {
        OptionValue::Number(_) => OptionValue::Number(text.parse().unwrap()),
        OptionValue::Whole(_) => OptionValue::Whole(text.parse().unwrap()),
        OptionValue::Switch(_) => OptionValue::Switch(text.parse().unwrap()),
        OptionValue::Name(_) => OptionValue::Name(text.to_owned().leak()),
    }
}

/// The name of a mesh's file.
pub fn name(file: &Path) -> String {
    file.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// The edit beside a mesh as MESH.sel (a number per vertex: 0 fixed, 1 free, 2 handle) and MESH.def (the handle's
/// matrix, row by row); without them the one that peers are timed on.
pub fn edit(mesh: &Path, model: &Model) -> (Vec<Role>, DAffine3) {
    let numbers = |extension: &str| -> Option<Vec<f64>> {
        let text = std::fs::read_to_string(mesh.with_extension(extension)).ok()?;
        let lines = text.lines().filter(|line| !line.starts_with('#'));
        let words = lines.flat_map(str::split_ascii_whitespace);
        Some(words.map(|word| word.parse().unwrap()).collect())
    };
    let (Some(selected), Some(m)) = (numbers("sel"), numbers("def")) else {
        return peers_edit(model);
    };
    let mut roles = vec![Role::Free; model.surface.positions.len()];
    for (status, vertex) in selected.iter().zip(model.drawn.surface_vertices()) {
        if let Some(vertex) = vertex {
            roles[vertex.index()] = match *status as i32 {
                0 => Role::Fixed,
                1 => Role::Free,
                _ => Role::Handle(0),
            };
        }
    }
    let rows = DMat3::from_cols_array(&[m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]]);
    let shift = DVec3::new(m[3], m[7], m[11]);
    (roles, DAffine3::from_mat3_translation(rows.transpose(), shift))
}

/// The lowest 5% along the longest axis are fixed; the highest 5% are turned by 60° and moved by a fifth of the
/// diagonal.
pub fn peers_edit(model: &Model) -> (Vec<Role>, DAffine3) {
    let bounds = model.bounds().unwrap();
    let extent = bounds.extent();
    let axis = (0..3).max_by(|&a, &b| extent[a].total_cmp(&extent[b])).unwrap();
    let positions = &model.surface.positions;
    let role = |p: &DVec3| match (p[axis] - bounds.min[axis]) / extent[axis] {
        t if t < 0.05 => Role::Fixed,
        t if t > 0.95 => Role::Handle(0),
        _ => Role::Free,
    };
    let roles: Vec<Role> = positions.iter().map(role).collect();
    let members = || {
        let all = roles.iter().zip(positions);
        all.filter(|(role, _)| matches!(role, Role::Handle(_))).map(|(_, p)| *p)
    };
    let (centre, about) = (
        members().sum::<DVec3>() / members().count() as f64,
        DVec3::AXES[(axis + 1) % 3],
    );
    let target = DAffine3::from_translation(centre + about * (0.2 * extent.length()))
        * DAffine3::from_axis_angle(about, 60.0_f64.to_radians())
        * DAffine3::from_translation(-centre);
    (roles, target)
}

/// The result of a function, and its time in milliseconds: the processor's if the environment has `PLIANT_CPU`.
pub fn timed<T>(run: impl FnOnce() -> T) -> (f64, T) {
    if std::env::var_os("PLIANT_CPU").is_some() {
        let start = processor_ms();
        let result = run();
        return (processor_ms() - start, result);
    }
    let start = Instant::now();
    let result = run();
    (ms(start), result)
}

/// Milliseconds that processors have spent on this process' threads.
pub fn processor_ms() -> f64 {
    let threads = std::fs::read_dir("/proc/self/task").unwrap();
    let spent = |thread: std::io::Result<std::fs::DirEntry>| -> f64 {
        let text = std::fs::read_to_string(thread.unwrap().path().join("schedstat")).unwrap();
        text.split_whitespace().next().unwrap().parse().unwrap()
    };
    threads.map(spent).sum::<f64>() * 1e-6
}

/// Milliseconds since `start`.
pub fn ms(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1e3
}

/// The median of `values`; NaN if there are none.
pub fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// The most memory that this process has held; 0 if the system doesn't report it.
pub fn peak_mb() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let kilobytes = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:")?.split_whitespace().next()?.parse().ok());
    kilobytes.map_or(0.0, |kb: f64| kb / 1024.0)
}

/// Resets [`peak_mb`] to the memory that the process holds now, if the system can do that.
pub fn forget_peak() {
    let _ = std::fs::write("/proc/self/clear_refs", "5");
}

/// The roles after a stroke on the handle's rim that adds a thousandth of the vertices to it.
pub fn stroke(model: &Model, roles: &[Role]) -> Vec<Role> {
    let mut stroked = roles.to_vec();
    let at_rim = |v: &u32| {
        let mut ring = model.topology.neighbours(SurfaceVertex(*v)).iter();
        roles[*v as usize] == Role::Free && ring.any(|n| roles[n.index()] == Role::Handle(0))
    };
    let mut queue: Vec<u32> = (0..roles.len() as u32).find(at_rim).into_iter().collect();
    let mut next = 0;
    while next < queue.len() && next < roles.len().div_ceil(1000) {
        let vertex = queue[next];
        next += 1;
        stroked[vertex as usize] = Role::Handle(0);
        for neighbour in model.topology.neighbours(SurfaceVertex(vertex)) {
            if stroked[neighbour.index()] == Role::Free && !queue.contains(&neighbour.0) {
                queue.push(neighbour.0);
            }
        }
    }
    stroked
}

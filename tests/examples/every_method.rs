//! Every method on every scene: the survey's four, with its edits, and limbs of scans that the pose tool finds, bent and
//! twisted as an artist would. `every_method [SCENE ..]`: all scenes, or those whose names contain one of the words.
//!
//! A line of JSON for each: the steps, the triangles that turned over, the least and the largest ratio of an edge, the
//! ratio of volumes, the handles' residual as a share of the diagonal, the places where the shape newly passes through
//! itself, and the number of sentences that say what came out badly.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a program that reports")]

use pliant_deform::METHODS;
use pliant_editor::Beginning;
use pliant_engine::watch::Watch;
use pliant_engine::{EngineError, Loaded, Solved};
use pliant_tests::{datum, diagonal, open};
use serde_json::{Value, json};

/// The methods with their defaults, and other options that a person would take for such edits.
const OTHERS: [(&str, &str); 5] = [
    ("arap, smooth", r#"{"name": "arap", "energy": "smooth"}"#),
    (
        "bilaplacian, normals",
        r#"{"name": "bilaplacian", "detail": "normal-displacements"}"#,
    ),
    (
        "bilaplacian, volumes",
        r#"{"name": "bilaplacian", "detail": "displacement-volumes"}"#,
    ),
    (
        "bilaplacian, transfer",
        r#"{"name": "bilaplacian", "detail": "deformation-transfer"}"#,
    ),
    ("cage, green", r#"{"name": "cage", "coordinates": "green"}"#),
];

/// A limb of a scan and its turn.
struct Limb {
    name: &'static str,
    scan: &'static str,
    at: [f64; 3],
    up: i32,
    axis: [f64; 3],
    degrees: f64,
}

#[rustfmt::skip]
const LIMBS: [Limb; 9] = [
    Limb { name: "armadillo, arm bent by 90°", scan: "armadillo.obj", at: [0.403, 0.199, 0.158], up: 1, axis: [0.0, 1.0, 0.0], degrees: 90.0 },
    Limb { name: "armadillo, arm twisted by 150°", scan: "armadillo.obj", at: [0.403, 0.199, 0.158], up: 1, axis: [1.0, 0.0, 0.0], degrees: 150.0 },
    Limb { name: "armadillo, arm twisted by 180°", scan: "armadillo.obj", at: [0.403, 0.199, 0.158], up: 1, axis: [1.0, 0.0, 0.0], degrees: 180.0 },
    Limb { name: "horse, neck twisted by 120°", scan: "horse.ply", at: HORSE, up: 0, axis: [0.0, 0.0, 1.0], degrees: 120.0 },
    Limb { name: "horse, neck twisted by 180°", scan: "horse.ply", at: HORSE, up: 0, axis: [0.0, 0.0, 1.0], degrees: 180.0 },
    Limb { name: "bunny, ear bent by 70°", scan: "stanford-bunny.obj", at: [-0.018, 0.187, -0.02], up: 0, axis: [0.0, 0.0, 1.0], degrees: 70.0 },
    Limb { name: "beast, head bent by 60°", scan: "beast.obj", at: [0.0, 251.326, 43.562], up: 0, axis: [1.0, 0.0, 0.0], degrees: 60.0 },
    Limb { name: "Homer, head bent by 60°", scan: "homer.obj", at: [0.502, 0.997, 0.452], up: 0, axis: [1.0, 0.0, 0.0], degrees: 60.0 },
    Limb { name: "human, elbow bent by 90°", scan: "human_neutral.obj", at: [0.819, 1.287, -0.072], up: 1, axis: [0.0, 1.0, 0.0], degrees: -90.0 },
];

const HORSE: [f64; 3] = [-0.009, 0.084, 0.076];

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let is_asked = |name: &str| words.is_empty() || words.iter().any(|word| name.contains(word));
    for scene in ["plane", "cylinder", "bar", "cactus"] {
        let edit = datum(&format!("survey/{scene}.edit.json"));
        if let (Some(file), Some(edit), true) = (datum(&format!("survey/{scene}.off")), edit, is_asked(scene)) {
            let edit: Value = serde_json::from_str(&std::fs::read_to_string(edit).unwrap()).unwrap();
            measure(scene, &open(&file), &edit);
        }
    }
    for limb in LIMBS.iter().filter(|limb| is_asked(limb.name)) {
        if let Some(file) = datum(&format!("scans/{}", limb.scan)) {
            measure(limb.name, &open(&file), &limb.edit());
        }
    }
}

impl Limb {
    fn edit(&self) -> Value {
        let (sin, cos) = (0.5 * self.degrees.to_radians()).sin_cos();
        let [x, y, z] = self.axis.map(|axis| axis * sin);
        json!({
            "version": 1,
            "method": { "name": "bilaplacian" },
            "handles": [{
                "name": "limb",
                "pose": { "at": self.at, "up": self.up },
                "transform": { "rotation": [x, y, z, cos] }
            }]
        })
    }
}

/// A line for each method.
fn measure(scene: &str, loaded: &Loaded, edit: &Value) {
    let own = METHODS
        .iter()
        .map(|declaration| (declaration.name.to_owned(), json!({ "name": declaration.name })));
    let others = OTHERS
        .iter()
        .map(|(name, method)| ((*name).to_owned(), serde_json::from_str(method).unwrap()));
    for (name, method) in own.chain(others) {
        let mut edit = edit.clone();
        edit["method"] = method;
        match outcome(loaded, &edit) {
            Ok(figures) => println!("{{\"scene\": \"{scene}\", \"method\": \"{name}\", {figures}}}"),
            Err(refused) => println!("{{\"scene\": \"{scene}\", \"method\": \"{name}\", \"refused\": \"{refused}\"}}"),
        }
    }
}

fn outcome(loaded: &Loaded, edit: &Value) -> Result<String, EngineError> {
    let beginning = Beginning::parse(&edit.to_string()).unwrap();
    let setup = beginning.resolve(&loaded.model).unwrap();
    let watch = Watch::default();
    let Solved {
        surface_positions,
        report,
        ..
    } = pliant_engine::solved("scene".as_ref(), &beginning, None, loaded, &setup, &watch)?;
    let (surface, topology) = (&loaded.model.surface, &loaded.model.topology);
    let rest = &surface.positions;
    let ratios = topology.edges().filter_map(|[a, b]| {
        let length = rest[a.index()].distance(rest[b.index()]);
        (length > 0.0).then(|| surface_positions[a.index()].distance(surface_positions[b.index()]) / length)
    });
    let (least, most) = ratios.fold((f64::INFINITY, 0.0), |(least, most): (f64, f64), r| {
        (least.min(r), most.max(r))
    });
    let said = report.warnings.len();
    Ok(format!(
        "\"steps\": {}, \"settled\": \"{}\", \"flips\": {}, \"least\": {least:.4}, \"largest\": {most:.2}, \"volume\": {:.3}, \
         \"residual\": {:.5}, \"said\": {said}",
        report.iterations,
        if report.converged { "yes" } else { "no" },
        report.distortion.flipped_faces,
        report.distortion.volume_ratio,
        report.handle_residual / diagonal(rest),
    ))
}

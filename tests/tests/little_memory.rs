//! Binding with a factor that exceeds the allowed memory: only by the command line.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;

use glam::DVec3;
use pliant_mesh::shapes;
use pliant_tests::{Folder, bend, diagonal, largest_distance, open};
use serde_json::{Value, json};

/// The largest distance between the shapes by both factors, in diagonals.
const SAME: f64 = 1e-6;

/// The result of the edit.
#[derive(Clone, PartialEq, Debug)]
enum Outcome {
    /// The file's positions, and whether the report says that the Laplacian's factor solved for them.
    Bent(Vec<DVec3>, bool),
    Refused,
}

/// A ball of 10,242 vertices whose upper end is moved and turned, with these arguments.
fn outcome(arguments: &[&str]) -> Outcome {
    let folder = Folder::new();
    let file = folder.write_mesh("ball.off", &shapes::icosphere(5));
    let (out, report) = (folder.at("out.off"), folder.at("report.json"));
    let edit = bend(&json!({ "translation": [0.2, 0.3, 0.1], "rotation": [0.0, 0.0, 0.6, 0.8] }));
    let report_to = ["--report", report.to_str().unwrap()];
    let ended = folder.apply(&file, &edit, &out, &[&report_to, arguments].concat());
    if ended.status != 0 {
        ended.refused(
            1,
            &["ball.off", "free vertices", "of memory", "make the region smaller"],
        );
        assert_eq!(folder.names(), ["ball.off"], "nothing is written");
        return Outcome::Refused;
    }
    ended.done();
    let told: Value = serde_json::from_str(&fs::read_to_string(&report).unwrap()).unwrap();
    let warnings = told["warnings"].as_array().unwrap();
    let says_so = |warning: &Value| warning.as_str().unwrap().contains("with the Laplacian's factor");
    Outcome::Bent(open(&out).model.rest_positions(), warnings.iter().any(says_so))
}

#[test]
fn with_less_memory_the_shape_is_the_same_and_with_too_little_it_is_refused() {
    let Outcome::Bent(expected, false) = outcome(&[]) else {
        panic!("there is memory enough on any machine")
    };
    let size = diagonal(&expected);
    // From the memory that the own factor needs down to less than a byte for each vertex.
    let steps = [64.0, 16.0, 12.0, 10.0, 9.0, 8.0, 7.0, 6.0, 5.0, 4.0, 2.0, 0.01];
    let (mut by_laplacian, mut refused) = (0, 0);
    for megabytes in steps {
        match outcome(&["--memory", &format!("{megabytes}MB")]) {
            Outcome::Bent(shape, says_so) => {
                assert_eq!(refused, 0, "{megabytes}: less was enough");
                assert!(
                    says_so || by_laplacian == 0,
                    "{megabytes}: less is taken by the Laplacian's"
                );
                by_laplacian += usize::from(says_so);
                let error = largest_distance(&shape, &expected) / size;
                assert!(error < SAME, "{megabytes}: {error:e}");
                assert!(says_so || error == 0.0, "{megabytes}: the same way, to the bit");
            }
            Outcome::Refused => refused += 1,
        }
    }
    assert!(by_laplacian > 0 && refused > 0, "{by_laplacian} {refused}");
}

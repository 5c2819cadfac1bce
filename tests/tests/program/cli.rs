//! The command line: exit statuses, one-line refusals that name the culprit, and an OUT that refusals leave untouched.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;

use glam::{DAffine3, DVec3};
use pliant_mesh::shapes;
use pliant_tests::{Folder, bare_edit, bend, run};
use serde_json::{Value, json};

#[test]
fn the_version_names_the_commit() {
    let said = run(["--version"]).done().out;
    assert_eq!(said.trim(), format!("pliant {}", pliant_app::VERSION));
    assert!(said.contains('(') && said.trim().ends_with(')'), "{said}");
}

#[test]
fn help_is_no_error_and_apply_lists_the_methods() {
    assert!(run(["--help"]).done().out.contains("apply"));
    assert!(run(["apply", "--help"]).done().out.contains("bilaplacian"));
}

#[test]
fn wrong_arguments_have_status_2() {
    run(["apply", "a.ply"]).refused(2, &["--edit", "--output"]);
    run(["info"]).refused(2, &["FILE"]);
    run(["info", "a.ply", "--jsn"]).refused(2, &["--jsn", "--json"]);
    let apply = ["apply", "a.ply", "--edit", "e.json", "--output"];
    run(apply.into_iter().chain(["o.ply", "--frames", "0"])).refused(2, &["--frames"]);
    run(apply.into_iter().chain(["o.ply", "--threads", "-1"])).refused(2, &["-1"]);
    run(apply.into_iter().chain(["o.ply", "--method", "magic"])).refused(2, &["magic", "bilaplacian"]);
    run(apply.into_iter().chain(["o.doc"])).refused(2, &["o.doc", ".glb"]);
    run(apply.into_iter().chain(["o.ply", "--report", "o.ply"])).refused(2, &["--report", "--output"]);
    let compare = ["compare", "a.ply", "--edit", "e.json", "--output", "o.png", "--methods"];
    run(compare.into_iter().chain(["arap,magic"])).refused(2, &["--methods", "magic", "bilaplacian"]);
    run(compare.into_iter().chain(["arap,primo,arap"])).refused(2, &["arap", "twice"]);
    run(compare.into_iter().chain(["arap:energy=smoth"])).refused(2, &["--methods", "`energy`", "smooth"]);
    run(compare.into_iter().chain(["arap", "--report", "o.png"])).refused(2, &["--report", "--output"]);
    run([
        "compare",
        "a.ply",
        "--edit",
        "e.json",
        "--output",
        "o.jpg",
        "--methods",
        "arap",
    ])
    .refused(2, &["o.jpg", ".png"]);
}

/// If every method refuses the edit there is no sheet, and the refusal gives the reason.
#[test]
fn a_comparison_of_methods_that_all_refuse_is_refused() {
    let folder = Folder::new();
    let file = folder.write_mesh("mesh.off", &shapes::icosphere(2));
    let mut wrong = bend(&json!({}));
    wrong["handles"][0]["select"] = json!({ "vertices": [999_999] });
    let edit = folder.write("edit.json", wrong.to_string());
    let out = folder.at("sheet.png");
    let line = [
        "compare".as_ref(),
        file.as_os_str(),
        "--edit".as_ref(),
        edit.as_os_str(),
        "--methods=arap,primo".as_ref(),
        "--output".as_ref(),
        out.as_os_str(),
    ];
    run(line).refused(1, &["999999"]);
    assert!(!out.exists());
}

#[test]
fn info_speaks_to_people_and_to_programs() {
    let folder = Folder::new();
    let aside = DAffine3::from_translation(DVec3::new(0.0, 0.0, 9.0));
    let both = shapes::together(&[shapes::icosphere(2), shapes::moved(&shapes::grid(3, 3), aside)]);
    let file = folder.write_mesh("two.off", &both);
    let text = run(["info".as_ref(), file.as_os_str()]).done().out;
    assert!(text.contains("two.off") && text.contains("components"), "{text}");
    let json = run(["info".as_ref(), file.as_os_str(), "--json".as_ref()]).done().out;
    let json: Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["format"], "off");
    assert_eq!(json["components"][0]["vertices"], 162);
    assert_eq!(json["findings"]["boundary_loops"]["count"], 1);
}

/// Each of these edits is refused with status 1 and one line that contains the words; OUT keeps its bytes.
#[test]
fn what_the_edit_format_does_not_have_is_refused_by_name() {
    let folder = Folder::new();
    let file = folder.write_mesh("mesh.off", &shapes::icosphere(2));
    let out = folder.write("out.off", "as it was");
    let with = |member: &str, value: Value| {
        let mut edit = bend(&json!({}));
        edit[member] = value;
        edit
    };
    let handle = |member: &str, value: Value| {
        let mut edit = bend(&json!({}));
        edit["handles"][0][member] = value;
        edit
    };
    let cases: Vec<(Value, &[&str])> = vec![
        (json!([]), &["the edit", "list"]),
        (json!({ "method": { "name": "bilaplacian" } }), &["version"]),
        (json!({ "version": 1 }), &["method"]),
        (
            json!({ "version": 2, "method": { "name": "bilaplacian" } }),
            &["version", "2", "1"],
        ),
        (
            json!({ "version": 1, "method": { "name": "laplace" } }),
            &["method.name", "laplace", "bilaplacian"],
        ),
        (
            json!({ "version": 1, "method": { "name": "bilaplacian", "order": 4 } }),
            &["order", "method"],
        ),
        (
            json!({ "version": 1, "method": { "name": "bilaplacian", "ordre": 2 } }),
            &["ordre", "method"],
        ),
        (json!({ "version": 1, "method": "bilaplacian" }), &["method", "object"]),
        (with("hadles", json!([])), &["hadles", "handles"]),
        (with("loose", json!("folow")), &["loose", "folow", "follow"]),
        (with("region", json!("al")), &["region", "al", "all"]),
        (with("region", json!({})), &["region"]),
        (with("fixed", json!({ "all": true })), &["fixed", "all"]),
        (with("fixed", json!({ "vertices": [0, 162] })), &["fixed", "162", "161"]),
        (
            with("fixed", json!({ "vertices": [1.5] })),
            &["fixed.vertices[0]", "1.5"],
        ),
        (with("fixed", json!({ "vertices": [-1] })), &["fixed.vertices[0]", "-1"]),
        (
            with("fixed", json!({ "ranges": [[0, 3], [5, 4]] })),
            &["fixed.ranges[1]"],
        ),
        (
            with("fixed", json!({ "ranges": [[100, 4000000000_u32]] })),
            &["fixed", "4000000000"],
        ),
        (with("fixed", json!({ "component": 1 })), &["fixed", "component 1"]),
        (
            with("fixed", json!({ "slab": { "axis": "w", "from": 0, "to": 1 } })),
            &["fixed.slab.axis", "longest"],
        ),
        (
            with("fixed", json!({ "slab": { "axis": "x", "from": 1, "to": 0 } })),
            &["fixed.slab.from"],
        ),
        (
            with("fixed", json!({ "slab": { "axis": "x", "from": 0 } })),
            &["fixed.slab", "to"],
        ),
        (
            with("fixed", json!({ "sphere": { "center": [0, 0], "radius": 1 } })),
            &["fixed.sphere.center", "3 numbers"],
        ),
        (
            with("fixed", json!({ "sphere": { "center": [0, 0, 0], "radius": -1 } })),
            &["fixed.sphere.radius", "-1"],
        ),
        (
            with("fixed", json!({ "box": { "min": [0, 2, 0], "max": [1, 1, 1] } })),
            &["fixed.box.min"],
        ),
        (
            with("fixed", json!({ "union": [{ "not": { "vertexes": [] } }] })),
            &["fixed.union[0].not", "vertexes", "vertices"],
        ),
        (
            with("stiffness", json!([{ "select": "all", "value": 2000 }])),
            &["stiffness[0].value", "2000", "1000"],
        ),
        (
            with("stiffness", json!([{ "select": "all", "value": 0 }])),
            &["stiffness[0].value", "0.001"],
        ),
        (
            with("stiffness", json!([{ "per_vertex": [1, 1] }])),
            &["stiffness[0].per_vertex", "2", "162"],
        ),
        (
            with("stiffness", json!([{ "per_vertex": [1, "x"] }])),
            &["stiffness[0].per_vertex[1]"],
        ),
        (
            with("stiffness", json!([{ "select": "all" }])),
            &["stiffness[0]", "value"],
        ),
        (
            handle("transform", json!({ "foo": 1 })),
            &["foo", "handles[0].transform"],
        ),
        (
            handle("transform", json!({ "scales": [1, 1, 1] })),
            &["scales", "did you mean `scale`?"],
        ),
        (
            handle("transform", json!({ "scale": 2 })),
            &["handles[0].transform.scale", "3 numbers"],
        ),
        (
            handle("transform", json!({ "rotation": [0, 0, 0, 0] })),
            &["handles[0].transform.rotation"],
        ),
        (
            handle("transform", json!({ "translation": [0, 0, null] })),
            &["handles[0].transform.translation[2]", "null"],
        ),
        (
            handle("transform", json!({ "matrix": [1, 0, 0, 0], })),
            &["handles[0].transform.matrix", "16 numbers"],
        ),
        (
            handle(
                "transform",
                json!({ "matrix": [1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] }),
            ),
            &["handles[0].transform.matrix", "last row"],
        ),
        (
            handle(
                "transform",
                json!({ "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1], "pivot": [0, 0, 0] }),
            ),
            &["matrix", "pivot"],
        ),
        (
            handle("select", json!("none")),
            &["head", "handles[0]", "selects no vertex"],
        ),
        (handle("select", json!(7)), &["handles[0].select", "selector"]),
        (handle("nam", json!("x")), &["nam", "handles[0]", "name"]),
        (handle("soft", json!(0)), &["handles[0].soft", "a weight from"]),
        (handle("soft", json!(true)), &["handles[0].soft", "a number"]),
        (
            handle("continuity", json!(3)),
            &["handles[0].continuity", "from 0 to 2"],
        ),
        (with("continuity", json!(-1)), &["continuity", "from 0 to 2"]),
        (
            with("continuity", json!([{ "select": "all", "value": 2.5 }])),
            &["continuity[0].value", "from 0 to 2"],
        ),
        (
            with("continuity", json!([{ "per_vertex": [1, 1] }])),
            &["continuity[0].per_vertex", "2", "162"],
        ),
    ];
    for (edit, words) in cases {
        folder
            .apply(&file, &edit, &out, &[])
            .refused(1, words)
            .refused(1, &["edit.json"]);
        assert_eq!(fs::read_to_string(&out).unwrap(), "as it was");
    }
    assert_eq!(folder.names(), ["mesh.off", "out.off"]);
}

#[test]
fn handles_that_share_a_vertex_are_both_named() {
    let folder = Folder::new();
    let file = folder.write_mesh("mesh.off", &shapes::icosphere(1));
    let mut edit = bare_edit();
    edit["handles"] = json!([
        { "name": "left", "select": { "ranges": [[0, 9]] } },
        { "name": "right", "select": { "ranges": [[9, 12]] } },
    ]);
    folder
        .apply(&file, &edit, &folder.at("out.off"), &[])
        .refused(1, &["left", "right", "vertex 9"]);
}

#[test]
fn an_edit_that_is_no_json_or_a_project_is_named() {
    let folder = Folder::new();
    let file = folder.write_mesh("mesh.off", &shapes::icosphere(1));
    let out = folder.at("out.off");
    let apply = |edit: &std::path::Path| {
        run([
            "apply".as_ref(),
            file.as_os_str(),
            "--edit".as_ref(),
            edit.as_os_str(),
            "--output".as_ref(),
            out.as_os_str(),
        ])
    };
    apply(&folder.write("edit.json", "{\"version\": 1,,}")).refused(1, &["edit.json", "JSON", "line 1"]);
    apply(&folder.write("edit.json", b"\xff\xfe{}")).refused(1, &["edit.json", "UTF-8"]);
    apply(&folder.at("missing.json")).refused(1, &["missing.json"]);
    apply(&folder.write("pose.pliant", "{}")).refused(1, &["pose.pliant", "project"]);
    assert!(!out.exists());
}

#[test]
fn what_can_not_be_written_is_named_and_leaves_nothing() {
    let folder = Folder::new();
    let file = folder.write_mesh("mesh.off", &shapes::icosphere(1));
    let edit = bend(&json!({ "translation": [0, 0, 1] }));
    folder
        .apply(&file, &edit, &folder.at("missing/out.off"), &[])
        .refused(1, &["missing", "no such"]);
    fs::create_dir(folder.at("folder.off")).unwrap();
    folder
        .apply(&file, &edit, &folder.at("folder.off"), &[])
        .refused(1, &["folder.off", "is a folder"]);
    // If the report can't be written, neither is OUT.
    let report = folder.at("missing/report.json");
    let out = folder.at("out.off");
    folder
        .apply(&file, &edit, &out, &["--report", report.to_str().unwrap()])
        .refused(1, &["report.json"]);
    // A file that was made read-only on purpose is not replaced.
    let kept = folder.write("kept.off", "as it was");
    let mut rights = fs::metadata(&kept).unwrap().permissions();
    rights.set_readonly(true);
    fs::set_permissions(&kept, rights).unwrap();
    folder
        .apply(&file, &edit, &kept, &[])
        .refused(1, &["kept.off", "permission"]);
    assert_eq!(fs::read_to_string(&kept).unwrap(), "as it was");
    assert_eq!(folder.names(), ["folder.off", "kept.off", "mesh.off"]);
}

#[test]
fn a_stopped_command_says_so_and_writes_nothing() {
    let folder = Folder::new();
    let file = folder.write_mesh("mesh.off", &shapes::icosphere(1));
    let (edit, out) = (
        folder.write("edit.json", bend(&json!({ "translation": [0, 0, 1] })).to_string()),
        folder.at("out.off"),
    );
    let (mut said, mut err) = (Vec::new(), Vec::new());
    let mut console = pliant_app::cli::Console {
        out: &mut said,
        err: &mut err,
        watch: Default::default(),
        staging: Default::default(),
    };
    console.watch.cancel.cancel();
    let arguments = [
        "pliant".as_ref(),
        "apply".as_ref(),
        file.as_os_str(),
        "--edit".as_ref(),
        edit.as_os_str(),
        "--output".as_ref(),
        out.as_os_str(),
    ];
    let status = pliant_app::cli::run(arguments.map(Into::into).into(), &mut console);
    assert_eq!(status, 1);
    assert!(String::from_utf8(err).unwrap().contains("stopped"));
    assert!(!out.exists());
}

#[test]
fn foreign_text_neither_steers_the_terminal_nor_fills_it() {
    let folder = Folder::new();
    let evil = format!("\u{1b}]0;x\u{7}\u{202e}{}.off", "y".repeat(150));
    let long = "z".repeat(1_000_000) + ".off";
    for name in [evil, long] {
        let ended = folder
            .apply(&folder.at(&name), &bare_edit(), &folder.at("out.off"), &[])
            .refused(1, &["can't be read"]);
        assert!(
            !ended
                .err
                .trim_end()
                .chars()
                .any(|letter| letter.is_control() || letter == '\u{202e}')
        );
        assert!(
            ended.err.chars().count() < 500,
            "{} characters",
            ended.err.chars().count()
        );
    }
    let endless = "x".repeat(1_000_000);
    let flag = ["apply".to_owned(), format!("--{endless}")];
    let weld = ["apply".to_owned(), "--weld".to_owned(), endless.clone()];
    let ended = [run(flag), run(weld)].map(|ended| ended.refused(2, &["--help"]));
    let option = format!("arap:{endless}=1");
    let arguments = [
        "apply", "a.off", "--edit", "e.json", "--output", "b.off", "--method", &option,
    ];
    let refused = run(arguments).refused(2, &["takes no value", "`energy`"]);
    for ended in ended.into_iter().chain([refused]) {
        let length = ended.err.chars().count();
        assert!(length < 750, "{length} characters");
    }
}

#[test]
fn vectors_that_there_are_not_are_refused() {
    let apply = ["apply", "a.ply", "--edit", "e.json", "--output", "b.ply"];
    run(apply.into_iter().chain(["--vectors", "avx1024"])).refused(2, &["--vectors", "avx512, avx2, baseline"]);
}

#[test]
fn more_threads_than_make_sense_are_refused() {
    let folder = Folder::new();
    let mesh = folder.write_mesh("mesh.off", &shapes::torus(12, 8));
    let most = 4 * std::thread::available_parallelism().unwrap().get();
    let (out, more) = (folder.at("out.off"), (most + 1).to_string());
    folder
        .apply(&mesh, &bare_edit(), &out, &["--threads", &more])
        .refused(2, &["--threads", "cores"]);
    folder
        .apply(&mesh, &bare_edit(), &out, &["--threads", &most.to_string()])
        .done();
}

//! The edit format: an edit that was read is written unchanged, and transforms move from rest to target.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use glam::{DAffine3, DMat3, DQuat, DVec3};
use pliant_deform::Loose;
use pliant_editor::{Beginning, EditFile, FieldEntry, HandleTransform, Selector};
use pliant_mesh::shapes;

const FULL: &str = r#"{
  "version": 1,
  "method": { "name": "bilaplacian" },
  "region": { "not": { "component": 2 } },
  "fixed": { "union": [{ "slab": { "axis": "longest", "from": 0.0, "to": 0.05 } }, { "ranges": [[3, 9], [12, 12]] }] },
  "handles": [
    { "name": "head", "select": { "intersection": ["all", { "box": { "min": [0, 1, 2], "max": [3, 4, 5] } }] },
      "transform": { "translation": [0.1, 0.2, 0.3], "rotation": [0, 0, 1, 1], "scale": [1, 2, 3], "pivot": [0, 1, 0] } },
    { "select": { "vertices": [7, 1] },
      "transform": { "matrix": [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 2, 0, 5, 6, 7, 1] } },
    { "select": { "sphere": { "center": [0, 0.5, 0], "radius": 0.2 } }, "soft": 2.5, "continuity": 0 }
  ],
  "stiffness": [{ "select": "all", "value": 10.0 }, { "per_vertex": [0.001, 1000, 1] }],
  "continuity": [{ "select": { "vertices": [3] }, "value": 1.5 }],
  "loose": "rest"
}"#;

#[test]
fn reading_what_was_written_gives_an_equal_edit_with_equal_text() {
    let edit = EditFile::parse(FULL).unwrap();
    let text = edit.to_json();
    let again = EditFile::parse(&text).unwrap();
    assert_eq!(edit, again);
    assert_eq!(text, again.to_json());
}

#[test]
fn what_an_edit_does_not_say_has_its_default() {
    let edit = EditFile::parse(r#"{"version": 1, "method": {"name": "bilaplacian"}}"#).unwrap();
    assert_eq!(edit, EditFile::default());
    assert_eq!((edit.region, edit.fixed), (Selector::All, Selector::None));
    let full = EditFile::parse(FULL).unwrap();
    let names: Vec<&str> = full.handles.iter().map(|handle| &*handle.name).collect();
    assert_eq!(names, ["head", "handle 2", "handle 3"]);
    assert_eq!(full.handles[2].transform, HandleTransform::IDENTITY);
    assert_eq!(full.stiffness[1], FieldEntry::PerVertex(vec![0.001, 1000.0, 1.0]));
}

fn transforms() -> Vec<HandleTransform> {
    EditFile::parse(FULL)
        .unwrap()
        .handles
        .iter()
        .map(|handle| handle.transform)
        .collect()
}

#[test]
fn a_transform_goes_from_rest_to_its_target_and_turns_about_its_pivot() {
    let default_pivot = DVec3::new(1.0, 2.0, 3.0);
    for transform in transforms() {
        assert_eq!(transform.at(0.0, default_pivot), DAffine3::IDENTITY);
        assert_eq!(transform.at(1.0, default_pivot), transform.affine(default_pivot));
        // Near its ends the path is near its end points: nothing jumps.
        for (t, end) in [(1e-9, 0.0), (1.0 - 1e-9, 1.0)] {
            assert!(
                transform
                    .at(t, default_pivot)
                    .abs_diff_eq(transform.at(end, default_pivot), 1e-7),
                "{transform:?}"
            );
        }
        // The pivot moves on a straight line.
        let pivot = transform.pivot_or(default_pivot);
        let whole = transform.affine(default_pivot).transform_point3(pivot) - pivot;
        let half = transform.at(0.5, default_pivot).transform_point3(pivot) - pivot;
        assert!(half.abs_diff_eq(whole * 0.5, 1e-12), "{transform:?}");
    }
}

#[test]
fn half_a_turn_is_half_the_angle_and_half_the_scale() {
    let transforms = transforms();
    let half = transforms[0].at(0.5, DVec3::ZERO);
    let wanted = DMat3::from_quat(DQuat::from_rotation_z(std::f64::consts::FRAC_PI_4))
        * DMat3::from_diagonal(DVec3::new(1.0, 1.5, 2.0));
    assert!(half.matrix3.abs_diff_eq(wanted, 1e-12));
    let half = transforms[1].at(0.5, DVec3::ZERO);
    let wanted = DMat3::from_quat(DQuat::from_rotation_z(std::f64::consts::FRAC_PI_4))
        * DMat3::from_diagonal(DVec3::new(1.0, 1.0, 1.5));
    assert!(half.matrix3.abs_diff_eq(wanted, 1e-12));
}

#[test]
fn a_mere_translation_far_from_the_origin_is_exact() {
    let text = r#"{"version": 1, "method": {"name": "bilaplacian"}, "handles":
        [{"select": "all", "transform": {"translation": [0.1, 0, 0], "pivot": [1e9, 3e9, 7e8]}}]}"#;
    let transform = EditFile::parse(text).unwrap().handles[0].transform;
    assert_eq!(
        transform.affine(DVec3::ZERO),
        DAffine3::from_translation(DVec3::new(0.1, 0.0, 0.0))
    );
    assert!(!transform.is_identity());
}

#[test]
fn only_what_moves_nothing_is_the_identity() {
    let is_identity = |transform: &str| {
        let text = format!(
            r#"{{"version": 1, "method": {{"name": "bilaplacian"}}, "handles": [{{"select": "all", "transform": {transform}}}]}}"#
        );
        EditFile::parse(&text).unwrap().changes_nothing()
    };
    for transform in [
        "{}",
        r#"{"pivot": [1, 2, 3]}"#,
        r#"{"rotation": [0, 0, 0, -3]}"#,
        r#"{"scale": [1, 1, 1]}"#,
    ] {
        assert!(is_identity(transform), "{transform}");
    }
    for transform in [
        r#"{"translation": [0, 1e-300, 0]}"#,
        r#"{"rotation": [0, 0, 1e-9, 1]}"#,
        r#"{"scale": [1, 1, -1]}"#,
    ] {
        assert!(!is_identity(transform), "{transform}");
    }
}

#[test]
fn loose_parts_are_told_all_at_once_or_one_by_one() {
    let read = |loose: &str| {
        let text = format!(r#"{{"version": 1, "method": {{"name": "bilaplacian"}}, "loose": {loose}}}"#);
        EditFile::parse(&text)
    };
    assert_eq!(read("\"bend\"").unwrap().loose, Loose::Bend);
    let entries = r#"[{"select": "all", "value": "rest"}, {"select": {"component": 2}, "value": "bend"},
        {"select": {"component": 3}, "value": "follow"}]"#;
    let edit = read(entries).unwrap();
    assert_eq!((edit.loose, edit.loose_parts.len()), (Loose::Rest, 2));
    assert_eq!(EditFile::parse(&edit.to_json()).unwrap(), edit);
    // An entry for all also replaces earlier ones.
    let last = read(r#"[{"select": {"component": 2}, "value": "bend"}, {"select": "all", "value": "rest"}]"#).unwrap();
    assert_eq!((last.loose, last.loose_parts.len()), (Loose::Rest, 0));
    for (loose, culprit) in [
        ("\"fly\"", "fly"),
        (r#"[{"select": "all"}]"#, "value"),
        (r#"[{"select": "all", "value": "stay"}]"#, "stay"),
    ] {
        let refused = read(loose).unwrap_err().to_string();
        assert!(refused.contains(culprit), "{refused}");
    }
}

#[test]
fn a_member_that_stands_twice_is_refused_by_name_and_place() {
    let method = r#""version": 1, "method": {"name": "bilaplacian"}"#;
    for (text, said) in [
        (
            format!(r#"{{{method}, "method": {{"name": "arap"}}}}"#),
            "`method` appears twice in the edit",
        ),
        (
            format!(
                r#"{{{method}, "handles": [{{"select": "all", "transform": {{"scale": [1, 1, 1], "scale": [2, 2, 2]}}}}]}}"#
            ),
            "`scale` appears twice in handles[0].transform",
        ),
        (
            r#"{"version": 1, "method": {"name": "bilaplacian", "order": 1, "order": 2}}"#.to_owned(),
            "`order` appears twice in method",
        ),
    ] {
        let refused = EditFile::parse(&text).unwrap_err().to_string();
        assert!(refused.contains(said), "{refused}");
    }
}

#[test]
fn a_transform_that_can_not_be_undone_is_refused_by_name() {
    let read = |transform: &str| {
        let text = format!(
            r#"{{"version": 1, "method": {{"name": "bilaplacian"}}, "handles": [{{"select": "all", "transform": {transform}}}]}}"#
        );
        EditFile::parse(&text)
    };
    for (transform, place) in [
        (r#"{"rotation": [0, 0, 0, 0]}"#, "rotation"),
        (r#"{"scale": [1, 0, 1]}"#, "scale"),
        (r#"{"scale": [1, -0.0, 1]}"#, "scale"),
        (r#"{"scale": [1, null, 1]}"#, "scale[1]"),
        // A projection, a column of zeros, two equal columns, three in a plane.
        (
            r#"{"matrix": [1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}"#,
            "matrix",
        ),
        (
            r#"{"matrix": [1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}"#,
            "matrix",
        ),
        (
            r#"{"matrix": [0.1, 0.2, 0.3, 0, 0.3, 0.6, 0.9, 0, 0, 0, 1, 0, 0, 0, 0, 1]}"#,
            "matrix",
        ),
        (
            r#"{"matrix": [1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 9, 0, 0, 0, 0, 1]}"#,
            "matrix",
        ),
    ] {
        let refused = read(transform).unwrap_err().to_string();
        assert!(refused.contains(&format!("handles[0].transform.{place} ")), "{refused}");
    }
    // An uneven, tiny, huge, sheared or mirrored map is a transform.
    for transform in [
        r#"{"scale": [1e-200, 1, 1e200]}"#,
        r#"{"scale": [-1, 1, 1]}"#,
        r#"{"rotation": [1e-200, 0, 0, 0]}"#,
        r#"{"matrix": [1e-200, 0, 0, 0, 0, 1e200, 0, 0, 0, 0, -3, 0, 5, 6, 7, 1]}"#,
        r#"{"matrix": [1, 0, 0, 0, 1e6, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}"#,
    ] {
        assert!(read(transform).is_ok(), "{transform}: {:?}", read(transform));
    }
}

#[test]
fn a_refusal_names_the_place_the_value_and_what_is_allowed() {
    let read = |edit: &str| EditFile::parse(&format!(r#"{{"version": 1, "method": {{"name": "arap"}}, {edit}}}"#));
    for (edit, said) in [
        (
            r#""fixed": {"union": ["all", {"sphere": {"center": [0, 0, 0], "radius": "big"}}]}"#,
            "fixed.union[1].sphere.radius must be a number, not \"big\"",
        ),
        (
            r#""fixed": {"slab": ["x", 0, 1]}"#,
            "fixed.slab must be an object with `axis`, `from`, `to`, not a list",
        ),
        (
            r#""fixed": {"ranges": [[1, 2, 3]]}"#,
            "fixed.ranges[0] must be a list of 2 values, not 3 values",
        ),
        (
            r#""fixed": "vertices""#,
            "fixed must be an object such as {\"vertices\": ..}, not \"vertices\"",
        ),
        (
            r#""handles": [{"select": "all", "soft": null}]"#,
            "handles[0].soft must be a number, not null",
        ),
        (
            r#""handles": [{"name": "a"}]"#,
            "handles[0] lacks its member `select`: add it",
        ),
        (r#""handles": {}"#, "handles must be"),
        (
            r#""stiffness": [{"select": "all", "per_vertex": []}]"#,
            "stiffness[0] has both `per_vertex` and `select`: keep one of them",
        ),
        (
            r#""stiffness": [{"per_vertex": [1, 0]}]"#,
            "stiffness[0].per_vertex[1] is 0, which is out of range",
        ),
        (
            r#""continuity": {}"#,
            "continuity must be a number from 0 to 2, or a list",
        ),
        (
            r#""loose": [{"select": "all", "value": "folow"}]"#,
            "loose[0].value: did you mean `follow`?",
        ),
        (r#""loose": 7"#, "loose"),
        (
            r#""regoin": "all""#,
            "unknown member `regoin` in the edit: did you mean `region`?",
        ),
    ] {
        let refused = read(edit).unwrap_err().to_string();
        assert!(refused.contains(said), "{refused}\n{said}");
    }
}

/// The refusal of any version is one short line.
#[test]
fn a_version_that_is_no_number_is_not_quoted_whole() {
    let text = format!(
        "{{\"version\": \"{}\\u001b[31m\", \"method\": {{\"name\": \"arap\"}}}}",
        "x".repeat(5000)
    );
    let said = EditFile::parse(&text).unwrap_err().to_string();
    assert!(said.contains("`version`") && said.len() < 200, "{said}");
    assert!(!said.chars().any(char::is_control), "{said:?}");
}

/// Names come from the file, so a refusal cuts them.
#[test]
fn a_handle_with_a_long_name_is_refused_in_a_short_sentence() {
    let model = shapes::model(shapes::grid(2, 2));
    let long = "é".repeat(3000);
    let handle = |vertices: &str| format!(r#"{{"name": "{long}", "select": {{"vertices": {vertices}}}}}"#);
    for (handles, word) in [
        (handle("[]"), "selects no vertex"),
        ([handle("[0, 1]"), handle("[1, 2]")].join(", "), "share 1"),
    ] {
        let text = format!(r#"{{"version": 1, "method": {{"name": "arap"}}, "handles": [{handles}]}}"#);
        let refused = Beginning::parse(&text).unwrap().resolve(&model);
        let said = refused.unwrap_err().to_string();
        assert!(said.contains(word) && said.chars().count() < 400, "{said}");
    }
}

#[test]
fn a_weld_distance_comes_back_and_is_the_meshs_own_where_none_is_given() {
    let edit = |weld: &str| EditFile::parse(&format!(r#"{{"version": 1, "method": {{"name": "arap"}}{weld}}}"#));
    assert_eq!(edit("").unwrap().weld, None);
    let given = edit(r#", "weld": 0.25"#).unwrap();
    assert_eq!(given.weld, Some(0.25));
    assert_eq!(EditFile::parse(&given.to_json()).unwrap(), given);
    for wrong in ["-0.1", "\"wide\""] {
        let said = edit(&format!(", \"weld\": {wrong}")).unwrap_err().to_string();
        assert!(said.contains("weld"), "{said}");
    }
}

//! An edit that names vertices by number, on other meshes of the same object: its sets and fields are found by place.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DAffine3, DQuat, DVec2, DVec3};
use pliant_deform::{Budget, Role};
use pliant_editor::{
    Command, Correction, CorrectionBrush, EditError, EditFile, Editor, Event, FieldEntry, HandleEntry, HandleTransform,
    InlineExecutor, Selector, Setup, Start, ToolMode, Until,
};
use pliant_mesh::{Cancel, Drawn, DrawnVertex, Model, Progress, SurfaceVertex, shapes};

use crate::rig::{CENTRE_PX, Random, Rig, weld};

/// A vase-like body of a scan's kind: `rings` and `segments` give other vertices on the same surface.
fn body(rings: usize, segments: usize) -> Drawn {
    shapes::turned(rings, segments, |share| {
        let (sin, cos) = (PI * share).sin_cos();
        DVec2::new(sin * (1.0 + 0.3 * (5.0 * share).cos()), 1.6 * cos)
    })
}

/// The vertices of a file whose positions `is_in`.
fn vertices(drawn: &Drawn, is_in: impl Fn(DVec3) -> bool) -> Selector {
    let numbered = (0..).zip(&drawn.positions).filter(|(_, p)| is_in(**p));
    Selector::Vertices(numbered.map(|(vertex, _)| vertex).collect())
}

fn is_top(p: DVec3) -> bool {
    p.z > 0.9
}

fn is_side(p: DVec3) -> bool {
    p.distance(DVec3::new(1.0, 0.0, 0.3)) < 0.35
}

fn is_free(p: DVec3) -> bool {
    p.z > -0.7
}

fn stiffness(p: DVec3) -> f64 {
    (1.5 * (2.0 * p.x).sin() + p.z).exp()
}

/// Two handles, a region, and a stiffness that changes everywhere.
fn painted(drawn: &Drawn) -> EditFile {
    let handle = |name: &str, select, transform| HandleEntry {
        select: Some(select),
        transform,
        ..named(name)
    };
    let turn = HandleTransform::Trs {
        translation: DVec3::new(0.2, 0.1, 0.3),
        rotation: DQuat::from_rotation_y(0.5),
        scale: DVec3::ONE,
        pivot: Some(DVec3::Z),
    };
    EditFile {
        region: vertices(drawn, is_free),
        handles: vec![
            handle("top", vertices(drawn, is_top), turn),
            handle("side", vertices(drawn, is_side), HandleTransform::IDENTITY),
        ],
        stiffness: vec![FieldEntry::PerVertex(
            drawn.positions.iter().map(|p| stiffness(*p)).collect(),
        )],
        ..EditFile::default()
    }
}

fn named(name: &str) -> HandleEntry {
    HandleEntry {
        name: name.to_owned(),
        select: None,
        pose: None,
        transform: HandleTransform::IDENTITY,
        free_along: None,
        curve: None,
        sketch: None,
        soft: None,
        continuity: None,
        parent: None,
        bend: None,
    }
}

/// The edit as another mesh reads it from the exported file.
fn exported(edit: &EditFile, model: &Model) -> EditFile {
    EditFile::parse(&edit.with_places(model).unwrap().to_json()).unwrap()
}

/// Displacements of the surface's vertices.
fn bent(setup: &Setup, model: &Model) -> Arc<Vec<DVec3>> {
    let (progress, cancel) = (Progress::new(), Cancel::new());
    let problem = setup.problem(model);
    let ordering = problem
        .ordering_within(Budget::of_most(None), &progress, &cancel)
        .unwrap();
    let mut bound = problem.bind(ordering.as_ref(), &progress, &cancel).unwrap();
    let start = Start::Shape(Arc::new(vec![DVec3::ZERO; model.surface.positions.len()]));
    let bent = start.bend(&mut bound, &setup.targets_at(1.0), Until::End, &cancel);
    bent.unwrap().shown
}

fn role_meant(p: DVec3) -> Role {
    match p {
        _ if is_top(p) => Role::Handle(0),
        _ if is_side(p) => Role::Handle(1),
        _ if is_free(p) => Role::Free,
        _ => Role::Fixed,
    }
}

#[test]
fn on_its_own_mesh_an_exported_edit_is_the_same_to_the_bit() {
    for (class, drawn) in shapes::classes() {
        let model = weld(drawn.clone());
        let numbers = || (0..drawn.file_vertex_count as u32).collect::<Vec<_>>();
        let some: Vec<u32> = numbers().into_iter().filter(|vertex| vertex % 5 == 0).collect();
        let values = numbers().into_iter().map(|vertex| 1.0 + f64::from(vertex % 7));
        let edit = EditFile {
            region: Selector::Not(Box::new(Selector::Vertices(some))),
            stiffness: vec![FieldEntry::PerVertex(values.collect())],
            ..EditFile::default()
        };
        let again = exported(&edit, &model);
        assert_eq!(again.resolve(&model), edit.resolve(&model), "{class}");
        assert!(again.placed(&model).unwrap().is_none(), "{class}");
        assert_eq!(EditFile::parse(&again.to_json()).unwrap(), again, "{class}");
        // A pose of the same triangles has the same vertices, wherever it is.
        let far = weld(shapes::moved(&drawn, DAffine3::from_translation(DVec3::X * 16.0)));
        if !far.surface.triangles.is_empty() && class != "far from the origin" {
            assert_eq!(again.placed(&far).map(|placed| placed.is_some()), Ok(false), "{class}");
        }
    }
}

#[test]
fn permuted_vertices_give_the_permuted_result() {
    let drawn = body(24, 20);
    let model = weld(drawn.clone());
    let edit = painted(&drawn);
    let mut order: Vec<usize> = (0..drawn.positions.len()).collect();
    let mut random = Random(5);
    for place in (1..order.len()).rev() {
        order.swap(place, random.below(place as u64 + 1) as usize);
    }
    let mut place_of = vec![0; order.len()];
    (0..).zip(&order).for_each(|(place, from)| place_of[*from] = place);
    let triangles = drawn
        .triangles
        .iter()
        .map(|t| t.map(|v| DrawnVertex(place_of[v.index()])));
    let permuted = weld(Drawn::once(
        order.iter().map(|from| drawn.positions[*from]).collect(),
        triangles.collect(),
    ));
    let [own, other] = [(&edit, &model), (&exported(&edit, &model), &permuted)].map(|(edit, model)| {
        let setup = edit.resolve(model).unwrap();
        let shape = bent(&setup, model);
        let file = model.surface_of_file();
        (setup, shape, file)
    });
    let diagonal = model.bounds().unwrap().diagonal();
    assert!(own.1.iter().any(|d| d.length() > 0.1 * diagonal));
    for (place, from) in (0..).zip(&order) {
        let vertex = |(_, _, file): &(Setup, Arc<Vec<DVec3>>, pliant_mesh::SurfaceOfFile), number: u32| {
            file.of(pliant_mesh::FileVertex(number))[0].index()
        };
        let (a, b) = (vertex(&own, *from as u32), vertex(&other, place));
        assert_eq!(own.0.roles[a], other.0.roles[b]);
        assert!((own.0.stiffness[a] / other.0.stiffness[b] - 1.0).abs() < 1e-12);
        assert!(own.1[a].distance(other.1[b]) < 1e-9 * diagonal);
    }
}

#[test]
fn another_mesh_of_the_same_surface_gets_the_same_sets_and_nearly_the_same_shape() {
    let drawn = body(40, 32);
    let model = weld(drawn.clone());
    let edit = painted(&drawn);
    let shape = bent(&edit.resolve(&model).unwrap(), &model);
    let exported = exported(&edit, &model);
    let diagonal = model.bounds().unwrap().diagonal();
    // Each mesh with the length of its longer edges, and those of the first one.
    for (case, rings, segments, jitter) in [
        ("finer", 80, 64, 0.0),
        ("coarser", 23, 18, 0.0),
        ("other", 37, 41, 0.0),
        ("jittered", 40, 33, 0.3),
    ] {
        let mut other = body(rings, segments);
        let edge = (3.2 / 40.0_f64).max(4.0 / rings as f64).max(7.0 / segments as f64);
        let mut random = Random(3);
        for p in &mut other.positions {
            let way = DVec3::from_array(std::array::from_fn(|_| random.unit() - 0.5));
            *p += jitter * 0.05 * way;
        }
        let other = weld(other);
        let setup = exported.resolve(&other).unwrap();
        let matched = setup.matched.as_ref().unwrap();
        assert_eq!(matched.found.len(), 3, "{case}");
        assert!(
            matched.found.iter().all(|found| found.share > 0.95),
            "{case}: {matched:?}"
        );
        let is_near_border = |p: DVec3| {
            let around = (0..60).map(|k| {
                let (sin, cos) = (f64::from(k) * 2.4).sin_cos();
                let height = f64::from(k) / 29.5 - 1.0;
                p + edge * (DVec2::new(cos, sin) * (1.0 - height * height).sqrt()).extend(height)
            });
            around.into_iter().any(|q| role_meant(q) != role_meant(p))
        };
        let positions = &other.surface.positions;
        let mut inside = 0;
        for (p, role) in positions.iter().zip(&setup.roles) {
            if !is_near_border(*p) {
                assert_eq!(*role, role_meant(*p), "{case}: {p}");
                inside += 1;
            }
        }
        assert!(inside > positions.len() / 3, "{case}: {inside} of {}", positions.len());
        for (p, own) in positions.iter().zip(&setup.stiffness) {
            assert!(
                (own / stiffness(*p)).ln().abs() < 0.15,
                "{case}: {p} {own} {}",
                stiffness(*p)
            );
        }
        let other_shape = bent(&setup, &other);
        for (p, d) in positions.iter().zip(other_shape.iter()) {
            let nearest = model.surface.positions.iter().zip(shape.iter());
            let nearest = nearest.min_by(|a, b| a.0.distance(*p).total_cmp(&b.0.distance(*p)));
            let (rest, moved) = nearest.unwrap();
            let apart = d.distance(*moved);
            assert!(
                apart < 0.02 * diagonal + 0.5 * rest.distance(*p),
                "{case}: {p} {d} {moved}"
            );
        }
    }
}

/// The largest distance of a shape from the nearest vertex of another one at rest, moved by its displacement.
fn apart((a, on_a): (&Model, &[DVec3]), (b, on_b): (&Model, &[DVec3])) -> f64 {
    let each = a.surface.positions.iter().zip(on_a).map(|(p, d)| {
        let others = b.surface.positions.iter().zip(on_b);
        let nearest = others.min_by(|x, y| x.0.distance(*p).total_cmp(&y.0.distance(*p)));
        nearest.unwrap().1.distance(*d)
    });
    each.fold(0.0, f64::max)
}

#[test]
fn what_was_painted_and_corrected_on_the_bent_shape_stays_where_it_was_seen() {
    let ways = ["painted", "corrected", "painted and corrected"];
    for (method, way) in ["bilaplacian", "arap"]
        .into_iter()
        .flat_map(|method| ways.map(|way| (method, way)))
    {
        let mut rig = Rig::open(body(40, 32));
        rig.choose(method);
        rig.paint_handle();
        rig.move_by('z', "0.4");
        rig.drain();
        if way != "corrected" {
            // More of the handle, which stays where it is seen.
            rig.paint(ToolMode::PaintHandle, &[CENTRE_PX + DVec2::new(60.0, 90.0)]);
            rig.drain();
        }
        if way != "painted" {
            rig.command(Command::SetTool(ToolMode::Correct));
            rig.command(Command::SetCorrection(CorrectionBrush {
                correction: Correction::Grab,
                ..CorrectionBrush::default()
            }));
            rig.command(Command::SetBrushRadius(60.0));
            let from = CENTRE_PX - DVec2::new(90.0, 60.0);
            rig.swipe(&[from, from - DVec2::new(15.0, 10.0), from - DVec2::new(40.0, 20.0)]);
            rig.drain();
            assert!(
                rig.editor
                    .document()
                    .kept()
                    .is_some_and(|kept| kept.corrections.is_some())
            );
        }
        let shape = rig.editor.view().displacements.to_vec();
        let diagonal = rig.model.bounds().unwrap().diagonal();
        let edit = exported(&rig.editor.edit_file().unwrap(), &rig.model);
        assert!(edit.kept.is_some());
        let other = weld(body(57, 45));
        let placed = edit.placed(&other).unwrap().unwrap();
        assert!(placed.matched.left_out.is_empty(), "{:?}", placed.matched);
        let seen = open_with(&other, placed.edit);
        let far = apart((&other, &seen), (&rig.model, &shape));
        assert!(far < 0.03 * diagonal, "{method}, {way}: {far} of {diagonal}");
    }
}

/// The shape that a window shows after it has opened a mesh with an edit.
fn open_with(model: &Arc<Model>, edit: EditFile) -> Vec<DVec3> {
    let jobs = InlineExecutor::new();
    let editor = Editor::new(Box::new(jobs.clone()));
    let mut rig = Rig::of(editor, jobs, Arc::clone(model));
    rig.send(Event::Opened {
        model: Arc::clone(model),
        name: String::new(),
        beginning: Some(edit.into()),
    });
    rig.drain();
    assert_eq!(rig.editor.view().problem, None);
    rig.editor.view().displacements.to_vec()
}

#[test]
fn the_sides_of_a_thin_sheet_stay_apart() {
    let sheet = |cells: usize| {
        let scale = DVec3::new(1.0, 1.0, 0.05) / cells as f64;
        let thin = shapes::moved(&shapes::bar(cells, cells, 1), DAffine3::from_scale(scale));
        let turn = DAffine3::from_rotation_x(0.3) * DAffine3::from_translation(DVec3::new(3.0, -1.0, 2.0));
        (thin.clone(), weld(shapes::moved(&thin, turn)))
    };
    let (flat, model) = sheet(30);
    let is_dot = |p: DVec3| p.truncate().distance(DVec2::splat(0.5)) < 0.25;
    let edit = EditFile {
        handles: vec![HandleEntry {
            select: Some(vertices(&flat, |p| p.z > 0.001 && is_dot(p))),
            ..named("dot")
        }],
        ..EditFile::default()
    };
    let exported = exported(&edit, &model);
    for (cells, is_turned) in [(22, false), (47, false), (22, true), (47, true)] {
        let (flat, mut other) = sheet(cells);
        if is_turned {
            other = weld(turned(other.rest()));
        }
        let setup = exported.resolve(&other).unwrap();
        let mut on_top = 0;
        for (p, vertex) in flat.positions.iter().zip(other.drawn.surface_vertices()) {
            if setup.roles[vertex.unwrap().index()] == Role::Handle(0) {
                assert!(p.z > 0.0005, "{cells}: {p}");
                on_top += 1;
            }
        }
        let meant = flat.positions.iter().filter(|p| p.z > 0.0005 && is_dot(**p)).count();
        assert!(
            (on_top as f64 / meant as f64 - 1.0).abs() < 0.1,
            "{cells}: {on_top} of {meant}"
        );
    }
}

/// The same vertices with triangles of the opposite winding.
fn turned(mut drawn: Drawn) -> Drawn {
    drawn.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
    drawn
}

#[test]
fn a_mesh_of_the_opposite_winding_is_matched_like_the_same_one() {
    let drawn = body(40, 32);
    let edit = EditFile {
        inside_out: Selector::Component(0),
        ..painted(&drawn)
    };
    let exported = exported(&edit, &weld(drawn));
    let other = body(37, 41);
    let [same, opposite] = [other.clone(), turned(other)].map(|drawn| exported.resolve(&weld(drawn)).unwrap());
    assert_eq!(opposite.roles, same.roles);
    assert_eq!(opposite.stiffness, same.stiffness);
    let [same_matched, opposite_matched] = [&same, &opposite].map(|setup| setup.matched.clone().unwrap());
    assert_eq!((same_matched.turned, opposite_matched.turned), (false, true));
    assert_eq!(opposite_matched.found, same_matched.found);
    // A part that was inside out faces outwards already.
    assert_eq!((same.inside_out.len(), opposite.inside_out.len()), (1, 0));
}

#[test]
fn a_mesh_elsewhere_is_refused_in_words() {
    let drawn = body(20, 16);
    let exported = exported(&painted(&drawn), &weld(drawn));
    let other = body(23, 18);
    assert!(exported.resolve(&weld(other.clone())).is_ok());
    for (case, motion) in [
        ("moved", DAffine3::from_translation(DVec3::new(0.0, 0.0, 2.0))),
        ("turned", DAffine3::from_rotation_x(1.5)),
        ("in other units", DAffine3::from_scale(DVec3::splat(100.0))),
    ] {
        let error = exported.resolve(&weld(shapes::moved(&other, motion))).unwrap_err();
        assert!(matches!(error, EditError::Elsewhere { .. }), "{case}: {error}");
        let said = error.to_string();
        assert!(
            said.contains("made on another mesh") && said.contains("move, turn and scale"),
            "{said}"
        );
        assert!(said.contains("of `top` is") || said.contains("of `side` is"), "{said}");
    }
}

#[test]
fn a_pin_smaller_than_the_other_mesh_triangles_is_not_lost() {
    let drawn = body(60, 48);
    let model = weld(drawn.clone());
    let pins = [300, 1200, 2000].map(|vertex| HandleEntry {
        select: Some(Selector::Vertices(vec![vertex])),
        ..named(&format!("pin {vertex}"))
    });
    let places = pins.clone().map(|pin| match pin.select {
        Some(Selector::Vertices(vertices)) => drawn.positions[vertices[0] as usize],
        _ => DVec3::NAN,
    });
    let edit = EditFile {
        handles: pins.to_vec(),
        ..EditFile::default()
    };
    let other = weld(body(13, 11));
    let setup = exported(&edit, &model).resolve(&other).unwrap();
    for (pin, place) in (0..).zip(places) {
        let own = other.surface.positions.iter().zip(&setup.roles);
        let own: Vec<DVec3> = own
            .filter(|(_, role)| **role == Role::Handle(pin))
            .map(|(p, _)| *p)
            .collect();
        assert!(
            !own.is_empty() && own.iter().all(|p| p.distance(place) < 0.5),
            "{own:?} {place}"
        );
    }
}

#[test]
fn whole_parts_are_found_by_place_whatever_their_numbers() {
    let at = |x: f64| DAffine3::from_translation(DVec3::X * x);
    let scan = |levels: [u32; 3]| {
        let balls = (0..).zip(levels).map(|(place, level)| {
            let ball = shapes::icosphere(level);
            shapes::moved(&ball, at(3.0 * f64::from(place)))
        });
        weld(shapes::together(&balls.collect::<Vec<_>>()))
    };
    let model = scan([3, 2, 1]);
    // The middle one.
    let edit = EditFile {
        inside_out: Selector::Component(1),
        loose_parts: vec![(Selector::Component(1), pliant_deform::Loose::Rest)],
        ..EditFile::default()
    };
    let other = scan([2, 1, 3]);
    let setup = exported(&edit, &model).resolve(&other).unwrap();
    let part = (0..other.surface.positions.len() as u32)
        .map(SurfaceVertex)
        .find(|v| (other.surface.positions[v.index()].x - 3.0).abs() < 1.1)
        .map(|v| other.topology.component(v));
    assert_eq!(setup.inside_out.iter().copied().collect::<Vec<_>>(), [part.unwrap()]);
    assert_eq!(setup.loose_parts, [(part.unwrap(), pliant_deform::Loose::Rest)]);
}

#[test]
fn examples_by_numbers_and_places_that_do_not_fit_are_refused_by_name() {
    let drawn = body(12, 10);
    let model = weld(drawn.clone());
    let count = drawn.positions.len();
    let shape = format!("{{\"displacements\": {:?}}}", vec![[0.0; 3]; count]);
    let text = format!("{{\"version\": 1, \"method\": {{\"name\": \"shells\", \"examples\": [{shape}]}}}}");
    let edit = exported(&EditFile::parse(&text).unwrap(), &model);
    assert!(edit.resolve(&model).is_ok());
    let said = edit.resolve(&weld(body(13, 11))).unwrap_err().to_string();
    assert!(
        said.contains("method.examples[0]") && said.contains("not matched by place"),
        "{said}"
    );

    let edit = exported(&painted(&drawn), &model);
    let broken = edit.to_json().replace("\"sample\": \"", "\"sample\": \"AA");
    let said = EditFile::parse(&broken)
        .unwrap()
        .resolve(&weld(body(13, 11)))
        .unwrap_err()
        .to_string();
    assert!(
        said.contains("places") && said.contains("export the edit again"),
        "{said}"
    );
}

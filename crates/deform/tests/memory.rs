//! The allocations of binding: they grow with the mesh and stay within the budget.
//!
//! The single test is alone in its binary, because an allocator counts for the whole process.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::f64::consts::TAU;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use glam::DVec3;
use pliant_deform::{
    Arap, ArapEnergy, Attachment, Bilaplacian, BilaplacianOrder, BindError, Budget, CageCoordinates, Detail,
    ExampleShape, Examples, Frames, Limit, METHODS, Method, OptionKind, OptionValue, Primo, Problem, Propagation, Rbf,
    Role, Shells, Transforms, Wrinkles,
};
use pliant_mesh::{Cancel, Drawn, DrawnVertex, Model, Progress, shapes};

/// The system's allocator, with counters.
struct Counting;

/// All bytes allocated since it was last set.
static ALLOCATED: AtomicUsize = AtomicUsize::new(0);
/// The bytes held.
static HELD: AtomicUsize = AtomicUsize::new(0);
/// The most bytes held at once since it was last set.
static PEAK: AtomicUsize = AtomicUsize::new(0);

fn count(bytes: usize) {
    ALLOCATED.fetch_add(bytes, Relaxed);
    let held = HELD.fetch_add(bytes, Relaxed) + bytes;
    PEAK.fetch_max(held, Relaxed);
}

#[expect(
    unsafe_code,
    reason = "each call is handed to the system's allocator with the very arguments that came in"
)]
// SAFETY: as `System`, to which every call is passed on.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size());
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        HELD.fetch_sub(layout.size(), Relaxed);
        unsafe { System.dealloc(at, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Three rings of this many vertices around a tip.
fn fan(count: usize) -> Drawn {
    let mut positions = vec![DVec3::Z * 0.2];
    for ring in 1..=3 {
        positions.extend((0..count).map(|place| {
            let (sin, cos) = (TAU * place as f64 / count as f64).sin_cos();
            DVec3::new(cos, sin, 0.0) * f64::from(ring) / 3.0
        }));
    }
    let at = |ring: usize, place: usize| DrawnVertex((1 + (ring - 1) * count + place % count) as u32);
    let mut triangles = Vec::new();
    for place in 0..count {
        triangles.push([DrawnVertex(0), at(1, place), at(1, place + 1)]);
        for ring in 1..3 {
            let [a, b] = [at(ring, place), at(ring, place + 1)];
            let [c, d] = [at(ring + 1, place), at(ring + 1, place + 1)];
            triangles.extend([[a, c, b], [b, c, d]]);
        }
    }
    Drawn::once(positions, triangles)
}

/// A torus and this many loose triangles beside it.
fn soup(count: usize) -> Drawn {
    let mut drawn = shapes::torus(12, 8);
    for crumb in 0..count {
        let first = drawn.positions.len() as u32;
        let at = DVec3::new((crumb % 97) as f64, (crumb / 97 % 89) as f64, (crumb / 97 / 89) as f64) * 0.1;
        drawn.positions.extend([at, at + DVec3::X * 0.01, at + DVec3::Y * 0.01]);
        drawn.triangles.push([first, first + 1, first + 2].map(DrawnVertex));
    }
    Drawn::once(drawn.positions, drawn.triangles)
}

struct Scene {
    model: Model,
    roles: Vec<Role>,
    method: Method,
    attachments: Vec<(&'static str, Attachment)>,
}

impl Scene {
    /// With this many examples.
    fn new(drawn: Drawn, (method, examples): &(Method, usize)) -> Self {
        let model = shapes::model(drawn);
        let bounds = model.bounds().unwrap();
        let role = |p: &DVec3| match (p.x - bounds.min.x) / bounds.extent().x {
            x if x > 0.9 => Role::Handle(0),
            x if x < 0.1 => Role::Fixed,
            _ => Role::Free,
        };
        Self {
            roles: model.surface.positions.iter().map(role).collect(),
            attachments: attached(&model, *examples),
            model,
            method: method.clone(),
        }
    }

    /// Orders and binds within a budget; returns the most bytes held at once and all bytes allocated, beyond those
    /// before.
    fn bind(&self, budget: Budget) -> (Result<usize, BindError>, usize, usize) {
        let stiffness = vec![1.0; self.roles.len()];
        let mesh = (&self.model.surface, &self.model.topology);
        let problem = Problem {
            attachments: &self.attachments,
            ..Problem::new(mesh, &self.roles, &stiffness, &self.method)
        };
        let (progress, cancel) = (Progress::new(), Cancel::new());
        let before = HELD.load(Relaxed);
        PEAK.store(before, Relaxed);
        ALLOCATED.store(0, Relaxed);
        let ordering = self.method.ordering(&self.model.topology, &progress, &cancel).unwrap();
        let bound = problem.bind_within(ordering.as_ref(), budget, &progress, &cancel);
        let (peak, allocated) = (PEAK.load(Relaxed) - before, ALLOCATED.load(Relaxed));
        (bound.map(|bound| bound.factor_len()), peak, allocated)
    }
}

fn attached(model: &Model, examples: usize) -> Vec<(&'static str, Attachment)> {
    let example = |number: usize| {
        let turned = |p: &DVec3| *p * (0.1 * (number + 1) as f64 * p.x).sin();
        ExampleShape {
            name: number.to_string(),
            displacements: Arc::new(model.surface.positions.iter().map(turned).collect()),
        }
    };
    let examples = Examples {
        shapes: Arc::new((0..examples).map(example).collect()),
        weights: vec![None; examples],
    };
    let brought = (!examples.shapes.is_empty()).then_some(("examples", Attachment::Shapes(examples)));
    brought.into_iter().collect()
}

/// All methods, and shells and wrinkles with two examples.
fn cases() -> Vec<(Method, usize)> {
    let mut led = Shells::default();
    led.led_above = 0;
    let with_examples = [Shells::default().into(), led.into(), Wrinkles::default().into()].map(|method| (method, 2));
    let plain = methods().into_iter().map(|method| (method, 0));
    plain.chain(with_examples).collect()
}

fn methods() -> Vec<Method> {
    let mut methods = vec![Method::from(Primo::default())];
    for order in BilaplacianOrder::ALL {
        let mut options = Bilaplacian::default();
        options.order = order;
        methods.push(options.into());
    }
    for detail in Detail::ALL.into_iter().filter(|detail| *detail != Detail::None) {
        let mut options = Bilaplacian::default();
        options.detail = detail;
        methods.push(options.into());
    }
    for energy in ArapEnergy::ALL {
        let mut arap = Arap::default();
        arap.energy = energy;
        methods.push(arap.into());
    }
    let with = |name: &str, option: &str, value: &'static str| {
        let method = Method::from_name(name).unwrap();
        method.with([(option, OptionValue::Name(value))]).unwrap()
    };
    for propagation in Propagation::ALL {
        methods.push(with("poisson", "propagation", propagation.name()));
    }
    for transforms in Transforms::ALL {
        methods.push(with("laplacian", "transforms", transforms.name()));
    }
    methods.push(Frames::default().into());
    methods.push(Rbf::default().into());
    methods.push(Method::from_name("mls").unwrap());
    methods.push(Method::from_name("embedded").unwrap());
    methods.push(Method::from_name("lattice").unwrap());
    for coordinates in CageCoordinates::ALL {
        let detail = OptionValue::Whole(3);
        let cage = with("cage", "coordinates", coordinates.name());
        methods.push(cage.with([("detail", detail)]).unwrap());
    }
    methods.push(Method::from_name("space-primo").unwrap());
    let mut led = Shells::default();
    methods.push(led.clone().into());
    led.led_above = 0;
    methods.push(led.into());
    methods
}

/// Every method with each of its numbers at the largest value, one at a time and all together.
fn largest() -> Vec<(Method, usize)> {
    let mut methods = Vec::new();
    for declaration in METHODS {
        let most = |kind: &OptionKind| match kind {
            OptionKind::Number { range: [_, high], .. } => Some(OptionValue::Number(*high)),
            OptionKind::Whole { range: [_, high] } => Some(OptionValue::Whole(*high)),
            OptionKind::Numbered { choices } => choices.last().map(|&(number, _)| OptionValue::Whole(number)),
            OptionKind::Named { .. } | OptionKind::Switch => None,
        };
        let options = declaration.options.iter();
        let largest: Vec<_> = options
            .filter_map(|option| Some((option.name, most(&option.kind)?)))
            .collect();
        let one_at_a_time = largest.iter().map(std::slice::from_ref);
        for options in one_at_a_time.chain([&*largest]) {
            let method = Method::from_name(declaration.name)
                .unwrap()
                .with(options.to_vec())
                .unwrap();
            // These two methods blend examples and learn from them.
            let examples = if ["shells", "wrinkles"].contains(&declaration.name) {
                2
            } else {
                0
            };
            methods.push((method, examples));
        }
    }
    methods
}

const PLENTY: Budget = Budget {
    bytes: 1 << 34,
    operations: u64::MAX,
};

#[test]
fn binding_allocates_as_the_mesh_grows_and_within_its_budget() {
    // Scratch memory is kept by thread; one thread makes the counts repeatable.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    pool.install(|| {
        for method in cases() {
            for (name, shape, sizes) in [
                ("vertex", fan as fn(usize) -> Drawn, [1000, 2000]),
                ("edge", shapes::non_manifold_fan, [1000, 2000]),
                ("soup", soup, [4000, 8000]),
            ] {
                let measured = sizes.map(|size| {
                    let (bound, peak, allocated) = Scene::new(shape(size), &method).bind(PLENTY);
                    // The coupled system of implicit transformations loses too many digits at an edge with this many
                    // triangles.
                    let may_refuse = name == "edge" && method.0 == Method::from_name("laplacian").unwrap();
                    let refused = bound.err();
                    assert!(
                        refused.is_none() || may_refuse && matches!(refused, Some(BindError::Inaccurate { .. })),
                        "{name}, {method:?}: {refused:?}"
                    );
                    (peak, allocated)
                });
                let [(peak, allocated), (twice, all_twice)] = measured;
                assert!(twice < 3 * peak, "{name}, {method:?}: {peak} {twice} held");
                // Each correction allocates its memory again, and at a crowded vertex order 3 needs more corrections for
                // more neighbours.
                let order = method.0.options::<Bilaplacian>().map(|options| options.order);
                let corrects_more = name == "vertex" && order == Some(BilaplacianOrder::CurvatureVariation);
                assert!(
                    corrects_more || all_twice < 3 * allocated,
                    "{name}, {method:?}: {allocated} {all_twice} in all"
                );
            }
            // A surface without a crowded vertex is also refused before its memory is allocated.
            let scene = Scene::new(shapes::grid(70, 70), &method);
            let (bound, peak, _) = scene.bind(PLENTY);
            bound.unwrap();
            let (refused, least, _) = scene.bind(Budget {
                bytes: 400_000,
                ..PLENTY
            });
            assert!(
                matches!(refused, Err(BindError::Budget { .. } | BindError::Handles { .. })),
                "{method:?}: {refused:?}"
            );
            assert!(least < peak, "{method:?}: {least} {peak}");
        }
        // The granted budget covers the memory of a binding: with a tenth less than its peak it is refused, or needs
        // less.
        for method in cases() {
            for drawn in [shapes::grid(120, 120), soup(8000)] {
                let scene = Scene::new(drawn, &method);
                let (bound, peak, _) = scene.bind(PLENTY);
                bound.unwrap();
                let granted = peak as u64 * 9 / 10;
                let (refused, held, _) = scene.bind(Budget {
                    bytes: granted,
                    ..PLENTY
                });
                let vertices = scene.roles.len();
                assert!(
                    refused.is_err() || held as u64 <= granted,
                    "{method:?}: {held} of {peak} bytes for {vertices} vertices"
                );
            }
        }
        // On a small mesh a method needs no more than its budget, even with the largest options, and is refused before
        // it exceeds it.
        for method in largest() {
            let scene = Scene::new(shapes::icosphere(3), &method);
            let (bound, peak, _) = scene.bind(PLENTY);
            assert!(bound.is_ok(), "{method:?}: {:?}", bound.err());
            for share in [0.9, 0.3] {
                let granted = (peak as f64 * share) as u64;
                let (bound, held, _) = scene.bind(Budget {
                    bytes: granted,
                    ..PLENTY
                });
                // Small tables are estimated per vertex.
                let most = granted + 200 * scene.roles.len() as u64;
                let most = if bound.is_ok() { most } else { most + granted / 10 };
                assert!(
                    held as u64 <= most,
                    "{method:?}: {held} where {granted} were granted of {peak}, {:?}",
                    bound.err()
                );
            }
        }
        // A mesh whose factorisation needs too many operations is refused before its memory is allocated.
        let method = (Method::from(Bilaplacian::default()), 0);
        let scene = Scene::new(shapes::tangle(170), &method);
        let (bound, peak, _) = scene.bind(PLENTY);
        bound.unwrap();
        let (refused, least, _) = scene.bind(Budget {
            operations: 0,
            ..PLENTY
        });
        assert!(
            matches!(
                refused,
                Err(BindError::Budget {
                    limit: Limit::Operations(_),
                    ..
                })
            ),
            "{refused:?}"
        );
        assert!(least < peak, "{least} {peak}");
    });
}

//! Seeded random trials of all inputs of a problem, on any mesh: options, roles, stiffness, transforms.
//!
//! A trial ends with a shape that is finite and meets its constraints, or with a refusal that names a vertex.

use std::collections::BTreeMap;

use glam::{DAffine3, DQuat, DVec3};
use pliant_deform::{
    Arap, ArapEnergy, Bilaplacian, BilaplacianOrder, ConstraintKind, Constraints, Discretisation, HandleFit, Loose,
    METHODS, Method, Needs, Ordering, Primo, Problem, Role, SolveError, TriangulationKind,
};
use pliant_mesh::{Cancel, Model, Progress};

/// The most steps towards the targets; nonlinear methods need not converge in them.
const STEPS: u32 = 12;

/// Frames of a drag, and the steps of the method in each.
const DRAG_FRAMES: u32 = 10;
const DRAG_STEPS: u32 = 3;

/// The end of a trial.
#[derive(Clone, PartialEq, Debug)]
pub enum Outcome {
    /// A shape that meets all requirements.
    Bent {
        /// The regularisation of its system, which is reported.
        regularised: Regularised,
        /// The number of solved vertices.
        solved_count: usize,
    },
    /// A refusal that names a vertex.
    Refused(String),
}

/// The need of regularisation: none if a system was factored without changes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Regularised {
    No,
    Yes,
}

/// A mesh with the orderings that its trials have needed so far.
pub struct Subject {
    pub name: String,
    pub model: std::sync::Arc<Model>,
    orderings: BTreeMap<u32, Ordering>,
}

impl Subject {
    pub fn new(name: impl Into<String>, model: std::sync::Arc<Model>) -> Self {
        let orderings = BTreeMap::new();
        Self {
            name: name.into(),
            model,
            orderings,
        }
    }

    fn ordering(&mut self, power: u32) -> &Ordering {
        let topology = &self.model.topology;
        self.orderings
            .entry(power)
            .or_insert_with(|| Ordering::of(topology, power, &Progress::new(), &Cancel::new()).unwrap())
    }
}

/// Every mesh in the folder of scans.
pub fn scans() -> Vec<Subject> {
    let Some(folder) = crate::datum("scans") else {
        return Vec::new();
    };
    let mut files: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    files.sort();
    let opened = files.into_iter().filter_map(|path| {
        let loaded = crate::try_open(&path).ok()?;
        Some(Subject::new(path.file_name()?.to_string_lossy(), loaded.model))
    });
    opened
        .filter(|subject| !subject.model.surface.triangles.is_empty())
        .collect()
}

/// Everything about a trial except the mesh.
#[derive(Clone, Debug)]
pub struct Trial {
    pub method: Method,
    roles: Vec<Role>,
    stiffness: Vec<f64>,
    soft: Vec<Option<f64>>,
    continuity: Vec<f64>,
    loose: Loose,
    aims: Vec<Aim>,
}

impl Trial {
    /// Trial number `seed` on `model`, which is always the same.
    pub fn new(seed: u64, model: &Model) -> Self {
        Self::with(seed, model, None)
    }

    /// The same trial with the method called `name`, if one is given. Options of ARAP and PriMo are random.
    pub fn with(seed: u64, model: &Model, name: Option<&str>) -> Self {
        let chance = &mut Chance(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ 0x5DEE_CE66);
        let count = model.surface.positions.len();
        let diagonal = model.bounds().unwrap().diagonal();
        let mut method = method(chance);
        if let Some(name) = name {
            method = Method::from_name(name).unwrap();
        }
        if let Some(mut options) = method.options::<Arap>().cloned() {
            options.energy = ArapEnergy::ALL[chance.below(ArapEnergy::ALL.len())];
            method = options.into();
        } else if let Some(mut options) = method.options::<Primo>().cloned() {
            options.thickness = 10_f64.powf(chance.between(-3.0, 0.0));
            method = options.into();
        }
        let ball = |chance: &mut Chance, radius: f64| around(model, diagonal, chance.below(count), radius);
        let (roles, handle_count) = random_roles(model, diagonal, chance);
        let mut stiffness = vec![1.0; count];
        if chance.share() < 0.4 {
            for _ in 0..1 + chance.below(3) {
                let (radius, value) = (chance.between(0.02, 0.3), 10_f64.powf(chance.between(-3.0, 3.0)));
                let patch = ball(chance, radius);
                for (own, &position) in stiffness.iter_mut().zip(&model.surface.positions) {
                    if patch(position) {
                        *own = value;
                    }
                }
            }
        }
        let soft = (0..handle_count)
            .map(|_| (chance.share() < 0.25).then(|| 10_f64.powf(chance.between(-4.0, 5.0))))
            .collect();
        let mut continuity = Vec::new();
        if chance.share() < 0.3 {
            let values = [0.0, 0.5, 1.0, 1.7, 2.0];
            let (near, far) = (values[chance.below(5)], values[chance.below(5)]);
            let radius = chance.between(0.1, 0.5);
            let patch = ball(chance, radius);
            continuity = model
                .surface
                .positions
                .iter()
                .map(|&p| if patch(p) { near } else { far })
                .collect();
        }
        let centre = model.bounds().unwrap().centre();
        let aims = (0..handle_count).map(|_| Aim::new(chance, centre, diagonal)).collect();
        Self {
            method,
            roles,
            stiffness,
            soft,
            continuity,
            loose: if chance.share() < 0.5 {
                Loose::Follow
            } else {
                Loose::Rest
            },
            aims,
        }
    }

    /// Binds and steps to the handles' targets. Panics unless the result is a sound shape or a refusal that names a
    /// vertex.
    pub fn run(&self, subject: &mut Subject) -> Outcome {
        self.go(subject, &[1.0], STEPS, &mut |_| {})
    }

    /// Binds and follows the handles along their paths, a few steps per frame. Panics like [`Trial::run`], and if a
    /// step raises the energy. Calls `drawn` with each frame's number as soon as the frame has its shape.
    pub fn drag(&self, subject: &mut Subject, drawn: &mut dyn FnMut(usize)) -> Outcome {
        let way: Vec<f64> = (0..=DRAG_FRAMES)
            .map(|frame| f64::from(frame) / f64::from(DRAG_FRAMES))
            .collect();
        self.go(subject, &way, DRAG_STEPS, drawn)
    }

    fn go(&self, subject: &mut Subject, way: &[f64], steps: u32, drawn: &mut dyn FnMut(usize)) -> Outcome {
        let model = std::sync::Arc::clone(&subject.model);
        let problem = Problem {
            surface: &model.surface,
            topology: &model.topology,
            roles: &self.roles,
            handle_count: self.aims.len(),
            stiffness: &self.stiffness,
            constraints: Constraints {
                soft: &self.soft,
                continuity: &self.continuity,
                parts: &[],
                sections: &[],
            },
            loose: self.loose,
            method: &self.method,
            attachments: &[],
            revision: 0,
        };
        let ordering = self.method.ordering_power().map(|power| subject.ordering(power));
        let mut bound = match problem.bind(ordering, &Progress::new(), &Cancel::new()) {
            Ok(bound) => bound,
            Err(error) => {
                let sentence = error.to_string();
                let Some(vertex) = error.vertex() else {
                    panic!("{sentence}")
                };
                assert!(
                    (vertex as usize) < self.roles.len() && sentence.contains(&vertex.to_string()),
                    "{sentence}"
                );
                return Outcome::Refused(sentence);
            }
        };
        let mut displacements = vec![DVec3::NAN; bound.vertex_count()];
        for (frame, &share) in way.iter().enumerate() {
            let targets: Vec<DAffine3> = self.aims.iter().map(|aim| aim.at(share)).collect();
            bound.set_targets(&targets).unwrap();
            let mut last = f64::INFINITY;
            for _ in 0..steps {
                match bound.step(&mut displacements) {
                    Ok(step) => {
                        let energy = step.energy;
                        assert!(
                            energy >= 0.0 && energy.is_finite() && energy <= last,
                            "an energy of {energy} after {last}"
                        );
                        last = energy;
                        if step.finished {
                            break;
                        }
                    }
                    Err(error @ (SolveError::Inaccurate { .. } | SolveError::NotFinite { .. })) => {
                        assert!(displacements.iter().all(|d| *d == DVec3::ZERO));
                        return Outcome::Refused(error.to_string());
                    }
                    Err(error) => panic!("{error}"),
                }
            }
            drawn(frame);
            self.check(&model, &targets, &displacements);
        }
        let is_regularised = bound.warnings().iter().any(|said| said.contains("stiffened"));
        Outcome::Bent {
            regularised: if is_regularised {
                Regularised::Yes
            } else {
                Regularised::No
            },
            solved_count: bound.solved_count(),
        }
    }

    fn check(&self, model: &Model, targets: &[DAffine3], displacements: &[DVec3]) {
        let holds_softly = self.method.declaration().heeds(ConstraintKind::SoftHandles);
        let holds_exactly = self.method.handle_fit() == HandleFit::Exact;
        let size = model.bounds().unwrap().diagonal();
        for ((role, rest), displacement) in self.roles.iter().zip(&model.surface.positions).zip(displacements) {
            assert!(displacement.is_finite(), "{displacement}");
            match *role {
                Role::Fixed => assert_eq!(*displacement, DVec3::ZERO, "what is fixed has moved"),
                Role::Handle(handle)
                    if holds_exactly && (self.soft[usize::from(handle)].is_none() || !holds_softly) =>
                {
                    let wanted = targets[usize::from(handle)].transform_point3(*rest) - *rest;
                    let apart = displacement.distance(wanted);
                    assert!(
                        apart < 1e-9 * (size + wanted.length() + rest.length()),
                        "a handle is {apart} off"
                    );
                }
                Role::Handle(_) | Role::Free => {}
            }
        }
    }
}

/// Returns true if a position is within `radius` diagonals of a vertex.
fn around(model: &Model, diagonal: f64, centre: usize, radius: f64) -> impl Fn(DVec3) -> bool + use<> {
    let centre = model.surface.positions[centre];
    move |p: DVec3| p.distance(centre) <= radius * diagonal
}

/// The role of each vertex, and the number of handles.
fn random_roles(model: &Model, diagonal: f64, chance: &mut Chance) -> (Vec<Role>, u16) {
    let count = model.surface.positions.len();
    let ball = |chance: &mut Chance, radius: f64| around(model, diagonal, chance.below(count), radius);
    let mut roles = vec![Role::Free; count];
    let assign = |roles: &mut [Role], role: Role, within: &dyn Fn(DVec3) -> bool| {
        for (own, &position) in roles.iter_mut().zip(&model.surface.positions) {
            if within(position) {
                *own = role;
            }
        }
    };
    // A free region like a person's, in most trials, and a few patches that are fixed.
    if chance.share() < 0.8 {
        let radius = chance.between(0.02, 0.35);
        let region = ball(chance, radius);
        assign(&mut roles, Role::Fixed, &|p| !region(p));
    }
    for _ in 0..chance.below(3) {
        let radius = chance.between(0.0, 0.2);
        assign(&mut roles, Role::Fixed, &ball(chance, radius));
    }
    // Handles are placed where vertices are free, so that there is something to solve for.
    let wanted = 1 + chance.below(3) as u16;
    for handle in 0..wanted {
        let free: Vec<usize> = (0..count).filter(|&vertex| roles[vertex] == Role::Free).collect();
        let centre = if free.is_empty() {
            chance.below(count)
        } else {
            free[chance.below(free.len())]
        };
        let radius = if chance.share() < 0.2 {
            0.0
        } else {
            chance.between(0.005, 0.1)
        };
        assign(
            &mut roles,
            Role::Handle(handle),
            &around(model, diagonal, centre, radius),
        );
    }
    let handle_count = without_covered(&mut roles, wanted);
    (roles, handle_count)
}

/// Renumbers the handles, of `count`, that no later one covers completely, and returns their number.
fn without_covered(roles: &mut [Role], count: u16) -> u16 {
    let mut numbers: Vec<Option<u16>> = vec![None; usize::from(count)];
    let mut next = 0;
    for role in roles {
        if let Role::Handle(handle) = role {
            let number = numbers[usize::from(*handle)].get_or_insert_with(|| {
                next += 1;
                next - 1
            });
            *role = Role::Handle(*number);
        }
    }
    next
}

fn method(chance: &mut Chance) -> Method {
    let share = chance.share();
    if share > 0.7 {
        // Any other surface method, with its default options.
        let others = METHODS[1..].iter().map(|declaration| (declaration.default)());
        let others: Vec<Method> = others.filter(|method| method.needs() != Needs::Points).collect();
        return others[chance.below(others.len())].clone();
    }
    let mut options = Bilaplacian::default();
    options.order = [
        BilaplacianOrder::ThinPlate,
        BilaplacianOrder::ThinPlate,
        BilaplacianOrder::Membrane,
        BilaplacianOrder::CurvatureVariation,
    ][chance.below(4)];
    if chance.share() < 0.4 {
        options.stretching = 10_f64.powf(chance.between(-3.0, 5.0));
        options.bending = if chance.share() < 0.2 {
            0.0
        } else {
            10_f64.powf(chance.between(-3.0, 3.0))
        };
    }
    if chance.share() < 0.4 {
        options.discretisation = Discretisation::ALL[chance.below(3)];
    }
    if chance.share() < 0.4 {
        options.triangulation = TriangulationKind::ALL[chance.below(3)];
    }
    if chance.share() < 0.4 {
        options.anisotropy = chance.share();
    }
    Method::from(options)
}

/// A handle's target: scaled and rotated about a centre by up to nearly half a turn, and translated by up to the
/// model's size; sometimes mirrored, shrunk to nothing or enlarged greatly.
#[derive(Clone, Debug)]
struct Aim {
    centre: DVec3,
    scale: DVec3,
    axis: DVec3,
    angle: f64,
    shift: DVec3,
}

impl Aim {
    fn new(chance: &mut Chance, centre: DVec3, diagonal: f64) -> Self {
        let direction = |chance: &mut Chance| {
            let mut axis = || chance.between(-1.0, 1.0);
            DVec3::new(axis(), axis(), axis()).normalize_or(DVec3::X)
        };
        let shift = direction(chance) * chance.between(0.0, 1.0) * diagonal;
        let (axis, angle) = (direction(chance), chance.between(-3.1, 3.1));
        let scale = match chance.below(8) {
            0 => DVec3::new(1.0, -0.5, 2.0),
            1 => DVec3::ZERO,
            2 => DVec3::splat(30.0),
            _ => DVec3::ONE,
        };
        Self {
            centre,
            scale,
            axis,
            angle,
            shift,
        }
    }

    /// The transform at a share of the path, from rest at 0 to the target at 1.
    fn at(&self, share: f64) -> DAffine3 {
        DAffine3::from_translation(self.centre + self.shift * share)
            * DAffine3::from_scale_rotation_translation(
                DVec3::ONE.lerp(self.scale, share),
                DQuat::from_axis_angle(self.axis, self.angle * share),
                DVec3::ZERO,
            )
            * DAffine3::from_translation(-self.centre)
    }
}

/// Pseudorandom numbers (Steele, Lea & Flood 2014, splitmix64), the same on every machine.
pub struct Chance(pub u64);

impl Chance {
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1).
    pub fn share(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + self.share() * (high - low)
    }

    /// Uniform in 0..`count`, which must not be 0.
    pub fn below(&mut self, count: usize) -> usize {
        (self.bits() % count as u64) as usize
    }

    /// True with probability 1/`count`.
    pub fn one_in(&mut self, count: usize) -> bool {
        self.below(count) == 0
    }

    /// A random element of a list that is not empty.
    pub fn of<'a, T>(&mut self, list: &'a [T]) -> &'a T {
        &list[self.below(list.len())]
    }
}

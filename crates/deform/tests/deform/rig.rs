//! A problem on a shape, and the verbs the laws need.

use glam::{DAffine3, DVec3};
use pliant_deform::{Attachment, Bound, Constraints, Loose, Method, Problem, Role};
use pliant_mesh::{Cancel, Drawn, DrawnVertex, Model, Progress, SurfaceVertex, shapes};

/// A shape and the roles, stiffness and options on it.
pub struct Scene {
    pub model: Model,
    pub roles: Vec<Role>,
    pub handle_count: usize,
    pub stiffness: Vec<f64>,
    pub soft: Vec<Option<f64>>,
    pub continuity: Vec<f64>,
    pub loose: Loose,
    pub parts: Vec<(u32, Loose)>,
    pub sections: Vec<u16>,
    pub method: Method,
    pub attachments: Vec<(&'static str, Attachment)>,
}

impl Scene {
    /// Everything free, no handle.
    pub fn new(drawn: Drawn) -> Self {
        let model = shapes::model(drawn);
        let count = model.surface.positions.len();
        Self {
            model,
            roles: vec![Role::Free; count],
            handle_count: 0,
            stiffness: vec![1.0; count],
            soft: Vec::new(),
            continuity: Vec::new(),
            loose: Loose::Follow,
            parts: Vec::new(),
            sections: Vec::new(),
            method: Method::default(),
            attachments: Vec::new(),
        }
    }

    /// Gives `role` to the vertices whose position passes `test`; handles are counted.
    pub fn with(mut self, role: Role, test: impl Fn(DVec3) -> bool) -> Self {
        for (own, &position) in self.roles.iter_mut().zip(&self.model.surface.positions) {
            if test(position) {
                *own = role;
            }
        }
        if let Role::Handle(handle) = role {
            self.handle_count = self.handle_count.max(usize::from(handle) + 1);
        }
        self
    }

    /// In every component, fixes the first vertices in x, y or z if `fixed`, and makes the last ones the handles 0 and
    /// 1 by turns.
    pub fn with_ends(mut self, fixed: bool) -> Self {
        for number in 0..self.model.topology.components().len() {
            let mut vertices: Vec<_> = self.model.topology.vertices_of(number as u32).collect();
            vertices.sort_by(|a, b| {
                let key = |v: &SurfaceVertex| self.model.surface.positions[v.index()].dot(DVec3::new(1.0, 0.31, 0.12));
                key(a).total_cmp(&key(b)).then(a.cmp(b))
            });
            let share = (vertices.len() / 6).max(1);
            for vertex in &vertices[vertices.len() - share..] {
                self.roles[vertex.index()] = Role::Handle((number % 2) as u16);
            }
            for vertex in &vertices[..share] {
                self.roles[vertex.index()] = if fixed { Role::Fixed } else { Role::Handle(1) };
            }
        }
        self.handle_count = 2;
        if !self.roles.contains(&Role::Handle(1)) {
            self.handle_count = 1;
        }
        self
    }

    pub fn bind(&self) -> Bound {
        self.try_bind().unwrap()
    }

    pub fn try_bind(&self) -> Result<Bound, pliant_deform::BindError> {
        let (topology, progress, cancel) = (&self.model.topology, Progress::new(), Cancel::new());
        let ordering = self.method.ordering(topology, &progress, &cancel).unwrap();
        self.problem(&self.method).bind(ordering.as_ref(), &progress, &cancel)
    }

    pub fn problem<'a>(&'a self, method: &'a Method) -> Problem<'a> {
        Problem {
            surface: &self.model.surface,
            topology: &self.model.topology,
            roles: &self.roles,
            handle_count: self.handle_count,
            stiffness: &self.stiffness,
            constraints: Constraints {
                soft: &self.soft,
                continuity: &self.continuity,
                parts: &self.parts,
                sections: &self.sections,
            },
            loose: self.loose,
            method,
            attachments: &self.attachments,
            revision: 7,
        }
    }

    /// Binds, moves the handles, and returns the displacements.
    pub fn moved(&self, targets: &[DAffine3]) -> Vec<DVec3> {
        step(&mut self.bind(), targets)
    }

    pub fn positions(&self) -> &[DVec3] {
        &self.model.surface.positions
    }

    /// The size of the bending part: √12 radii of gyration of the components with handles, by the middles of triangles'
    /// edges.
    pub fn size(&self) -> f64 {
        let topology = &self.model.topology;
        let mut bends = vec![false; topology.components().len()];
        for (vertex, role) in (0..).map(SurfaceVertex).zip(&self.roles) {
            bends[topology.component(vertex) as usize] |= matches!(role, Role::Handle(_));
        }
        let own = |corners: &&[SurfaceVertex; 3]| bends[topology.component(corners[0]) as usize];
        let (mut area, mut first, mut second) = (0.0, DVec3::ZERO, 0.0);
        for corners in self.model.surface.triangles.iter().filter(own) {
            let [a, b, c] = corners.map(|v| self.positions()[v.index()]);
            let third = pliant_mesh::face_area([a, b, c]) / 3.0;
            for middle in [a + b, b + c, c + a].map(|sum| 0.5 * sum) {
                area += third;
                first += middle * third;
                second += middle.length_squared() * third;
            }
        }
        (12.0 * (second / area - (first / area).length_squared())).sqrt()
    }

    pub fn diagonal(&self) -> f64 {
        self.model.bounds().unwrap().diagonal()
    }
}

pub fn step(bound: &mut Bound, targets: &[DAffine3]) -> Vec<DVec3> {
    let mut displacements = vec![DVec3::NAN; bound.vertex_count()];
    bound.set_targets(targets).unwrap();
    let step = bound.step(&mut displacements).unwrap();
    assert!(step.converged && step.energy >= 0.0 && step.energy.is_finite());
    displacements
}

pub fn back_substitute(bound: &mut Bound, targets: &[DAffine3]) -> Vec<DVec3> {
    let mut displacements = vec![DVec3::NAN; bound.vertex_count()];
    bound.set_targets(targets).unwrap();
    bound.step_by_back_substitution(&mut displacements).unwrap();
    displacements
}

/// The largest distance between two fields.
pub fn apart(a: &[DVec3], b: &[DVec3]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
}

/// A rotation about `centre` by `angle_rad` about a slanted axis, then a translation.
pub fn turned(centre: DVec3, angle_rad: f64, shift: DVec3) -> DAffine3 {
    DAffine3::from_translation(centre + shift)
        * DAffine3::from_axis_angle(DVec3::new(0.6, 0.48, 0.64), angle_rad)
        * DAffine3::from_translation(-centre)
}

/// Steps until finished; the last displacements and every step's energy.
pub fn settle(bound: &mut Bound, targets: &[DAffine3]) -> (Vec<DVec3>, Vec<f64>) {
    let mut displacements = vec![DVec3::NAN; bound.vertex_count()];
    bound.set_targets(targets).unwrap();
    let mut energies = Vec::new();
    loop {
        let step = bound.step(&mut displacements).unwrap();
        energies.push(step.energy);
        assert!(step.energy >= 0.0 && step.energy.is_finite());
        assert!(displacements.iter().all(|d| d.is_finite()));
        if step.finished {
            return (displacements, energies);
        }
    }
}

/// Scales about `centre`.
pub fn scaled(centre: DVec3, scale: DVec3) -> DAffine3 {
    DAffine3::from_translation(centre) * DAffine3::from_scale(scale) * DAffine3::from_translation(-centre)
}

/// Turns and moves each handle differently, by about half a turn and half the size.
pub fn far(scene: &Scene) -> Vec<DAffine3> {
    let (centre, size) = (scene.model.bounds().unwrap().centre(), scene.diagonal());
    (0..scene.handle_count)
        .map(|h| turned(centre, 1.5 + h as f64, DVec3::new(0.3, -0.2, 0.1 * h as f64) * size))
        .collect()
}

/// The mirror image in x.
pub fn mirrored(drawn: &Drawn) -> Drawn {
    let mut image = drawn.clone();
    for p in &mut image.positions {
        p.x = -p.x;
    }
    for corners in &mut image.triangles {
        let [a, b, c]: [DrawnVertex; 3] = *corners;
        *corners = [a, c, b];
    }
    image
}

/// Gaussian elimination with row pivoting.
pub fn eliminated(mut a: Vec<Vec<f64>>, mut b: Vec<DVec3>) -> Vec<DVec3> {
    let size = b.len();
    for k in 0..size {
        let pivot = (k..size)
            .max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs()))
            .unwrap();
        a.swap(k, pivot);
        b.swap(k, pivot);
        for row in k + 1..size {
            let factor = a[row][k] / a[k][k];
            for column in k..size {
                a[row][column] -= factor * a[k][column];
            }
            let above = b[k];
            b[row] -= above * factor;
        }
    }
    for k in (0..size).rev() {
        let known: DVec3 = (k + 1..size).map(|column| b[column] * a[k][column]).sum();
        b[k] = (b[k] - known) / a[k][k];
    }
    b
}

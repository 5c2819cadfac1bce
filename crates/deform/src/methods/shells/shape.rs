//! The positions of the vertices, their energy, and its gradient.

use glam::DVec3;
use pliant_mesh::face_area;
use rayon::prelude::*;

use super::Shells;
use super::elements::{Edge, Elements, Face, Hinge};
use super::enclosed::Enclosed;
use super::examples::Examples;
use super::face::{self, Barrier};
use super::frames::Frame;
use super::hinge;
use super::springs::springs;
use crate::descent::springs::Springs;
use crate::handles::Handle;
use crate::numerical::lists::Lists;
use crate::numerical::rows::CHUNK;
use crate::numerical::sums::{CHUNKS_A_TASK, Field};
use crate::region::boundary_problem::BoundaryProblem;
use crate::region::partition::Partition;

/// The resistance to a rigid motion by the diagonal within a step where nothing else resists, in units of stretching.
const INERTIA: f64 = 1e-6;

/// A shape. Angles, weights and energy are valid after an evaluation of the displacements.
#[derive(Clone, Debug)]
pub(super) struct Shape {
    /// The displacement of each local vertex, in world units.
    pub displacements: Vec<DVec3>,
    /// θ of each hinge. An evaluation takes the angles nearest to their earlier values.
    pub angles_rad: Vec<f64>,
    /// The weights of the examples: an evaluation finds the free ones.
    pub weights: Vec<f64>,
    /// E, in squared world units.
    pub energy: f64,
}

impl Shape {
    /// Moves the first vertices by `share` times a field.
    pub fn move_by(&mut self, field: &Field, share: f64) {
        self.displacements[..field.len()]
            .par_iter_mut()
            .zip(field)
            .with_min_len(CHUNK)
            .for_each(|(displacement, field)| *displacement += DVec3::from_array(*field) * share);
    }
}

/// Everything that has an energy.
#[derive(Debug)]
pub(super) struct Energy {
    pub elements: Elements,
    pub enclosed: Enclosed,
    pub examples: Examples,
    pub springs: Springs<f64>,
    /// Components that only examples move.
    pub frames: Vec<Frame>,
    /// The addition to the matrices' diagonal at these solved vertices, which belong to `frames`: all together they may
    /// move rigidly without any energy.
    pub inertia: Vec<(u32, f64)>,
    /// The factor that makes the energy a number without unit: one over the area.
    pub unit: f64,
    /// For each solved vertex: its edges, doubled, plus the number of its end.
    edges_at: Lists,
    /// For each solved vertex: its hinges, four times, plus the number of its corner.
    hinges_at: Lists,
    /// For each solved vertex: its triangles, four times, plus the number of its corner.
    faces_at: Lists,
}

/// The residuals' gradients at a shape.
#[derive(Debug, Default)]
pub(super) struct Slopes {
    /// For each edge the unit vector from its first end to the second.
    pub edges: Vec<DVec3>,
    /// For each hinge the gradient of its angle at its corners.
    pub hinges: Vec<[DVec3; 4]>,
    /// For each triangle the gradient of its area at its corners.
    pub faces: Vec<[DVec3; 3]>,
    /// The second derivative of each triangle's energy by its area.
    pub face_weights: Vec<f64>,
    /// For each solved vertex the gradient of its component's volume; empty if no volume counts.
    pub volume: Field,
    /// The gradient of the energy at the solved vertices.
    pub energy: Field,
}

impl Energy {
    /// Makes the energy of these elements and of the volumes and soft handles.
    pub fn of(
        problem: &BoundaryProblem,
        options: &Shells,
        partition: &Partition,
        handles: &[Handle],
        mut elements: Elements,
    ) -> Self {
        let enclosed = Enclosed::of(problem, options, &mut elements);
        let examples = Examples::of(problem.examples, &elements, &enclosed);
        for (number, face) in elements.faces.iter_mut().enumerate() {
            face.least += examples.least_area(number);
        }
        let (frames, inertia) = loose(problem, partition, &elements, &examples);
        let count = elements.solved_count;
        let ends = (0..).zip(&elements.edges);
        let ends = ends.flat_map(|(edge, Edge { ends, .. })| [(ends[0], 2 * edge), (ends[1], 2 * edge + 1)]);
        let corners = (0..).zip(&elements.hinges);
        let corners = corners.flat_map(|(hinge, Hinge { corners, .. })| {
            [0, 1, 2, 3].map(|corner| (corners[corner as usize], 4 * hinge + corner))
        });
        let of_faces = (0..).zip(&elements.faces);
        let of_faces = of_faces.flat_map(|(face, Face { corners, .. })| {
            [0, 1, 2].map(|corner| (corners[corner as usize], 4 * face + corner))
        });
        let is_solved = |(vertex, _): &(u32, u32)| (*vertex as usize) < count;
        Self {
            faces_at: Lists::of(count, of_faces.filter(is_solved)),
            edges_at: Lists::of(count, ends.filter(is_solved)),
            hinges_at: Lists::of(count, corners.filter(is_solved)),
            enclosed,
            examples,
            frames,
            inertia,
            springs: springs(problem, options, partition, handles, &elements),
            unit: if elements.area > 0.0 {
                elements.area.recip()
            } else {
                0.0
            },
            elements,
        }
    }

    /// The rest shape.
    pub fn at_rest(&self) -> Shape {
        let mut shape = Shape {
            displacements: vec![DVec3::ZERO; self.elements.vertices.len()],
            angles_rad: Vec::new(),
            weights: vec![0.0; self.examples.count()],
            energy: 0.0,
        };
        self.rest(&mut shape);
        shape
    }

    /// Makes a shape the rest shape.
    pub fn rest(&self, shape: &mut Shape) {
        shape.displacements.fill(DVec3::ZERO);
        shape.weights.fill(0.0);
        self.relax_angles(shape);
        shape.energy = 0.0;
    }

    /// Forgets the whole turns of the hinges: the next evaluation takes the angles nearest to those of the shape's
    /// weights.
    pub fn relax_angles(&self, shape: &mut Shape) {
        let Shape {
            angles_rad, weights, ..
        } = shape;
        angles_rad.clear();
        let hinges = self.elements.hinges.iter().enumerate();
        angles_rad.extend(hinges.map(|(place, hinge)| hinge.angle_rad + self.examples.angle_rad(place, weights)));
    }

    /// The edges that end at a solved vertex, doubled, plus the number of the end.
    pub fn edges_at(&self, vertex: usize) -> &[u32] {
        self.edges_at.at(vertex)
    }

    /// The hinges with a corner at a solved vertex, four times, plus the number of the corner.
    pub fn hinges_at(&self, vertex: usize) -> &[u32] {
        self.hinges_at.at(vertex)
    }

    /// The triangles with a corner at a solved vertex, four times, plus the number of the corner.
    pub fn faces_at(&self, vertex: usize) -> &[u32] {
        self.faces_at.at(vertex)
    }

    /// An edge's length, and the derivative of its energy by it.
    pub fn edge_at(&self, shape: &Shape, place: usize) -> (f64, f64) {
        let edge = &self.elements.edges[place];
        let [a, b] = edge.ends.map(|local| self.position(shape, local));
        let length = a.distance(b);
        let stretched = length - edge.length - self.examples.length(place, &shape.weights);
        (length, edge.weight * stretched)
    }

    /// A triangle's corners and area, and the derivative of its energy by the area.
    pub fn face_at(&self, shape: &Shape, place: usize) -> ([DVec3; 3], f64, f64) {
        let own = &self.elements.faces[place];
        let corners = own.corners.map(|local| self.position(shape, local));
        let area = face_area(corners);
        let grown = area - own.area - self.examples.area(place, &shape.weights);
        (corners, area, own.weight * grown + Barrier::of(own, area).slope)
    }

    /// A hinge's corners, and the derivative of its energy by the angle, which an evaluation has found.
    pub fn hinge_at(&self, shape: &Shape, place: usize) -> ([DVec3; 4], f64) {
        let hinge = &self.elements.hinges[place];
        let corners = hinge.corners.map(|local| self.position(shape, local));
        (corners, self.moment_at(shape, place))
    }

    /// The derivative of a hinge's energy by its angle.
    fn moment_at(&self, shape: &Shape, place: usize) -> f64 {
        let hinge = &self.elements.hinges[place];
        let bent = shape.angles_rad[place] - hinge.angle_rad - self.examples.angle_rad(place, &shape.weights);
        hinge.weight * bent
    }

    fn position(&self, shape: &Shape, local: u32) -> DVec3 {
        self.elements.rest[local as usize] + shape.displacements[local as usize]
    }

    /// The addition to a matrix' diagonal at each solved vertex: the springs, and the inertia of components that
    /// nothing holds.
    pub fn on_diagonal(&self) -> impl Iterator<Item = (u32, f64)> + '_ {
        let springs = self.springs.all().iter().map(|spring| (spring.local, spring.strength));
        springs.chain(self.inertia.iter().copied())
    }

    /// Finds the angles, the weights and the energy with these springs.
    pub fn evaluate(&self, shape: &mut Shape, springs: &Springs<f64>) {
        let (elements, examples) = (&self.elements, &self.examples);
        if examples.are_free() {
            self.follow_angles(shape);
        }
        let Shape {
            displacements,
            angles_rad,
            weights,
            ..
        } = &mut *shape;
        examples.weigh(elements, &self.enclosed, displacements, angles_rad, weights);
        let (displacements, weights) = (&shape.displacements, &shape.weights);
        let at = |local: u32| elements.rest[local as usize] + displacements[local as usize];
        let mut energy = partial_sums(&elements.edges, |place, edge| {
            let [a, b] = edge.ends.map(at);
            edge.weight * (a.distance(b) - edge.length - examples.length(place, weights)).powi(2)
        });
        energy += partial_sums(&elements.faces, |place, own| {
            let area = face_area(own.corners.map(at));
            own.weight * (area - own.area - examples.area(place, weights)).powi(2) + 2.0 * Barrier::of(own, area).energy
        });
        let bent: Vec<f64> = shape
            .angles_rad
            .par_chunks_mut(CHUNK)
            .zip(elements.hinges.par_chunks(CHUNK))
            .enumerate()
            .with_min_len(CHUNKS_A_TASK)
            .map(|(chunk, (angles, hinges))| {
                let mut sum = 0.0;
                for (place, (angle, hinge)) in (chunk * CHUNK..).zip(angles.iter_mut().zip(hinges)) {
                    *angle = hinge::unwrapped(hinge::angle_rad(hinge.corners.map(at)), *angle);
                    sum += hinge.weight * (*angle - hinge.angle_rad - examples.angle_rad(place, weights)).powi(2);
                }
                sum
            })
            .collect();
        energy += bent.iter().sum::<f64>();
        for (number, part) in self.enclosed.parts.iter().enumerate() {
            energy += part.weight * (part.volume_at(&at) - part.volume - examples.volume(number, weights)).powi(2);
        }
        shape.energy =
            0.5 * energy + examples.energy(weights) + springs.added_energy(0.0, |vertex| shape.displacements[vertex]);
    }

    /// Finds the angles.
    fn follow_angles(&self, shape: &mut Shape) {
        let (elements, displacements) = (&self.elements, &shape.displacements);
        let at = |local: u32| elements.rest[local as usize] + displacements[local as usize];
        shape
            .angles_rad
            .par_iter_mut()
            .zip(&elements.hinges)
            .with_min_len(CHUNK)
            .for_each(|(angle, hinge)| *angle = hinge::unwrapped(hinge::angle_rad(hinge.corners.map(at)), *angle));
    }

    /// Finds the gradients at an evaluated shape.
    pub fn find_slopes(&self, shape: &Shape, slopes: &mut Slopes) {
        let (elements, examples) = (&self.elements, &self.examples);
        let (displacements, weights) = (&shape.displacements, &shape.weights);
        let at = |local: u32| elements.rest[local as usize] + displacements[local as usize];
        let along = |edge: &Edge| {
            let [a, b] = edge.ends.map(at);
            (b - a).try_normalize().unwrap_or_default()
        };
        let (edges, hinges, faces) = (&elements.edges, &elements.hinges, &elements.faces);
        edges
            .par_iter()
            .with_min_len(CHUNK)
            .map(along)
            .collect_into_vec(&mut slopes.edges);
        let turning = |hinge: &Hinge| hinge::gradient(hinge.corners.map(at));
        hinges
            .par_iter()
            .with_min_len(CHUNK)
            .map(turning)
            .collect_into_vec(&mut slopes.hinges);
        let growing = |own: &Face| face::gradient(own.corners.map(at));
        faces
            .par_iter()
            .with_min_len(CHUNK)
            .map(growing)
            .collect_into_vec(&mut slopes.faces);
        let firmness = |own: &Face| own.weight + Barrier::of(own, face_area(own.corners.map(at))).curvature;
        faces
            .par_iter()
            .with_min_len(CHUNK)
            .map(firmness)
            .collect_into_vec(&mut slopes.face_weights);
        slopes.volume.clear();
        let mut pressures = vec![];
        if !self.enclosed.parts.is_empty() {
            slopes.volume.resize(elements.solved_count, [0.0; 3]);
        }
        for (number, part) in self.enclosed.parts.iter().enumerate() {
            part.add_gradient(&at, &mut slopes.volume);
            pressures.push(part.weight * (part.volume_at(&at) - part.volume - examples.volume(number, weights)));
        }
        let (along, turning, growing) = (&slopes.edges, &slopes.hinges, &slopes.faces);
        (0..elements.solved_count)
            .into_par_iter()
            .with_min_len(CHUNK)
            .map(|vertex| {
                let mut sum = DVec3::ZERO;
                for &entry in self.edges_at(vertex) {
                    let place = entry as usize / 2;
                    let pull = along[place] * self.edge_at(shape, place).1;
                    sum += if entry % 2 == 0 { -pull } else { pull };
                }
                for &entry in self.hinges_at(vertex) {
                    let (place, corner) = (entry as usize / 4, entry as usize % 4);
                    sum += turning[place][corner] * self.moment_at(shape, place);
                }
                for &entry in self.faces_at(vertex) {
                    let (place, corner) = (entry as usize / 4, entry as usize % 4);
                    sum += growing[place][corner] * self.face_at(shape, place).2;
                }
                sum.to_array()
            })
            .collect_into_vec(&mut slopes.energy);
        for (part, pressure) in self.enclosed.parts.iter().zip(pressures) {
            for &vertex in &part.solved {
                let slope = slopes.volume[vertex as usize];
                let own = &mut slopes.energy[vertex as usize];
                own.iter_mut()
                    .zip(slope)
                    .for_each(|(own, slope)| *own += pressure * slope);
            }
        }
        self.springs
            .add_gradient(|vertex| displacements[vertex], &mut slopes.energy);
    }
}

/// Sums `of` over all items, with the same result on any number of threads.
fn partial_sums<T: Sync>(each: &[T], of: impl Fn(usize, &T) -> f64 + Sync) -> f64 {
    let sums: Vec<f64> = each
        .par_chunks(CHUNK)
        .enumerate()
        .with_min_len(CHUNKS_A_TASK)
        .map(|(number, chunk)| (number * CHUNK..).zip(chunk).map(|(place, own)| of(place, own)).sum())
        .collect();
    sums.iter().sum()
}

/// The components that nothing holds, and their vertices' additions to the diagonal.
fn loose(
    problem: &BoundaryProblem,
    partition: &Partition,
    elements: &Elements,
    examples: &Examples,
) -> (Vec<Frame>, Vec<(u32, f64)>) {
    if examples.count() == 0 {
        return (Vec::new(), Vec::new());
    }
    let mut masses = vec![0.0; elements.vertices.len()];
    for edge in &elements.edges {
        let mass = 0.5 * edge.weight * edge.length * edge.length;
        edge.ends.iter().for_each(|&end| masses[end as usize] += mass);
    }
    let frames = Frame::all(problem, partition, elements, &examples.displacements, &masses);
    let unit = INERTIA / problem.size().powi(2).max(f64::MIN_POSITIVE);
    let vertices = frames.iter().flat_map(|frame| frame.vertices());
    let inertia = vertices.map(|&local| (local, unit * masses[local as usize])).collect();
    (frames, inertia)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use glam::{DAffine3, DVec3};
    use pliant_mesh::{Cancel, Drawn, Progress, shapes};

    use super::super::{Descent, Shells, ShellsSolver};
    use super::Slopes;
    use crate::handles::Handle;
    use crate::region::boundary_problem::BoundaryProblem;
    use crate::{Constraints, ExampleShape, Examples, Method, Role};

    fn noise(k: usize) -> f64 {
        2.0 * ((k as f64 * 12.9898).sin() * 43_758.545).fract() - 1.0
    }

    /// Makes a solver for an unevenly stiff shape: its lowest part is fixed, its highest part is a soft handle, and
    /// each weight has an example.
    fn solver(drawn: Drawn, weights: &[Option<f64>]) -> ShellsSolver {
        let model = shapes::model(drawn);
        let bounds = model.bounds().unwrap();
        let positions = &model.surface.positions;
        let role = |p: &DVec3| match (p.z - bounds.min.z) / bounds.extent().z {
            h if h > 0.85 => Role::Handle(0),
            h if h < 0.15 => Role::Fixed,
            _ => Role::Free,
        };
        let roles: Vec<Role> = positions.iter().map(role).collect();
        let stiffness: Vec<f64> = (0..roles.len()).map(|v| 1.0 + (v % 5) as f64).collect();
        let options = Shells {
            volume: 3.0,
            bending: 0.01,
            ..Shells::default()
        };
        let example = |number: usize| ExampleShape {
            name: String::new(),
            displacements: std::sync::Arc::new(
                positions
                    .iter()
                    .map(|p| {
                        let turn = glam::DQuat::from_rotation_x(p.z + 0.3 * number as f64);
                        turn * *p * (1.0 + 0.1 * p.x) - *p
                    })
                    .collect(),
            ),
        };
        let examples = Examples {
            shapes: std::sync::Arc::new((0..weights.len()).map(example).collect()),
            weights: weights.to_vec(),
        };
        let method = Method::from(options.clone());
        let problem = BoundaryProblem {
            constraints: Constraints {
                soft: &[Some(0.5)],
                ..Constraints::default()
            },
            examples: Some(&examples),
            ..BoundaryProblem::new((&model.surface, &model.topology), &roles, &stiffness)
        };
        let partition = method.partition(&problem).unwrap();
        let handles = [Handle::new(partition.handles[0].clone(), positions)];
        let mut solver = ShellsSolver::bind(
            &problem,
            &options,
            &partition,
            &handles,
            &Progress::new(),
            &Cancel::new(),
        )
        .unwrap();
        let target = DAffine3::from_translation(DVec3::new(0.4, 0.1, 0.3)) * DAffine3::from_rotation_x(1.0);
        solver.energy.springs.aim(&[handles[0].motion(&target)]);
        solver.give(weights);
        solver
    }

    #[test]
    fn the_gradient_is_the_slope_of_the_energy() {
        let drawn = [shapes::icosphere(2), shapes::torus(12, 8), shapes::non_manifold_fan(7)];
        let given = [Some(0.4), Some(-0.7)];
        let cases = drawn.map(|drawn| (drawn, &[][..])).into_iter();
        let led = [&given[..], &[None, None], &[None, Some(0.4), None]];
        for (drawn, weights) in cases.chain(led.map(|weights| (shapes::torus(12, 8), weights))) {
            let solver = solver(drawn, weights);
            let energy = &solver.energy;
            let mut shape = energy.at_rest();
            for (vertex, displacement) in shape.displacements.iter_mut().enumerate() {
                *displacement = DVec3::new(noise(3 * vertex), noise(3 * vertex + 1), noise(3 * vertex + 2)) * 0.05;
            }
            energy.evaluate(&mut shape, &energy.springs);
            let mut slopes = Slopes::default();
            energy.find_slopes(&shape, &mut slopes);
            let largest = slopes
                .energy
                .as_flattened()
                .iter()
                .fold(0.0, |a: f64, b| a.max(b.abs()));
            assert!(largest > 1e-3);
            for vertex in (0..energy.elements.solved_count).step_by(5) {
                for axis in 0..3 {
                    let at = |step: f64| {
                        let mut moved = shape.clone();
                        moved.displacements[vertex][axis] += step;
                        energy.evaluate(&mut moved, &energy.springs);
                        moved.energy
                    };
                    let slope = (at(1e-6) - at(-1e-6)) / 2e-6;
                    let error = (slope - slopes.energy[vertex][axis]).abs() / largest;
                    assert!(error < 1e-6, "{vertex} {axis}: {error:e}");
                }
            }
        }
    }

    /// It agrees to first order; the rest is of second order in the length.
    #[test]
    fn at_rest_the_matrix_is_the_second_derivative() {
        let cases = [
            (shapes::icosphere(2), &[][..]),
            (shapes::torus(12, 8), &[]),
            (shapes::torus(12, 8), &[None]),
            (shapes::icosphere(2), &[None, Some(0.0), None]),
        ];
        for (drawn, weights) in cases {
            let mut solver = solver(drawn, weights);
            solver.energy.springs.aim(&[crate::handles::Motion::default()]);
            let rest = solver.energy.at_rest();
            let mut slopes = Slopes::default();
            solver.energy.find_slopes(&rest, &mut slopes);
            let Some(Descent::Newton(system)) = &mut solver.descent else {
                unreachable!("a small surface")
            };
            system.factor(&solver.energy, &rest, &slopes, &Cancel::new()).unwrap();
            let length = 1e-7;
            let mut moved = rest;
            let count = solver.energy.elements.solved_count;
            for (vertex, displacement) in moved.displacements[..count].iter_mut().enumerate() {
                *displacement = DVec3::new(noise(3 * vertex), noise(3 * vertex + 1), noise(3 * vertex + 2)) * length;
            }
            solver.energy.evaluate(&mut moved, &solver.energy.springs);
            let volume = std::mem::take(&mut slopes.volume);
            solver.energy.find_slopes(&moved, &mut slopes);
            slopes.volume = volume;
            let mut back = slopes.energy.clone();
            system.apply(&solver.energy, &slopes, &mut back);
            for (own, moved) in back.iter().zip(&moved.displacements) {
                let error = (DVec3::from_array(*own) - *moved).length() / length;
                assert!(error < 1e-3, "{error:e}");
            }
        }
    }
}

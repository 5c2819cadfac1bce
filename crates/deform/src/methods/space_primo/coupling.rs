//! The joints between cells, and the springs that tie cells to constrained vertices.

use std::collections::BTreeMap;

use glam::{DMat3, DVec3};

use super::octree::Octree;
use crate::Role;
use crate::handles::Handle;
use crate::method::BindInput;
use crate::methods::primo::joints::{Joints, Side};
use crate::space::joining::joins;
use crate::space::shaping::shaping;
use crate::sparse::Elimination;
use crate::sparse::ordering::graph::elimination;

/// The stiffness of the spring between a cell and a hard handle or fixed vertices, relative to a joint between two
/// cells.
const TIED: f64 = 100.0;

/// The same for a soft handle of weight 1.
const SOFT: f64 = 1.0;

/// A patch: its area, its mean and the second moment about it.
#[derive(Clone, Copy, Debug)]
struct Patch {
    weight: f64,
    first: DVec3,
    second: DMat3,
}

impl Default for Patch {
    /// An empty patch: a matrix's own default is the identity.
    fn default() -> Self {
        Self {
            weight: 0.0,
            first: DVec3::ZERO,
            second: DMat3::ZERO,
        }
    }
}

impl Patch {
    /// Adds a piece of this weight about `middle`, with the second moment `spread` per weight. All are relative to an
    /// origin nearby.
    fn add(&mut self, weight: f64, middle: DVec3, spread: DMat3) {
        self.weight += weight;
        self.first += middle * weight;
        self.second += (spread + square(middle)) * weight;
    }

    fn middle(&self) -> DVec3 {
        self.first / self.weight
    }

    fn spread(&self) -> DMat3 {
        self.second * self.weight.recip() - square(self.middle())
    }
}

/// Joins the cells, which are renumbered in an order of elimination. Coordinates are relative to `world_origin`.
///
/// # Errors
/// It was cancelled.
pub(super) fn joined(
    octree: &mut Octree,
    input: &BindInput<'_>,
    world_origin: DVec3,
) -> Result<Joints, pliant_mesh::Cancelled> {
    let patches = patches(octree, world_origin);
    let pairs: Vec<[u32; 2]> = patches.iter().map(|(pair, _)| *pair).collect();
    let centres: Vec<DVec3> = (0..octree.cells.len())
        .map(|cell| octree.world_centre(cell) - world_origin)
        .collect();
    let loose = joins(&centres, &pairs);
    input.cancel.check()?;
    let mut neighbours = vec![Vec::new(); centres.len()];
    for [one, other] in pairs.iter().chain(&loose) {
        neighbours[*one as usize].push(*other);
        neighbours[*other as usize].push(*one);
    }
    let (mut offsets, mut list) = (vec![0], Vec::new());
    for own in &neighbours {
        list.extend_from_slice(own);
        offsets.push(list.len() as u32);
    }
    let Elimination { order, ends } = elimination(&offsets, &list, input.cancel)?;
    let stiffness = stiffness(octree, input, &neighbours);
    let mut number_of = vec![0; order.len()];
    for (number, &cell) in order.iter().enumerate() {
        number_of[cell as usize] = number;
    }
    octree.reorder(&order);
    let mut centres: Vec<DVec3> = order.iter().map(|&cell| centres[cell as usize]).collect();
    let stiffness: Vec<f64> = order.iter().map(|&cell| stiffness[cell as usize]).collect();
    let mut rows = vec![Vec::new(); order.len()];
    let side = octree.grid.world_side;
    let loose = loose.into_iter().map(|pair| {
        let middle = pair
            .iter()
            .map(|&cell| octree.world_centre(number_of[cell as usize]) - world_origin);
        let mut patch = Patch::default();
        patch.add(side * side, 0.5 * middle.sum::<DVec3>(), cube(side));
        // Joined as firmly as if they touched.
        (pair, patch, side)
    });
    let touching = patches.into_iter().map(|(pair, patch)| {
        let sizes = pair.map(|cell| octree.world_size(number_of[cell as usize]));
        (pair, patch, 0.5 * (sizes[0] + sizes[1]))
    });
    for (pair, patch, distance) in touching.chain(loose) {
        let [one, other] = pair.map(|cell| number_of[cell as usize]);
        let weight = patch.weight / distance * 0.5 * (stiffness[one] + stiffness[other]);
        for [own, beside] in [[one, other], [other, one]] {
            rows[own].push(Side {
                other: beside as u32,
                weight,
                own_arm: patch.middle() - centres[own],
                other_arm: patch.middle() - centres[beside],
                spread: patch.spread(),
            });
        }
    }
    let count = rows.len();
    centres.push(DVec3::ZERO);
    centres.extend(
        input
            .handles
            .iter()
            .map(|handle: &Handle| handle.world_centre - world_origin),
    );
    for ((cell, ground), (patch, firmness)) in ties(octree, input, world_origin) {
        rows[cell].push(Side {
            other: (count + ground) as u32,
            weight: firmness * side * stiffness[cell].max(1.0),
            own_arm: patch.middle() - centres[cell],
            other_arm: patch.middle() - centres[count + ground],
            spread: patch.spread(),
        });
    }
    let volume = (0..count).map(|cell| octree.world_size(cell).powi(3)).sum();
    Ok(Joints::of_rows(rows, centres, volume, ends))
}

/// The common faces, by the cells' present numbers.
fn patches(octree: &Octree, world_origin: DVec3) -> Vec<([u32; 2], Patch)> {
    let side = octree.grid.world_side;
    let mut patches: BTreeMap<[u32; 2], Patch> = BTreeMap::new();
    octree.faces(|pair, world_middle, axis| {
        let mut across = DVec3::splat(side * side / 12.0);
        across[axis] = 0.0;
        let patch = patches.entry(pair).or_default();
        patch.add(side * side, world_middle - world_origin, DMat3::from_diagonal(across));
    });
    patches.into_iter().collect()
}

/// The constrained vertices of each cell and ground, and the stiffness of the tie: ground 0 is that of fixed vertices,
/// then the handles.
fn ties(octree: &Octree, input: &BindInput<'_>, world_origin: DVec3) -> BTreeMap<(usize, usize), (Patch, f64)> {
    let problem = input.problem;
    let mut ties: BTreeMap<(usize, usize), (Patch, f64)> = BTreeMap::new();
    let at = |vertices: Vec<u32>| -> Vec<DVec3> {
        let places = vertices
            .into_iter()
            .map(|vertex| problem.surface.positions[vertex as usize]);
        places.collect()
    };
    let mut tie = |places: Vec<DVec3>, ground: usize, firmness: f64| {
        for position in places {
            if let Some(cell) = octree.cell_at(position) {
                let tie = ties
                    .entry((cell as usize, ground))
                    .or_insert((Patch::default(), firmness));
                // A vertex counts as a small ball, so that a single one turns its cell.
                tie.0
                    .add(1.0, position - world_origin, cube(0.5 * octree.grid.world_side));
            }
        }
    };
    let fixed = (0..problem.roles.len() as u32).filter(|&vertex| problem.roles[vertex as usize] == Role::Fixed);
    tie(at(shaping(problem, fixed)), 0, TIED);
    tie(octree.world_held().collect(), 0, TIED);
    for (number, (handle, soft)) in input.handles.iter().zip(&input.partition.soft).enumerate() {
        let firmness = soft.map_or(TIED, |weight| (SOFT * weight).min(TIED));
        let vertices = handle.vertices.iter().copied();
        tie(at(shaping(problem, vertices)), 1 + number, firmness);
    }
    ties
}

/// The mean of the painted stiffness in each cell, and of the neighbours for a cell without a vertex.
fn stiffness(octree: &Octree, input: &BindInput<'_>, neighbours: &[Vec<u32>]) -> Vec<f64> {
    let mut sums = vec![(0.0, 0.0); neighbours.len()];
    let problem = input.problem;
    for vertex in shaping(problem, 0..problem.stiffness.len() as u32) {
        let (stiffness, position) = (
            problem.stiffness[vertex as usize],
            problem.surface.positions[vertex as usize],
        );
        if let Some(cell) = octree.cell_at(position) {
            let sum = &mut sums[cell as usize];
            *sum = (sum.0 + stiffness, sum.1 + 1.0);
        }
    }
    loop {
        let open: Vec<(usize, (f64, f64))> = (0..sums.len())
            .filter(|&cell| sums[cell].1 == 0.0)
            .map(|cell| {
                let known = neighbours[cell].iter().map(|&other| sums[other as usize]);
                let known = known.filter(|sum| sum.1 > 0.0).map(|sum| sum.0 / sum.1);
                (cell, known.fold((0.0, 0.0), |sum, value| (sum.0 + value, sum.1 + 1.0)))
            })
            .filter(|(_, sum)| sum.1 > 0.0)
            .collect();
        if open.is_empty() {
            break;
        }
        for (cell, sum) in open {
            sums[cell] = sum;
        }
    }
    sums.into_iter()
        .map(|(sum, count)| if count > 0.0 { sum / count } else { 1.0 })
        .collect()
}

/// The second moment of a cube with this side.
fn cube(side: f64) -> DMat3 {
    DMat3::from_diagonal(DVec3::splat(side * side / 12.0))
}

/// v vᵀ.
fn square(v: DVec3) -> DMat3 {
    DMat3::from_cols(v * v.x, v * v.y, v * v.z)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use std::collections::BTreeMap;

    use glam::{DAffine3, DMat3, DQuat, DVec3};
    use pliant_mesh::{Cancel, Progress, shapes};

    use super::super::declaration::bound;
    use super::super::octree::Octree;
    use super::joined;
    use crate::handles::Handle;
    use crate::method::BindInput;
    use crate::methods::primo::pose::Pose;
    use crate::numerical::sums::Field;
    use crate::region::boundary_problem::BoundaryProblem;
    use crate::sparse::refactorisation::Refactorisation;
    use crate::{Method, Role, SpacePrimo};

    fn noise(k: usize) -> f64 {
        2.0 * ((k as f64 * 12.9898).sin() * 43_758.545).fract()
    }

    /// Calls `test` with a ball whose top is a handle and whose lowest vertex is fixed.
    fn with_ball(test: impl Fn(&SpacePrimo, &BindInput<'_>)) {
        let model = shapes::model(shapes::icosphere(3));
        let positions = &model.surface.positions;
        let handle = |p: &DVec3| if p.z > 0.7 { Role::Handle(0) } else { Role::Free };
        let mut roles: Vec<Role> = positions.iter().map(handle).collect();
        // A single vertex, so that the cells enclose the inside.
        let lowest = (0..roles.len()).min_by(|&a, &b| positions[a].z.total_cmp(&positions[b].z));
        roles[lowest.unwrap()] = Role::Fixed;
        let options = SpacePrimo {
            cells: 800,
            tolerance: 1e-12,
            ..SpacePrimo::default()
        };
        let method = Method::from(options.clone());
        let stiffness = vec![1.0; roles.len()];
        let problem = BoundaryProblem::new((&model.surface, &model.topology), &roles, &stiffness);
        let partition = method.partition(&problem).unwrap();
        let handles = [Handle::new(partition.handles[0].clone(), positions)];
        test(
            &options,
            &BindInput {
                problem: &problem,
                needs: method.needs(),
                takes_first_power: false,
                partition: &partition,
                handles: &handles,
                attachment: None,
                ordering: None,
                refactorisation: Refactorisation::Never,
                progress: &Progress::new(),
                cancel: &Cancel::new(),
            },
        );
    }

    #[test]
    fn the_energy_is_the_integral_over_common_faces_and_the_gradient_its_slope() {
        with_ball(|options, input| {
            let mut octree = Octree::of(input, options.cells as usize).unwrap();
            let origin = input.handles[0].world_centre;
            let joints = joined(&mut octree, input, origin).unwrap();
            let count = joints.count();
            assert!(octree.cells.iter().any(|cell| cell.size > 1) && count > 50);
            let mut pose = Pose::at_rest(count, 2);
            for cell in 0..count {
                let random =
                    |k: usize| DVec3::new(noise(9 * cell + k), noise(9 * cell + k + 1), noise(9 * cell + k + 2));
                pose.rotations[cell] = DQuat::from_scaled_axis(random(0) * 0.4);
                pose.turns[cell] = DMat3::from_quat(pose.rotations[cell]);
                pose.shifts[cell] = random(3) * 0.1;
            }
            pose.turns[count + 1] = DMat3::from_diagonal(DVec3::new(1.1, 0.9, 0.7));
            pose.shifts[count + 1] = DVec3::new(0.1, 0.2, 0.0);
            pose.evaluate(&joints);
            // The image of a world point under a body.
            let taken = |body: usize, point: DVec3| {
                let centre = match body.checked_sub(count) {
                    None => octree.world_centre(body),
                    Some(0) => origin,
                    Some(handle) => input.handles[handle - 1].world_centre,
                };
                pose.turns[body] * (point - centre) + centre + pose.shifts[body]
            };
            let gap =
                |one: usize, other: usize, point: DVec3| (taken(one, point) - taken(other, point)).length_squared();
            let side = octree.grid.world_side;
            let mut expected = 0.0;
            octree.faces(|[one, other], middle, axis| {
                let [one, other] = [one as usize, other as usize];
                let distance = 0.5 * (octree.world_size(one) + octree.world_size(other));
                // Gauss's rule of two points along each side is exact.
                for corner in 0..4 {
                    let reach = side / 12.0_f64.sqrt();
                    let sign = |bit: usize| if corner >> bit & 1 == 0 { reach } else { -reach };
                    let point = middle + DVec3::AXES[(axis + 1) % 3] * sign(0) + DVec3::AXES[(axis + 2) % 3] * sign(1);
                    expected += 0.5 * side * side / 4.0 / distance * gap(one, other, point);
                }
            });
            let mut tied: BTreeMap<(u32, usize), Vec<DVec3>> = BTreeMap::new();
            for (role, &position) in input.problem.roles.iter().zip(&input.problem.surface.positions) {
                let ground = match role {
                    Role::Free => continue,
                    Role::Fixed => count,
                    Role::Handle(_) => count + 1,
                };
                if let Some(cell) = octree.cell_at(position) {
                    tied.entry((cell, ground)).or_default().push(position);
                }
            }
            for ((cell, ground), points) in tied {
                for &point in &points {
                    for aside in DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]) {
                        let share = 100.0 * side / (6 * points.len()) as f64;
                        expected += 0.5 * share * gap(cell as usize, ground, point + aside * (side / 4.0));
                    }
                }
            }
            assert!(
                (pose.energy - expected).abs() < 1e-8 * expected,
                "{} {expected}",
                pose.energy
            );
            let largest = pose.gradient.iter().flatten().fold(0.0, |a: f64, b| a.max(b.abs()));
            for cell in (0..count).step_by(11) {
                for axis in 0..3 {
                    let beside = |length: f64| {
                        let mut direction: Field = vec![[0.0; 3]; count];
                        direction[cell][axis] = 1.0;
                        let mut moved = pose.clone();
                        moved.moved(&pose, &direction, length);
                        moved.evaluate(&joints);
                        moved.energy
                    };
                    let slope = (beside(1e-5) - beside(-1e-5)) / 2e-5;
                    assert!((slope - pose.gradient[cell][axis]).abs() < 1e-7 * largest);
                }
            }
        });
    }

    #[test]
    fn at_the_result_the_gradient_is_zero() {
        with_ball(|options, input| {
            let mut bound = bound(options, input).unwrap();
            let target = DAffine3::from_translation(DVec3::new(0.4, 0.1, 0.3)) * DAffine3::from_rotation_x(1.0);
            let motions = vec![input.handles[0].motion(&target)];
            let size = |pose: &Pose| pose.gradient.iter().flatten().fold(0.0, |a: f64, b| a.max(b.abs()));
            bound.bodies.advance(&motions);
            let first = size(&bound.bodies.current);
            let mut last = f64::INFINITY;
            loop {
                bound.bodies.advance(&motions);
                let (converged, energy) = bound.bodies.outcome();
                assert!(energy <= last);
                last = energy;
                if converged {
                    break;
                }
            }
            let least = size(&bound.bodies.current);
            assert!(last > 1e-4 && least < 1e-4 * first, "{last} {first} {least}");
        });
    }
}

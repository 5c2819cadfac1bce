//! Steps: Gauss–Newton with a line search, from the last maps or from the handles' blended motions.

use faer::Mat;
use glam::{DMat3, DVec3};

use super::energy::{DOF, Energy, NodeMap};
use super::first::First;
use super::graph::Graph;
use super::system::System;
use crate::descent;
use crate::descent::energy::lower;
use crate::descent::rival::{Rival, aim, compare};
use crate::descent::rule::{Rule, State};
use crate::handles::Motion;
use crate::handles::blend::{HandleFrame, Screws};
use crate::handles::screw::{Screw, carried};
use crate::numerical::dense;
use crate::space::blend::Affine;

/// Energies below this share of the number of nodes are rounding.
const NOTHING: f64 = 1e-24;

/// The nodes' maps and their handles.
#[derive(Debug)]
pub(super) struct Solver {
    pub energy: Energy,
    system: System,
    /// The nodes, relative to the first handle's centre, in world units.
    pub(super) nodes: Vec<DVec3>,
    pub(super) handles: Vec<HandleFrame>,
    /// The handles' harmonic weights, one row a node.
    weights: Vec<f64>,
    pub(super) maps: Vec<NodeMap>,
    pub(super) motions: Vec<Motion>,
    /// E at `maps`.
    pub(super) value: f64,
    pub(super) has_converged: bool,
    /// True if the descent has stalled: no step was found that lowers the energy, though the maps have not converged.
    pub(super) has_stalled: bool,
    tolerance: f64,
    pub(super) rival: Rival<First>,
}

const REST: NodeMap = NodeMap {
    linear: DMat3::ZERO,
    shift: DVec3::ZERO,
};

impl Solver {
    pub fn of(
        energy: Energy,
        system: System,
        graph: &Graph,
        handles: &[crate::handles::Handle],
        is_held: bool,
        tolerance: f64,
    ) -> Self {
        let world_origin = handles.first().map_or(DVec3::ZERO, |handle| handle.world_centre);
        Self {
            nodes: graph.world_nodes.iter().map(|node| *node - world_origin).collect(),
            handles: HandleFrame::of_all(handles, world_origin),
            weights: harmonic(&energy, handles.len(), is_held),
            maps: vec![REST; energy.count()],
            motions: vec![Motion::default(); handles.len()],
            value: 0.0,
            has_converged: true,
            has_stalled: false,
            energy,
            system,
            tolerance,
            rival: Rival::default(),
        }
    }

    /// The number of entries that the factor stores.
    pub fn stored(&self) -> usize {
        self.system.stored()
    }

    /// Returns true if the descent has stalled: no step was found that lowers the energy, though the maps have not
    /// converged.
    pub fn has_stalled(&self) -> bool {
        self.has_stalled && self.rival.first().is_none()
    }

    /// Returns to rest, as after binding.
    pub fn rest(&mut self) {
        self.rival.end();
        self.back_to_rest();
    }

    pub(super) fn back_to_rest(&mut self) {
        self.maps.fill(REST);
        self.motions.fill(Motion::default());
        self.value = 0.0;
        self.has_converged = true;
        self.has_stalled = false;
    }

    /// One step towards `motions`. Returns whether it converged, and the energy per node.
    pub fn step(&mut self, motions: &[Motion]) -> (bool, f64) {
        if self.motions != motions {
            aim(self, motions);
            self.start(motions);
        } else if !self.has_converged && !self.has_stalled {
            self.descend();
        }
        compare(self);
        let first = self.rival.first();
        // The second descent may have ended with its first step.
        let has_converged = self.has_converged && first.is_none();
        let value = first.map_or(self.value, |first| first.value);
        if !value.is_finite() {
            // The result is refused; the next targets begin afresh.
            self.rest();
        }
        (has_converged, value / self.energy.count().max(1) as f64)
    }

    /// The nodes' motions in world units: those of a drag's own descent until a second one has ended.
    pub fn affine(&self, graph: &Graph) -> Vec<Affine> {
        let shown = self.rival.first().map_or(&self.maps, |first| &first.maps);
        let maps = graph.world_nodes.iter().zip(shown);
        maps.map(|(&world_centre, map)| Affine {
            world_centre,
            linear: map.linear,
            shift: map.shift * self.energy.world_unit,
        })
        .collect()
    }

    /// Takes the better of two starts, and a step from there.
    pub(super) fn start(&mut self, motions: &[Motion]) {
        let was_at_rest = self.motions.iter().all(Motion::is_rest);
        let Screws {
            from_rest,
            onwards,
            may_stay,
        } = Screws::of(&self.handles, &self.motions, motions);
        self.motions.copy_from_slice(motions);
        let rest = vec![REST; self.maps.len()];
        let from_rest = self.carried(&rest, &from_rest);
        let value = self.energy.evaluate(&from_rest, motions, None);
        let mut best = (from_rest, value);
        if !was_at_rest {
            let onwards = self.carried(&self.maps, &onwards);
            let last = std::mem::take(&mut self.maps);
            for maps in std::iter::once(onwards).chain(may_stay.then_some(last)) {
                let value = self.energy.evaluate(&maps, motions, None);
                if value < best.1 {
                    best = (maps, value);
                }
            }
        }
        (self.maps, self.value) = best;
        self.has_converged = false;
        self.has_stalled = false;
        if self.value.is_finite() {
            self.descend();
        }
    }

    /// These maps, moved by screws.
    fn carried(&self, maps: &[NodeMap], screws: &[Screw]) -> Vec<NodeMap> {
        let unit = self.energy.world_unit;
        let count = screws.len();
        let each = maps.iter().zip(&self.nodes).enumerate();
        each.map(|(node, (map, place))| {
            let own = &self.weights[node * count..(node + 1) * count];
            let moved = carried(*place + map.shift * unit, screws, own);
            let turn = DMat3::from_quat(moved.turn.normalize());
            NodeMap {
                linear: turn * map.linear + (turn - DMat3::IDENTITY),
                shift: map.shift + moved.displacement / unit,
            }
        })
        .collect()
    }

    /// One Gauss–Newton step that lowers the energy, if there is one.
    fn descend(&mut self) {
        let mut gradient = vec![[0.0; DOF]; self.maps.len()];
        let before = self.energy.evaluate(&self.maps, &self.motions, Some(&mut gradient));
        let nothing = NOTHING * self.maps.len() as f64;
        if before <= nothing {
            self.has_converged = true;
            return;
        }
        if self.system.factor(&self.energy, &self.maps).is_err() {
            self.has_stalled = true;
            return;
        }
        let uphill = self.system.solve(&gradient);
        let products = gradient.as_flattened().iter().zip(uphill.as_flattened());
        let slope = -2.0 * products.map(|(a, b)| a * b).sum::<f64>();
        self.value = before;
        let lowered = lower(&mut Step {
            trial: self.maps.clone(),
            trial_value: before,
            solver: self,
            uphill,
            slope,
        });
        let rule = Rule {
            tolerance: self.tolerance,
            nothing,
            rounded: 0.0,
        };
        let state = rule.state(lowered, self.value);
        self.has_converged = state == State::Converged;
        self.has_stalled = state == State::Stalled;
    }
}

/// A Gauss–Newton step, and the maps that it tries.
struct Step<'a> {
    solver: &'a mut Solver,
    uphill: Vec<[f64; DOF]>,
    slope: f64,
    trial: Vec<NodeMap>,
    trial_value: f64,
}

impl descent::energy::Energy for Step<'_> {
    fn value(&self) -> f64 {
        self.solver.value
    }

    fn aim(&mut self) -> f64 {
        self.slope
    }

    fn try_length(&mut self, length: f64) -> f64 {
        let each = self.solver.maps.iter().zip(&self.uphill);
        self.trial = each.map(|(map, x)| moved(map, x, -length)).collect();
        self.trial_value = self.solver.energy.evaluate(&self.trial, &self.solver.motions, None);
        self.trial_value
    }

    fn accept(&mut self, _: f64) {
        std::mem::swap(&mut self.solver.maps, &mut self.trial);
        self.solver.value = self.trial_value;
    }

    fn forget(&mut self) -> bool {
        false
    }
}

fn moved(map: &NodeMap, x: &[f64; DOF], length: f64) -> NodeMap {
    let column = |k: usize| DVec3::new(x[k], x[4 + k], x[8 + k]) * length;
    NodeMap {
        linear: map.linear + DMat3::from_cols(column(0), column(1), column(2)),
        shift: map.shift + column(3),
    }
}

/// Each handle's harmonic weight on each node: 1 at its own constraints and 0 at the others'. If nothing is held they
/// sum to 1.
fn harmonic(energy: &Energy, handle_count: usize, is_held: bool) -> Vec<f64> {
    let count = energy.count();
    let mut matrix = Mat::<f64>::zeros(count, count);
    let mut right = Mat::<f64>::zeros(count, handle_count);
    for joint in &energy.edges {
        let [one, other] = joint.nodes.map(|node| node as usize);
        matrix[(one, one)] += joint.weight;
        matrix[(other, other)] += joint.weight;
        matrix[(one, other)] -= joint.weight;
        matrix[(other, one)] -= joint.weight;
    }
    for constraint in &energy.constraints {
        for &(one, a, _) in &constraint.nodes {
            for &(other, b, _) in &constraint.nodes {
                matrix[(one as usize, other as usize)] += constraint.weight * a * b;
            }
            if let Some((handle, _)) = constraint.handle {
                right[(one as usize, handle)] += constraint.weight * a;
            }
        }
    }
    let solution = dense::solved(matrix, right);
    let mut weights = vec![0.0; count * handle_count];
    for (node, own) in weights.chunks_exact_mut(handle_count.max(1)).enumerate() {
        for (handle, weight) in own.iter_mut().enumerate() {
            let value = solution[(node, handle)];
            *weight = if value.is_finite() { value.clamp(0.0, 1.0) } else { 0.0 };
        }
        let sum: f64 = own.iter().sum();
        if sum > 0.0 && !is_held {
            own.iter_mut().for_each(|weight| *weight /= sum);
        }
    }
    weights
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use glam::{DAffine3, DMat3, DVec3};
    use pliant_mesh::{Cancel, Progress, shapes};

    use super::super::declaration::bound;
    use super::super::energy::{DOF, NodeMap};
    use super::{Solver, moved};
    use crate::handles::{Handle, Motion};
    use crate::method::BindInput;
    use crate::region::boundary_problem::BoundaryProblem;
    use crate::sparse::refactorisation::Refactorisation;
    use crate::{Embedded, Method, Role};

    fn noise(k: usize) -> f64 {
        2.0 * ((k as f64 * 12.9898).sin() * 43_758.545).fract()
    }

    /// A ball whose top is a handle and whose bottom is fixed, unevenly stiff, and the handle's motion.
    fn solver() -> (Solver, Vec<Motion>) {
        let model = shapes::model(shapes::icosphere(2));
        let positions = &model.surface.positions;
        let role = |p: &DVec3| match p.z {
            z if z > 0.7 => Role::Handle(0),
            z if z < -0.7 => Role::Fixed,
            _ => Role::Free,
        };
        let roles: Vec<Role> = positions.iter().map(role).collect();
        let stiffness: Vec<f64> = (0..roles.len()).map(|v| 1.0 + (v % 5) as f64).collect();
        let options = Embedded {
            nodes: 20,
            tolerance: 1e-12,
            ..Embedded::default()
        };
        let method = Method::from(options.clone());
        let problem = BoundaryProblem::new((&model.surface, &model.topology), &roles, &stiffness);
        let partition = method.partition(&problem).unwrap();
        let handles = [Handle::new(partition.handles[0].clone(), positions)];
        let target = DAffine3::from_translation(DVec3::new(0.4, 0.1, 0.3)) * DAffine3::from_rotation_x(1.0);
        let motions = vec![handles[0].motion(&target)];
        let input = BindInput {
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
        };
        (bound(&options, &input).unwrap().solver, motions)
    }

    fn scattered(count: usize) -> Vec<NodeMap> {
        let random = |k: usize| DVec3::new(noise(k), noise(k + 1), noise(k + 2));
        let map = |node: usize| NodeMap {
            linear: DMat3::from_cols(random(12 * node), random(12 * node + 3), random(12 * node + 6)) * 0.4,
            shift: random(12 * node + 9) * 0.3,
        };
        (0..count).map(map).collect()
    }

    /// E by its definition, with A instead of A − I, and the constraints' blend written out.
    fn defined(solver: &Solver, maps: &[NodeMap], motions: &[Motion]) -> f64 {
        let energy = &solver.energy;
        let a = |node: u32| maps[node as usize].linear + DMat3::IDENTITY;
        let mut sum = 0.0;
        for (node, rigidity) in (0..).zip(&energy.rigidity) {
            let columns = [a(node).x_axis, a(node).y_axis, a(node).z_axis];
            for i in 0..3 {
                for j in 0..3 {
                    let unit = if i == j { 1.0 } else { 0.0 };
                    sum += rigidity * (columns[i].dot(columns[j]) - unit).powi(2);
                }
            }
        }
        for joint in &energy.edges {
            let [one, other] = joint.nodes;
            for (from, to, along) in [(one, other, joint.along), (other, one, -joint.along)] {
                let [t, s] = [from, to].map(|node| maps[node as usize].shift);
                sum += joint.weight * (a(from) * along + t - (along + s)).length_squared();
            }
        }
        for constraint in &energy.constraints {
            let taken = |offset: DVec3| -> DVec3 {
                let each = constraint.nodes.iter();
                each.map(|&(node, weight, arm)| {
                    (a(node) * (arm + offset) + maps[node as usize].shift - (arm + offset)) * weight
                })
                .sum()
            };
            let goes = |offset: DVec3| {
                constraint.handle.map_or(DVec3::ZERO, |(handle, [x, y, z, w])| {
                    let q = offset * energy.world_unit / energy.world_radii[handle];
                    motions[handle].displace([x + q.x, y + q.y, z + q.z, w]) / energy.world_unit
                })
            };
            let at = |offset: DVec3| taken(offset) - goes(offset);
            sum += constraint.weight * at(DVec3::ZERO).length_squared();
            for axis in DVec3::AXES {
                let offset = axis * 0.3;
                sum += constraint.weight * (at(offset) - at(DVec3::ZERO)).length_squared();
            }
        }
        sum
    }

    #[test]
    fn the_energy_is_its_definition_and_the_gradient_its_slope() {
        let (solver, motions) = solver();
        let maps = scattered(solver.energy.count());
        let mut gradient = vec![[0.0; DOF]; maps.len()];
        let value = solver.energy.evaluate(&maps, &motions, Some(&mut gradient));
        let expected = defined(&solver, &maps, &motions);
        assert!((value - expected).abs() < 1e-12 * expected, "{value} {expected}");
        let largest = gradient.as_flattened().iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        for node in (0..maps.len()).step_by(3) {
            for k in 0..DOF {
                let beside = |length: f64| {
                    let mut direction = [0.0; DOF];
                    direction[k] = 1.0;
                    let mut maps = maps.clone();
                    maps[node] = moved(&maps[node], &direction, length);
                    defined(&solver, &maps, &motions)
                };
                let slope = (beside(1e-5) - beside(-1e-5)) / 2e-5;
                assert!((slope - 2.0 * gradient[node][k]).abs() < 1e-7 * largest, "{node} {k}");
            }
        }
    }

    #[test]
    fn the_matrix_is_half_the_hessian_where_nothing_is_missed() {
        let (mut solver, _) = solver();
        let still = vec![Motion::default()];
        let rest = solver.maps.clone();
        solver.system.factor(&solver.energy, &rest).unwrap();
        let direction: Vec<[f64; DOF]> = (0..rest.len())
            .map(|node| std::array::from_fn(|k| noise(DOF * node + k)))
            .collect();
        // H x for the half gradient g is g(x) to first order, so that H⁻¹ g(x) is x.
        let length = 1e-6;
        let maps: Vec<NodeMap> = rest
            .iter()
            .zip(&direction)
            .map(|(map, x)| moved(map, x, length))
            .collect();
        let mut gradient = vec![[0.0; DOF]; rest.len()];
        solver.energy.evaluate(&maps, &still, Some(&mut gradient));
        let found = solver.system.solve(&gradient);
        let pairs = found.as_flattened().iter().zip(direction.as_flattened());
        let error = pairs.fold(0.0, |worst: f64, (found, x)| worst.max((found / length - x).abs()));
        assert!(error < 1e-3, "{error:e}");
    }

    #[test]
    fn at_the_result_the_gradient_is_zero() {
        let (mut solver, motions) = solver();
        let mut last = f64::INFINITY;
        while {
            let (converged, energy) = solver.step(&motions);
            assert!(energy <= last);
            last = energy;
            !converged
        } {}
        let size = |maps: &[NodeMap]| {
            let mut gradient = vec![[0.0; DOF]; maps.len()];
            solver.energy.evaluate(maps, &motions, Some(&mut gradient));
            gradient.as_flattened().iter().fold(0.0, |a: f64, b| a.max(b.abs()))
        };
        let rest = vec![super::REST; solver.maps.len()];
        assert!(
            last > 1e-3 && size(&solver.maps) < 1e-5 * size(&rest),
            "{last} {:e}",
            size(&solver.maps)
        );
    }
}

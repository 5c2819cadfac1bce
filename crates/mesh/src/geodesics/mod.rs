//! Distances along the surface, by fast marching over triangles.
//!
//! Vertices settle by rising distance as in Dijkstra's search. A settled edge of a triangle also reaches the third
//! vertex straight through the triangle: unfolded into the plane, the two distances place a virtual source behind the
//! edge, and the third vertex's distance is the length of the straight line from there, if that line crosses the edge
//! [KS98], with the circular front of [NK02]. So on a flat sheet without obtuse triangles distances are exact, where
//! plain Dijkstra zigzags and is up to 40% too long; it costs a few operations a triangle.

mod front;
mod joint;

use glam::DVec3;

pub use self::joint::{JOINT_RINGS, Joint, Shape, joint_of, level_crossing};
use crate::geodesics::front::Front;
use crate::{Surface, SurfaceVertex, Topology};

/// The distance of every vertex from the nearest of `sources`, along the surface, in world units; infinite beyond
/// `limit` and on components without a source. It is never shorter than the straight line and never longer than the
/// shortest path along edges.
pub fn distances_along_surface(
    surface: &Surface,
    topology: &Topology,
    sources: &[SurfaceVertex],
    limit: f64,
) -> Vec<f64> {
    let seeds: Vec<(SurfaceVertex, f64)> = sources.iter().map(|&v| (v, 0.0)).collect();
    let mut distances = vec![f64::INFINITY; surface.positions.len()];
    let mut search = DistanceSearch::default();
    let position = |v: SurfaceVertex| surface.positions[v.index()];
    for &(v, distance) in search.within(&surface.triangles, topology, position, &seeds, limit) {
        distances[v.index()] = distance;
    }
    distances
}

/// A search whose memory is kept between calls: the cost of a brush's dab then depends on the vertices under it, not on
/// the size of the mesh.
#[derive(Clone, Debug, Default)]
pub struct DistanceSearch {
    /// The best distance so far, infinite for vertices that the front has not reached yet; reset after each search.
    distance: Vec<f64>,
    is_settled: Vec<bool>,
    front: Front,
    reached: Vec<(SurfaceVertex, f64)>,
    touched: Vec<SurfaceVertex>,
}

impl DistanceSearch {
    /// The vertices within `limit` of the nearest of `seeds`, nearest first, with their distances, on the surface of
    /// these triangles with vertices at `position`. A seed is a vertex and its initial distance, not negative: a point
    /// on a triangle is given by its corners and their distances.
    pub fn within(
        &mut self,
        triangles: &[[SurfaceVertex; 3]],
        topology: &Topology,
        position: impl Fn(SurfaceVertex) -> DVec3,
        seeds: &[(SurfaceVertex, f64)],
        limit: f64,
    ) -> &[(SurfaceVertex, f64)] {
        self.within_stretched(triangles, topology, position, |_| 1.0, seeds, limit)
    }

    /// The same where a way counts as so many times longer as `stretch` says at the vertices along it, above 0. With
    /// 1 everywhere the distances are those of [`Self::within`] to the bit.
    pub fn within_stretched(
        &mut self,
        triangles: &[[SurfaceVertex; 3]],
        topology: &Topology,
        position: impl Fn(SurfaceVertex) -> DVec3,
        stretch: impl Fn(SurfaceVertex) -> f64,
        seeds: &[(SurfaceVertex, f64)],
        limit: f64,
    ) -> &[(SurfaceVertex, f64)] {
        self.distance.resize(topology.vertex_count(), f64::INFINITY);
        self.is_settled.resize(topology.vertex_count(), false);
        self.reached.clear();
        self.front.begin(limit);
        for &(v, distance) in seeds {
            self.offer(v, distance.max(0.0), limit);
        }
        while let Some((distance, v)) = self.front.pop() {
            if self.is_settled[v.index()] || distance != self.distance[v.index()] {
                continue;
            }
            self.is_settled[v.index()] = true;
            self.reached.push((v, distance));
            self.march_from(v, triangles, topology, (&position, &stretch), limit);
        }
        for v in self.touched.drain(..) {
            self.distance[v.index()] = f64::INFINITY;
            self.is_settled[v.index()] = false;
        }
        &self.reached
    }

    fn march_from(
        &mut self,
        v: SurfaceVertex,
        triangles: &[[SurfaceVertex; 3]],
        topology: &Topology,
        (position, stretch): (&impl Fn(SurfaceVertex) -> DVec3, &impl Fn(SurfaceVertex) -> f64),
        limit: f64,
    ) {
        let here = position(v);
        let distance = self.distance[v.index()];
        for &u in topology.neighbours(v) {
            if self.is_settled[u.index()] {
                continue;
            }
            let stretched = 0.5 * (stretch(v) + stretch(u));
            self.offer(u, distance + here.distance(position(u)) * stretched, limit);
        }
        for t in topology.faces(v, triangles) {
            let [a, b, c] = triangles[t as usize];
            let (one, other) = if v == a {
                (b, c)
            } else if v == b {
                (c, a)
            } else {
                (a, b)
            };
            let (side, third) = match (self.is_settled[one.index()], self.is_settled[other.index()]) {
                (true, false) => (one, other),
                (false, true) => (other, one),
                _ => continue,
            };
            let corners = [here, position(side), position(third)];
            let stretched = (stretch(v) + stretch(side) + stretch(third)) / 3.0;
            let ends = [distance / stretched, self.distance[side.index()] / stretched];
            if let Some(through) = through_triangle(corners, ends) {
                // Through a stretched triangle no vertex comes before those that lead to it, so results depend on no order.
                let least = if stretched == 1.0 { 0.0 } else { distance };
                self.offer(third, (through * stretched).max(least), limit);
            }
        }
    }

    fn offer(&mut self, v: SurfaceVertex, distance: f64, limit: f64) {
        let best = &mut self.distance[v.index()];
        if distance < *best && distance <= limit {
            if *best == f64::INFINITY {
                self.touched.push(v);
            }
            *best = distance;
            self.front.push(distance, v);
        }
    }
}

/// The third corner's distance by a straight line across the edge between the first two, whose distances are given;
/// `None` if no such line crosses the edge.
fn through_triangle([a, b, c]: [DVec3; 3], [at_a, at_b]: [f64; 2]) -> Option<f64> {
    // The plane with a at the origin, b on the x axis and c above it.
    let (along, to_c) = (b - a, c - a);
    let length = along.length();
    let per_length = length.recip();
    let c_x = to_c.dot(along) * per_length;
    let c_y = along.cross(to_c).length() * per_length;
    // The virtual source below the axis.
    let source_x = 0.5 * (length + (at_a - at_b) * (at_a + at_b) * per_length);
    let below_squared = (at_a - source_x) * (at_a + source_x);
    // Zero lengths give NaN, which fails here.
    if !(below_squared >= 0.0 && c_y > 0.0) {
        return None;
    }
    let below = below_squared.sqrt();
    let height = c_y + below;
    // The point where the line crosses the axis, times its height.
    let crossing = source_x * c_y + c_x * below;
    let across = c_x - source_x;
    (crossing >= 0.0 && crossing <= length * height).then(|| (across * across + height * height).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes;

    #[test]
    fn on_a_flat_sheet_distances_are_straight() {
        let model = shapes::model(shapes::grid(20, 15));
        let source = SurfaceVertex(77);
        let distances = distances_along_surface(&model.surface, &model.topology, &[source], f64::INFINITY);
        for (p, d) in model.surface.positions.iter().zip(&distances) {
            assert!((p.distance(model.surface.positions[source.index()]) - d).abs() < 1e-9);
        }
    }

    #[test]
    fn on_a_sphere_distances_are_arcs() {
        let model = shapes::model(shapes::icosphere(4));
        let source = SurfaceVertex(5);
        let distances = distances_along_surface(&model.surface, &model.topology, &[source], f64::INFINITY);
        for (p, d) in model.surface.positions.iter().zip(&distances) {
            let arc = p.angle_between(model.surface.positions[source.index()]);
            assert!((arc - d).abs() < 0.02 * arc + 1e-9, "{arc} {d}");
        }
    }

    #[test]
    fn distances_lie_between_the_straight_line_and_the_way_along_edges() {
        for (class, drawn) in shapes::classes() {
            let model = shapes::model(drawn);
            let (surface, topology) = (&model.surface, &model.topology);
            let Some(&[source, ..]) = surface.triangles.first() else {
                continue;
            };
            let distances = distances_along_surface(surface, topology, &[source], f64::INFINITY);
            let along_edges = bellman_ford(surface, topology, source);
            for v in 0..distances.len() {
                let straight = surface.positions[v].distance(surface.positions[source.index()]);
                assert!(distances[v] >= straight - 1e-9, "{class}");
                assert!(distances[v] <= along_edges[v] + 1e-9, "{class}");
                let is_reached = topology.component(SurfaceVertex(v as u32)) == topology.component(source);
                assert_eq!(distances[v].is_finite(), is_reached, "{class}");
            }
        }
    }

    fn bellman_ford(surface: &Surface, topology: &Topology, source: SurfaceVertex) -> Vec<f64> {
        let mut distances = vec![f64::INFINITY; surface.positions.len()];
        distances[source.index()] = 0.0;
        loop {
            let before = distances.clone();
            for [a, b] in topology.edges().map(|edge| edge.map(SurfaceVertex::index)) {
                let length = surface.positions[a].distance(surface.positions[b]);
                distances[a] = distances[a].min(distances[b] + length);
                distances[b] = distances[b].min(distances[a] + length);
            }
            if before == distances {
                return distances;
            }
        }
    }

    #[test]
    fn a_stretched_way_is_as_many_times_longer_and_a_search_that_stretches_nothing_is_the_same_to_the_bit() {
        let model = shapes::model(shapes::icosphere(3));
        let (surface, topology) = (&model.surface, &model.topology);
        let position = |v: SurfaceVertex| surface.positions[v.index()];
        let mut search = DistanceSearch::default();
        let mut within = |stretch: &dyn Fn(SurfaceVertex) -> f64| {
            let seeds = [(SurfaceVertex(0), 0.0)];
            let found = search.within_stretched(&surface.triangles, topology, position, stretch, &seeds, 100.0);
            found.to_vec()
        };
        let plain = within(&|_| 1.0);
        let all = distances_along_surface(surface, topology, &[SurfaceVertex(0)], 100.0);
        assert!(plain.iter().all(|&(v, distance)| all[v.index()] == distance));
        for (tripled, plain) in within(&|_| 3.0).iter().zip(&plain) {
            assert!((tripled.1 - 3.0 * plain.1).abs() < 1e-9);
        }
        // A belt around the equator that is four times as long.
        let belt = within(&|v| if position(v).z.abs() < 0.3 { 4.0 } else { 1.0 });
        let longer = belt.iter().filter(|&&(v, distance)| distance > 1.2 * all[v.index()]);
        assert!(longer.clone().count() > 100);
        assert!(belt.iter().all(|&(v, distance)| distance > all[v.index()] - 1e-9));
    }

    #[test]
    fn a_limit_cuts_and_a_reused_search_forgets() {
        let model = shapes::model(shapes::torus(24, 12));
        let (surface, topology) = (&model.surface, &model.topology);
        let all = distances_along_surface(surface, topology, &[SurfaceVertex(3)], f64::INFINITY);
        let mut search = DistanceSearch::default();
        let position = |v: SurfaceVertex| surface.positions[v.index()];
        let mut within = |v, limit| {
            let seeds = [(SurfaceVertex(v), 0.0)];
            search
                .within(&surface.triangles, topology, position, &seeds, limit)
                .to_vec()
        };
        within(100, 1.0);
        let reached = within(3, 0.8);
        assert_eq!(reached.len(), all.iter().filter(|&&d| d <= 0.8).count());
        assert!(reached.iter().all(|&(v, d)| all[v.index()] == d));
        assert!(reached.is_sorted_by(|a, b| a.1 <= b.1));
    }
}

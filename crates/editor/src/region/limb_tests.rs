//! Laws of the region around a handle on a limb that meets others, on shapes of round bars that merge smoothly.

use std::collections::BTreeMap;

use glam::{DVec3, IVec3};
use pliant_mesh::{Drawn, DrawnVertex, shapes};

use super::tests::painted_input;
use super::*;

/// A round bar between two points, in world units.
#[derive(Clone, Copy)]
struct Bar {
    from: DVec3,
    to: DVec3,
    radius: f64,
}

impl Bar {
    /// The distance from its surface; negative inside.
    fn distance(&self, point: DVec3) -> f64 {
        let along = self.to - self.from;
        let share = ((point - self.from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        point.distance(self.from + along * share) - self.radius
    }

    /// The position of a point along it, 0 to 1 between its ends.
    fn share(&self, point: DVec3) -> f64 {
        let along = self.to - self.from;
        (point - self.from).dot(along) / along.length_squared()
    }
}

const CELL: f64 = 0.1;

/// The length over which bars merge.
const MERGE: f64 = 0.1;

/// The surface of merged bars: a vertex in each cell of a grid that it goes through, and a quad across each of the grid's
/// edges.
fn merged(bars: &[Bar]) -> Drawn {
    // An irrational shift, so that no corner of the grid is on the surface.
    let shift = DVec3::new(0.0314, 0.0271, 0.0161);
    let distance = |corner: IVec3| {
        let point = corner.as_dvec3() * CELL + shift;
        let sum: f64 = bars.iter().map(|bar| (-bar.distance(point) / MERGE).exp()).sum();
        -MERGE * sum.ln()
    };
    let ends = || {
        bars.iter()
            .flat_map(|bar| [bar.from, bar.to].map(|end| (end, bar.radius)))
    };
    let least = ends().fold(DVec3::INFINITY, |least, (end, radius)| least.min(end - radius)) - 3.0 * CELL;
    let most = ends().fold(DVec3::NEG_INFINITY, |most, (end, radius)| most.max(end + radius)) + 3.0 * CELL;
    let (least, most) = ((least / CELL).floor().as_ivec3(), (most / CELL).ceil().as_ivec3());
    let corners = (least.x..most.x)
        .flat_map(|x| (least.y..most.y).flat_map(move |y| (least.z..most.z).map(move |z| IVec3::new(x, y, z))));
    let values: BTreeMap<[i32; 3], f64> = corners.map(|corner| (corner.to_array(), distance(corner))).collect();
    let mut crossings: BTreeMap<[i32; 3], (DVec3, f64)> = BTreeMap::new();
    let mut quads = Vec::new();
    for (&corner, &here) in &values {
        let corner = IVec3::from_array(corner);
        for axis in 0..3 {
            let step = IVec3::AXES[axis];
            let Some(&there) = values.get(&(corner + step).to_array()) else {
                continue;
            };
            if (here < 0.0) == (there < 0.0) {
                continue;
            }
            let point = (corner.as_dvec3() + step.as_dvec3() * (here / (here - there))) * CELL + shift;
            let (one, other) = (IVec3::AXES[(axis + 1) % 3], IVec3::AXES[(axis + 2) % 3]);
            let mut cells = [corner, corner - one, corner - one - other, corner - other].map(|cell| cell.to_array());
            for cell in cells {
                let (sum, count) = crossings.entry(cell).or_insert((DVec3::ZERO, 0.0));
                (*sum, *count) = (*sum + point, *count + 1.0);
            }
            if here >= 0.0 {
                cells.reverse();
            }
            quads.push(cells);
        }
    }
    let numbers: BTreeMap<[i32; 3], u32> = crossings.keys().copied().zip(0..).collect();
    let positions = crossings.values().map(|(sum, count)| *sum / *count).collect();
    let triangles = quads.iter().flat_map(|quad| {
        let [a, b, c, d] = quad.map(|cell| DrawnVertex(numbers[&cell]));
        [[a, b, c], [a, c, d]]
    });
    Drawn::once(positions, triangles.collect())
}

/// The region of a ring around the first of some bars, between these shares of it.
fn of_ring(bars: &[Bar], ring: std::ops::Range<f64>, reach: Reach) -> (RegionInput, Region) {
    let model = shapes::model(merged(bars));
    let paint = |point: &DVec3| {
        let is_own = bars.iter().all(|bar| bars[0].distance(*point) <= bar.distance(*point));
        match is_own && ring.contains(&bars[0].share(*point)) {
            true => Paint::Handle(HandleId(0)),
            false => Paint::Bare,
        }
    };
    let input = painted_input(model, &[HandleId(0)], reach, paint);
    let region = Region::measure(&input, &Cancel::new()).unwrap();
    (input, region)
}

/// The share of the vertices on a bar that are free: those nearer to it than to any other one, between these shares of it.
fn free_share(bars: &[Bar], bar: usize, part: std::ops::Range<f64>, (input, region): &(RegionInput, Region)) -> f64 {
    let is_on = |point: &DVec3| {
        let nearest = bars
            .iter()
            .all(|other| bars[bar].distance(*point) <= other.distance(*point));
        nearest && part.contains(&bars[bar].share(*point))
    };
    let vertices = input.model.surface.positions.iter().zip(&*region.roles);
    let on: Vec<bool> = vertices
        .filter(|(p, _)| is_on(p))
        .map(|(_, role)| *role == Role::Free)
        .collect();
    assert!(on.len() > 20, "{bar} {}", on.len());
    on.iter().filter(|free| **free).count() as f64 / on.len() as f64
}

/// Two legs, the first of which gets the handle, and a trunk.
fn legs(apart: f64, lean: f64) -> Vec<Bar> {
    let leg = |side: f64| Bar {
        from: DVec3::new(side * apart, 0.0, 0.0),
        to: DVec3::new(side * (apart + 4.0 * lean.sin()), 0.0, -4.0 * lean.cos()),
        radius: 0.4,
    };
    let trunk = Bar {
        from: DVec3::new(0.0, 0.0, 0.3),
        to: DVec3::new(0.0, 0.0, 4.0),
        radius: 0.8,
    };
    vec![leg(-1.0), leg(1.0), trunk]
}

#[test]
fn a_handle_on_a_leg_bends_it_up_to_the_hip_and_leaves_the_other_leg_and_the_trunk() {
    for lean_deg in [0.0, 10.0, 20.0_f64] {
        let bars = legs(0.5, lean_deg.to_radians());
        let found = of_ring(&bars, 0.3..0.5, Reach::Found);
        assert!(
            free_share(&bars, 0, 0.6..1.0, &found) == 1.0,
            "{lean_deg}: the shank comes along"
        );
        assert!(
            free_share(&bars, 0, 0.15..0.29, &found) > 0.9,
            "{lean_deg}: the thigh bends"
        );
        assert!(free_share(&bars, 1, 0.15..1.0, &found) < 0.02, "{lean_deg}");
        assert!(free_share(&bars, 2, 0.3..1.0, &found) == 0.0, "{lean_deg}");
        let feature = of_ring(&bars, 0.3..0.5, Reach::Feature);
        let other = free_share(&bars, 1, 0.05..1.0, &feature);
        assert!(other > 0.05, "{lean_deg}: it needs to be held back: {other}");
    }
}

#[test]
fn a_handle_along_a_whole_leg_bends_the_hip_and_leaves_the_other_leg() {
    for lean_deg in [0.0, 10.0, 20.0_f64] {
        let bars = legs(0.5, lean_deg.to_radians());
        // As a spine makes it: 2.5 half thicknesses.
        let length = 2.5 * bars[0].radius;
        let along = 0.1..2.0;
        let bounded = of_ring(&bars, along.clone(), Reach::Bounded(length));
        assert!(
            free_share(&bars, 0, -0.2..0.09, &bounded) > 0.5,
            "{lean_deg}: the hip bends"
        );
        assert!(free_share(&bars, 1, 0.15..1.0, &bounded) < 0.02, "{lean_deg}");
        assert!(free_share(&bars, 2, 0.3..1.0, &bounded) == 0.0, "{lean_deg}");
        let plain = of_ring(&bars, along, Reach::Length(length));
        let other = free_share(&bars, 1, 0.0..1.0, &plain);
        assert!(other > 0.05, "{lean_deg}: it needs to be held back: {other}");
    }
}

#[test]
fn a_handle_on_a_branch_of_tubes_at_any_angle_leaves_the_other_branch() {
    for half_deg in [20.0, 35.0, 50.0, 65.0_f64] {
        let (sin, cos) = half_deg.to_radians().sin_cos();
        let tube = |direction: DVec3| Bar {
            from: DVec3::ZERO,
            to: 5.0 * direction,
            radius: 0.5,
        };
        let bars = [DVec3::new(sin, 0.0, -cos), DVec3::new(-sin, 0.0, -cos), DVec3::Z].map(tube);
        let found = of_ring(&bars, 0.4..0.6, Reach::Found);
        let beyond_the_crotch = 0.5 / half_deg.to_radians().sin() / 5.0 + 0.15;
        assert!(
            free_share(&bars, 1, beyond_the_crotch..1.0, &found) < 0.02,
            "{half_deg}"
        );
        assert!(free_share(&bars, 2, 0.4..1.0, &found) < 0.02, "{half_deg}");
        assert!(free_share(&bars, 0, 0.3..0.39, &found) > 0.5, "{half_deg}");
    }
}

#[test]
fn a_leg_leaves_the_tail_and_a_tail_leaves_the_legs() {
    let leg = |side: f64| Bar {
        from: DVec3::new(side, 0.0, 0.0),
        to: DVec3::new(side, 0.0, -3.5),
        radius: 0.4,
    };
    let tail = Bar {
        from: DVec3::new(0.0, 0.5, 0.5),
        to: DVec3::new(0.0, 4.5, 0.5),
        radius: 0.3,
    };
    let trunk = Bar {
        from: DVec3::new(0.0, 0.0, 0.5),
        to: DVec3::new(0.0, -5.0, 0.5),
        radius: 0.9,
    };
    let bars = [leg(-0.6), leg(0.6), tail, trunk];
    let found = of_ring(&bars, 0.35..0.55, Reach::Found);
    assert!(free_share(&bars, 1, 0.3..1.0, &found) < 0.02);
    assert!(free_share(&bars, 2, 0.3..1.0, &found) < 0.02);
    let bars = [tail, leg(-0.6), leg(0.6), trunk];
    let found = of_ring(&bars, 0.4..0.6, Reach::Found);
    assert!(free_share(&bars, 1, 0.3..1.0, &found) < 0.02);
    assert!(free_share(&bars, 2, 0.3..1.0, &found) < 0.02);
    assert!(free_share(&bars, 0, 0.65..1.0, &found) == 1.0);
}

#[test]
fn a_reach_that_is_a_length_grows_along_the_limb_and_never_onto_the_other_one() {
    let bars = legs(0.5, 0.0);
    let mut before = 0;
    for length in [0.5, 1.0, 2.0, 4.0] {
        let bounded = of_ring(&bars, 0.3..0.5, Reach::Bounded(length));
        assert!(bounded.1.counts.free > before, "{length}");
        before = bounded.1.counts.free;
        assert!(free_share(&bars, 1, 0.15..1.0, &bounded) < 0.02, "{length}");
    }
}

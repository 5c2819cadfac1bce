//! The empty cubes inside the shape, and those of them that belong to the moving part.
//!
//! The region may cut a closed shape open, so the whole surface decides: a cube is inside if the surface winds around
//! its middle. Winding numbers are counted along columns of cubes in three directions, so that a hole in the surface
//! spoils only the columns that pass through it, and the others outvote them. Inside, cubes nearer to the moving part
//! than to the fixed one belong to it; they are held where the two meet.

use std::collections::VecDeque;

use glam::{DVec2, DVec3, IVec3};
use pliant_mesh::Surface;

use super::grid::{EMPTY, FILLED, Grid, OUTSIDE, SIDES};

/// A cube with only fixed vertices.
const WALL: u8 = 3;

/// The distance of columns from the middles of their cubes, so that none passes through a vertex of a regular mesh.
const ASIDE: DVec2 = DVec2::new(1.618e-4, 2.718e-4);

/// Marks as [`OUTSIDE`] every empty cube that gets no cell. `filled` has the cubes of the moving part. If the surface
/// is not closed, the space that the moving cubes enclose is inside too. Returns the cubes beside which the inside is
/// fixed.
pub(super) fn sort_out(grid: &Grid, surface: &Surface, is_closed: bool, filled: &mut [u8]) -> Vec<IVec3> {
    let mut is_inside = wound(grid, surface);
    if !is_closed {
        for (inside, is_enclosed) in is_inside.iter_mut().zip(enclosed(grid, filled)) {
            *inside |= is_enclosed;
        }
    }
    let mut walls = Vec::new();
    for corners in &surface.triangles {
        grid.cubes_of(corners.map(|corner| surface.positions[corner.index()]), |cube| {
            let cube = grid.index(cube);
            if filled[cube] == EMPTY {
                walls.push(cube);
            }
        });
    }
    let owners = owners(grid, filled, &walls, &is_inside);
    for (state, owner) in filled.iter_mut().zip(&owners) {
        if *state == EMPTY && *owner != FILLED {
            *state = OUTSIDE;
        }
    }
    let is_beside_fixed = |cube: &IVec3| {
        let other = |step: IVec3| grid.has(*cube + step) && owners[grid.index(*cube + step)] == WALL;
        owners[grid.index(*cube)] == FILLED && filled[grid.index(*cube)] == EMPTY && SIDES.into_iter().any(other)
    };
    grid.cubes().filter(is_beside_fixed).collect()
}

/// The empty cubes that can't be reached from a corner of the grid.
fn enclosed(grid: &Grid, filled: &[u8]) -> Vec<bool> {
    let mut states = filled.to_vec();
    let mut queue = vec![IVec3::ZERO];
    states[grid.index(IVec3::ZERO)] = OUTSIDE;
    while let Some(cube) = queue.pop() {
        for step in SIDES {
            let other = cube + step;
            if grid.has(other) && states[grid.index(other)] == EMPTY {
                states[grid.index(other)] = OUTSIDE;
                queue.push(other);
            }
        }
    }
    states.into_iter().map(|state| state == EMPTY).collect()
}

/// Whether each cube inside is nearer to the moving part ([`FILLED`]) or to the fixed one ([`WALL`]); neither outside.
fn owners(grid: &Grid, filled: &[u8], walls: &[usize], is_inside: &[bool]) -> Vec<u8> {
    let mut owners = vec![EMPTY; filled.len()];
    walls.iter().for_each(|&cube| owners[cube] = WALL);
    let mut queue = VecDeque::new();
    for cube in grid.cubes() {
        let index = grid.index(cube);
        if filled[index] == FILLED {
            owners[index] = FILLED;
        }
        if owners[index] != EMPTY {
            queue.push_back(cube);
        }
    }
    while let Some(cube) = queue.pop_front() {
        let owner = owners[grid.index(cube)];
        for step in SIDES {
            let other = cube + step;
            if grid.has(other) && is_inside[grid.index(other)] && owners[grid.index(other)] == EMPTY {
                owners[grid.index(other)] = owner;
                queue.push_back(other);
            }
        }
    }
    owners
}

/// Whether the surface winds around each cube by the majority of the three columns through it.
fn wound(grid: &Grid, surface: &Surface) -> Vec<bool> {
    let mut votes = vec![0_u8; grid.cube_count()];
    let mut winding = vec![0_i32; grid.cube_count()];
    for axis in 0..3 {
        winding.fill(0);
        // The axis comes last; a cyclic shift of x, y and z keeps left and right.
        let turned = |v: DVec3| DVec3::new(v[(axis + 1) % 3], v[(axis + 2) % 3], v[axis]);
        let back = |cube: IVec3| {
            let mut own = IVec3::ZERO;
            (own[(axis + 1) % 3], own[(axis + 2) % 3], own[axis]) = (cube.x, cube.y, cube.z);
            own
        };
        let counts = turned(grid.counts.as_dvec3()).as_ivec3();
        for corners in &surface.triangles {
            let points = corners.map(|corner| turned(grid.in_cubes(surface.positions[corner.index()])));
            each_crossing(points, counts, |cube, sign| winding[grid.index(back(cube))] += sign);
        }
        // The crossings below.
        for cube in grid.cubes() {
            if cube[axis] > 0 {
                winding[grid.index(cube)] += winding[grid.index(cube - IVec3::AXES[axis])];
            }
            votes[grid.index(cube)] += u8::from(winding[grid.index(cube)] != 0);
        }
    }
    votes.into_iter().map(|votes| votes > 1).collect()
}

/// Calls `visit` with the first cube above each crossing of a column and a triangle, and with 1 if the column enters
/// there and −1 if it leaves. Coordinates count cubes.
fn each_crossing(points: [DVec3; 3], counts: IVec3, mut visit: impl FnMut(IVec3, i32)) {
    let flat = points.map(|point| point.truncate() - 0.5 - ASIDE);
    let low = flat[0].min(flat[1]).min(flat[2]).ceil().max(DVec2::ZERO);
    let most = (counts.truncate() - 1).as_dvec2();
    let high = flat[0].max(flat[1]).max(flat[2]).floor().min(most);
    if low.cmpgt(high).any() {
        return;
    }
    let doubled = (flat[1] - flat[0]).perp_dot(flat[2] - flat[0]);
    if doubled == 0.0 {
        return;
    }
    for y in low.y as i32..=high.y as i32 {
        for x in low.x as i32..=high.x as i32 {
            let at = DVec2::new(f64::from(x), f64::from(y));
            let opposite = |a: usize, b: usize| (flat[a] - at).perp_dot(flat[b] - at) / doubled;
            let shares = [opposite(1, 2), opposite(2, 0), opposite(0, 1)];
            if shares.iter().any(|share| *share < 0.0) {
                continue;
            }
            let z: f64 = shares.iter().zip(points).map(|(share, point)| share * point.z).sum();
            let first = (z - 0.5).ceil().max(0.0);
            if first < f64::from(counts.z) {
                // A column enters at a triangle that faces down.
                visit(IVec3::new(x, y, first as i32), if doubled < 0.0 { 1 } else { -1 });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, IVec3};
    use pliant_mesh::shapes;

    use super::each_crossing;

    #[test]
    fn a_ball_winds_once_around_its_inside_and_not_around_the_outside() {
        let model = shapes::model(shapes::icosphere(3));
        let counts = IVec3::splat(24);
        let mut winding = vec![0; 24 * 24 * 24];
        let index = |cube: IVec3| ((cube.z * 24 + cube.y) * 24 + cube.x) as usize;
        for corners in &model.surface.triangles {
            let points = corners.map(|corner| model.surface.positions[corner.index()] * 10.0 + 12.0);
            each_crossing(points, counts, |cube, sign| winding[index(cube)] += sign);
        }
        for z in 1..24 {
            for y in 0..24 {
                for x in 0..24 {
                    let cube = IVec3::new(x, y, z);
                    winding[index(cube)] += winding[index(cube - IVec3::Z)];
                    let radius = (cube.as_dvec3() + 0.5 - 12.0).length();
                    if (radius - 10.0).abs() > 0.3 {
                        assert_eq!(winding[index(cube)], i32::from(radius < 10.0), "{cube} {radius}");
                    }
                }
            }
        }
        each_crossing([DVec3::ZERO; 3], counts, |_, _| unreachable!("it has no area"));
    }
}

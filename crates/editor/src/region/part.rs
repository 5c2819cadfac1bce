//! The reach of a handle that stops where the part ends that the handle is on.
//!
//! The lines at equal distances from a handle tell what lies around it. On a sheet they lengthen from the beginning, by
//! 2π times the distance. Along a limb, a nose or a head they keep their length, or shorten at a neck, and lengthen where
//! the part joins the body. A handle on such a part reaches a little beyond that place, and not across the body.

use pliant_mesh::{Surface, SurfaceVertex, Topology};

/// The number of lines.
const LINES: usize = 60;

/// A part has ended where a line is this many times as long as the shortest one before it.
const WIDER: f64 = 1.8;

/// A line is as long as the shortest one if it is at most this many times its length.
const AS_SHORT: f64 = 1.15;

/// The lines keep their length along a part that is at least this long, in radii of the handle.
const PART_RADII: f64 = 0.5;

/// The least reach, in radii of the handle: a shorter one would crease.
const LEAST_RADII: f64 = 1.0;

/// The reach of a handle of this radius, in world units: `most`, or less if the part ends before that. `reached` are the
/// vertices within `most` of the handle with their distances, and `distances` is scratch memory of one NaN a vertex.
pub(super) fn end_of_part(
    surface: &Surface,
    topology: &Topology,
    reached: &[(SurfaceVertex, f64)],
    distances: &mut [f64],
    radius: f64,
    most: f64,
) -> f64 {
    if !(most > 0.0 && most.is_finite()) {
        return most;
    }
    for &(vertex, distance) in reached {
        distances[vertex.index()] = distance;
    }
    let lengths = line_lengths(surface, topology, reached, distances, most);
    for (vertex, _) in reached {
        distances[vertex.index()] = f64::NAN;
    }
    let mut shortest = f64::INFINITY;
    // The last line that is as short as the shortest so far.
    let mut narrow = 0;
    for (line, &length) in lengths.iter().enumerate() {
        shortest = shortest.min(length);
        if length <= AS_SHORT * shortest {
            narrow = line;
        } else if length > WIDER * shortest && distance_of(narrow, most) >= PART_RADII * radius {
            return distance_of(line, most).max(LEAST_RADII * radius).min(most);
        }
    }
    most
}

/// The distance of a line from the handle, between multiples of the spacing so that no vertex of a regular mesh is
/// exactly on it.
fn distance_of(line: usize, most: f64) -> f64 {
    (line as f64 + 0.5) * most / LINES as f64
}

/// The lengths of the lines at even distances up to `most`; those at which nothing is left are left out.
fn line_lengths(
    surface: &Surface,
    topology: &Topology,
    reached: &[(SurfaceVertex, f64)],
    distances: &[f64],
    most: f64,
) -> Vec<f64> {
    let position = |v: SurfaceVertex| surface.positions[v.index()];
    let mut lengths = vec![0.0; LINES];
    for &(vertex, highest) in reached {
        for face in topology.faces(vertex, &surface.triangles) {
            let triangle = surface.triangles[face as usize];
            let values = triangle.map(|corner| distances[corner.index()]);
            // Each triangle counts at the first of its farthest corners.
            let farthest = values
                .iter()
                .position(|value| values.iter().all(|other| other <= value));
            if farthest.is_none_or(|corner| triangle[corner] != vertex) {
                continue;
            }
            let lowest = values.iter().copied().fold(highest, f64::min);
            let line_at = |distance: f64| (distance * LINES as f64 / most - 0.5).ceil().max(0.0) as usize;
            for line in line_at(lowest)..line_at(highest).min(LINES) {
                let level = distance_of(line, most);
                let crossing = pliant_mesh::level_crossing(triangle.map(position), values.map(|value| value - level));
                lengths[line] += crossing.map_or(0.0, |[from, to]| from.distance(to));
            }
        }
    }
    let end = lengths
        .iter()
        .rposition(|&length| length > 0.0)
        .map_or(0, |last| last + 1);
    lengths.truncate(end);
    lengths
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use pliant_mesh::{DistanceSearch, Model, shapes};

    use super::*;

    const MOST: f64 = 3.0;

    fn reach(model: &Model, members: &[SurfaceVertex], radius: f64, most: f64) -> f64 {
        let seeds: Vec<(SurfaceVertex, f64)> = members.iter().map(|&vertex| (vertex, 0.0)).collect();
        let (surface, topology) = (&model.surface, &model.topology);
        let position = |v: SurfaceVertex| surface.positions[v.index()];
        let mut search = DistanceSearch::default();
        let reached = search.within(&surface.triangles, topology, position, &seeds, most);
        let mut distances = vec![f64::NAN; surface.positions.len()];
        end_of_part(surface, topology, reached, &mut distances, radius, most)
    }

    /// A sheet of 4 × 4 from whose middle a limb of radius .4 and height `height` rises, with a round end.
    fn limb_on_a_sheet(height: f64) -> Model {
        let mut drawn = shapes::grid(160, 160);
        let middle = drawn.positions.iter().sum::<DVec3>() / drawn.positions.len() as f64;
        let size = drawn
            .positions
            .iter()
            .fold(0.0, |most: f64, p| most.max((*p - middle).abs().max_element()));
        for position in &mut drawn.positions {
            let flat = (*position - middle) * (2.0 / size);
            let distance = flat.truncate().length();
            // The disc of radius .8 becomes the limb: its rim, .2 wide, is the wall.
            let (radius, rise) = match distance {
                ..0.6 => (0.4 * distance / 0.6, height),
                0.6..0.8 => (0.4, height * (0.8 - distance) / 0.2),
                _ => (0.4 + (distance - 0.8) * 1.6 / (distance.max(2.0) - 0.4), 0.0),
            };
            *position = (flat.normalize_or_zero() * radius).with_z(rise);
        }
        shapes::model(drawn)
    }

    /// The vertices within so far of the limb's end.
    fn cap(model: &Model, height: f64) -> Vec<SurfaceVertex> {
        let vertices = (0..).map(SurfaceVertex).zip(&model.surface.positions);
        vertices
            .filter(|(_, p)| p.z > height - 1e-9)
            .map(|(vertex, _)| vertex)
            .collect()
    }

    #[test]
    fn a_handle_at_the_end_of_a_limb_reaches_to_the_body_and_a_little_beyond() {
        let height = 1.5;
        let model = limb_on_a_sheet(height);
        let reach = reach(&model, &cap(&model, height), 0.4, MOST);
        assert!((height..height + 0.5).contains(&reach), "{reach}");
    }

    #[test]
    fn on_a_sheet_a_handle_reaches_as_far_as_it_may() {
        let model = shapes::model(shapes::grid(60, 60));
        let middle = model.surface.positions.iter().sum::<DVec3>() / model.surface.positions.len() as f64;
        let vertices = (0..).map(SurfaceVertex).zip(&model.surface.positions);
        let size = model
            .surface
            .positions
            .iter()
            .fold(0.0, |most: f64, p| most.max((*p - middle).length()));
        let near = vertices.filter(|(_, p)| p.distance(middle) < 0.2 * size);
        let members: Vec<SurfaceVertex> = near.map(|(vertex, _)| vertex).collect();
        let most = 0.6 * size;
        assert_eq!(reach(&model, &members, 0.2 * size, most), most);
    }

    #[test]
    fn along_a_tube_a_handle_reaches_as_far_as_it_may() {
        let model = shapes::model(shapes::tube(24, 60, 10.0));
        let low = model
            .surface
            .positions
            .iter()
            .fold(f64::INFINITY, |low, p| low.min(p.z));
        let vertices = (0..).map(SurfaceVertex).zip(&model.surface.positions);
        let members = vertices.filter(|(_, p)| p.z < low + 0.5).map(|(vertex, _)| vertex);
        let members: Vec<SurfaceVertex> = members.collect();
        assert_eq!(reach(&model, &members, 1.0, MOST), MOST);
    }
}

//! The polygons into which a track divides a triangle.
//!
//! Each chain of the track, from edge to edge, divides the polygon that has its ends. Points are numbered: the corners
//! from 0 to 2, then the track's stations.

use glam::DVec2;
use pliant_mesh::SurfaceVertex;
use pliant_mesh::geometry::{WithoutEar, ears, turn};

use super::snaps::Snaps;
use super::track::Station;

/// The number of the first station.
pub(super) const FIRST_STATION: u32 = 3;

/// Nearer to a line, a point has no sure side.
const FLAT: f64 = 1e-15;

/// A triangle that a track divides.
#[derive(Clone, Debug)]
pub(super) struct Divided {
    /// Its corners.
    pub(super) corners: [SurfaceVertex; 3],
    /// Counterclockwise, by numbers of points.
    pub(super) polygons: Vec<Vec<u32>>,
    /// The triangles of each polygon, with stations put onto corners.
    pub(super) triangles: Vec<Vec<[u32; 3]>>,
}

/// The parts of a track in one triangle.
#[derive(Clone, Debug, Default)]
pub(super) struct Chains {
    /// Each from edge to edge, by numbers of stations.
    pub(super) open: Vec<Vec<usize>>,
    /// A closed track that is in this triangle alone.
    pub(super) ring: Option<Vec<usize>>,
}

/// The number of a station as a point.
fn point_of(station: usize) -> u32 {
    FIRST_STATION + station as u32
}

impl Divided {
    /// Divides a triangle; `length` measures between points. `None` if chains cross or touch.
    pub(super) fn of(
        corners: [SurfaceVertex; 3],
        chains: &Chains,
        (stations, snaps): (&[Station], &Snaps),
        length: impl Fn(u32, u32) -> f64,
    ) -> Option<Self> {
        let plane = Plane { corners, stations };
        let open = chains
            .open
            .iter()
            .map(|chain| chain.iter().map(|&s| point_of(s)).collect());
        let open: Vec<Vec<u32>> = open.collect();
        plane.check_crossings(&open, chains.ring.as_deref())?;
        let mut polygons = vec![plane.outline(&open)?];
        for chain in &open {
            let (first, last) = (chain[0], chain[chain.len() - 1]);
            let holder = polygons
                .iter()
                .position(|polygon| polygon.contains(&first) && polygon.contains(&last))?;
            let mut polygon = polygons.swap_remove(holder);
            let start = polygon.iter().position(|&point| point == first)?;
            polygon.rotate_left(start);
            let end = polygon.iter().position(|&point| point == last)?;
            let inner = &chain[1..chain.len() - 1];
            let right = polygon[..=end].iter().chain(inner.iter().rev());
            let left = polygon[end..].iter().chain([&first]).chain(inner);
            polygons.extend([right.copied().collect(), left.copied().collect()]);
        }
        if let Some(ring) = &chains.ring {
            polygons = plane.around(ring.iter().map(|&s| point_of(s)).collect())?;
        }
        // A polygon whose points are all at two corners has no triangles, and one whose points are too near to each other
        // has no sure ones.
        let of_polygon = |polygon: &Vec<u32>| {
            let polygon = plane.snapped(polygon, snaps);
            let places: Vec<DVec2> = polygon.iter().map(|&point| plane.place(point)).collect();
            let cut_length = |a: usize, b: usize| length(polygon[a], polygon[b]);
            let triangles = ears(&places, FLAT, cut_length, WithoutEar::GiveUp)?.into_iter();
            Some(
                triangles
                    .map(|triangle| triangle.map(|corner| polygon[corner]))
                    .collect(),
            )
        };
        Some(Self {
            corners,
            triangles: polygons.iter().map(of_polygon).collect::<Option<_>>()?,
            polygons,
        })
    }
}

/// A triangle laid into the plane, with its corners at (0, 0), (1, 0) and (0, 1).
struct Plane<'a> {
    corners: [SurfaceVertex; 3],
    stations: &'a [Station],
}

impl Plane<'_> {
    fn place(&self, point: u32) -> DVec2 {
        let corner = |corner: usize| [DVec2::ZERO, DVec2::X, DVec2::Y][corner];
        if point < FIRST_STATION {
            return corner(point as usize);
        }
        match self.stations[(point - FIRST_STATION) as usize] {
            Station::Inside { weights, .. } => DVec2::new(weights.y, weights.z),
            Station::On(crossing) => {
                let end = |end: SurfaceVertex| corner(self.corner(end).unwrap_or(0));
                end(crossing.ends[0]).lerp(end(crossing.ends[1]), crossing.share)
            }
        }
    }

    fn corner(&self, vertex: SurfaceVertex) -> Option<usize> {
        self.corners.iter().position(|&corner| corner == vertex)
    }

    /// A polygon whose stations are at the corners that they are put onto.
    fn snapped(&self, polygon: &[u32], snaps: &Snaps) -> Vec<u32> {
        let place = |&point: &u32| {
            let station = point.checked_sub(FIRST_STATION);
            let corner = station.and_then(|station| self.corner(snaps.at(station as usize)?));
            corner.map_or(point, |corner| corner as u32)
        };
        let mut snapped: Vec<u32> = polygon.iter().map(place).collect();
        snapped.dedup();
        while snapped.len() > 1 && snapped.first() == snapped.last() {
            snapped.pop();
        }
        snapped
    }

    /// The triangle's outline, with the ends of all chains; `None` if two are in one place.
    fn outline(&self, chains: &[Vec<u32>]) -> Option<Vec<u32>> {
        let ends: Vec<u32> = chains
            .iter()
            .flat_map(|chain| [chain[0], chain[chain.len() - 1]])
            .collect();
        let mut outline = Vec::new();
        for corner in 0..3 {
            outline.push(corner);
            let edge = [corner as usize, (corner as usize + 1) % 3].map(|corner| self.corners[corner]);
            let share = |&point: &u32| match self.stations[(point - FIRST_STATION) as usize] {
                Station::On(crossing) if crossing.ends == edge => Some((crossing.share, point)),
                Station::On(crossing) if crossing.ends == [edge[1], edge[0]] => Some((1.0 - crossing.share, point)),
                _ => None,
            };
            let mut along: Vec<(f64, u32)> = ends.iter().filter_map(share).collect();
            along.sort_by(|a, b| a.0.total_cmp(&b.0));
            if along.windows(2).any(|pair| pair[0].0 == pair[1].0) {
                return None;
            }
            outline.extend(along.into_iter().map(|(_, point)| point));
        }
        Some(outline)
    }

    /// The polygon inside a ring, and that between it and the outline, joined by an edge there and back.
    fn around(&self, mut ring: Vec<u32>) -> Option<Vec<Vec<u32>>> {
        let next = ring.iter().cycle().skip(1);
        let sides = ring.iter().zip(next).map(|(&a, &b)| [a, b]).collect::<Vec<_>>();
        let area: f64 = sides
            .iter()
            .map(|side| self.place(side[0]).perp_dot(self.place(side[1])))
            .sum();
        let is_free = |bridge: [u32; 2]| !sides.iter().any(|&side| self.cross(bridge, side));
        let bridges = (0..3).flat_map(|corner| ring.iter().map(move |&point| [corner, point]));
        let [corner, point] = bridges.into_iter().find(|&bridge| is_free(bridge))?;
        if area < 0.0 {
            ring.reverse();
        }
        let start = ring.iter().position(|&other| other == point)?;
        ring.rotate_left(start);
        let outline = (0..=3).map(|step| (corner + step) % 3);
        let around = outline.chain([point]).chain(ring.iter().rev().copied());
        Some(vec![around.collect(), ring])
    }

    /// `None` if two pieces of the track cross.
    fn check_crossings(&self, open: &[Vec<u32>], ring: Option<&[usize]>) -> Option<()> {
        let pairs = |chain: &Vec<u32>| chain.windows(2).map(|pair| [pair[0], pair[1]]).collect::<Vec<_>>();
        let mut segments: Vec<[u32; 2]> = open.iter().flat_map(pairs).collect();
        if let Some(ring) = ring {
            let next = ring.iter().cycle().skip(1);
            segments.extend(ring.iter().zip(next).map(|(&a, &b)| [a, b].map(point_of)));
        }
        let pairs = || (0..segments.len()).flat_map(|a| (0..a).map(move |b| (a, b)));
        (!pairs().any(|(a, b)| self.cross(segments[a], segments[b]))).then_some(())
    }

    /// Returns true if two segments without a common end cross.
    fn cross(&self, one: [u32; 2], other: [u32; 2]) -> bool {
        if one.iter().any(|point| other.contains(point)) {
            return false;
        }
        let ([a, b], [c, d]) = (one.map(|p| self.place(p)), other.map(|p| self.place(p)));
        let are_apart = |p: f64, q: f64| (p > FLAT && q < -FLAT) || (p < -FLAT && q > FLAT);
        are_apart(turn(a, b, c), turn(a, b, d)) && are_apart(turn(c, d, a), turn(c, d, b))
    }
}

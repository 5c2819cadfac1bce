//! Crossings that are put onto the vertex that the curve nearly meets, so that no sliver is left beside it.

use std::collections::{BTreeMap, BTreeSet};

use pliant_mesh::{Model, SurfaceVertex};

use super::track::{Station, Track};

/// A crossing nearer to an end of its edge than this share of the edge is put onto that vertex.
const NEAR: f64 = 0.05;

/// For each station of a track the vertex that it is put onto.
#[derive(Clone, Debug)]
pub(super) struct Snaps(Vec<Option<SurfaceVertex>>);

impl Snaps {
    /// Those that leave the track simple: it meets each vertex once, and a border only at its ends.
    pub(super) fn of(model: &Model, track: &Track, is_closed: bool) -> Self {
        let near = |station: &Station| match station {
            Station::On(crossing) if crossing.share < NEAR => Some(crossing.ends[0]),
            Station::On(crossing) if crossing.share > 1.0 - NEAR => Some(crossing.ends[1]),
            _ => None,
        };
        let snaps: Vec<Option<SurfaceVertex>> = track.stations.iter().map(near).collect();
        let count = snaps.len();
        // The number of runs of stations at each vertex, and whether one of them is an end of the track.
        let mut runs: BTreeMap<SurfaceVertex, (usize, bool)> = BTreeMap::new();
        for (place, vertex) in snaps.iter().enumerate() {
            let Some(vertex) = *vertex else { continue };
            let before = match place.checked_sub(1) {
                Some(before) => snaps[before],
                None if is_closed => snaps[count - 1],
                None => None,
            };
            let run = runs.entry(vertex).or_default();
            run.0 += usize::from(before != Some(vertex));
            run.1 |= !is_closed && (place == 0 || place + 1 == count);
        }
        let borders: BTreeSet<SurfaceVertex> = model.topology.boundary_edge_list().iter().flatten().copied().collect();
        let mut own = Self(snaps);
        own.forget(|vertex| {
            let (runs, is_end) = runs.get(&vertex).copied().unwrap_or_default();
            runs != 1 || (borders.contains(&vertex) && !is_end)
        });
        let mut places: Vec<(Option<SurfaceVertex>, usize)> = own.0.iter().copied().zip(0..).collect();
        places.dedup_by_key(|(vertex, place)| vertex.ok_or(*place));
        if places.len() <= 3 {
            own.forget(|_| true);
        }
        own
    }

    /// The vertex that a station is put onto.
    pub(super) fn at(&self, station: usize) -> Option<SurfaceVertex> {
        self.0[station]
    }

    /// Leaves the stations at some vertices where they are. Returns those vertices that had any.
    pub(super) fn forget(&mut self, is_left: impl Fn(SurfaceVertex) -> bool) -> BTreeSet<SurfaceVertex> {
        let left = |snap: &mut Option<SurfaceVertex>| snap.take_if(|vertex| is_left(*vertex));
        self.0.iter_mut().filter_map(left).collect()
    }
}

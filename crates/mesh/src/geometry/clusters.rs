//! A graph of points that are neighbours, and a coarser one of clusters of them.

use glam::DVec3;

use crate::{SurfaceVertex, Topology};

/// No cluster yet, or not in the list.
const NONE: u32 = u32::MAX;

/// The neighbours of each point of a list, by their places in it, one after another in memory.
pub(super) struct Neighbours {
    starts: Vec<u32>,
    all: Vec<u32>,
}

/// The cluster of each point of a list.
pub(super) struct Clusters {
    of_each: Vec<u32>,
    count: usize,
}

/// The place in a list of each of a surface's vertices, `u32::MAX` for those that are not in it; the list has each once.
pub(super) fn places_of(vertices: &[SurfaceVertex], vertex_count: usize) -> Vec<u32> {
    let mut places = vec![NONE; vertex_count];
    for (place, v) in (0..).zip(vertices) {
        places[v.index()] = place;
    }
    places
}

impl Neighbours {
    /// Those of some vertices of a surface among these: `places` are those of [`places_of`].
    pub(super) fn among(vertices: &[SurfaceVertex], topology: &Topology, places: &[u32]) -> Self {
        let others = |vertex: &SurfaceVertex| topology.neighbours(*vertex).iter().map(|v| places[v.index()]);
        Self::of(
            vertices
                .iter()
                .map(|vertex| others(vertex).filter(|&place| place != NONE)),
        )
    }

    fn of(lists: impl Iterator<Item = impl Iterator<Item = u32>>) -> Self {
        let (mut starts, mut all) = (vec![0], Vec::new());
        for list in lists {
            all.extend(list);
            starts.push(all.len() as u32);
        }
        Self { starts, all }
    }

    pub(super) fn at(&self, place: usize) -> &[u32] {
        &self.all[self.starts[place] as usize..self.starts[place + 1] as usize]
    }

    /// The mean of the values of a point's neighbours; 0 without neighbours.
    pub(super) fn mean(&self, values: &[DVec3], place: usize) -> DVec3 {
        let others = self.at(place);
        let sum: DVec3 = others.iter().map(|&other| values[other as usize]).sum();
        sum / others.len().max(1) as f64
    }

    /// The mean square of the distances between neighbours; NaN if there are none.
    pub(super) fn mean_squared_edge(&self, points: &[DVec3]) -> f64 {
        let of_point = |(place, point): (usize, &DVec3)| -> f64 {
            let others = self.at(place).iter();
            others
                .map(|&other| point.distance_squared(points[other as usize]))
                .sum()
        };
        points.iter().enumerate().map(of_point).sum::<f64>() / self.all.len() as f64
    }

    /// Clusters of a point and its neighbours, some seven on a surface, and the neighbours of each cluster. There are
    /// fewer clusters than points if any are neighbours.
    pub(super) fn clusters(&self) -> (Clusters, Self) {
        let points = self.starts.len() - 1;
        let mut of_each = vec![NONE; points];
        let mut count = 0;
        for place in 0..points {
            let others = self.at(place);
            let is_free = |&other: &u32| of_each[other as usize] == NONE;
            if of_each[place] == NONE && others.iter().all(is_free) {
                of_each[place] = count;
                others.iter().for_each(|&other| of_each[other as usize] = count);
                count += 1;
            }
        }
        // Every other point has a neighbour in a cluster.
        for place in 0..points {
            if of_each[place] == NONE {
                let mut others = self.at(place).iter().map(|&other| of_each[other as usize]);
                of_each[place] = others.find(|&cluster| cluster != NONE).unwrap_or(0);
            }
        }
        let mut members = vec![Vec::new(); count as usize];
        for (place, &cluster) in (0..).zip(&of_each) {
            members[cluster as usize].push(place);
        }
        let beside = |(cluster, members): (u32, &Vec<u32>)| {
            let others = members.iter().flat_map(|&place| self.at(place as usize));
            let mut beside: Vec<u32> = others.map(|&other| of_each[other as usize]).collect();
            beside.sort_unstable();
            beside.dedup();
            beside.into_iter().filter(move |&other| other != cluster)
        };
        let neighbours = Self::of((0..).zip(&members).map(beside));
        let count = count as usize;
        (Clusters { of_each, count }, neighbours)
    }
}

impl Clusters {
    /// The mean of each cluster's values.
    pub(super) fn means(&self, values: &[DVec3]) -> Vec<DVec3> {
        let mut sums = vec![(DVec3::ZERO, 0.0); self.count];
        for (&cluster, &value) in self.of_each.iter().zip(values) {
            let (sum, count) = &mut sums[cluster as usize];
            *sum += value;
            *count += 1.0;
        }
        sums.into_iter().map(|(sum, count)| sum / count).collect()
    }

    /// The value of each point's cluster.
    pub(super) fn spread(&self, values: &[DVec3]) -> Vec<DVec3> {
        self.of_each.iter().map(|&cluster| values[cluster as usize]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes;

    #[test]
    fn clusters_are_fewer_hang_together_and_keep_what_is_constant() {
        for (class, drawn) in shapes::classes() {
            let model = shapes::model(drawn);
            let vertices: Vec<SurfaceVertex> = (0..model.surface.positions.len() as u32).map(SurfaceVertex).collect();
            let places = places_of(&vertices, vertices.len());
            let fine = Neighbours::among(&vertices, &model.topology, &places);
            let (clusters, coarse) = fine.clusters();
            assert!(clusters.count < vertices.len() || fine.all.is_empty(), "{class}");
            let alike = clusters.means(&vec![DVec3::ONE; vertices.len()]);
            assert!(alike.iter().all(|&mean| mean == DVec3::ONE), "{class}: none is empty");
            for place in 0..vertices.len() {
                for &other in fine.at(place) {
                    let [own, other] = [place, other as usize].map(|place| clusters.of_each[place]);
                    assert!(own == other || coarse.at(own as usize).contains(&other), "{class}");
                }
            }
        }
    }
}

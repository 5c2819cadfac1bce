//! Ways from a handle that count as longer where they cross a concave crease.
//!
//! A nose, a lip and a cheek are parts of a face because creases are between them (the minima rule [HR84]), and none of
//! them is narrower than its surroundings. So a way across a concave crease counts as longer by the angle of the crease
//! times [`CREASE_RADII`] radii of the handle, and a reach that would end a little beyond the crease ends in it. This is
//! an isophotic metric [PSH+04] of one side: convex edges, such as a nose's bridge, cost nothing. Creases that are small
//! beside the handle are smoothed away. Along a limb none count: the hollow of a knee or of a hock is where it bends.

use glam::DVec3;
use pliant_mesh::{Cancel, Cancelled, DistanceSearch, Surface, SurfaceVertex, Topology, concavities};

use super::branching::is_on_limb;
use super::limb_end::limb_end;

/// The length by which a crease of one radian counts, in radii of the handle.
const CREASE_RADII: f64 = 3.0;

/// The length over which normals are smoothed, in radii of the handle.
const SMOOTH_RADII: f64 = 0.15;

/// Up to this distance from the handle, in radii, creases count less, and at its edge not at all: a handle may end in one,
/// and still needs room to bend.
const FREE_RADII: f64 = 1.0;

/// A handle of at least so many times the scale of its limb goes all along it, as around a spine.
const LONG_SCALES: f64 = 2.0;

/// Beyond such a handle, ways keep their length over so many times that scale, so that the body has room to bend.
const ROOM_SCALES: f64 = 1.0;

/// The search for the vertices that a handle reaches, with memory that is kept between handles.
#[derive(Default)]
pub(super) struct CreaseSearch {
    search: DistanceSearch,
    /// By how many times ways at each vertex count as longer; 1 between searches, and empty before the first.
    stretch: Vec<f64>,
    /// The vertices at which it may be another number.
    stretched: Vec<SurfaceVertex>,
    /// Scratch memory of one NaN a vertex.
    distances: Vec<f64>,
    /// The vertices within plain distance.
    plain: Vec<(SurfaceVertex, f64)>,
}

impl CreaseSearch {
    /// The vertices within `most` of the members of a handle of this radius, in world units, nearly nearest first, with
    /// the lengths of their ways.
    pub(super) fn within(
        &mut self,
        surface: &Surface,
        topology: &Topology,
        members: &[(SurfaceVertex, f64)],
        radius: f64,
        most: f64,
    ) -> &[(SurfaceVertex, f64)] {
        self.search_plain(surface, topology, members, most);
        if self.is_on_limb(surface, topology, radius) {
            return &self.plain;
        }
        self.stretch_creases(surface, topology, radius);
        self.stretched_within(surface, topology, members, most)
    }

    /// The same, where ways also count as longer beyond the end of the limb that the handle is on, and none leads to a
    /// limb beside it. `scale` is that of the limb, in world units, as a handle's radius is.
    ///
    /// # Errors
    /// [`Cancelled`] soon after `cancel` is raised.
    pub(super) fn within_limb(
        &mut self,
        surface: &Surface,
        topology: &Topology,
        members: &[(SurfaceVertex, f64)],
        [radius, scale]: [f64; 2],
        most: f64,
        cancel: &Cancel,
    ) -> Result<&[(SurfaceVertex, f64)], Cancelled> {
        self.search_plain(surface, topology, members, most);
        let is_long = radius >= LONG_SCALES * scale;
        let room = if is_long { ROOM_SCALES * scale } else { 0.0 };
        if let Some(beyond) = limb_end(&mut self.search, surface, topology, members, [scale, room], cancel)? {
            self.stretch.resize(surface.positions.len(), 1.0);
            for (vertex, times) in beyond {
                self.stretch[vertex.index()] = times;
                self.stretched.push(vertex);
            }
        } else if self.is_on_limb(surface, topology, radius) {
            return Ok(&self.plain);
        } else {
            self.stretch_creases(surface, topology, radius);
        }
        Ok(self.stretched_within(surface, topology, members, most))
    }

    /// Finds the vertices within plain distance.
    fn search_plain(&mut self, surface: &Surface, topology: &Topology, members: &[(SurfaceVertex, f64)], most: f64) {
        let position = |v: SurfaceVertex| -> DVec3 { surface.positions[v.index()] };
        let found = self
            .search
            .within(&surface.triangles, topology, position, members, most);
        self.plain.clear();
        self.plain.extend_from_slice(found);
    }

    /// Returns true if the surface within plain distance branches.
    fn is_on_limb(&mut self, surface: &Surface, topology: &Topology, radius: f64) -> bool {
        self.distances.resize(surface.positions.len(), f64::NAN);
        is_on_limb(surface, topology, &self.plain, &mut self.distances, radius)
    }

    /// Lets ways count as longer across the creases within plain distance.
    fn stretch_creases(&mut self, surface: &Surface, topology: &Topology, radius: f64) {
        let Self {
            stretch,
            stretched,
            plain,
            ..
        } = self;
        // In the mesh's order neighbours are near each other in memory, too.
        plain.sort_unstable_by_key(|&(vertex, _)| vertex);
        stretched.extend(plain.iter().map(|&(vertex, _)| vertex));
        let concavities = concavities(
            &surface.triangles,
            topology,
            &surface.positions,
            stretched,
            SMOOTH_RADII * radius,
        );
        stretch.resize(surface.positions.len(), 1.0);
        for (&(vertex, distance), concavity) in plain.iter().zip(concavities) {
            let weight = (distance / (FREE_RADII * radius)).min(1.0);
            stretch[vertex.index()] += weight * CREASE_RADII * radius * concavity;
        }
    }

    /// Searches by the stretched ways, and forgets how long they are.
    fn stretched_within(
        &mut self,
        surface: &Surface,
        topology: &Topology,
        members: &[(SurfaceVertex, f64)],
        most: f64,
    ) -> &[(SurfaceVertex, f64)] {
        let position = |v: SurfaceVertex| -> DVec3 { surface.positions[v.index()] };
        let stretch = &mut self.stretch;
        let at = |v: SurfaceVertex| stretch[v.index()];
        let reached = self
            .search
            .within_stretched(&surface.triangles, topology, position, at, members, most);
        self.stretched
            .drain(..)
            .for_each(|vertex| stretch[vertex.index()] = 1.0);
        reached
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod tests {
    use pliant_mesh::{Drawn, Model, shapes};

    use super::*;

    /// The radius of the ball of [`shapes::half_ball`].
    const BALL: f64 = 0.15;
    const HANDLE: f64 = 0.1;

    /// The farthest distance from the ball's axis that a handle on its top reaches.
    fn reaches(drawn: Drawn, scale: f64) -> f64 {
        let model: Model = shapes::model(drawn);
        let positions = &model.surface.positions;
        let top = positions.iter().max_by(|a, b| a.z.abs().total_cmp(&b.z.abs())).unwrap();
        let all = (0..).map(SurfaceVertex).zip(positions);
        let members = all
            .filter(|(_, p)| p.distance(*top) < scale * HANDLE)
            .map(|(v, _)| (v, 0.0));
        let members: Vec<(SurfaceVertex, f64)> = members.collect();
        let (mut search, radius) = (CreaseSearch::default(), scale * HANDLE);
        let reached = search.within(&model.surface, &model.topology, &members, radius, 3.0 * radius);
        let away = |&(v, _): &(SurfaceVertex, f64)| positions[v.index()].truncate().length();
        reached.iter().map(away).fold(0.0, f64::max)
    }

    #[test]
    fn a_handle_on_a_nose_reaches_its_crease_and_one_on_a_ball_as_far_as_ever() {
        for cells in [60, 90, 140, 400] {
            let end = reaches(shapes::half_ball(cells, 1.0), 1.0) / BALL;
            assert!((0.99..1.3).contains(&end), "{cells} cells: {end}");
        }
        let larger = glam::DAffine3::from_scale(DVec3::splat(20.0));
        let end = reaches(shapes::moved(&shapes::half_ball(90, 1.0), larger), 20.0) / (20.0 * BALL);
        assert!((0.99..1.3).contains(&end), "larger: {end}");
        // A socket is hollow all over, so ways in it count as longer. Its edge is convex and costs nothing: the handle reaches
        // beyond it, and less far than the .164 that 3 × .1 less the wall would be.
        let end = reaches(shapes::half_ball(90, -1.0), 1.0) - BALL;
        assert!((0.05..0.164).contains(&end), "socket: {end}");
    }

    #[test]
    fn a_handle_on_a_limb_reaches_past_a_hollow_as_far_as_by_plain_distance() {
        // A tube of radius 1 that bends by 127° where z is 6.
        let bent = |p: DVec3| p + DVec3::X * (2.0 * (p.z - 6.0).abs());
        let mut drawn = shapes::tube(48, 96, 12.0);
        drawn.positions.iter_mut().for_each(|p| *p = bent(*p));
        let model = shapes::model(drawn);
        let (surface, topology) = (&model.surface, &model.topology);
        let position = |v: SurfaceVertex| surface.positions[v.index()];
        let all = (0..).map(SurfaceVertex).zip(&surface.positions);
        let side = all.filter(|(_, p)| p.distance(bent(DVec3::new(0.0, 1.0, 4.0))) < 1.0);
        let members: Vec<(SurfaceVertex, f64)> = side.map(|(v, _)| (v, 0.0)).collect();
        let (radius, most) = (1.5, 4.5);
        let (mut search, mut creases) = (DistanceSearch::default(), CreaseSearch::default());
        let plain = search.within(&surface.triangles, topology, position, &members, most);
        assert!(plain.iter().any(|&(v, _)| position(v).z > 6.5), "it reaches the hollow");
        let concave = concavities(&surface.triangles, topology, &surface.positions, &near(plain), 0.2);
        assert!(concave.iter().any(|&turn| turn > 0.5), "there is a hollow");
        assert_eq!(creases.within(surface, topology, &members, radius, most), plain);
    }

    fn near(reached: &[(SurfaceVertex, f64)]) -> Vec<SurfaceVertex> {
        reached.iter().map(|&(vertex, _)| vertex).collect()
    }

    #[test]
    fn a_crease_near_the_handle_holds_its_reach_back() {
        let model = shapes::model(shapes::half_ball(90, 1.0));
        // It ends 0.3 radii before the crease.
        let radius = 2.0 * HANDLE;
        let height = BALL * (0.3 * radius / BALL).sin();
        let all = (0..).map(SurfaceVertex).zip(&model.surface.positions);
        let members = all.filter(|(_, p)| p.z > height).map(|(v, _)| (v, 0.0));
        let members: Vec<(SurfaceVertex, f64)> = members.collect();
        let (surface, topology, most) = (&model.surface, &model.topology, 1.5 * radius);
        let position = |v: SurfaceVertex| surface.positions[v.index()];
        let beyond = |reached: &[(SurfaceVertex, f64)]| {
            let away = reached.iter().map(|&(v, _)| position(v).truncate().length());
            away.fold(0.0, f64::max) - BALL
        };
        let (mut search, mut creases) = (DistanceSearch::default(), CreaseSearch::default());
        let plain = beyond(search.within(&surface.triangles, topology, position, &members, most));
        let held = beyond(creases.within(surface, topology, &members, radius, most));
        assert!(held < 0.5 * plain, "{held} of {plain}");
    }

    #[test]
    fn a_handle_that_ends_in_a_crease_still_reaches_beyond_it() {
        let model = shapes::model(shapes::half_ball(90, 1.0));
        let all = (0..).map(SurfaceVertex).zip(&model.surface.positions);
        let members = all.filter(|(_, p)| p.z > 1e-3).map(|(v, _)| (v, 0.0));
        let members: Vec<(SurfaceVertex, f64)> = members.collect();
        let mut search = CreaseSearch::default();
        let reached = search.within(&model.surface, &model.topology, &members, 2.0 * HANDLE, 6.0 * HANDLE);
        let away = |&(v, _): &(SurfaceVertex, f64)| model.surface.positions[v.index()].truncate().length();
        let end = reached.iter().map(away).fold(0.0, f64::max);
        assert!(end > BALL + HANDLE, "{end}");
    }
}

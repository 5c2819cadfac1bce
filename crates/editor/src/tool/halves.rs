//! A handle and its image across the plane of symmetry: one handle on both sides, or twins.
//!
//! A stroke on a limb often laps over to the limb beside it, or over the middle of the body. So a few vertices that are
//! on both sides do not make both limbs one handle: their share decides. Between twins, each of them goes to the handle
//! on whose side of the plane it is.

use std::sync::Arc;

use pliant_mesh::{Model, SurfaceVertex};

use crate::jobs::BothSides;

/// A handle is one on both sides if at least this share of its vertices are partners of others of them. A round patch has
/// this share if the plane is 0.63 of its radius from its middle.
const ONE_SHARE: f64 = 0.25;

/// With at least this share the given vertices alone are on both sides, as all around a limb.
const BOTH_SHARE: f64 = 0.5;

/// A twin has at least this share of its handle's number of vertices; fewer are scraps on a side that lacks the part.
const LEAST_TWIN: f64 = 0.25;

/// The message if a handle gets no twin because the other side lacks its part.
pub(super) const NO_TWIN: &str =
    "The other side has no part like this one, so this side alone moves: make a handle of its own there.";

/// Whether these numbers of vertices of a twin and of its handle are of a part that both sides have.
pub(super) fn is_twin(twin: usize, own: usize) -> bool {
    twin > 0 && twin as f64 >= LEAST_TWIN * own as f64
}

/// Whose a vertex is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Half {
    Own,
    Twin,
    /// It is on the plane between twins.
    Neither,
}

/// The handle.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum State {
    /// It is one on both sides.
    One,
    /// It has a twin, and is itself in front of the plane.
    InFront,
    /// It has a twin, and is itself behind the plane.
    Behind,
}

/// The vertices that a handle was given, before any of them goes to its twin. They grow during a stroke.
#[derive(Debug)]
pub(super) struct Halves {
    sides: Arc<BothSides>,
    model: Arc<Model>,
    given: Vec<SurfaceVertex>,
    is_given: Vec<bool>,
    /// Given vertices that have partners among the given ones.
    is_shared: Vec<bool>,
    shared_count: usize,
    /// The sum of the given vertices' heights over the plane.
    height: f64,
    /// A handle that had a twin before keeps it.
    has_twin: bool,
}

impl Halves {
    /// Those of a handle without vertices; with a twin if it `has_twin` already.
    pub(super) fn of_nothing(sides: Arc<BothSides>, model: Arc<Model>, has_twin: bool) -> Self {
        let count = model.surface.positions.len();
        Self {
            sides,
            model,
            given: Vec::new(),
            is_given: vec![false; count],
            is_shared: vec![false; count],
            shared_count: 0,
            height: 0.0,
            has_twin,
        }
    }

    /// Gives the handle further vertices; returns those that it was not given before.
    pub(super) fn give(&mut self, vertices: &[SurfaceVertex]) -> Vec<SurfaceVertex> {
        let mut new = Vec::new();
        for &vertex in vertices {
            if std::mem::replace(&mut self.is_given[vertex.index()], true) {
                continue;
            }
            new.push(vertex);
            self.height += self.height_of(vertex);
            let sides = Arc::clone(&self.sides);
            for partner in sides
                .opposite([vertex])
                .filter(|partner| self.is_given[partner.index()])
            {
                for shared in [vertex, partner] {
                    let was_shared = std::mem::replace(&mut self.is_shared[shared.index()], true);
                    self.shared_count += usize::from(!was_shared);
                }
            }
        }
        self.given.extend(&new);
        new
    }

    /// Whether a vertex' place in the image of the given ones is uncertain: it was not given itself, and is no
    /// counterpart where the shape is its own mirror image.
    pub(super) fn is_uncertain(&self, vertex: SurfaceVertex) -> bool {
        let position = |vertex: SurfaceVertex| self.model.surface.positions[vertex.index()];
        let image = self.sides.plane.mirrored(position(vertex));
        let is_exact = |other: SurfaceVertex| {
            let around = self.model.topology.neighbours(other).iter();
            let longest = around.map(|beside| position(other).distance(position(*beside)));
            position(other).distance(image) <= longest.fold(0.0, f64::max)
        };
        !self.is_given[vertex.index()] && !self.sides.opposite([vertex]).any(is_exact)
    }

    /// Whether a vertex was given, and not only as an image.
    pub(super) fn is_given(&self, vertex: SurfaceVertex) -> bool {
        self.is_given[vertex.index()]
    }

    /// Whether the given vertices alone are on both sides.
    pub(super) fn are_both_sides(&self) -> bool {
        self.shared_count as f64 >= BOTH_SHARE * self.given.len() as f64
    }

    /// All vertices that it was given.
    pub(super) fn given(&self) -> &[SurfaceVertex] {
        &self.given
    }

    /// Whether both sides are one handle, or the handle's side.
    pub(super) fn state(&self) -> State {
        let is_one = self.shared_count as f64 >= ONE_SHARE * self.given.len() as f64;
        match is_one && self.shared_count > 0 && !self.has_twin {
            true => State::One,
            false if self.height > 0.0 => State::InFront,
            false => State::Behind,
        }
    }

    /// These vertices and their partners, ascending, with whose each is.
    pub(super) fn around(&self, vertices: &[SurfaceVertex]) -> Vec<(SurfaceVertex, Half)> {
        let mut all = vertices.to_vec();
        all.extend(self.sides.opposite(vertices.iter().copied()));
        all.sort_unstable();
        all.dedup();
        all.into_iter().map(|vertex| (vertex, self.half(vertex))).collect()
    }

    fn half(&self, vertex: SurfaceVertex) -> Half {
        if self.state() == State::One {
            return Half::Own;
        }
        match (self.is_given[vertex.index()], self.is_shared[vertex.index()]) {
            (false, _) => Half::Twin,
            (true, false) => Half::Own,
            (true, true) => {
                let height = self.height_of(vertex);
                match height * self.height {
                    same if same > 0.0 => Half::Own,
                    other if other < 0.0 => Half::Twin,
                    _ => Half::Neither,
                }
            }
        }
    }

    fn height_of(&self, vertex: SurfaceVertex) -> f64 {
        self.sides.plane.height(self.model.surface.positions[vertex.index()])
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod tests {
    use std::f64::consts::PI;
    use std::sync::Arc;

    use glam::{DQuat, DVec3};
    use pliant_mesh::{Cancel, DrawnVertex, MirrorPlane, Model, Progress, SurfaceVertex, shapes};

    use super::{Half, Halves, State};
    use crate::jobs::BothSides;

    const LEG: f64 = 8.0;

    /// Half the distance between the middles of both legs, which are 1 thick from the middle.
    const APART: f64 = 1.25;

    /// Two legs that hang down from a bend, one at negative x and one at positive x, each turned forward by an angle in
    /// radians below y = −2; and their places with hanging legs.
    fn legs(forward_rad: [f64; 2]) -> (Arc<Model>, Vec<DVec3>) {
        let mut tube = shapes::tube(40, 140, 2.0 * LEG + PI * APART);
        for p in &mut tube.positions {
            let bend = (p.z - LEG).clamp(0.0, PI * APART) / APART;
            let below = (LEG - p.z).max(p.z - LEG - PI * APART).max(0.0);
            let out = DVec3::new(-bend.cos(), bend.sin(), 0.0);
            *p = (APART + p.x) * out + DVec3::new(0.0, -below, p.y);
        }
        let drawn = tube.positions.clone();
        for p in &mut tube.positions {
            let hip = DVec3::new(0.0, -2.0, 0.0);
            let share = (-2.0 - p.y).clamp(0.0, 1.0);
            let angle = share * forward_rad[usize::from(p.x > 0.0)];
            *p = hip + DQuat::from_rotation_x(angle) * (*p - hip);
        }
        let model = shapes::model(tube);
        let mut hanging = vec![DVec3::ZERO; model.surface.positions.len()];
        for (vertex, place) in (0..).map(DrawnVertex).zip(drawn) {
            hanging[model.drawn.surface_vertex(vertex).unwrap().index()] = place;
        }
        (Arc::new(model), hanging)
    }

    fn nothing_on(model: &Arc<Model>) -> Halves {
        let plane = MirrorPlane::across(0, 0.0);
        let sides = BothSides::find(model, None, Some(plane), &Progress::new(), &Cancel::new());
        Halves::of_nothing(Arc::new(sides.unwrap().unwrap()), Arc::clone(model), false)
    }

    fn where_hanging(hanging: &[DVec3], is_given: impl Fn(DVec3) -> bool) -> Vec<SurfaceVertex> {
        let all = (0..hanging.len() as u32).map(SurfaceVertex);
        all.filter(|v| is_given(hanging[v.index()])).collect()
    }

    #[test]
    fn a_limb_that_laps_over_to_the_limb_beside_it_has_a_twin_and_each_keeps_its_side() {
        for forward_rad in [[0.0, 0.0], [0.0, 0.4], [0.3, -0.3]] {
            let (model, hanging) = legs(forward_rad);
            let limb = where_hanging(&hanging, |p| p.x < 0.2 && p.y < 1.5);
            let mut halves = nothing_on(&model);
            halves.give(&limb);
            assert_eq!(halves.state(), State::Behind, "{forward_rad:?}");
            let around = halves.around(&limb);
            for (vertex, half) in &around {
                let p = hanging[vertex.index()];
                assert_eq!(*half == Half::Own, p.x < 0.0, "{forward_rad:?}: {p} is {half:?}");
            }
            let twins = around.iter().filter(|(_, half)| *half == Half::Twin).count();
            let expected = where_hanging(&hanging, |p| p.x > 0.0 && p.y < 1.5).len();
            assert!(
                twins as f64 > 0.98 * expected as f64,
                "{forward_rad:?}: {twins} of {expected}"
            );
        }
    }

    #[test]
    fn a_handle_over_the_middle_is_one_and_the_way_to_it_does_not_matter() {
        let (model, hanging) = legs([0.0, 0.4]);
        let limb = where_hanging(&hanging, |p| p.x < 0.1 && p.y < 1.5);
        let middle = where_hanging(&hanging, |p| p.x.abs() < 1.0 && p.y > 0.5);
        let mut from_limb = nothing_on(&model);
        from_limb.give(&limb);
        assert_eq!(from_limb.state(), State::Behind);
        let mut from_middle = nothing_on(&model);
        from_middle.give(&middle);
        assert_eq!(from_middle.state(), State::One);
        assert!(from_middle.around(&middle).iter().all(|(_, half)| *half == Half::Own));
        from_middle.give(&limb);
        from_limb.give(&middle);
        assert_eq!(from_limb.state(), from_middle.state());
        assert_eq!(from_limb.around(&limb), from_middle.around(&limb));
        assert_eq!(from_limb.give(&limb), []);
    }

    #[test]
    fn a_band_around_the_middle_is_on_both_sides_by_itself_and_a_patch_beside_it_is_not() {
        let (model, hanging) = legs([0.0, 0.4]);
        let given = |is_given: &dyn Fn(DVec3) -> bool| {
            let mut halves = nothing_on(&model);
            halves.give(&where_hanging(&hanging, is_given));
            halves
        };
        let band = given(&|p| p.x.abs() < 1.0 && p.y > -0.5);
        assert!(band.state() == State::One && band.are_both_sides());
        let patch = given(&|p| (-1.0..0.2).contains(&p.x) && p.y > -0.5);
        assert!(patch.state() == State::One && !patch.are_both_sides());
    }

    #[test]
    fn a_handle_with_a_twin_keeps_it() {
        let (model, hanging) = legs([0.0, 0.0]);
        let middle = where_hanging(&hanging, |p| p.x.abs() < 1.0 && p.y > 0.5);
        let one = nothing_on(&model);
        let mut halves = Halves::of_nothing(one.sides, Arc::clone(&model), true);
        halves.give(&where_hanging(&hanging, |p| p.x < -1.0));
        halves.give(&middle);
        assert_eq!(halves.state(), State::Behind);
        for (vertex, half) in halves.around(&middle) {
            let x = hanging[vertex.index()].x;
            assert_eq!(half == Half::Own, x < 0.0, "{x}");
        }
    }
}

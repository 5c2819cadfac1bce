//! The reach of twins: handles on both sides of a plane of symmetry, of which the second was made with the first.
//!
//! A shape is never quite the same on both sides, nor are its limbs posed alike. So a twin's reach, found on its own, may
//! run across a cheek that the other arm is far from. A twin reaches at most as much as its handle does, in areas of
//! each.

use std::collections::BTreeMap;

use pliant_mesh::{Surface, SurfaceVertex, Topology, face_area};

use crate::document::{HandleId, Reach};

/// The areas that the first handles of twins reach, in areas of the handle.
pub(super) struct TwinReach<'a> {
    surface: &'a Surface,
    topology: &'a Topology,
    /// The first handle of each second one.
    firsts: &'a BTreeMap<HandleId, HandleId>,
    shares: BTreeMap<HandleId, (Reach, f64)>,
}

impl<'a> TwinReach<'a> {
    pub(super) fn new(surface: &'a Surface, topology: &'a Topology, firsts: &'a BTreeMap<HandleId, HandleId>) -> Self {
        Self {
            surface,
            topology,
            firsts,
            shares: BTreeMap::new(),
        }
    }

    /// The limit of what a handle reaches: this one, or that at which a twin has reached as much as its handle. Vertices
    /// are `reached` nearly nearest first. Twins with different settings of a person keep them.
    pub(super) fn limit(
        &mut self,
        (id, reach): (HandleId, Reach),
        members: &[SurfaceVertex],
        reached: &[(SurfaceVertex, f64)],
        limit: f64,
    ) -> f64 {
        let within = || reached.iter().take_while(|(_, distance)| *distance <= limit);
        if self.firsts.values().any(|first| *first == id) {
            let area: f64 = within().map(|(vertex, _)| self.area(*vertex)).sum();
            self.shares.insert(id, (reach, area / self.area_of(members)));
        }
        let first = self.firsts.get(&id).and_then(|first| self.shares.get(first));
        let Some((_, share)) = first.filter(|(own, _)| *own == reach) else {
            return limit;
        };
        let most = share * self.area_of(members);
        let mut area = 0.0;
        for (vertex, distance) in within() {
            area += self.area(*vertex);
            if area > most {
                return *distance;
            }
        }
        limit
    }

    fn area_of(&self, vertices: &[SurfaceVertex]) -> f64 {
        vertices.iter().map(|vertex| self.area(*vertex)).sum()
    }

    /// A vertex' share of the surface.
    fn area(&self, vertex: SurfaceVertex) -> f64 {
        let triangles = &self.surface.triangles;
        let faces = self.topology.faces(vertex, triangles);
        let corners = |face: u32| triangles[face as usize].map(|v| self.surface.positions[v.index()]);
        faces.map(|face| face_area(corners(face)) / 3.0).sum()
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod tests {
    use std::collections::BTreeMap;

    use glam::DVec3;
    use pliant_deform::Role;
    use pliant_mesh::{Cancel, shapes};

    use crate::document::{HandleId, Paint, Reach};
    use crate::region::Region;
    use crate::region::tests::painted_input;

    const FIRST: HandleId = HandleId(1);
    const SECOND: HandleId = HandleId(4);
    const REACH: Reach = Reach::Length(0.15);

    /// The free vertices around two discs of a sheet, one near its border and one in its middle, in areas of each.
    fn free(firsts: BTreeMap<HandleId, HandleId>, reaches: [Reach; 2]) -> [f64; 2] {
        let middles = [DVec3::new(0.08, 0.5, 0.0), DVec3::new(0.65, 0.5, 0.0)];
        let near = |p: &DVec3, middle: DVec3, radius: f64| p.distance(middle) < radius;
        let paint = |p: &DVec3| match () {
            () if near(p, middles[0], 0.06) => Paint::Handle(FIRST),
            () if near(p, middles[1], 0.06) => Paint::Handle(SECOND),
            () => Paint::Bare,
        };
        let model = shapes::model(shapes::grid(100, 100));
        let mut input = painted_input(model, &[FIRST, SECOND], REACH, paint);
        input.twins = firsts;
        input.handles = vec![(FIRST, reaches[0]), (SECOND, reaches[1])];
        let region = Region::measure(&input, &Cancel::new()).unwrap();
        let positions = &input.model.surface.positions;
        [0, 1].map(|handle| {
            let count = |is: &dyn Fn(usize, f64) -> bool| {
                let from = |v: usize| positions[v].distance(middles[handle]);
                (0..positions.len()).filter(|v| is(*v, from(*v))).count() as f64
            };
            let free = count(&|v, from| region.roles[v] == Role::Free && from < 0.25);
            free / count(&|v, _| region.roles[v] == Role::Handle(handle as u16))
        })
    }

    #[test]
    fn a_twin_reaches_as_much_as_its_handle_unless_a_person_has_set_another_reach() {
        let twins = BTreeMap::from([(SECOND, FIRST)]);
        let alone = free(BTreeMap::new(), [REACH; 2]);
        // The border cuts a quarter off.
        assert!(alone[1] > 1.2 * alone[0], "{alone:?}");
        let tied = free(twins.clone(), [REACH; 2]);
        assert_eq!(tied[0], alone[0]);
        assert!((tied[1] / tied[0] - 1.0).abs() < 0.1, "{tied:?}");
        let larger = [REACH, Reach::Length(0.16)];
        assert_eq!(free(twins, larger), free(BTreeMap::new(), larger));
    }
}

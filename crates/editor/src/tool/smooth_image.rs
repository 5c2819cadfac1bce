//! The rim of an image across the plane of symmetry, without rags.
//!
//! Where limbs stand differently on both sides, counterparts are off by some edges, here more and there less: an image
//! has holes, islands and a ragged rim. A few rounds of majority among neighbours take them off.

use std::collections::BTreeMap;

use pliant_mesh::{SurfaceVertex, Topology};

/// Rags are narrower than twice this many edges.
const ROUNDS: usize = 8;

/// The vertices that enter or leave the image of a set, and whether they are in it then. `is_in` is the image, and
/// `may_change` says which vertices are not decided by anything else.
pub(super) fn smooth_image(
    topology: &Topology,
    image: &[SurfaceVertex],
    is_in: impl Fn(SurfaceVertex) -> bool,
    may_change: impl Fn(SurfaceVertex) -> bool,
) -> BTreeMap<SurfaceVertex, bool> {
    let mut changed: BTreeMap<SurfaceVertex, bool> = BTreeMap::new();
    // Only vertices at the rim can change, and later those beside them.
    let at_rim = |vertex: &SurfaceVertex| topology.neighbours(*vertex).iter().any(|other| !is_in(*other));
    let mut looked_at: Vec<SurfaceVertex> = image.iter().copied().filter(at_rim).collect();
    for _ in 0..ROUNDS {
        let beside = looked_at
            .iter()
            .flat_map(|vertex| topology.neighbours(*vertex).iter().copied());
        let mut around: Vec<SurfaceVertex> = beside.chain(looked_at.iter().copied()).collect();
        around.sort_unstable();
        around.dedup();
        around.retain(|vertex| may_change(*vertex));
        let is_now = |vertex: SurfaceVertex| changed.get(&vertex).copied().unwrap_or_else(|| is_in(vertex));
        let turned = around.into_iter().filter_map(|vertex| {
            let neighbours = topology.neighbours(vertex);
            let inside = neighbours.iter().filter(|other| is_now(**other)).count();
            let will_be = match (2 * inside).cmp(&neighbours.len()) {
                std::cmp::Ordering::Less => false,
                std::cmp::Ordering::Equal => is_now(vertex),
                std::cmp::Ordering::Greater => true,
            };
            (will_be != is_now(vertex)).then_some((vertex, will_be))
        });
        let turned: Vec<(SurfaceVertex, bool)> = turned.collect();
        looked_at = turned.iter().map(|(vertex, _)| *vertex).collect();
        changed.extend(turned);
        if looked_at.is_empty() {
            break;
        }
    }
    changed.retain(|vertex, is_inside| *is_inside != is_in(*vertex));
    changed
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use pliant_mesh::{SurfaceVertex, shapes};

    use super::smooth_image;

    #[test]
    fn holes_islands_and_rags_go_a_straight_rim_and_what_is_decided_stay() {
        let model = shapes::model(shapes::grid(40, 40));
        let positions = &model.surface.positions;
        let all = || (0..positions.len() as u32).map(SurfaceVertex);
        let is_half = |v: SurfaceVertex| positions[v.index()].x < 0.501;
        // Every seventh vertex is on the wrong side.
        let is_rag = |v: SurfaceVertex| v.index() % 7 == 3;
        let is_near = |v: SurfaceVertex| (positions[v.index()].x - 0.5).abs() < 0.2;
        let ragged: BTreeSet<SurfaceVertex> = all().filter(|v| is_half(*v) != (is_rag(*v) && is_near(*v))).collect();
        let image: Vec<SurfaceVertex> = ragged.iter().copied().collect();
        let smoothed = |is_decided: &dyn Fn(SurfaceVertex) -> bool| -> BTreeSet<SurfaceVertex> {
            let changed = smooth_image(&model.topology, &image, |v| ragged.contains(&v), |v| !is_decided(v));
            let is_in = |v: &SurfaceVertex| changed.get(v).copied().unwrap_or_else(|| ragged.contains(v));
            all().filter(is_in).collect()
        };
        let smooth = smoothed(&|_| false);
        let wrong = |v: &SurfaceVertex| smooth.contains(v) != is_half(*v);
        assert!(all().filter(wrong).all(|v| (positions[v.index()].x - 0.5).abs() < 0.06));
        assert_eq!(smoothed(&|_| true), ragged);
        let straight: Vec<SurfaceVertex> = all().filter(|v| is_half(*v)).collect();
        let changed = smooth_image(&model.topology, &straight, is_half, |_| true);
        assert!(
            changed
                .keys()
                .all(|v| positions[v.index()].y < 0.05 || positions[v.index()].y > 0.95)
        );
    }
}

//! The tips of a spine's limb.
//!
//! The fingers of a hand are longer than the arm is thick, so that the limb around a spine leaves their tips out, and
//! may leave out a patch at a thumb. The limb cuts them off from the body: left free, they would be a slack end of what
//! the spine moves. They are the limb's, if they are wholly near its spine; a shank below a spine that ends at the knee
//! is not.

use pliant_mesh::{SurfaceVertex, Topology};

/// The pieces of the surface that the limb of these vertices cuts off from the body, which is the largest piece, and whose
/// vertices all are `near` its spine.
pub(super) fn tips(
    limb: &[SurfaceVertex],
    topology: &Topology,
    vertex_count: usize,
    near: impl Fn(SurfaceVertex) -> bool,
) -> Vec<SurfaceVertex> {
    let mut is_passed = vec![false; vertex_count];
    limb.iter().for_each(|vertex| is_passed[vertex.index()] = true);
    let rim = limb.iter().flat_map(|vertex| topology.neighbours(*vertex));
    let mut pieces: Vec<Vec<SurfaceVertex>> = Vec::new();
    for &start in rim {
        let (mut piece, mut front) = (Vec::new(), vec![start]);
        while let Some(vertex) = front.pop() {
            if !std::mem::replace(&mut is_passed[vertex.index()], true) {
                piece.push(vertex);
                front.extend(topology.neighbours(vertex));
            }
        }
        if !piece.is_empty() {
            pieces.push(piece);
        }
    }
    let body = (0..pieces.len()).max_by_key(|&piece| pieces[piece].len());
    let cut_off = (0..).zip(&pieces).filter(|(piece, _)| Some(*piece) != body);
    let tips = cut_off.filter(|(_, vertices)| vertices.iter().all(|vertex| near(*vertex)));
    tips.flat_map(|(_, vertices)| vertices.iter().copied()).collect()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use pliant_mesh::{SurfaceVertex, shapes};

    use super::tips;

    #[test]
    fn what_the_limb_cuts_off_near_its_spine_is_its_own_and_neither_the_body_nor_what_is_far_off() {
        let mut strip = shapes::grid(60, 10);
        strip.positions.iter_mut().for_each(|p| p.x *= 6.0);
        let model = shapes::model(strip);
        let positions = &model.surface.positions;
        let within = |from: f64, to: f64| -> Vec<SurfaceVertex> {
            let all = (0..positions.len() as u32).map(SurfaceVertex);
            all.filter(|v| (from..=to).contains(&positions[v.index()].x)).collect()
        };
        let found = |limb: &[SurfaceVertex], near: [f64; 2]| -> BTreeSet<SurfaceVertex> {
            let is_near = |v: SurfaceVertex| (near[0]..=near[1]).contains(&positions[v.index()].x);
            tips(limb, &model.topology, positions.len(), is_near)
                .into_iter()
                .collect()
        };
        let limb = within(3.95, 4.95);
        let tip: BTreeSet<SurfaceVertex> = within(4.95, 7.0).into_iter().collect();
        // The body is as near here.
        assert_eq!(found(&limb, [-1.0, 7.0]), tip);
        assert_eq!(
            found(&limb, [3.0, 5.55]),
            BTreeSet::new(),
            "a part of the tip is too far away"
        );
        // An island in the limb.
        let hole = within(4.35, 4.55);
        let mut around = within(3.95, 7.0);
        around.retain(|v| !hole.contains(v));
        assert_eq!(found(&around, [3.0, 7.0]), hole.into_iter().collect());
    }
}

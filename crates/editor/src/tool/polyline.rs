//! Lines over the view, as points of it: their length, their loops, and their bends.

use glam::DVec2;

use crate::view::distance_to_segment;

/// The length of a line, in points.
pub(super) fn length_px(line: &[DVec2]) -> f64 {
    line.windows(2).map(|pair| pair[0].distance(pair[1])).sum()
}

/// The longest loop of a line that crosses itself, from the crossing around to its last point before it; `None` if it
/// does not cross itself.
pub(super) fn crossed_loop(line: &[DVec2]) -> Option<Vec<DVec2>> {
    let segments = line.len().saturating_sub(1);
    let pairs = (0..segments).flat_map(|from| (from + 2..segments).map(move |to| (from, to)));
    let crossing = |(from, to): (usize, usize)| {
        let (a, b, c, d) = (line[from], line[from + 1], line[to], line[to + 1]);
        let across = (b - a).perp_dot(d - c);
        let [own, other] = [(c - a).perp_dot(d - c) / across, (c - a).perp_dot(b - a) / across];
        let is_inside = (0.0..=1.0).contains(&own) && (0.0..=1.0).contains(&other);
        is_inside.then(|| (from, to, a.lerp(b, own)))
    };
    let (from, to, at) = pairs.filter_map(crossing).max_by_key(|(from, to, _)| to - from)?;
    Some(std::iter::once(at).chain(line[from + 1..=to].iter().copied()).collect())
}

/// The points of a line that are needed so that no other is further from it than this, by the division of Douglas and Peucker.
pub(super) fn simplified(line: &[DVec2], slack_px: f64) -> Vec<DVec2> {
    let [first, inner @ .., last] = line else {
        return line.to_vec();
    };
    let away = |(_, point): &(usize, &DVec2)| distance_to_segment(**point, *first, *last);
    let farthest = inner.iter().enumerate().max_by(|a, b| away(a).total_cmp(&away(b)));
    match farthest {
        Some(farthest) if away(&farthest) > slack_px => {
            let middle = farthest.0 + 1;
            let mut kept = simplified(&line[..=middle], slack_px);
            kept.pop();
            kept.extend(simplified(&line[middle..], slack_px));
            kept
        }
        _ => vec![*first, *last],
    }
}

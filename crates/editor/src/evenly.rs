//! Points at even distances along a line.

use glam::DVec3;

/// Points at even distances along a line over the surface; a closed line does not come to its first point again.
pub(crate) fn evenly(line: &[DVec3], count: usize, is_closed: bool) -> Vec<DVec3> {
    let mut places = vec![0.0];
    for pair in line.windows(2) {
        places.push(places[places.len() - 1] + pair[0].distance(pair[1]));
    }
    let whole = places[places.len() - 1];
    let steps = if is_closed { count } else { count - 1 } as f64;
    let at = |place: f64| {
        let next = places.partition_point(|other| *other < place).min(line.len() - 1);
        let before = next.saturating_sub(1);
        let way = places[next] - places[before];
        let share = if way > 0.0 { (place - places[before]) / way } else { 0.0 };
        line[before].lerp(line[next], share)
    };
    match line {
        [] => Vec::new(),
        _ => (0..count).map(|point| at(whole * point as f64 / steps)).collect(),
    }
}

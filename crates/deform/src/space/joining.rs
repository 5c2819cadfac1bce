//! Links that join loose parts: the nearest points of two, until all are one, and braces of the joints.

use glam::DVec3;

/// Further links at each end of a brace.
const BRACES: usize = 2;

/// Pairs of points, the nearest first, that join all parts that the pairs `firm` do not join.
///
/// They are the shortest spanning tree of the parts, which grows from the first point (Prim), in memory that grows with
/// the points alone.
pub(crate) fn joins(points: &[DVec3], firm: &[[u32; 2]]) -> Vec<[u32; 2]> {
    let mut part: Vec<usize> = (0..points.len()).collect();
    let mut parts = points.len();
    for [one, other] in firm {
        let [one, other] = [one, other].map(|&point| root(&mut part, point as usize));
        parts -= usize::from(one != other);
        part[one.max(other)] = one.min(other);
    }
    if parts <= 1 {
        return Vec::new();
    }
    let part: Vec<usize> = (0..points.len()).map(|point| root(&mut part, point)).collect();
    let mut members = vec![Vec::new(); points.len()];
    for (point, &of) in part.iter().enumerate() {
        members[of].push(point);
    }
    // The first of several pairs that differ by rounding alone is taken.
    let longest = points.iter().fold(f64::MIN_POSITIVE, |longest, point| {
        longest.max(point.distance(points[0]))
    });
    let key = |one: usize, other: usize| {
        let distance = (points[one].distance(points[other]) / longest * 1e9).round() as u64;
        (distance, [one.min(other) as u32, one.max(other) as u32])
    };
    // The best pair of each point outside with one inside.
    let mut best = vec![(u64::MAX, [u32::MAX; 2]); points.len()];
    // A little more than its squared distance: it excludes most pairs.
    let mut bound = vec![f64::INFINITY; points.len()];
    let mut outside: Vec<usize> = (0..points.len()).collect();
    let mut joins = Vec::with_capacity(parts - 1);
    let mut next = part[0];
    loop {
        outside.retain(|&point| part[point] != next);
        for &point in &outside {
            for &inside in &members[next] {
                let square = points[point].distance_squared(points[inside]);
                if square <= bound[point] {
                    best[point] = best[point].min(key(point, inside));
                    bound[point] = bound[point].min(square * (1.0 + 1e-6) + (1e-8 * longest).powi(2));
                }
            }
        }
        let Some(&nearest) = outside.iter().min_by_key(|&&point| best[point]) else {
            break;
        };
        joins.push(best[nearest]);
        next = part[nearest];
    }
    joins.sort_unstable();
    joins.into_iter().map(|(_, pair)| pair).collect()
}

/// Further pairs beside each of the `links` that alone holds two parts together, which could turn about it: each end is
/// joined to points around the other one, off its axis if there are any. `links` are ascending within each pair.
pub(crate) fn braces(points: &[DVec3], links: &[[u32; 2]]) -> Vec<[u32; 2]> {
    let mut around = vec![Vec::new(); points.len()];
    for &[one, other] in links {
        around[one as usize].push(other);
        around[other as usize].push(one);
    }
    let mut braces = Vec::new();
    for [one, other] in bridges(&around) {
        for (from, to) in [(one, other), (other, one)] {
            let axis = (points[to as usize] - points[from as usize]).normalize_or_zero();
            let off = |&beside: &u32| axis.cross(points[beside as usize] - points[to as usize]).length();
            let mut beside: Vec<u32> = around[to as usize].iter().copied().filter(|&v| v != from).collect();
            beside.sort_by(|a, b| off(b).total_cmp(&off(a)).then(a.cmp(b)));
            braces.extend(beside.iter().take(BRACES).map(|&v| [v.min(from), v.max(from)]));
        }
    }
    braces.sort_unstable();
    braces.dedup();
    braces.retain(|pair| !around[pair[0] as usize].contains(&pair[1]));
    braces
}

/// The links without which a graph falls apart, by a depth-first search [Tar72].
fn bridges(around: &[Vec<u32>]) -> Vec<[u32; 2]> {
    const UNSEEN: u32 = u32::MAX;
    let mut found = Vec::new();
    let mut seen = vec![UNSEEN; around.len()];
    let mut lowest = vec![UNSEEN; around.len()];
    let mut time = 0;
    for start in 0..around.len() {
        if seen[start] != UNSEEN {
            continue;
        }
        // A node, the node before it, and the number of its neighbours visited so far.
        let mut path = vec![(start, UNSEEN, 0)];
        (seen[start], lowest[start]) = (time, time);
        time += 1;
        while let Some(&mut (node, from, ref mut looked_at)) = path.last_mut() {
            if let Some(&other) = around[node].get(*looked_at) {
                *looked_at += 1;
                let other_node = other as usize;
                if other == from {
                    continue;
                }
                if seen[other_node] == UNSEEN {
                    (seen[other_node], lowest[other_node]) = (time, time);
                    time += 1;
                    path.push((other_node, node as u32, 0));
                } else {
                    lowest[node] = lowest[node].min(seen[other_node]);
                }
                continue;
            }
            path.pop();
            if let Some(&(above, ..)) = path.last() {
                lowest[above] = lowest[above].min(lowest[node]);
                if lowest[node] > seen[above] {
                    found.push([above.min(node) as u32, above.max(node) as u32]);
                }
            }
        }
    }
    found
}

/// The lowest known point of a part.
fn root(part: &mut [usize], mut point: usize) -> usize {
    while part[point] != point {
        part[point] = part[part[point]];
        point = part[point];
    }
    point
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::{braces, joins};

    fn noise(k: usize) -> f64 {
        ((k as f64 * 12.9898).sin() * 43_758.545).fract()
    }

    #[test]
    fn joins_are_the_shortest_tree_of_the_parts() {
        let points: Vec<DVec3> = (0..40)
            .map(|k| DVec3::new(noise(3 * k), noise(3 * k + 1), noise(3 * k + 2)))
            .collect();
        let firm: Vec<[u32; 2]> = (0..12).map(|k| [k, 39 - k]).collect();
        // All pairs, the shortest first.
        let mut part: Vec<usize> = (0..40).collect();
        let mut join = |[one, other]: [u32; 2]| {
            let (a, b) = (part[one as usize], part[other as usize]);
            part.iter_mut().filter(|part| **part == b).for_each(|part| *part = a);
            a != b
        };
        firm.iter().for_each(|&pair| {
            join(pair);
        });
        let mut pairs: Vec<[u32; 2]> = (0..40)
            .flat_map(|one| (one + 1..40).map(move |other| [one, other]))
            .collect();
        let length = |[one, other]: [u32; 2]| points[one as usize].distance(points[other as usize]);
        pairs.sort_by(|a, b| length(*a).total_cmp(&length(*b)));
        let expected: Vec<[u32; 2]> = pairs.into_iter().filter(|&pair| join(pair)).collect();
        assert_eq!(joins(&points, &firm), expected);
        assert!(joins(&points[..1], &[]).is_empty() && joins(&[], &[]).is_empty());
    }

    #[test]
    fn a_link_that_holds_two_parts_alone_is_braced_and_others_are_not() {
        let corner = |x: f64| {
            [
                DVec3::new(x, 0.0, 0.0),
                DVec3::new(x, 1.0, 0.0),
                DVec3::new(x, 0.0, 1.0),
            ]
        };
        let points = [corner(0.0), corner(2.0)].concat();
        let triangles = [[0, 1], [1, 2], [0, 2], [3, 4], [4, 5], [3, 5]];
        let hinged = [&triangles[..], &[[0, 3]]].concat();
        assert_eq!(braces(&points, &hinged), [[0, 4], [0, 5], [1, 3], [2, 3]]);
        let firm = [&hinged[..], &[[1, 4]]].concat();
        assert!(braces(&points, &firm).is_empty());
    }
}

//! The generated triangle mesh: half-edge adjacency, and the check that it is closed and manifold.

use super::vector::Vec3;

/// Vertices with colours, and triangles, counterclockwise seen from outside.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Positions in world units.
    pub positions: Vec<Vec3>,
    /// Linear red, green and blue in [0, 1], one entry per vertex.
    pub colours: Vec<Vec3>,
    /// Vertex indices, three per triangle.
    pub triangles: Vec<[u32; 3]>,
    /// Morph targets: a name, and the displacement of each vertex.
    pub targets: Vec<(&'static str, Vec<Vec3>)>,
}

/// The opposite of a half-edge on the boundary.
pub const BOUNDARY: u32 = u32::MAX;

impl Mesh {
    /// Area-weighted unit normals, one per vertex.
    pub fn normals(&self) -> Vec<Vec3> {
        let mut sums = vec![Vec3::default(); self.positions.len()];
        for t in &self.triangles {
            let [a, b, c] = t.map(|i| self.positions[i as usize]);
            let twice_area = (b - a).cross(c - a);
            for &i in t {
                sums[i as usize] += twice_area;
            }
        }
        sums.into_iter().map(Vec3::normalized).collect()
    }

    /// For half-edge `3 t + c` (from corner `c` of triangle `t` to the next corner), the opposite half-edge or
    /// [`BOUNDARY`].
    ///
    /// # Errors
    /// Names an edge of more than two triangles, or of two triangles with opposite orientation.
    pub fn opposites(&self) -> Result<Vec<u32>, String> {
        let mut edges: Vec<(u32, u32, u32)> = Vec::with_capacity(self.triangles.len() * 3);
        for (t, triangle) in self.triangles.iter().enumerate() {
            for c in 0..3 {
                let (a, b) = (triangle[c], triangle[(c + 1) % 3]);
                edges.push((a.min(b), a.max(b), (3 * t + c) as u32));
            }
        }
        edges.sort_unstable();
        let mut opposite = vec![BOUNDARY; edges.len()];
        let starts_at = |h: u32| self.triangles[h as usize / 3][h as usize % 3];
        for group in edges.chunk_by(|p, q| (p.0, p.1) == (q.0, q.1)) {
            match *group {
                [_] => {}
                [(_, _, h), (_, _, k)] if starts_at(h) != starts_at(k) => {
                    opposite[h as usize] = k;
                    opposite[k as usize] = h;
                }
                _ => return Err(format!("edge {}-{} is not manifold", group[0].0, group[0].1)),
            }
        }
        Ok(opposite)
    }

    /// Keeps only the largest component: fine detail can pinch off a speck.
    pub fn keep_largest_part(&mut self) {
        let mut leader: Vec<u32> = (0..self.positions.len() as u32).collect();
        for triangle in &self.triangles {
            let a = find(&mut leader, triangle[0]);
            for &other in &triangle[1..] {
                let b = find(&mut leader, other);
                leader[b as usize] = a;
            }
        }
        let leaders: Vec<u32> = (0..self.positions.len() as u32).map(|i| find(&mut leader, i)).collect();
        let mut counts = vec![0_u32; leaders.len()];
        leaders.iter().for_each(|&i| counts[i as usize] += 1);
        let Some(largest) = (0..counts.len()).rev().max_by_key(|&i| counts[i]) else {
            return;
        };
        let mut kept = 0;
        let renumbered: Vec<Option<u32>> = leaders
            .iter()
            .map(|&i| {
                let is_kept = i as usize == largest;
                kept += u32::from(is_kept);
                is_kept.then(|| kept - 1)
            })
            .collect();
        let mut number = renumbered.iter();
        self.positions.retain(|_| number.next().is_some_and(Option::is_some));
        self.triangles.retain_mut(|triangle| {
            let numbers = triangle.map(|i| renumbered[i as usize]);
            let [Some(a), Some(b), Some(c)] = numbers else {
                return false;
            };
            *triangle = [a, b, c];
            true
        });
    }

    /// Checks that the mesh is closed, manifold, connected and oriented outwards, without degenerate triangles.
    ///
    /// # Errors
    /// Names the first edge, vertex or triangle that violates this.
    pub fn check_closed(&self) -> Result<(), String> {
        let opposite = self.opposites()?;
        if let Some(h) = opposite.iter().position(|&o| o == BOUNDARY) {
            return Err(format!("triangle {} has an open edge", h / 3));
        }
        let mut degree = vec![0_u32; self.positions.len()];
        let mut leaving = vec![BOUNDARY; self.positions.len()];
        for (t, triangle) in self.triangles.iter().enumerate() {
            let [a, b, c] = triangle.map(|i| self.positions[i as usize]);
            if (b - a).cross(c - a).length() <= 0.0 {
                return Err(format!("triangle {t} has no area"));
            }
            for (c, &i) in triangle.iter().enumerate() {
                degree[i as usize] += 1;
                leaving[i as usize] = (3 * t + c) as u32;
            }
        }
        for (i, &start) in leaving.iter().enumerate() {
            if start == BOUNDARY {
                return Err(format!("vertex {i} belongs to no triangle"));
            }
            let (mut h, mut around) = (start, 0);
            while around <= degree[i] {
                h = opposite[previous(h) as usize];
                around += 1;
                if h == start {
                    break;
                }
            }
            if around != degree[i] {
                return Err(format!("the triangles around vertex {i} form more than one fan"));
            }
        }
        let mut reached = vec![false; self.triangles.len()];
        let mut queue = vec![0_u32];
        reached[0] = true;
        let mut count = 0;
        while let Some(t) = queue.pop() {
            count += 1;
            for c in 0..3 {
                let next = opposite[(3 * t + c) as usize] / 3;
                if !std::mem::replace(&mut reached[next as usize], true) {
                    queue.push(next);
                }
            }
        }
        if count != self.triangles.len() {
            return Err(format!(
                "only {count} of {} triangles are connected",
                self.triangles.len()
            ));
        }
        let six_volumes = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| self.positions[i as usize]);
            a.dot(b.cross(c))
        };
        if self.triangles.iter().map(six_volumes).sum::<f64>() <= 0.0 {
            return Err("the triangles are oriented inwards".to_owned());
        }
        Ok(())
    }
}

/// The root of `i`'s set, with path halving.
fn find(leader: &mut [u32], mut i: u32) -> u32 {
    while leader[i as usize] != i {
        leader[i as usize] = leader[leader[i as usize] as usize];
        i = leader[i as usize];
    }
    i
}

/// The half-edge after `h` in its triangle.
pub fn next(h: u32) -> u32 {
    if h % 3 == 2 { h - 2 } else { h + 1 }
}

/// The half-edge before `h` in its triangle.
pub fn previous(h: u32) -> u32 {
    if h.is_multiple_of(3) { h + 2 } else { h - 1 }
}

/// Maps 0..`count` in parallel on all threads; the result does not depend on their number.
pub fn in_parallel<T: Send>(count: usize, function: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let share = count.div_ceil(threads).max(1);
    let function = &function;
    std::thread::scope(|scope| {
        let parts: Vec<_> = (0..count)
            .step_by(share)
            .map(|from| scope.spawn(move || (from..(from + share).min(count)).map(function).collect::<Vec<T>>()))
            .collect();
        parts
            .into_iter()
            .flat_map(|part| part.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
            .collect()
    })
}

#[cfg(test)]
mod tests {
    use super::super::vector::v;
    use super::*;

    fn tetrahedron() -> Mesh {
        let positions = vec![v(0.0, 0.0, 0.0), v(1.0, 0.0, 0.0), v(0.0, 1.0, 0.0), v(0.0, 0.0, 1.0)];
        let triangles = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        Mesh {
            colours: vec![v(1.0, 1.0, 1.0); 4],
            positions,
            triangles,
            targets: Vec::new(),
        }
    }

    #[test]
    fn a_tetrahedron_is_closed_and_its_normals_point_out() {
        let mesh = tetrahedron();
        assert_eq!(mesh.check_closed(), Ok(()));
        let centre = v(0.25, 0.25, 0.25);
        assert!(
            mesh.normals()
                .iter()
                .zip(&mesh.positions)
                .all(|(n, p)| n.dot(*p - centre) > 0.0)
        );
    }

    #[test]
    fn open_turned_and_touching_surfaces_are_refused() {
        let mut open = tetrahedron();
        open.triangles.pop();
        assert!(open.check_closed().is_err());
        let mut turned = tetrahedron();
        turned.triangles[0] = [0, 1, 2];
        assert!(turned.check_closed().is_err());
        let mut inwards = tetrahedron();
        inwards.triangles.iter_mut().for_each(|t| t.reverse());
        assert!(inwards.check_closed().is_err());
        let mut touching = tetrahedron();
        touching
            .positions
            .extend([v(-1.0, 0.0, 0.0), v(0.0, -1.0, 0.0), v(0.0, 0.0, -1.0)]);
        touching.triangles.extend([[0, 5, 4], [0, 4, 6], [4, 5, 6], [5, 0, 6]]);
        assert!(
            touching
                .check_closed()
                .is_err_and(|sentence| sentence.contains("vertex 0"))
        );
    }

    #[test]
    fn specks_are_dropped() {
        let mut mesh = tetrahedron();
        mesh.positions.insert(0, v(9.0, 9.0, 9.0));
        mesh.triangles.iter_mut().flatten().for_each(|i| *i += 1);
        mesh.positions
            .extend([v(5.0, 0.0, 0.0), v(6.0, 0.0, 0.0), v(5.0, 1.0, 0.0)]);
        mesh.triangles.insert(1, [5, 6, 7]);
        mesh.keep_largest_part();
        assert_eq!(
            (mesh.positions, mesh.triangles),
            (tetrahedron().positions, tetrahedron().triangles)
        );
    }

    #[test]
    fn parallel_results_stand_in_order() {
        assert_eq!(
            in_parallel(1000, |i| i * i),
            (0..1000).map(|i| i * i).collect::<Vec<_>>()
        );
        assert!(in_parallel(0, |i| i).is_empty());
    }
}

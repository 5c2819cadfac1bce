//! Chooses the borders to join and the anchors between them: by pairs, or by nearness and arc length.

use std::collections::BTreeMap;

use glam::DVec3;
use pliant_deform::RigidMotion;
use pliant_mesh::{FileVertex, SurfaceOfFile, SurfaceVertex};

use super::line::{Correspondence, Line};
use super::pair::{MergeError, Pair};
use crate::borders::Borders;
use crate::error::StitchError;
use crate::part::Part;

/// Two borders that are joined.
#[derive(Clone, Debug)]
pub(crate) struct Join {
    /// A's border.
    pub a: Line,
    /// B's border, in the opposite direction, so that both have the same direction.
    pub b: Line,
    /// The map between them.
    pub map: Correspondence,
}

/// Without pairs, at most this many of each part's longest borders are considered.
const MOST_BORDERS: usize = 16;

/// The vertices on both sides of the nearest one that are tried as the beginning of a border.
const AROUND: usize = 2;

/// The number of points at which two borders are compared.
const SAMPLES: usize = 96;

/// The most candidates whose other borders are compared point by point: symmetric borders have one for each vertex.
const MOST_COMPARED: usize = 64;

/// Two borders are the two sides of one cut if a rigid motion fits their points within this share of their length.
const CONGRUENT: f64 = 1e-5;

/// After the first two borders are fitted, others also belong together if their points are within this share of their
/// length.
const NEAR: f64 = 0.1;

impl Join {
    /// The joins that pairs of vertices name.
    pub fn by_pairs(parts: [&Part<'_>; 2], borders: [&Borders; 2], pairs: &[Pair]) -> Result<Vec<Self>, MergeError> {
        let mut of_borders: BTreeMap<usize, (usize, Vec<[usize; 2]>)> = BTreeMap::new();
        let mut taken: BTreeMap<usize, usize> = BTreeMap::new();
        let mut seen: [BTreeMap<SurfaceVertex, ()>; 2] = Default::default();
        let tables = parts.map(|part| part.model.surface_of_file());
        for (number, pair) in pairs.iter().enumerate() {
            let mut on = [(0, 0, SurfaceVertex(0)); 2];
            for side in 0..2 {
                let (border, place) = found((parts[side], &tables[side]), borders[side], pair, side)?;
                let vertex = borders[side].sound[border].vertices[place];
                if seen[side].insert(vertex, ()).is_some() {
                    let vertex = pair.named[side];
                    return Err(MergeError::of(
                        side,
                        StitchError::TwicePaired {
                            part: ["A", "B"][side],
                            vertex,
                        },
                    ));
                }
                on[side] = (border, place, vertex);
            }
            let [(a, place_a, _), (b, place_b, _)] = on;
            let own = of_borders.entry(a).or_insert_with(|| (b, Vec::new()));
            if own.0 != b || *taken.entry(b).or_insert(a) != a {
                let [a, b] = pair.named;
                return Err(MergeError::of(0, StitchError::CrossedBorders { pair: number, a, b }));
            }
            let count = borders[1].sound[b].vertices.len();
            own.1.push([place_a, count - 1 - place_b]);
        }
        let mut joins = Vec::new();
        for (a, (b, mut places)) in of_borders {
            let (a, b) = (line(parts[0], borders[0], a), reversed(parts[1], borders[1], b));
            places.sort_unstable();
            let falls = (0..places.len()).filter(|&k| places[(k + 1) % places.len()][1] < places[k][1]);
            if places.len() > 1 && falls.count() != 1 {
                let vertex = parts[0].model.first_file_vertex(a.vertices[0]).0;
                return Err(MergeError::of(0, StitchError::PairsOutOfOrder { vertex }));
            }
            let anchors = places.iter().map(|&[i, j]| [a.ways[i], b.ways[j]]).collect();
            let map = Correspondence::of(anchors, [a.length(), b.length()]);
            joins.push(Self { a, b, map });
        }
        Ok(joins)
    }

    /// The joins of the borders that are nearest and differ least in length. With `holds` B does not move first, and
    /// the borders whose points have the least way to each other are joined.
    pub fn by_nearness(parts: [&Part<'_>; 2], borders: [&Borders; 2], holds: bool) -> Vec<Self> {
        let most = |side: usize| borders[side].sound.len().min(MOST_BORDERS);
        let a: Vec<Line> = (0..most(0)).map(|k| line(parts[0], borders[0], k)).collect();
        let b: Vec<Line> = (0..most(1)).map(|k| reversed(parts[1], borders[1], k)).collect();
        let mut candidates = Vec::new();
        for (i, a) in a.iter().enumerate() {
            for (j, b) in b.iter().enumerate() {
                candidates.extend(Candidate::best(i, j, a, b, holds));
            }
        }
        let key = |candidate: &Candidate| (!candidate.is_congruent, candidate.i, candidate.j);
        let near = |candidate: &Candidate| candidate.is_congruent.then(|| candidate.count_near(&a, &b));
        let mut ranked: Vec<(Option<usize>, Candidate)> = candidates
            .into_iter()
            .map(|candidate| (near(&candidate), candidate))
            .collect();
        ranked.sort_by(|(near_a, a), (near_b, b)| {
            let of_kind = near_b.cmp(near_a);
            of_kind.then(a.cost.total_cmp(&b.cost)).then(key(a).cmp(&key(b)))
        });
        // The best candidate for the two sides of a cut is the one that brings most other borders together. Borders
        // whose middles come together are a bound for that, so only the first candidates are compared in full.
        let together = |candidate: &Candidate| (0..b.len()).filter_map(|j| candidate.partner(j, &a, &b)).count();
        let compared = ranked.len().min(MOST_COMPARED);
        if ranked
            .first()
            .is_some_and(|(near, _)| near.is_some_and(|near| near > 0))
        {
            let counts: Vec<Option<usize>> = ranked[..compared]
                .iter()
                .map(|(near, candidate)| near.map(|_| together(candidate)))
                .collect();
            // The first of equal ones.
            let best = (0..compared).rev().max_by_key(|&k| counts[k]).unwrap_or(0);
            ranked.swap(0, best);
        }
        let Some((_, first)) = ranked.first() else {
            return Vec::new();
        };
        let mut joins = vec![first.join(&a[first.i], &b[first.j])];
        let mut used = [vec![first.i], vec![first.j]];
        for j in 0..b.len() {
            if used[1].contains(&j) {
                continue;
            }
            if let Some((i, shift)) = first.partner(j, &a, &b)
                && !used[0].contains(&i)
            {
                joins.push(join(&a[i], &b[j], shift));
                used[0].push(i);
                used[1].push(j);
            }
        }
        joins
    }
}

/// The sound border of a pair's vertex, and the vertex' place in it.
fn found(
    (part, table): (&Part<'_>, &SurfaceOfFile),
    borders: &Borders,
    pair: &Pair,
    side: usize,
) -> Result<(usize, usize), MergeError> {
    let vertex = pair.file[side].ok_or_else(|| {
        MergeError::of(
            side,
            StitchError::NotOnBorder {
                vertex: pair.named[side],
            },
        )
    })?;
    let of_file = table.of(FileVertex(vertex));
    let named = |error| match error {
        StitchError::NotOnBorder { .. } => StitchError::NotOnBorder {
            vertex: pair.named[side],
        },
        other => other,
    };
    let on = borders.at(vertex, of_file, part.model);
    let on = on.map_err(|error| MergeError::of(side, named(error)))?;
    let border = on[0];
    let place = borders.sound[border]
        .vertices
        .iter()
        .position(|own| of_file.contains(own));
    Ok((border, place.unwrap_or(0)))
}

fn line(part: &Part<'_>, borders: &Borders, number: usize) -> Line {
    let vertices = borders.sound[number].vertices.clone();
    let points = vertices
        .iter()
        .map(|v| part.model.surface.positions[v.index()])
        .collect();
    Line::of(vertices, points)
}

fn reversed(part: &Part<'_>, borders: &Borders, number: usize) -> Line {
    let mut vertices = borders.sound[number].vertices.clone();
    vertices.reverse();
    let points = vertices
        .iter()
        .map(|v| part.model.surface.positions[v.index()])
        .collect();
    Line::of(vertices, points)
}

/// Two borders, and the way along B's border at the beginning of A's.
struct Candidate {
    i: usize,
    j: usize,
    shift: f64,
    is_congruent: bool,
    /// The distance of the borders and the difference of their lengths, in world units. If B does not move first, the
    /// root mean square of the ways between their points.
    cost: f64,
    /// The motion that takes B's border onto A's; `None` for rest.
    motion: Option<RigidMotion>,
}

impl Candidate {
    /// The candidates for two borders: every shift under which they are congruent, or else the nearest.
    fn best(i: usize, j: usize, a: &Line, b: &Line, holds: bool) -> Vec<Self> {
        let of_a = samples(a, 0.0);
        let middle = of_a.iter().sum::<DVec3>() / SAMPLES as f64;
        let length = 0.5 * (a.length() + b.length());
        let apart = a.middle.distance(b.middle) + (a.length() - b.length()).abs();
        let may_be_congruent = (a.length() - b.length()).abs() <= CONGRUENT * length;
        let mut congruent = Vec::new();
        let mut nearest: Option<(f64, f64)> = None;
        for k in 0..b.count() {
            let shift = b.ways[k];
            let of_b = samples(b, shift);
            let own_middle = of_b.iter().sum::<DVec3>() / SAMPLES as f64;
            let moved = if holds { DVec3::ZERO } else { middle - own_middle };
            let pairs = of_a.iter().zip(&of_b);
            let distance = pairs.map(|(a, b)| a.distance_squared(*b + moved)).sum::<f64>();
            if may_be_congruent {
                let motion = fit(&of_b, &of_a);
                let residual = rms(&of_b, &of_a, motion.as_ref());
                if residual <= CONGRUENT * length {
                    congruent.push(Self {
                        i,
                        j,
                        shift,
                        is_congruent: true,
                        cost: apart + (distance / SAMPLES as f64).sqrt(),
                        motion: motion.filter(|_| !holds),
                    });
                }
            }
            if nearest.is_none_or(|(least, _)| distance < least) {
                nearest = Some((distance, shift));
            }
        }
        if !congruent.is_empty() {
            return congruent;
        }
        let of_nearest = nearest.map(|(distance, shift)| Self {
            i,
            j,
            shift,
            is_congruent: false,
            cost: match holds {
                true => (distance / SAMPLES as f64).sqrt(),
                false => apart,
            },
            motion: fit(&samples(b, shift), &of_a).filter(|_| !holds),
        });
        of_nearest.into_iter().collect()
    }

    /// The place of a point of B under this candidate's motion.
    fn moved(&self, point: DVec3) -> DVec3 {
        let way = self.motion.as_ref().map(|motion| motion.displace(point));
        point + way.unwrap_or(DVec3::ZERO)
    }

    /// The number of B's other borders whose middles come near to the middles of A's.
    fn count_near(&self, a: &[Line], b: &[Line]) -> usize {
        (0..b.len()).filter(|&j| self.near(j, a, b).next().is_some()).count()
    }

    /// The borders of A with middles near to which this candidate's motion takes the middle of B's border `j`.
    fn near<'a>(&'a self, j: usize, a: &'a [Line], b: &'a [Line]) -> impl Iterator<Item = (usize, &'a Line)> + 'a {
        let (middle, own) = (self.moved(b[j].middle), b[j].length());
        a.iter().enumerate().filter(move |(i, line)| {
            let length = 0.5 * (line.length() + own);
            *i != self.i && j != self.j && line.middle.distance(middle) <= NEAR * length
        })
    }

    /// The border of A onto which this candidate's motion takes B's border `j`, and the shift.
    fn partner(&self, j: usize, a: &[Line], b: &[Line]) -> Option<(usize, f64)> {
        let mut best: Option<(f64, usize, f64)> = None;
        for (i, line) in self.near(j, a, b) {
            let length = 0.5 * (line.length() + b[j].length());
            let of_a = samples(line, 0.0);
            // Where the borders come together, the beginning of A's is near to the point of B's that belongs to it.
            let far = |k: &usize| self.moved(b[j].points[*k]).distance_squared(line.points[0]);
            let nearest = (0..b[j].count()).min_by(|x, y| far(x).total_cmp(&far(y)));
            let around = nearest
                .into_iter()
                .flat_map(|k| (0..=2 * AROUND).map(move |step| k + step));
            for k in around.map(|k| (k + b[j].count() * AROUND - AROUND) % b[j].count()) {
                let of_b = samples(&b[j], b[j].ways[k]);
                let off = rms(&of_b, &of_a, self.motion.as_ref()) / length;
                if off <= NEAR && best.is_none_or(|(least, ..)| off < least) {
                    best = Some((off, i, b[j].ways[k]));
                }
            }
        }
        best.map(|(_, i, shift)| (i, shift))
    }

    fn join(&self, a: &Line, b: &Line) -> Join {
        join(a, b, self.shift)
    }
}

/// The join of two borders in which the way `shift` along B's border corresponds to the beginning of A's.
fn join(a: &Line, b: &Line, shift: f64) -> Join {
    Join {
        map: Correspondence::of(vec![[0.0, shift]], [a.length(), b.length()]),
        a: a.clone(),
        b: b.clone(),
    }
}

/// Points at equal distances along a line, beginning at the way `from`.
fn samples(line: &Line, from: f64) -> Vec<DVec3> {
    let step = line.length() / SAMPLES as f64;
    (0..SAMPLES).map(|k| line.point(from + k as f64 * step)).collect()
}

/// The rigid motion that takes points nearest to others.
pub(crate) fn fit(from: &[DVec3], to: &[DVec3]) -> Option<RigidMotion> {
    let ways: Vec<DVec3> = from.iter().zip(to).map(|(from, to)| *to - *from).collect();
    RigidMotion::fit(from, &ways)
}

/// The root of the mean squared distance between moved points and others.
fn rms(from: &[DVec3], to: &[DVec3], motion: Option<&RigidMotion>) -> f64 {
    let moved = |point: DVec3| point + motion.map_or(DVec3::ZERO, |motion| motion.displace(point));
    let sum = from
        .iter()
        .zip(to)
        .map(|(from, to)| moved(*from).distance_squared(*to))
        .sum::<f64>();
    (sum / from.len().max(1) as f64).sqrt()
}

//! The ways on from a handle: the pieces of the surface around it that are apart from each other until the search comes
//! back to the handle.
//!
//! Seen from far away, the vertices at least so far from a handle are many pieces: a foot, the other leg, a trunk. Nearer
//! to the handle they grow and meet, which is the merge tree of the distance. A piece that is as long as it needs to be
//! before it meets an older one is a way on.

use pliant_mesh::{Surface, SurfaceVertex, Topology, face_area};

/// In no piece.
const NONE: u32 = u32::MAX;

/// A piece of the surface, apart from others until the distance falls to where they meet.
#[derive(Clone, Debug)]
pub(super) struct Way {
    /// Its vertices around the farthest one, nearest to the handle first.
    pub(super) end: Vec<SurfaceVertex>,
    /// Its area with everything beyond it, in square world units.
    pub(super) area: f64,
    /// The last of the pieces that it met before the front closed.
    group: u32,
}

/// The ways on from a handle.
#[derive(Clone, Debug)]
pub(super) struct Ways {
    /// All of them, by falling distance of their ends.
    pub(super) all: Vec<Way>,
    /// True if they are in several groups, as on a limb, whose front closes behind the handle.
    has_sides: bool,
}

impl Ways {
    /// The ways on the sides of the tip and of the body, which is the group with the largest area, if there are several
    /// groups: besides the body, the tip and pieces that the handle encloses.
    pub(super) fn sides(&self) -> Option<[Vec<&Way>; 2]> {
        let area = |group: u32| {
            let own = self.all.iter().filter(|way| way.group == group);
            own.map(|way| way.area).sum::<f64>()
        };
        let groups = self.all.iter().map(|way| way.group);
        let body = groups.max_by(|&a, &b| area(a).total_cmp(&area(b)))?;
        let (body, tip) = self.all.iter().partition(|way| way.group == body);
        self.has_sides.then_some([tip, body])
    }
}

/// A piece while the distance falls.
#[derive(Clone, Copy, Debug)]
struct Piece {
    farthest: f64,
    /// The older piece that it met, and the distance there.
    met: Option<(u32, f64)>,
}

/// The pieces, and those of the vertices.
struct Pieces {
    all: Vec<Piece>,
    of_vertex: Vec<u32>,
}

/// The ways on from the vertices `around` a handle, which are given nearest first with their distances. A way is at least
/// `length` long and has at least this area, and a front that closes behind the handle does so within the distance `back`.
pub(super) fn ways(
    surface: &Surface,
    topology: &Topology,
    around: &[(SurfaceVertex, f64)],
    [length, back]: [f64; 2],
    least_area: f64,
) -> Ways {
    let Pieces { all: pieces, of_vertex } = pieces(topology, around);
    let met = |number: u32| pieces[number as usize].met;
    let mut areas = areas(surface, topology, around, &of_vertex, pieces.len());
    // A piece that is too short or too small belongs to the older one that it met, which has a lower number.
    let mut is_way = vec![false; pieces.len()];
    for number in (0..pieces.len()).rev() {
        let piece = &pieces[number];
        let is_long = piece.met.is_none_or(|(_, at)| piece.farthest - at >= length);
        is_way[number] = is_long && areas[number] >= least_area;
        if let Some((older, _)) = piece.met.filter(|_| !is_way[number]) {
            areas[older as usize] += areas[number];
        }
    }
    let mut way_of: Vec<u32> = (0..pieces.len() as u32).collect();
    for number in 0..pieces.len() {
        if let Some((older, _)) = pieces[number].met.filter(|_| !is_way[number]) {
            way_of[number] = way_of[older as usize];
        }
    }
    let numbers: Vec<u32> = (0..pieces.len() as u32)
        .filter(|&number| is_way[number as usize])
        .collect();
    // The last meeting is where the front closes; around a handle that closes round the limb itself there is none.
    let last = numbers
        .iter()
        .filter_map(|&number| Some((number, met(number)?.1)))
        .min_by(|(a, at_a), (b, at_b)| at_a.total_cmp(at_b).then(a.cmp(b)));
    let roots = numbers.iter().filter(|&&number| met(number).is_none()).count();
    let closing = last.filter(|_| roots == 1).map(|(number, _)| number);
    let has_sides = roots > 1 || last.is_some_and(|(_, at)| at <= back);
    let group_of = |mut number: u32| loop {
        match met(number).filter(|_| Some(number) != closing) {
            Some((older, _)) => number = way_of[older as usize],
            None => return number,
        }
    };
    let all = numbers.iter().map(|&number| {
        let Piece { farthest, met } = pieces[number as usize];
        let own = farthest - met.map_or(0.0, |(_, at)| at);
        let nearest = farthest - (2.0 * length).min(0.5 * own);
        let is_end = |(v, at): &&(SurfaceVertex, f64)| {
            *at >= nearest && way_of.get(of_vertex[v.index()] as usize) == Some(&number)
        };
        Way {
            end: around.iter().filter(is_end).map(|(v, _)| *v).collect(),
            area: areas[number as usize],
            group: group_of(number),
        }
    });
    Ways {
        all: all.collect(),
        has_sides,
    }
}

/// The pieces of all vertices beyond the handle.
fn pieces(topology: &Topology, around: &[(SurfaceVertex, f64)]) -> Pieces {
    let mut all: Vec<Piece> = Vec::new();
    let mut of_vertex = vec![NONE; topology.vertex_count()];
    // The piece that each has become a part of.
    let mut whole: Vec<u32> = Vec::new();
    for &(vertex, at) in around.iter().rev().take_while(|(_, at)| *at > 0.0) {
        let mut own = NONE;
        for &beside in topology.neighbours(vertex) {
            let other = of_vertex[beside.index()];
            if other == NONE {
                continue;
            }
            let other = whole_of(&mut whole, other);
            if own == NONE || own == other {
                own = other;
                continue;
            }
            // Pieces are numbered by falling distance.
            let (older, younger) = (own.min(other), own.max(other));
            all[younger as usize].met = Some((older, at));
            whole[younger as usize] = older;
            own = older;
        }
        if own == NONE {
            own = all.len() as u32;
            whole.push(own);
            all.push(Piece {
                farthest: at,
                met: None,
            });
        }
        of_vertex[vertex.index()] = own;
    }
    Pieces { all, of_vertex }
}

/// The piece that one is a part of by now; the way there is halved.
fn whole_of(whole: &mut [u32], mut piece: u32) -> u32 {
    while whole[piece as usize] != piece {
        let next = whole[whole[piece as usize] as usize];
        whole[piece as usize] = next;
        piece = next;
    }
    piece
}

/// The area of each piece, by number, with the surface beyond the search that hangs on it.
fn areas(
    surface: &Surface,
    topology: &Topology,
    around: &[(SurfaceVertex, f64)],
    of_vertex: &[u32],
    count: usize,
) -> Vec<f64> {
    let mut areas = vec![0.0; count];
    let area_around = |vertex: SurfaceVertex| -> f64 {
        let corners = |face: u32| surface.triangles[face as usize].map(|v| surface.positions[v.index()]);
        let faces = topology.faces(vertex, &surface.triangles);
        faces.map(|face| face_area(corners(face)) / 3.0).sum()
    };
    let mut is_counted = vec![false; topology.vertex_count()];
    around.iter().for_each(|(vertex, _)| is_counted[vertex.index()] = true);
    let mut front = Vec::new();
    for &(vertex, _) in around {
        let Some(area) = areas.get_mut(of_vertex[vertex.index()] as usize) else {
            continue;
        };
        *area += area_around(vertex);
        front.push(vertex);
        while let Some(vertex) = front.pop() {
            for &beside in topology.neighbours(vertex) {
                if !std::mem::replace(&mut is_counted[beside.index()], true) {
                    *area += area_around(beside);
                    front.push(beside);
                }
            }
        }
    }
    areas
}

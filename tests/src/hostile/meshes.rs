//! Meshes that are difficult for a solver or a reader: one vertex or edge shared by thousands, long strips, loose
//! triangles, coincident vertices, no area, extreme sizes, numbers that are not finite.

use std::f64::consts::TAU;

use crate::trials::Chance;

/// Triangles over positions, as in a file.
#[derive(Clone, Default, Debug)]
pub struct Soup {
    pub positions: Vec<[f64; 3]>,
    pub triangles: Vec<[u32; 3]>,
}

/// The fault of a mesh.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Class {
    Sheet,
    Ball,
    Parts,
    Fan,
    Cones,
    SharedEdge,
    SharedPath,
    Strip,
    Loose,
    Coincident,
    ZeroArea,
    Needles,
    Repeated,
    Huge,
    Tiny,
    MixedScale,
    FarAway,
    NotFinite,
    Tangle,
}

impl Class {
    /// The classes that every solver must bend.
    pub const SOUND: [Self; 3] = [Self::Sheet, Self::Ball, Self::Parts];
    pub const ALL: [Self; 19] = [
        Self::Sheet,
        Self::Ball,
        Self::Parts,
        Self::Fan,
        Self::Cones,
        Self::SharedEdge,
        Self::SharedPath,
        Self::Strip,
        Self::Loose,
        Self::Coincident,
        Self::ZeroArea,
        Self::Needles,
        Self::Repeated,
        Self::Huge,
        Self::Tiny,
        Self::MixedScale,
        Self::FarAway,
        Self::NotFinite,
        Self::Tangle,
    ];
}

/// A mesh of a class, with about this many triangles.
pub fn mesh(class: Class, triangles: usize, chance: &mut Chance) -> Soup {
    let n = triangles.max(2);
    let side = ((n / 2) as f64).sqrt().ceil() as u32;
    let mut soup = match class {
        Class::Sheet => sheet(side.max(1), side.max(1)),
        Class::Ball => ball(side.max(3)),
        Class::Parts => parts(n, chance),
        Class::Fan => fan(n as u32),
        Class::Cones => cones(n as u32, 1 + chance.below(4) as u32),
        Class::SharedEdge => shared_path(n as u32, 1),
        Class::SharedPath => shared_path(n as u32, 2 + chance.below(5) as u32),
        Class::Strip => sheet((n / 2).max(1) as u32, 1 + chance.below(2) as u32),
        Class::Loose => loose(n as u32),
        Class::Tangle => tangle(n, chance),
        _ => sheet(side.max(1), side.max(1)),
    };
    spoil(&mut soup, class, chance);
    soup
}

/// Gives a sound mesh the fault of its class.
fn spoil(soup: &mut Soup, class: Class, chance: &mut Chance) {
    let scale = |soup: &mut Soup, factor: f64| {
        soup.positions.iter_mut().flatten().for_each(|number| *number *= factor);
    };
    match class {
        Class::Huge => scale(soup, 10_f64.powf(chance.between(6.0, 38.5))),
        Class::Tiny => scale(soup, 10_f64.powf(chance.between(-45.0, -6.0))),
        Class::FarAway => {
            let by = 10_f64.powf(chance.between(3.0, 18.0));
            soup.positions.iter_mut().for_each(|p| p[0] += by);
        }
        Class::MixedScale => {
            for p in &mut soup.positions {
                let factor = 10_f64.powf(chance.between(-12.0, 12.0));
                *p = p.map(|number| number * factor);
            }
        }
        Class::Needles => soup.positions.iter_mut().for_each(|p| p[1] *= 1e-9),
        Class::ZeroArea => {
            let flat = chance.below(3);
            soup.positions.iter_mut().for_each(|p| p[1..].fill(0.0));
            if flat == 0 {
                soup.positions.fill([1.0, 2.0, 3.0]);
            }
        }
        Class::Coincident => {
            let count = soup.positions.len();
            for _ in 0..count / 2 {
                soup.positions[chance.below(count)] = soup.positions[chance.below(count)];
            }
        }
        Class::Repeated => {
            let times = 1 + chance.below(30);
            let first = soup.triangles.len() / (times + 1) + 1;
            soup.triangles.truncate(first);
            soup.triangles = soup.triangles.repeat(times + 1);
        }
        Class::NotFinite => {
            for _ in 0..1 + chance.below(4) {
                let count = soup.positions.len();
                let strange = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 3.5e38, 1e300, -0.0];
                soup.positions[chance.below(count)][chance.below(3)] = *chance.of(&strange);
            }
        }
        _ => {}
    }
}

/// A curved rectangle of w × h cells.
fn sheet(w: u32, h: u32) -> Soup {
    let mut soup = Soup::default();
    for y in 0..=h {
        for x in 0..=w {
            let [u, v] = [f64::from(x), f64::from(y)];
            soup.positions
                .push([u, v, 0.3 * (0.5 * u).sin() + 0.2 * (0.7 * v).cos()]);
        }
    }
    for y in 0..h {
        for x in 0..w {
            let a = y * (w + 1) + x;
            soup.triangles
                .extend([[a, a + 1, a + w + 2], [a, a + w + 2, a + w + 1]]);
        }
    }
    soup
}

/// A closed ball of n rings.
fn ball(n: u32) -> Soup {
    let mut soup = Soup::default();
    soup.positions.push([0.0, 0.0, 1.0]);
    for ring in 1..n {
        let latitude = f64::from(ring) / f64::from(n) * TAU / 2.0;
        for step in 0..n {
            let longitude = f64::from(step) / f64::from(n) * TAU;
            let sine = latitude.sin();
            soup.positions
                .push([sine * longitude.cos(), sine * longitude.sin(), 2.0 * latitude.cos()]);
        }
    }
    let last = soup.positions.len() as u32;
    soup.positions.push([0.0, 0.0, -2.0]);
    for step in 0..n {
        let next = (step + 1) % n;
        soup.triangles.push([0, 1 + step, 1 + next]);
        for ring in 0..n - 2 {
            let [a, b] = [1 + ring * n + step, 1 + ring * n + next];
            soup.triangles.extend([[a, a + n, b + n], [a, b + n, b]]);
        }
        soup.triangles.push([last - n + step, last, last - n + next]);
    }
    soup
}

/// Several separate sheets and balls.
fn parts(triangles: usize, chance: &mut Chance) -> Soup {
    let count = 2 + chance.below(5);
    let mut soup = Soup::default();
    for part in 0..count {
        let side = ((triangles / count / 2) as f64).sqrt().ceil().max(2.0) as u32;
        let of_part = if chance.one_in(2) {
            sheet(side, side)
        } else {
            ball(side.max(3))
        };
        let first = soup.positions.len() as u32;
        let away = part as f64 * 2.5 * f64::from(side);
        soup.positions
            .extend(of_part.positions.iter().map(|p| [p[0], p[1] + away, p[2]]));
        soup.triangles
            .extend(of_part.triangles.iter().map(|t| t.map(|corner| corner + first)));
    }
    soup
}

/// One vertex shared by n triangles.
fn fan(n: u32) -> Soup {
    let mut soup = Soup::default();
    soup.positions.push([0.0; 3]);
    for step in 0..=n {
        let angle = f64::from(step) / f64::from(n) * 0.9 * TAU;
        soup.positions
            .push([angle.cos(), angle.sin(), 0.1 * (3.0 * angle).sin()]);
    }
    soup.triangles = (1..=n).map(|step| [0, step, step + 1]).collect();
    soup
}

/// Closed cones with many sides, one above another: each apex has thousands of neighbours.
fn cones(triangles: u32, count: u32) -> Soup {
    let n = (triangles / count / 2).max(3);
    let mut soup = Soup::default();
    for cone in 0..count {
        let (first, z) = (soup.positions.len() as u32, 3.0 * f64::from(cone));
        soup.positions.extend([[0.0, 0.0, z], [0.0, 0.0, z + 2.0]]);
        for step in 0..n {
            let angle = f64::from(step) / f64::from(n) * TAU;
            soup.positions.push([angle.cos(), angle.sin(), z + 0.5]);
            let [a, b] = [first + 2 + step, first + 2 + (step + 1) % n];
            soup.triangles.extend([[first, b, a], [first + 1, a, b]]);
        }
    }
    soup
}

/// A path of `edges` edges, with n triangles shared among them like the pages of a book.
fn shared_path(n: u32, edges: u32) -> Soup {
    let mut soup = Soup::default();
    soup.positions
        .extend((0..=edges).map(|step| [0.0, 0.0, f64::from(step)]));
    for page in 0..n {
        let angle = f64::from(page) / f64::from(n) * TAU;
        let edge = page % edges;
        let tip = soup.positions.len() as u32;
        soup.positions.push([angle.cos(), angle.sin(), f64::from(edge) + 0.5]);
        soup.triangles.push([edge, edge + 1, tip]);
    }
    soup
}

/// Triangles without common vertices.
fn loose(n: u32) -> Soup {
    let mut soup = Soup::default();
    for triangle in 0..n {
        let [x, y] = [f64::from(triangle % 100), f64::from(triangle / 100)].map(|n| 2.0 * n);
        let first = 3 * triangle;
        soup.positions
            .extend([[x, y, 0.0], [x + 1.0, y, 0.1], [x, y + 1.0, 0.2]]);
        soup.triangles.push([first, first + 1, first + 2]);
    }
    soup
}

/// Triangles between random vertices: not a surface at all.
fn tangle(n: usize, chance: &mut Chance) -> Soup {
    let count = (n / (1 + chance.below(8))).max(4);
    let mut soup = Soup::default();
    let mut number = || chance.between(-1.0, 1.0);
    soup.positions = (0..count).map(|_| [number(), number(), number()]).collect();
    let mut corner = || chance.below(count) as u32;
    soup.triangles = (0..n).map(|_| [corner(), corner(), corner()]).collect();
    soup
}

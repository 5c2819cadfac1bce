//! The lines that handles follow, on a surface: the place of each vertex, and the vertices' maps at a share of the way.

use std::sync::Arc;

use glam::{DAffine3, DVec3};
use pliant_deform::{Role, Target, TurnedMap};
use pliant_mesh::{Surface, SurfaceVertex};

use crate::crease;
use crate::document::{HandleCurve, HandleLine, HandleSketch};
use crate::outline;

/// The sections of a handle along its line ([`pliant_deform::Constraints::sections`]): at a bend by 300 degrees each of
/// them turns by less than 10 degrees against the next.
const SECTIONS: u16 = 32;

/// In one step a curve turns by at most this angle, in radians, so that methods follow full turns.
const STEP_RAD: f64 = std::f64::consts::FRAC_PI_4;

/// The lines of a setup's handles, with the places of their vertices. Copies share them.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Lines {
    each: Arc<Vec<Laid>>,
    /// The section of each surface vertex; empty without lines.
    sections: Arc<Vec<u16>>,
    /// The number of the first handle whose crease can't be told from its surroundings, and the reason.
    refused: Option<(usize, String)>,
}

/// A line and the vertices that follow it.
#[derive(Clone, PartialEq, Debug)]
struct Laid {
    /// The handle's number.
    handle: usize,
    vertices: Followers,
}

/// An entry for each of a handle's vertices, which ascend.
#[derive(Clone, PartialEq, Debug)]
enum Followers {
    Curve(HandleCurve, Arc<Vec<OnCurve>>),
    /// The vertex' way to the sketched line.
    Sketch(Vec<DVec3>),
}

/// A vertex that follows a curve.
#[derive(Clone, Copy, PartialEq, Debug)]
struct OnCurve {
    /// The place on the curve at rest that is nearest to it.
    place: f64,
    /// Its way when the crease along the curve gets twice as sharp.
    detail: DVec3,
}

impl Lines {
    /// The lines of handles on a surface at rest whose vertices have these roles.
    pub(crate) fn of<'a>(
        lines: impl Iterator<Item = Option<&'a HandleLine>>,
        roles: &[Role],
        surface: &Surface,
    ) -> Self {
        let mut own = Self::default();
        for (handle, line) in lines.enumerate() {
            let Some(line) = line else { continue };
            let sections = Arc::make_mut(&mut own.sections);
            sections.resize(roles.len(), 0);
            let is_own = |vertex: &usize| roles[*vertex] == Role::Handle(handle as u16);
            let vertices: Vec<usize> = (0..roles.len()).filter(is_own).collect();
            let vertices = match line {
                HandleLine::Curve(curve) => {
                    let (followers, refused) = along_curve(curve, &vertices, surface, sections);
                    own.refused = own.refused.or_else(|| Some((handle, refused?)));
                    followers
                }
                HandleLine::Sketch(sketch) => to_sketch(sketch, &vertices, surface, sections),
            };
            Arc::make_mut(&mut own.each).push(Laid { handle, vertices });
        }
        own
    }

    /// The same with the present way of each handle's curve, by the handle's number; curves with another rest stay, and so
    /// does the width of a crease.
    pub(crate) fn moved<'a>(&self, present: impl Fn(usize) -> Option<&'a HandleCurve>) -> Self {
        let moved = |laid: &Laid| match (&laid.vertices, present(laid.handle)) {
            (Followers::Curve(curve, places), Some(present)) if present.is_keyed_as(curve) => Laid {
                handle: laid.handle,
                vertices: Followers::Curve(present.clone().with_width_of(curve), Arc::clone(places)),
            },
            _ => laid.clone(),
        };
        Self {
            each: Arc::new(self.each.iter().map(moved).collect()),
            sections: Arc::clone(&self.sections),
            refused: self.refused.clone(),
        }
    }

    /// The number of the first handle whose crease can't be sharpened, and the reason: a sentence without its subject.
    pub(crate) fn refused(&self) -> Option<&(usize, String)> {
        self.refused.as_ref()
    }

    /// The curves with a free point, by the handles' numbers.
    pub(crate) fn free_curves(&self) -> impl Iterator<Item = (usize, &HandleCurve)> {
        self.each.iter().filter_map(|laid| match &laid.vertices {
            Followers::Curve(curve, _) if curve.free_point().is_some() => Some((laid.handle, curve)),
            _ => None,
        })
    }

    /// The same with curves that are held, after their free points have slid by these lengths: one for each of
    /// [`free_curves`](Self::free_curves), or none.
    pub(crate) fn slid(&self, lengths: &[f64]) -> Self {
        let slid: Vec<(usize, HandleCurve)> = self
            .free_curves()
            .zip(lengths.iter().copied().chain(std::iter::repeat(0.0)))
            .filter_map(|((handle, curve), length)| Some((handle, curve.slid(length).or_else(|| curve.slid(0.0))?)))
            .collect();
        self.moved(|number| {
            slid.iter()
                .find(|(handle, _)| *handle == number)
                .map(|(_, curve)| curve)
        })
    }

    /// Returns true if no handle follows a line.
    pub fn is_empty(&self) -> bool {
        self.each.is_empty()
    }

    /// The section of each surface vertex; empty without lines.
    pub(crate) fn sections(&self) -> &[u16] {
        &self.sections
    }

    /// The number of steps to a share of the lines' way from rest.
    pub(crate) fn steps(&self, share: f64) -> usize {
        let turns = self.each.iter().map(|laid| match &laid.vertices {
            Followers::Curve(curve, _) => curve.largest_turn_rad(),
            Followers::Sketch(_) => 0.0,
        });
        (share * turns.fold(0.0, f64::max) / STEP_RAD).ceil() as usize
    }

    /// The handles' targets at a share of the lines' way: first the line moves its vertices, then the handle's map.
    pub fn targets(&self, maps: &[DAffine3], share: f64) -> Vec<Target> {
        let mut targets: Vec<Target> = maps.iter().copied().map(Target::Map).collect();
        for laid in self.each.iter() {
            let (Some(target), Some(then)) = (targets.get_mut(laid.handle), maps.get(laid.handle)) else {
                continue;
            };
            if let Some(first) = laid.vertices.maps(share) {
                let both = |first: TurnedMap| match *then == DAffine3::IDENTITY {
                    true => first,
                    false => TurnedMap {
                        map: *then * first.map,
                        ..first
                    },
                };
                *target = Target::Maps(first.into_iter().map(both).collect());
            }
        }
        targets
    }
}

impl Followers {
    /// The map of each vertex at a share of the way; `None` if nothing moves.
    fn maps(&self, share: f64) -> Option<Vec<TurnedMap>> {
        match self {
            Self::Curve(curve, places) => {
                let curve = curve.part(share);
                let motion = curve.motion_at(1.0);
                let sharpen = curve.crease().map_or(0.0, |crease| crease.sharpen());
                let length = curve.rest().length();
                let turn = |section: u16| curve.turn_rad((f64::from(section) + 0.5) / f64::from(SECTIONS) * length);
                let turns_rad: Vec<DVec3> = (0..SECTIONS).map(turn).collect();
                let map = |own: &OnCurve| {
                    let sharper = DAffine3::from_translation(own.detail * sharpen);
                    match (motion.is_rest(), sharpen == 0.0) {
                        (true, _) => sharper,
                        (false, true) => motion.map_at(own.place),
                        (false, false) => motion.map_at(own.place) * sharper,
                    }
                };
                let turned = |own: &OnCurve| TurnedMap {
                    map: map(own),
                    turn_rad: turns_rad[usize::from(section(own.place / length))],
                };
                (!curve.is_rest()).then(|| places.iter().map(turned).collect())
            }
            Self::Sketch(ways) => {
                let maps = || {
                    ways.iter()
                        .map(|way| TurnedMap {
                            map: DAffine3::from_translation(*way * share),
                            turn_rad: DVec3::ZERO,
                        })
                        .collect()
                };
                (share != 0.0).then(maps)
            }
        }
    }
}

/// The vertices with their places, and the reason why the crease along the curve can't be sharpened.
fn along_curve(
    curve: &HandleCurve,
    vertices: &[usize],
    surface: &Surface,
    sections: &mut [u16],
) -> (Followers, Option<String>) {
    let rest = curve.rest();
    let mut followers = Vec::with_capacity(vertices.len());
    for vertex in vertices {
        let place = rest.nearest(surface.positions[*vertex]);
        sections[*vertex] = section(place / rest.length());
        let detail = DVec3::ZERO;
        followers.push(OnCurve { place, detail });
    }
    let mut refused = None;
    if let Some(crease) = curve.crease() {
        let is_beside = |vertex: usize| {
            let own = vertices.binary_search(&vertex).map(|own| followers[own].place);
            own.is_ok_and(|place| surface.positions[vertex].distance(rest.position(place)) < crease.width())
        };
        match crease::details(surface, vertices, is_beside) {
            Ok(details) => {
                for (vertex, detail) in details {
                    if let Ok(own) = vertices.binary_search(&vertex) {
                        followers[own].detail = detail;
                    }
                }
            }
            Err(why) => refused = Some(why),
        }
    }
    (Followers::Curve(curve.clone(), Arc::new(followers)), refused)
}

/// Vertices that are not on the outline stay.
fn to_sketch(sketch: &HandleSketch, vertices: &[usize], surface: &Surface, sections: &mut [u16]) -> Followers {
    let is_own = |vertex: SurfaceVertex| vertices.binary_search(&vertex.index()).is_ok();
    let matched = outline::matched(sketch, surface, is_own).unwrap_or_default();
    let mut ways = vec![DVec3::ZERO; vertices.len()];
    let count = matched.len() as f64;
    for (number, (vertex, way)) in matched.into_iter().enumerate() {
        sections[vertex.index()] = section(number as f64 / count);
        if let Ok(place) = vertices.binary_search(&vertex.index()) {
            ways[place] = way;
        }
    }
    Followers::Sketch(ways)
}

/// The section after a share of the line.
fn section(share: f64) -> u16 {
    ((f64::from(SECTIONS) * share) as u16).min(SECTIONS - 1)
}

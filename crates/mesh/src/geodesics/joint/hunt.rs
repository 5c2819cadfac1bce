//! The search for the joint of a point: origins of rings are tried in turn, the likeliest first.

use std::rc::Rc;

use glam::DVec3;

use super::candidates::{self, SMALLEST_SHARE};
use super::cut::{Cut, NUDGE_RADII};
use super::origin::{FarTips, Origin};
use super::rings::{Body, End, Field, Narrowest, Rings, Source};
use super::shape::Shape;
use super::ways::{Ways, extent};
use crate::geodesics::DistanceSearch;
use crate::{Cancel, Cancelled, SurfaceVertex};

/// If a point is so near to the tip of its rings that it is itself the tip, and the far tip is within so many radii, the
/// point is on the side of a head, not at the tip of a limb.
const HEAD_RADII: f64 = 3.0;

/// The first search covers this share of the component's extent; only if that is not enough does another search cover
/// all of it.
const FIRST_SHARE: f64 = 0.35;

/// A straight joint is the narrowest ring within so many radii of the askew one where the point is beyond that.
const BESIDE_RADII: f64 = 1.5;

/// The search for the joint of a point in a triangle.
pub(super) struct Hunt<'a> {
    shape: &'a Shape<'a>,
    cancel: &'a Cancel,
    ways: Ways,
    search: DistanceSearch,
    point: DVec3,
    corners: [SurfaceVertex; 3],
    /// The triangle's corners, with their distances from the point.
    seeds: [(SurfaceVertex, f64); 3],
    /// The rings of the whole surface around tips that were tried, which several steps of the search need.
    whole: Vec<(SurfaceVertex, Rc<(Field, Rings)>)>,
}

/// What the rings around the point itself show.
struct Surroundings {
    /// The narrowest ring; it is askew if the point is on the side of a limb.
    askew: Option<Cut>,
    /// True if the point is the tip of a limb.
    is_tip: bool,
}

impl<'a> Hunt<'a> {
    pub(super) fn new(shape: &'a Shape<'a>, ways: Ways, triangle: u32, point: DVec3, cancel: &'a Cancel) -> Self {
        let corners = shape.triangles[triangle as usize];
        Self {
            shape,
            cancel,
            ways,
            search: DistanceSearch::default(),
            point,
            corners,
            seeds: corners.map(|v| (v, shape.positions[v.index()].distance(point))),
            whole: Vec::new(),
        }
    }

    /// The ring of the joint that is `up` candidates farther from the limb's tip than the guess, and the number of
    /// candidates before it.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub(super) fn cut(&mut self, up: i32) -> Result<Option<(Cut, i32)>, Cancelled> {
        let (mut origins, far) = self.likely_origins()?;
        let mut found = self.first_candidate(&origins, up)?;
        if found.is_none() {
            let FarTips { limb, ends } = match far {
                Some(tips) => tips,
                None => self.far_tips()?,
            };
            let tried = origins.len();
            for tip in limb {
                if origins.iter().all(|origin| origin.tip != tip) {
                    origins.push(Origin::far(tip));
                }
            }
            found = self.first_candidate(&origins[tried..], up)?;
            if found.is_none() {
                found = self.beside(&origins)?.map(|cut| (cut, 0));
            }
            if found.is_none() {
                found = self.neck(ends)?.map(|cut| (cut, 0));
            }
        }
        self.cancel.check()?;
        Ok(found)
    }

    /// The origins that the rings around the point suggest, and the far tips if they were needed for that.
    fn likely_origins(&mut self) -> Result<(Vec<Origin>, Option<FarTips>), Cancelled> {
        let topology = self.shape.topology;
        let component: Vec<SurfaceVertex> = topology.vertices_of(topology.component(self.corners[0])).collect();
        let near = FIRST_SHARE * extent(self.shape, &component);
        let Surroundings { askew, is_tip } = self.surroundings(near)?;
        let mut origins = Vec::new();
        if is_tip {
            origins.push(Origin {
                tip: self.corners[0],
                near,
                source: Source::Tip,
                least: SMALLEST_SHARE,
            });
        }
        let Some(askew) = askew else { return Ok((origins, None)) };
        let tip = askew.tip(self.shape);
        let from_rings = Origin {
            tip,
            near: 1.6 * self.shape.positions[tip.index()].distance(askew.centre) + 4.0 * askew.radius,
            source: Source::Tip,
            least: 0.0,
        };
        let away = |tip: SurfaceVertex| self.shape.positions[tip.index()].distance(self.point);
        if away(tip) >= askew.radius {
            origins.push(from_rings);
            return Ok((origins, None));
        }
        let far = self.far_tips()?;
        let farthest = far.limb[0];
        let away = self.shape.positions[farthest.index()].distance(self.point);
        let is_on_head = (askew.radius..HEAD_RADII * askew.radius).contains(&away);
        origins.push(from_rings);
        let last = origins.len() - usize::from(is_on_head);
        origins.insert(last, Origin::far(farthest));
        Ok((origins, Some(far)))
    }

    fn far_tips(&mut self) -> Result<FarTips, Cancelled> {
        FarTips::of(&mut self.search, self.shape, &self.seeds, self.cancel)
    }

    /// The rings around `seeds` up to the distance `limit`.
    fn rings(&mut self, seeds: &[(SurfaceVertex, f64)], limit: f64) -> Result<(Field, Rings), Cancelled> {
        let field = Field::measure(&mut self.search, self.shape, &self.ways, seeds, limit);
        self.cancel.check()?;
        let rings = Rings::of(self.shape, &field, Body::Large);
        self.cancel.check()?;
        Ok((field, rings))
    }

    /// The rings around a tip up to the distance `limit`.
    fn rings_of_tip(&mut self, tip: SurfaceVertex, limit: f64) -> Result<Rc<(Field, Rings)>, Cancelled> {
        let known = self
            .whole
            .iter()
            .find(|(other, _)| *other == tip && limit.is_infinite());
        if let Some((_, rings)) = known {
            return Ok(Rc::clone(rings));
        }
        let rings = Rc::new(self.rings(&[(tip, 0.0)], limit)?);
        if limit.is_infinite() {
            self.whole.push((tip, Rc::clone(&rings)));
        }
        Ok(rings)
    }

    /// The rings around the point. The search first covers the distance `near`, and everything if the rings have not
    /// widened again by then.
    fn surroundings(&mut self, near: f64) -> Result<Surroundings, Cancelled> {
        let seeds = self.seeds;
        let mut is_tip = false;
        for limit in [near, f64::INFINITY] {
            let (field, rings) = self.rings(&seeds, limit)?;
            is_tip |= limit == near && candidates::is_tip(&rings);
            match rings.narrowest(&self.corners, 0, Source::Point) {
                Some(Narrowest { level, end }) if end == End::Widens || limit.is_infinite() => {
                    let askew = Some(Cut::of(self.shape, &field, &rings, level));
                    return Ok(Surroundings { askew, is_tip });
                }
                _ => {}
            }
        }
        Ok(Surroundings { askew: None, is_tip })
    }

    /// The straightened candidate from the first of some origins that has one, and the number of candidates before it.
    fn first_candidate(&mut self, origins: &[Origin], up: i32) -> Result<Option<(Cut, i32)>, Cancelled> {
        for origin in origins {
            if let Some((cut, up)) = self.candidate(origin, up)? {
                return Ok(Some((self.straight(&cut, NUDGE_RADII).unwrap_or(cut), up)));
            }
        }
        Ok(None)
    }

    /// The candidate `up` places farther from the tip than the guess, and the number of places that there are.
    fn candidate(&mut self, origin: &Origin, up: i32) -> Result<Option<(Cut, i32)>, Cancelled> {
        for limit in [origin.near, f64::INFINITY] {
            let around = self.rings_of_tip(origin.tip, limit)?;
            let (field, rings) = &*around;
            let candidates =
                candidates::candidates(rings, &self.corners, origin.source, origin.least, limit.is_infinite());
            let found = candidates.at(up);
            if let Some((level, place)) = found.filter(|&(_, place)| limit.is_infinite() || place == up) {
                return Ok(Some((Cut::of(self.shape, field, rings, level), place)));
            }
            if limit.is_infinite() {
                break;
            }
        }
        Ok(None)
    }

    /// The straight ring of the last joint before the point, from the first of some origins that has one with the point
    /// on its limb.
    fn beside(&mut self, origins: &[Origin]) -> Result<Option<Cut>, Cancelled> {
        for origin in origins {
            let around = self.rings_of_tip(origin.tip, f64::INFINITY)?;
            let (field, rings) = &*around;
            let Some(level) = candidates::just_before(rings, &self.corners) else {
                continue;
            };
            let askew = Cut::of(self.shape, field, rings, level);
            let straight = self.straight(&askew, BESIDE_RADII);
            if straight.is_some() {
                return Ok(straight);
            }
        }
        Ok(None)
    }

    /// The neck of a bust, from the first of its ends that is the end of its base. The limb is the head, on the other side.
    fn neck(&mut self, ends: [SurfaceVertex; 2]) -> Result<Option<Cut>, Cancelled> {
        for end in ends {
            let around = self.rings_of_tip(end, f64::INFINITY)?;
            let (field, rings) = &*around;
            let Some(level) = candidates::neck(rings, &self.corners) else {
                continue;
            };
            let mut cut = Cut::of(self.shape, field, rings, level);
            cut.limb = rings.body(level);
            cut.share = 1.0 - cut.share;
            return Ok(Some(self.straight(&cut, NUDGE_RADII).unwrap_or(cut)));
        }
        Ok(None)
    }

    fn straight(&mut self, cut: &Cut, nudge: f64) -> Option<Cut> {
        cut.straightened(&mut self.search, self.shape, &self.ways, &self.corners, nudge)
    }
}

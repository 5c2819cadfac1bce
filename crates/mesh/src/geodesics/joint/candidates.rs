//! The rings of a limb that may be its joint, from the tip towards the body.
//!
//! Beside a joint the limb is wider: a wrist is narrower than the hand and the forearm, a shoulder than the chest. So
//! with a ring's length L as a function of the distance d from the tip, a joint is a place where log L is convex:
//! L(d − w) L(d + w) / L(d)² is above 1, and at its largest, for w about the limb's radius. It is below 1 everywhere on
//! balls and flat sheets. Knees and elbows of smooth limbs do not show in the rings; candidates in the middle of long
//! gaps stand in for them.

use std::f64::consts::TAU;
use std::ops::Range;

use super::rings::{End, Rings, Source};
use crate::SurfaceVertex;

/// The least convexity of a joint.
const CONVEX: f64 = 1.1;

/// A narrow ring is exceeded so many times by rings before and after it.
const NARROWS: f64 = 1.15;

/// The length of limb, in radii, that makes one candidate in the middle of a gap.
const GAP_RADII: f64 = 4.8;

/// A limb that the guess cuts off has at least this share of the area, so that a finger leads to its hand.
const LEAST_GUESS: f64 = 0.005;

/// A ring that shows as a joint is across a palm if it is wider by this ratio than one within [`PALM_RADII`] beyond it.
const PALM_OVER_WRIST: f64 = 1.2;

/// A wrist is within so many radii of a palm's ring.
const PALM_RADII: f64 = 4.0;

/// A limb that is this many times wider than its narrowest ring is no longer the same limb.
const WIDENED: f64 = 2.2;

/// A limb is at least this many radii long.
const LONG_RADII: f64 = 1.7;

/// A limb has at most this share of the area.
const LARGEST_SHARE: f64 = 0.35;

/// The same where the rings show no joint: half of a surface, and a little more.
const LARGEST_HALF: f64 = 0.53;

/// A point so many radii beyond a joint may be on the joint's limb.
const ASKEW_RADII: f64 = 2.5;

/// Rings around a tip are at least so many times as long as the ring before them.
const TIP_WIDENS: f64 = 0.98;

/// A limb that shows around its own tip is at least this many radii long.
const TIP_RADII: f64 = 2.2;

/// The same limb's least share of the area, so that a toe leads to its foot.
pub(super) const SMALLEST_SHARE: f64 = 0.01;

/// A head may have this share of the area if its neck is the only narrow ring.
const LARGEST_HEAD: f64 = 0.9;

/// The rings are those of one piece if they go on until they have cut off this share of the area.
const ONE_PIECE: f64 = 0.85;

/// The neck of such a head is exceeded so many times by rings before and after it.
const NECK: f64 = 1.5;

/// The point's distance from the joint is at least this many radii.
const CLEAR_RADII: f64 = 0.25;

/// The joints that a point may mean.
pub(super) struct Candidates {
    /// Their levels, ascending.
    levels: Vec<usize>,
    /// The place of the likeliest one; `None` if the search ended before it.
    guess: Option<usize>,
}

impl Candidates {
    /// The level of the candidate `up` places from the guess, or of the last one on that side, and its number of places.
    /// `None` if there is none.
    pub(super) fn at(&self, up: i32) -> Option<(usize, i32)> {
        let (last, guess) = (self.levels.len().checked_sub(1)? as i32, self.guess? as i32);
        let place = guess.saturating_add(up).clamp(0, last);
        Some((self.levels[place as usize], place - guess))
    }
}

/// The candidates beyond a point. The guess is the first joint that the rings show and that is not a detail's, or the
/// narrowest ring if the limb widens before that. Limbs below the share `least` of the area do not count. `is_whole` tells
/// that the rings are those of the whole surface.
pub(super) fn candidates(
    rings: &Rings,
    corners: &[SurfaceVertex; 3],
    source: Source,
    least: f64,
    is_whole: bool,
) -> Candidates {
    let levels = levels(rings, corners, source, least, is_whole);
    let joints = joints(rings);
    let is_palm = |level: usize| joints.contains(&level) && narrows_soon(rings, level);
    let is_likely = |&level: &usize| rings.limb_share(level) >= LEAST_GUESS && !is_palm(level);
    let sees_enough = |place: &usize| is_whole || rings.radii().last() >= Some(&palm_end(rings, levels[*place]));
    let likely = levels.iter().position(is_likely).filter(sees_enough);
    Candidates {
        guess: likely.or(is_whole.then_some(0)),
        levels,
    }
}

/// The distance from the tip within which the wrist is if a level is across a palm.
fn palm_end(rings: &Rings, level: usize) -> f64 {
    rings.radii()[level] + PALM_RADII * rings.lengths()[level] / TAU
}

/// Returns true if the limb is clearly narrower soon beyond a level.
fn narrows_soon(rings: &Rings, level: usize) -> bool {
    let (length, end) = (rings.lengths()[level], palm_end(rings, level));
    let later = (level..rings.lengths().len()).take_while(|&later| rings.radii()[later] <= end);
    later
        .map(|later| rings.lengths()[later])
        .any(|later| later > 0.0 && PALM_OVER_WRIST * later < length)
}

/// The levels of the candidates, ascending.
fn levels(rings: &Rings, corners: &[SurfaceVertex; 3], source: Source, least: f64, is_whole: bool) -> Vec<usize> {
    let mut all = shown(rings, corners, least);
    // Rings beyond the search's limit may be narrower.
    let narrowest = rings
        .narrowest(corners, 0, source)
        .filter(|narrowest| is_whole || narrowest.end == End::Widens);
    let narrowest = narrowest.map(|narrowest| narrowest.level);
    if let Some(narrowest) = narrowest.filter(|&level| (least..=LARGEST_HALF).contains(&rings.limb_share(level))) {
        let has_widened = |level: usize| {
            let between = &rings.lengths()[narrowest..level.max(narrowest)];
            between
                .iter()
                .any(|length| *length > WIDENED * rings.lengths()[narrowest])
        };
        if all.first().is_none_or(|&first| has_widened(first)) {
            all.insert(0, narrowest);
        }
    }
    if all.is_empty() {
        all.extend(neck_within(
            rings,
            rings.first(corners)..rings.lengths().len(),
            LARGEST_SHARE,
        ));
    }
    all
}

/// Returns true if rings around a point show a joint before they cease to be those of a tip: they widen all the time, and
/// far less than around a point on a side.
pub(super) fn is_tip(rings: &Rings) -> bool {
    let lengths = rings.lengths();
    let Some(joint) = widening(rings).into_iter().next() else {
        return false;
    };
    let widens = lengths[..=joint].windows(2).all(|pair| pair[1] >= TIP_WIDENS * pair[0]);
    let is_long = rings.radii()[joint] >= TIP_RADII * lengths[joint] / TAU;
    widens && is_long && rings.limb_share(joint) >= SMALLEST_SHARE
}

/// The last joint before a point, if the point is within [`ASKEW_RADII`] of it: rings around a tip are askew at a shoulder,
/// so a point on the upper arm may be beyond the ring of its own joint.
pub(super) fn just_before(rings: &Rings, corners: &[SurfaceVertex; 3]) -> Option<usize> {
    let at = *rings.radii().get(rings.first(corners))?;
    let is_near = |&level: &usize| {
        let radius = rings.lengths()[level] / TAU;
        (0.0..ASKEW_RADII * radius).contains(&(at - rings.radii()[level]))
            && rings.radii()[level] >= LONG_RADII * radius
            && rings.limb_share(level) <= LARGEST_SHARE
    };
    joints(rings).into_iter().rfind(is_near)
}

/// The narrowest of some rings between two parts that are both much wider.
fn neck_within(rings: &Rings, levels: Range<usize>, most: f64) -> Option<usize> {
    let lengths = rings.lengths();
    let longest = |range: Range<usize>| lengths[range].iter().copied().fold(0.0, f64::max);
    let is_neck = |&level: &usize| {
        let exceeded = longest(0..level).min(longest(level..lengths.len()));
        (1.0 - LARGEST_HEAD..=most).contains(&rings.limb_share(level)) && exceeded >= NECK * lengths[level]
    };
    let rings = levels.filter(|&level| lengths.get(level).is_some_and(|length| *length > 0.0));
    rings.filter(is_neck).min_by(|&a, &b| lengths[a].total_cmp(&lengths[b]))
}

/// The neck of a bust, by the rings around the end of its base, if it is before the point and all beyond it is one piece:
/// a body with legs is no head.
pub(super) fn neck(rings: &Rings, corners: &[SurfaceVertex; 3]) -> Option<usize> {
    let last = rings.lengths().iter().rposition(|length| *length > 0.0)?;
    let is_one_piece = rings.limb_share(last) >= ONE_PIECE;
    is_one_piece.then(|| neck_within(rings, 0..rings.first(corners), LARGEST_HEAD))?
}

/// The joints that the rings show beyond a point, and the middles of gaps between them.
fn shown(rings: &Rings, corners: &[SurfaceVertex; 3], least: f64) -> Vec<usize> {
    let first = rings.first(corners);
    let radius = |level: usize| rings.lengths().get(level).map_or(0.0, |length| length / TAU);
    let apart = |one: usize, other: usize| rings.radii()[other] - rings.radii()[one];
    let is_clear = |&level: &usize| {
        level >= first
            && apart(first, level) >= CLEAR_RADII * radius(level)
            && rings.radii()[level] >= LONG_RADII * radius(level)
            && (least..=LARGEST_SHARE).contains(&rings.limb_share(level))
    };
    let (joints, before): (Vec<usize>, Vec<usize>) = joints(rings).into_iter().partition(is_clear);
    // The first gap begins at the last joint before the point.
    let mut all = Vec::new();
    let mut from = before.into_iter().rfind(|level| Some(level) < joints.first());
    for &to in &joints {
        all.extend(between(rings, from, to).filter(is_clear));
        all.push(to);
        from = Some(to);
    }
    all
}

/// The levels that divide a long gap between two joints; none before the first joint of a limb.
fn between(rings: &Rings, from: Option<usize>, to: usize) -> impl Iterator<Item = usize> {
    let from = from.unwrap_or(to);
    let lengths = &rings.lengths()[from..=to];
    let mean_radius = lengths.iter().sum::<f64>() / TAU / lengths.len() as f64;
    let gap = (rings.radii()[to] - rings.radii()[from]) / mean_radius;
    let parts = (gap / GAP_RADII).round().max(1.0) as usize;
    (1..parts).map(move |number| from + (to - from) * number / parts)
}

/// The distance around which rings are compared with a level's, in levels; `None` beyond the ends.
fn window(rings: &Rings, level: usize) -> Option<usize> {
    let length = rings.lengths()[level];
    let spacing = rings.radii().get(1)? - rings.radii()[0];
    let window = ((length / TAU / spacing).round() as usize).max(1);
    (length > 0.0 && window <= level && level + window < rings.lengths().len()).then_some(window)
}

/// L(d − w) L(d + w) / L(d)²; 0 where there is no ring.
fn convexity(rings: &Rings, level: usize) -> f64 {
    let length = |level: usize| rings.lengths()[level];
    match window(rings, level) {
        Some(window) => length(level - window) * length(level + window) / length(level).powi(2),
        None => 0.0,
    }
}

/// The levels that are more convex than all around them and not narrower than before, ascending.
fn widening(rings: &Rings) -> Vec<usize> {
    let length = |level: usize| rings.lengths()[level];
    let values: Vec<f64> = (0..rings.lengths().len())
        .map(|level| convexity(rings, level))
        .collect();
    let is_peak = |&level: &usize| {
        let Some(window) = window(rings, level).filter(|_| values[level] >= CONVEX) else {
            return false;
        };
        let around = &values[level - window..=level + window];
        let mut before = around[..window].iter();
        let mut after = around[window + 1..].iter();
        length(level - window) <= NARROWS * length(level)
            && before.all(|value| *value < values[level])
            && after.all(|value| *value <= values[level])
    };
    (0..values.len()).filter(is_peak).collect()
}

/// The levels whose rings are narrower than those before and after them, ascending.
fn narrow(rings: &Rings) -> Vec<usize> {
    let length = |level: usize| rings.lengths()[level];
    let mut found = Vec::new();
    let (mut least, mut most, mut narrows) = (0, 0, false);
    for level in (0..rings.lengths().len()).filter(|&level| length(level) > 0.0) {
        if narrows {
            if length(level) < length(least) {
                least = level;
            }
            if length(level) > NARROWS * length(least) {
                found.push(least);
                (most, narrows) = (level, false);
            }
        } else {
            if length(level) > length(most) {
                most = level;
            }
            if length(level) * NARROWS < length(most) {
                (least, narrows) = (level, true);
            }
        }
    }
    found
}

/// The joints that the rings show, ascending: narrow ones, and those where the limb begins to widen, except beside a
/// narrow one.
fn joints(rings: &Rings) -> Vec<usize> {
    let mut joints = narrow(rings);
    let near = |one: usize, other: usize| {
        let radius = rings.lengths()[one].min(rings.lengths()[other]) / TAU;
        (rings.radii()[one] - rings.radii()[other]).abs() < radius
    };
    let others: Vec<usize> = widening(rings)
        .into_iter()
        .filter(|&level| joints.iter().all(|&narrow| !near(narrow, level)))
        .collect();
    joints.extend(others);
    joints.sort_unstable();
    joints
}

//! The `vn` lines that an edit changes, and those that it adds.
//!
//! Exporters share one `vn` line among all corners with the same normal, so a `vn` has no single vertex to follow.
//! While all its users need one direction, it turns with them. If they bend apart, or some of them rest, the line stays
//! with the first of them, or with those that rest, and the others get lines of their own; users that agree share one.

use std::collections::HashMap;

use glam::DVec3;
use pliant_mesh::{Cancelled, DrawnVertex};

use super::statements::NONE;
use super::stored::Stored;
use crate::save::course::Course;
use crate::save::moved::Moved;

/// Users of one `vn` share a line if none is further from their mean than this: the cosine of a degree.
const AGREEMENT: f64 = 0.999_847_695;

/// Directions are sorted into cells, this many to a unit, a third of a degree each.
const CELLS: f64 = 256.0;

/// The `vn` lines after an edit.
#[derive(Debug, Default)]
pub(super) struct Normals {
    /// The lines that change, in rising order, each with its new value.
    pub(super) changed: Vec<(u32, DVec3)>,
    /// The values of new lines.
    pub(super) added: Vec<DVec3>,
    /// The line of each drawn vertex: the file's, or an added one for numbers beyond those. Empty if none is added.
    pub(super) of_vertex: Vec<u32>,
}

impl Normals {
    /// The lines that `moved` needs.
    pub(super) fn of(stored: &Stored, moved: &Moved<'_>, course: &Course<'_>) -> Result<Self, Cancelled> {
        if stored.normal.is_empty() {
            return Ok(Self::default());
        }
        let old = &stored.statements.normals;
        let of_vertex = |v: usize| Some(stored.normal[v]).filter(|&index| index != NONE);
        let rest: Vec<DVec3> = (0..stored.normal.len())
            .map(|v| of_vertex(v).map_or(DVec3::ZERO, |index| old[index as usize]))
            .collect();
        let (of_frames, course) = course.split(0.8);
        let frames = moved.frames(&rest, &of_frames)?;
        let wanted = |v: usize| {
            let vertex = DrawnVertex(v as u32);
            let carried = if moved.moves(vertex) {
                frames.carry_normal(vertex, rest[v])
            } else {
                rest[v]
            };
            carried.normalize_or_zero()
        };
        let mut lines = vec![Line::default(); old.len()];
        let mut each = Vec::with_capacity(rest.len());
        for v in 0..rest.len() {
            course.pass(v, 2 * rest.len())?;
            let direction = wanted(v);
            each.push(direction);
            if let Some(index) = of_vertex(v).filter(|_| direction != DVec3::ZERO) {
                lines[index as usize].add(direction, rest[v].normalize_or_zero());
            }
        }
        let means: Vec<DVec3> = lines.iter().map(|line| line.sum.normalize_or_zero()).collect();
        for (v, direction) in each.iter().enumerate() {
            if let Some(index) = of_vertex(v).filter(|_| *direction != DVec3::ZERO) {
                let is_near = direction.dot(means[index as usize]) >= AGREEMENT;
                lines[index as usize].agree &= is_near;
            }
        }
        let mut out = Self::default();
        for (index, line) in lines.iter().enumerate().filter(|(_, line)| line.is_whole()) {
            if line.changes {
                out.changed.push((index as u32, means[index] * old[index].length()));
            }
        }
        if lines.iter().all(|line| line.is_whole() || !line.changes) {
            return Ok(out);
        }
        out.divide(stored, &lines, &each, &rest, &course)?;
        Ok(out)
    }

    /// Divides the lines whose users need different directions. `each` has the direction for each drawn vertex, as a
    /// unit vector.
    fn divide(
        &mut self,
        stored: &Stored,
        lines: &[Line],
        each: &[DVec3],
        rest: &[DVec3],
        course: &Course<'_>,
    ) -> Result<(), Cancelled> {
        let old_count = stored.statements.normals.len() as u32;
        self.of_vertex = stored.normal.clone();
        // By line and direction: a number among the lines, and the sum of the directions of its users.
        let mut cells: HashMap<(u32, [i16; 3]), usize> = HashMap::new();
        let mut divided: Vec<(u32, DVec3, f64)> = Vec::new();
        let mut is_taken = vec![false; lines.len()];
        for (v, &direction) in each.iter().enumerate() {
            course.pass(each.len() + v, 2 * each.len())?;
            let index = stored.normal[v];
            if index == NONE || direction == DVec3::ZERO || lines[index as usize].is_whole() {
                continue;
            }
            let (line, stays) = (&lines[index as usize], rest[v].normalize_or_zero());
            // Users that keep their direction keep the line.
            if line.has_resting && direction.dot(stays) >= AGREEMENT {
                continue;
            }
            let cell = direction.to_array().map(|number| (number * CELLS).round() as i16);
            let number = *cells.entry((index, cell)).or_insert_with(|| {
                let is_first = !line.has_resting && !std::mem::replace(&mut is_taken[index as usize], true);
                let target = if is_first {
                    index
                } else {
                    self.added.push(DVec3::ZERO);
                    old_count + self.added.len() as u32 - 1
                };
                divided.push((target, DVec3::ZERO, rest[v].length()));
                divided.len() - 1
            });
            let (target, sum, _) = &mut divided[number];
            *sum += direction;
            self.of_vertex[v] = *target;
        }
        for (target, sum, length) in divided {
            let value = sum.normalize_or_zero() * length;
            match target.checked_sub(old_count) {
                Some(added) => self.added[added as usize] = value,
                None => self.changed.push((target, value)),
            }
        }
        self.changed.sort_unstable_by_key(|(index, _)| *index);
        Ok(())
    }
}

/// The directions that the users of one `vn` need.
#[derive(Clone, Copy)]
struct Line {
    sum: DVec3,
    /// True if a user needs another direction than the line's.
    changes: bool,
    /// True if a user needs the line's direction.
    has_resting: bool,
    /// True if all are near to their mean.
    agree: bool,
}

impl Default for Line {
    fn default() -> Self {
        Self {
            sum: DVec3::ZERO,
            changes: false,
            has_resting: false,
            agree: true,
        }
    }
}

impl Line {
    fn add(&mut self, wanted: DVec3, rest: DVec3) {
        self.sum += wanted;
        match wanted == rest {
            true => self.has_resting = true,
            false => self.changes = true,
        }
    }

    /// Returns true if one direction is enough for its users.
    fn is_whole(&self) -> bool {
        self.agree && !(self.changes && self.has_resting)
    }
}

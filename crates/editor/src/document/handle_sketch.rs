//! A line that a person draws for the outline of a model.

use std::sync::Arc;

use glam::{DMat4, DVec2, DVec3};
use pliant_mesh::MirrorPlane;

/// The smallest weight of a sketch; 1 is exact.
const LEAST_WEIGHT: f64 = 1e-3;

/// A line over a picture, to which the outline that is seen there is matched. Copies share it.
#[derive(Clone, PartialEq, Debug)]
pub struct HandleSketch(Arc<Parts>);

#[derive(PartialEq, Debug)]
struct Parts {
    clip_from_world: DMat4,
    world_from_clip: DMat4,
    line: Vec<DVec2>,
    /// The share of the line's length up to each of its points.
    shares: Vec<f64>,
    weight: f64,
}

impl HandleSketch {
    /// The line through points in normalised device coordinates of the view `clip_from_world`. The weight, from 0.001 to
    /// 1, tells how exactly it is met.
    ///
    /// # Errors
    /// A sentence without its subject, the sketch.
    pub fn new(clip_from_world: DMat4, line: Vec<DVec2>, weight: f64) -> Result<Self, String> {
        let world_from_clip = clip_from_world.inverse();
        if !clip_from_world.is_finite() || !world_from_clip.is_finite() {
            return Err(
                "has a `view_projection` that flattens space: give the matrix of the view, column by column".to_owned(),
            );
        }
        if !(LEAST_WEIGHT..=1.0).contains(&weight) {
            return Err(format!(
                "has the `weight` {weight}: give a number from {LEAST_WEIGHT} to 1"
            ));
        }
        if line.len() < 2 {
            return Err(format!("has a `line` of {} points: give at least 2", line.len()));
        }
        if let Some(point) = line.iter().position(|point| !point.is_finite()) {
            return Err(format!(
                "has a coordinate at point {point} of its `line` that is not finite: give finite numbers"
            ));
        }
        let mut lengths = vec![0.0];
        let mut length = 0.0;
        for (point, pair) in line.windows(2).enumerate() {
            let step = pair[0].distance(pair[1]);
            if step == 0.0 {
                let next = point + 1;
                return Err(format!(
                    "has points {point} and {next} of its `line` in the same place: leave one of them out"
                ));
            }
            length += step;
            lengths.push(length);
        }
        if line[0] == line[line.len() - 1] {
            return Err(
                "has a `line` that ends where it begins: give an open line along a part of the outline".to_owned(),
            );
        }
        Ok(Self(Arc::new(Parts {
            clip_from_world,
            world_from_clip,
            shares: lengths.into_iter().map(|own| own / length).collect(),
            line,
            weight,
        })))
    }

    /// Its mirror image across a plane: the same picture the other way round, seen from the mirrored place.
    pub(crate) fn mirrored(&self, plane: &MirrorPlane) -> Option<Self> {
        // A mirror alone would turn all triangles inside out, so the picture is mirrored, too.
        let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| plane.mirrored_vector(axis).extend(0.0));
        let world_from_mirrored = DMat4::from_cols(x, y, z, plane.mirrored(DVec3::ZERO).extend(1.0));
        let turned = DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0));
        let line = self.line().iter().map(|point| DVec2::new(-point.x, point.y));
        let clip_from_world = turned * *self.clip_from_world() * world_from_mirrored;
        Self::new(clip_from_world, line.collect(), self.weight()).ok()
    }

    /// The matrix from world to clip space.
    pub fn clip_from_world(&self) -> &DMat4 {
        &self.0.clip_from_world
    }

    /// The line's points, in normalised device coordinates.
    pub fn line(&self) -> &[DVec2] {
        &self.0.line
    }

    /// The weight, 1 for an exact one.
    pub fn weight(&self) -> f64 {
        self.0.weight
    }

    /// The weight of a soft handle that holds the outline so exactly; `None` for a hard one.
    pub(crate) fn soft(&self) -> Option<f64> {
        let weight = self.weight();
        (weight < 1.0).then(|| weight / (1.0 - weight))
    }

    /// A world position as it is seen, in normalised device coordinates; `None` behind the viewer.
    pub(crate) fn seen(&self, world: DVec3) -> Option<DVec2> {
        let clip = *self.clip_from_world() * world.extend(1.0);
        (clip.w > 0.0).then(|| clip.truncate().truncate() / clip.w)
    }

    /// The world position that is seen at `place` and is as far from the viewer as `world`.
    pub(crate) fn put(&self, world: DVec3, place: DVec2) -> DVec3 {
        let mut clip = *self.clip_from_world() * world.extend(1.0);
        (clip.x, clip.y) = (place.x * clip.w, place.y * clip.w);
        let back = self.0.world_from_clip * clip;
        back.truncate() / back.w
    }

    /// The unit direction from a world position towards the viewer, whichever way depth is measured.
    pub(crate) fn towards_viewer(&self, world: DVec3) -> DVec3 {
        let back = &self.0.world_from_clip;
        // All rays meet in the eye, or they are parallel.
        let eye = back.z_axis;
        let towards = if eye.w.abs() > 1e-9 * eye.truncate().length() {
            eye.truncate() / eye.w - world
        } else {
            back.x_axis.truncate().cross(back.y_axis.truncate())
        };
        towards.normalize_or(DVec3::Z)
    }

    /// The point of the line after a share of its length.
    pub(crate) fn point_at(&self, share: f64) -> DVec2 {
        let Parts { line, shares, .. } = &*self.0;
        let next = shares.partition_point(|own| *own <= share).clamp(1, line.len() - 1);
        let part = (share - shares[next - 1]) / (shares[next] - shares[next - 1]);
        line[next - 1].lerp(line[next], part)
    }

    /// The distance of a place from the line.
    pub(crate) fn distance(&self, place: DVec2) -> f64 {
        let to_segment = |pair: &[DVec2]| {
            let along = pair[1] - pair[0];
            let share = ((place - pair[0]).dot(along) / along.length_squared()).clamp(0.0, 1.0);
            place.distance(pair[0] + along * share)
        };
        self.line().windows(2).map(to_segment).fold(f64::INFINITY, f64::min)
    }
}

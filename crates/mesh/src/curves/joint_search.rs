//! The pose of a chain with limits whose end is at a target: damped least squares on the turns of its joints
//! \[Wam86\]. Each bends within its range and turns about the segment before it.

use glam::{DMat3, DQuat, DVec3};

use super::joint_limits::JointLimits;

/// Steps from one pose.
const STEPS: usize = 60;

/// The search has arrived within this share of the chain's length.
const ARRIVED: f64 = 1e-10;

/// The number of steps after which the search checks whether the end still comes nearer.
const LOOK: usize = 8;

/// The search rests if more than this share of the way is left since the last look.
const SLOW: f64 = 0.7;

/// The first damping, as a share of the chain's length.
const DAMPING: f64 = 1e-2;

/// A joint whose bend has a sine below this is straight.
const STRAIGHT: f64 = 1e-9;

/// The largest turn about an axis in one step, in radians.
const LARGEST_TURN: f64 = 0.5;

/// A chain as the directions of its segments.
#[derive(Clone, Debug)]
struct Pose {
    directions: Vec<DVec3>,
}

/// The chain with its end at the target, found from one of these two poses. A chain that does not arrive is the first one,
/// brought as near as it comes from there.
pub(super) fn posed(starts: [&[DVec3]; 2], target: DVec3, limits: JointLimits<'_>) -> Vec<DVec3> {
    let lengths: Vec<f64> = starts[0].windows(2).map(|pair| pair[0].distance(pair[1])).collect();
    let search = Search {
        root: starts[0][0],
        target,
        whole: lengths.iter().sum(),
        lengths,
        limits,
    };
    let [(first, missed), second] = starts.map(|start| search.descend(search.pose_of(start)));
    let arrives = ARRIVED * search.whole;
    let pose = if missed > arrives && second.1 <= arrives {
        second.0
    } else {
        first
    };
    search.points(&pose)
}

struct Search<'a> {
    root: DVec3,
    target: DVec3,
    lengths: Vec<f64>,
    whole: f64,
    limits: JointLimits<'a>,
}

impl Search<'_> {
    /// The pose of these points within the limits.
    fn pose_of(&self, points: &[DVec3]) -> Pose {
        let mut directions: Vec<DVec3> = Vec::with_capacity(self.lengths.len());
        for (joint, pair) in points.windows(2).enumerate() {
            let direction = (pair[1] - pair[0]).normalize_or(DVec3::X);
            let before = directions.last().copied().or(self.limits.before);
            directions.push(before.map_or(direction, |before| self.limits.allowed(joint, before, direction)));
        }
        Pose { directions }
    }

    fn points(&self, pose: &Pose) -> Vec<DVec3> {
        let mut points = vec![self.root];
        for (direction, length) in pose.directions.iter().zip(&self.lengths) {
            points.push(points[points.len() - 1] + *direction * *length);
        }
        points
    }

    /// Damped steps until the end arrives or rests, with the distance that is left.
    fn descend(&self, mut pose: Pose) -> (Pose, f64) {
        let mut points = self.points(&pose);
        let mut missed = points[points.len() - 1].distance(self.target);
        let mut damping = DAMPING * self.whole;
        let mut looked = f64::INFINITY;
        for step in 0..STEPS {
            if step % LOOK == 0 {
                if missed > SLOW * looked {
                    break;
                }
                looked = missed;
            }
            if missed <= ARRIVED * self.whole {
                break;
            }
            let tried = self.stepped(&pose, &points, damping);
            let tried_points = self.points(&tried);
            let left = tried_points[tried_points.len() - 1].distance(self.target);
            if left < missed {
                (pose, points, missed) = (tried, tried_points, left);
                damping *= 0.25;
            } else {
                damping *= 4.0;
            }
        }
        (pose, missed)
    }

    /// One damped step of all joints. Joints that it would take beyond their ranges go to their ends, and the others make
    /// up for it.
    fn stepped(&self, pose: &Pose, points: &[DVec3], damping: f64) -> Pose {
        let end = points[points.len() - 1];
        let axes = self.axes(pose, points);
        let mut turns = vec![None; axes.len()];
        loop {
            let mut left = self.target - end;
            let mut square = DMat3::from_diagonal(DVec3::splat(damping * damping));
            for (axis, turn) in axes.iter().zip(&turns) {
                let way = axis.axis.cross(end - points[axis.joint]);
                match turn {
                    Some(turn) => left -= way * *turn,
                    None => square += DMat3::from_cols(way * way.x, way * way.y, way * way.z),
                }
            }
            let pull = square.inverse() * left;
            let mut is_within = true;
            for (axis, turn) in axes.iter().zip(&mut turns) {
                if turn.is_some() {
                    continue;
                }
                let wanted = axis.axis.cross(end - points[axis.joint]).dot(pull);
                if wanted < axis.range[0] || wanted > axis.range[1] {
                    *turn = Some(wanted.clamp(axis.range[0], axis.range[1]));
                    is_within = false;
                }
            }
            if is_within {
                for (axis, turn) in axes.iter().zip(&mut turns) {
                    turn.get_or_insert_with(|| axis.axis.cross(end - points[axis.joint]).dot(pull));
                }
                break;
            }
        }
        let mut turned = DQuat::IDENTITY;
        let mut directions: Vec<DVec3> = Vec::with_capacity(pose.directions.len());
        let mut own = axes.iter().zip(turns).peekable();
        for (joint, direction) in pose.directions.iter().enumerate() {
            let mut here = DQuat::IDENTITY;
            while let Some((axis, turn)) = own.next_if(|(axis, _)| axis.joint == joint) {
                here *= DQuat::from_axis_angle(axis.axis, turn.unwrap_or_default());
            }
            turned = (turned * here).normalize();
            let new = (turned * *direction).normalize();
            let before = directions.last().copied().or(self.limits.before);
            directions.push(before.map_or(new, |before| self.limits.allowed(joint, before, new)));
        }
        Pose { directions }
    }

    /// The axes about which the joints turn, ascending by joint. If a joint has two, its turn about the first is applied
    /// last.
    fn axes(&self, pose: &Pose, points: &[DVec3]) -> Vec<Axis> {
        let free = [-LARGEST_TURN, LARGEST_TURN];
        let mut axes = Vec::with_capacity(2 * pose.directions.len());
        let mut before = self.limits.before.map(|before| before.normalize_or(DVec3::X));
        for (joint, direction) in pose.directions.iter().enumerate() {
            match before {
                None => {
                    let across = direction.any_orthonormal_vector();
                    for axis in [across, direction.cross(across)] {
                        axes.push(Axis {
                            joint,
                            axis,
                            range: free,
                        });
                    }
                }
                Some(before) => {
                    let normal = before.cross(*direction);
                    // A straight joint bends towards the target.
                    let to_target = before.cross(self.target - points[joint]);
                    let axis = if normal.length() > STRAIGHT { normal } else { to_target };
                    let axis = axis.try_normalize().unwrap_or_else(|| before.any_orthonormal_vector());
                    let bend = before.angle_between(*direction);
                    let [least, most] = self.limits.range(joint);
                    let range = [
                        (least - bend).clamp(-LARGEST_TURN, 0.0),
                        (most - bend).clamp(0.0, LARGEST_TURN),
                    ];
                    axes.push(Axis {
                        joint,
                        axis: before,
                        range: free,
                    });
                    axes.push(Axis { joint, axis, range });
                }
            }
            before = Some(*direction);
        }
        axes
    }
}

/// An axis about which a joint turns, with the range of the turn in radians.
struct Axis {
    joint: usize,
    axis: DVec3,
    range: [f64; 2],
}

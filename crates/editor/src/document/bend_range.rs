//! The least and the most bend of a joint in degrees: 0 where the bones before and after it are one straight line.

/// The bends of a joint without limits, in degrees.
pub const FREE_BEND_DEG: [f64; 2] = [0.0, 180.0];

/// Returns true if this is the least and the most bend of a joint, in degrees from 0 to 180.
pub(crate) fn is_bend_range_deg([least, most]: [f64; 2]) -> bool {
    FREE_BEND_DEG[0] <= least && least <= most && most <= FREE_BEND_DEG[1]
}

//! Handles' motions over time: keys, and the transforms between them.

mod motion;
mod track;

pub use self::motion::Timeline;
pub use self::track::Ease;
pub(crate) use self::track::{Key, Track};

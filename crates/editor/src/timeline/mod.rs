//! Handles' motions over time: keys, and the transforms between them.

mod filter;
mod followed;
mod footprints;
mod frame_pose;
mod interpolation;
mod middle;
mod motion;
mod numbers;
mod path;
mod places;
mod posed;
mod present_key;
mod span;
mod spline;
mod track;

pub(crate) use self::filter::filter_shifts;
pub use self::followed::{FollowedFrame, FollowedHandle, Following};
pub use self::footprints::Footprints;
pub(crate) use self::frame_pose::{frames_that_reach, transform_at};
pub use self::middle::middle_of;
pub use self::motion::Timeline;
pub(crate) use self::motion::values_of;
pub(crate) use self::numbers::{NumberTrack, Values};
pub use self::path::BodyMotion;
pub(crate) use self::path::body_motions;
pub(crate) use self::places::places_of_handles;
pub(crate) use self::posed::Posed;
pub(crate) use self::present_key::present_key;
pub use self::span::{HandlePlace, SequenceTimeline};
pub(crate) use self::span::{Span, SpanKey};
pub(crate) use self::track::{Key, Track};

//! Curves through control points: a spline, its arc length and frames, and the motion from one curve to another.
//!
//! From below: `spline` is the centripetal Catmull–Rom spline \[YSK11\] with its table of arc lengths, `curve` adds
//! rotation-minimising frames \[WJZL08\] and finds the place that is nearest to a point, `motion` moves each point as the
//! frame at its place moves, and `between` finds the curves half way, along which a large turn is a turn. `laid` finds the triangles
//! under a curve, `feature_line` finds the crease or border that a rough line means, and `chain` pulls points whose
//! distances stay and whose joints may have limits (`joint_limits`), if its passes rest by turning all joints together
//! (`joint_search`).

mod between;
mod chain;
mod curve;
mod feature_line;
mod joint_limits;
mod joint_search;
mod laid;
mod monotone;
mod motion;
mod spline;

pub use between::CurvePath;
pub use chain::{pulled_briefly, pulled_chain, pulled_within};
pub use curve::{Curve, CurveRefused, LARGEST_TWIST_DEG, SCALE_RANGE};
pub use feature_line::feature_line;
pub use joint_limits::{BendRange, FREE_BEND, JointLimits};
pub use laid::triangles_under;
pub use motion::CurveMotion;

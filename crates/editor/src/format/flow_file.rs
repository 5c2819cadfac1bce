//! The flow format: the dye, the velocities and the forces with which `pliant flow` begins.

use glam::DVec3;
use serde::Deserialize;
use serde_json::{Value, json};

use super::edit_error::EditError;
use super::json::parse;
use super::reader::read;
use super::selector::Selector;
use super::transform::vector;
use super::version::check_version;

/// The most steps of a flow.
const MOST_STEPS: f64 = 100_000.0;

/// A flow along a surface. Lengths are in world units, times in seconds.
#[derive(Clone, PartialEq, Debug)]
pub struct FlowFile {
    /// The dyes, later ones over earlier ones.
    pub dye: Vec<DyeEntry>,
    /// The velocities at the start, which add up.
    pub velocity: Vec<VelocityEntry>,
    /// The acceleration of dyed fluid.
    pub gravity: DVec3,
    /// Kinematic viscosity, 0 or more.
    pub viscosity: f64,
    /// The strength of vorticity confinement per second, 0 or more.
    pub confinement: f64,
    /// Whether steps are of second order.
    pub accuracy: Accuracy,
    /// The length of a step, above 0.
    pub step: f64,
    /// The whole time, 0 or more.
    pub seconds: f64,
}

/// Dye on some vertices.
#[derive(Clone, PartialEq, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DyeEntry {
    /// The vertices.
    pub select: Selector,
    /// Linear red, green and blue, each from 0 to 1.
    #[serde(with = "vector")]
    pub color: DVec3,
}

/// A velocity of some vertices, of which the part along the surface counts.
#[derive(Clone, PartialEq, Debug)]
pub struct VelocityEntry {
    /// The vertices.
    pub select: Selector,
    /// The velocity.
    pub motion: FlowMotion,
}

/// A velocity in space.
#[derive(Clone, PartialEq, Debug)]
pub enum FlowMotion {
    /// That of a rotation.
    Spin {
        /// Its axis, a unit vector.
        axis: DVec3,
        /// Radians per second.
        rate: f64,
        /// A point on the axis; `None` is the mean of the selected vertices.
        center: Option<DVec3>,
    },
    /// The same everywhere.
    Push(DVec3),
}

/// The order of accuracy of a step.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Deserialize)]
#[serde(rename_all = "kebab-case", expecting = "\"first-order\" or \"second-order\"")]
pub enum Accuracy {
    /// The first: edges of dye blur, and swirls calm down.
    FirstOrder,
    /// The second.
    #[default]
    SecondOrder,
}

/// The members in the file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct StoredFlow {
    #[serde(rename = "version")]
    _version: u64,
    #[serde(default)]
    dye: Vec<DyeEntry>,
    #[serde(default)]
    velocity: Vec<StoredVelocity>,
    #[serde(default, with = "vector")]
    gravity: DVec3,
    #[serde(default)]
    viscosity: f64,
    #[serde(default)]
    confinement: f64,
    #[serde(default)]
    advection: Accuracy,
    #[serde(default = "a_sixtieth")]
    step: f64,
    #[serde(default = "two")]
    seconds: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct StoredVelocity {
    select: Selector,
    spin: Option<StoredSpin>,
    push: Option<StoredVector>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct StoredSpin {
    #[serde(with = "vector")]
    axis: DVec3,
    rate: f64,
    center: Option<StoredVector>,
}

#[derive(Deserialize)]
#[serde(transparent)]
struct StoredVector(#[serde(with = "vector")] DVec3);

fn a_sixtieth() -> f64 {
    1.0 / 60.0
}

fn two() -> f64 {
    2.0
}

impl FlowFile {
    /// Reads the format's JSON text.
    ///
    /// # Errors
    /// Members that the format does not have, and values out of range, by name and place.
    pub fn parse(text: &str) -> Result<Self, EditError> {
        let read = parse(text).and_then(|value| Self::read(&value));
        read.map_err(|error| error.at("the flow"))
    }

    /// Like [`FlowFile::parse`], for text that was read already.
    ///
    /// # Errors
    /// Those of [`FlowFile::parse`].
    pub fn from_value(value: &Value) -> Result<Self, EditError> {
        Self::read(value).map_err(|error| error.at("the flow"))
    }

    fn read(value: &Value) -> Result<Self, EditError> {
        check_version(value)?;
        let stored: StoredFlow = read(value)?;
        for (number, DyeEntry { select, color }) in stored.dye.iter().enumerate() {
            let place = |error: EditError, member: &str| error.under(member).under(&format!("dye[{number}]"));
            select.check().map_err(|error| place(error, "select"))?;
            if color.min_element() < 0.0 || color.max_element() > 1.0 {
                let allowed = "linear red, green and blue, each from 0 to 1";
                let refused = EditError::out_of_range(&json!(color.to_array()), allowed);
                return Err(place(refused, "color"));
            }
        }
        for (member, found) in [("viscosity", stored.viscosity), ("confinement", stored.confinement)] {
            if found < 0.0 {
                return Err(EditError::out_of_range(&json!(found), "a number from 0").under(member));
            }
        }
        if stored.step <= 0.0 {
            return Err(EditError::out_of_range(&json!(stored.step), "a time above 0").under("step"));
        }
        if stored.seconds < 0.0 || stored.seconds / stored.step > MOST_STEPS {
            let allowed = "a time from 0 of at most 100000 steps";
            return Err(EditError::out_of_range(&json!(stored.seconds), allowed).under("seconds"));
        }
        let velocity = stored.velocity.into_iter().enumerate();
        let velocity = velocity.map(|(number, stored)| {
            let entry = VelocityEntry::of(stored);
            entry.map_err(|error| error.under(&format!("velocity[{number}]")))
        });
        Ok(Self {
            dye: stored.dye,
            velocity: velocity.collect::<Result<_, _>>()?,
            gravity: stored.gravity,
            viscosity: stored.viscosity,
            confinement: stored.confinement,
            accuracy: stored.advection,
            step: stored.step,
            seconds: stored.seconds,
        })
    }

    /// The number of steps: the whole time over a step's, rounded.
    pub fn steps(&self) -> usize {
        (self.seconds / self.step).round() as usize
    }
}

impl VelocityEntry {
    fn of(stored: StoredVelocity) -> Result<Self, EditError> {
        let StoredVelocity { select, spin, push } = stored;
        select.check().map_err(|error| error.under("select"))?;
        let motion = match (spin, push) {
            (Some(spin), None) => {
                let refused = || EditError::out_of_range(&json!(spin.axis.to_array()), "a direction");
                let axis = spin.axis.try_normalize();
                FlowMotion::Spin {
                    axis: axis.ok_or_else(|| refused().under("axis").under("spin"))?,
                    rate: spin.rate,
                    center: spin.center.map(|center| center.0),
                }
            }
            (None, Some(push)) => FlowMotion::Push(push.0),
            _ => return Err(EditError::custom("needs either `spin` or `push`".to_owned())),
        };
        Ok(Self { select, motion })
    }
}

impl FlowMotion {
    /// The motion with a centre, which is `mean` unless the file names one.
    pub(crate) fn with_centre(&self, mean: impl FnOnce() -> DVec3) -> Self {
        match *self {
            Self::Spin {
                axis,
                rate,
                center: None,
            } => Self::Spin {
                axis,
                rate,
                center: Some(mean()),
            },
            ref other => other.clone(),
        }
    }

    /// The velocity at a position.
    pub fn at(&self, position: DVec3) -> DVec3 {
        match *self {
            Self::Spin { axis, rate, center } => (axis * rate).cross(position - center.unwrap_or_default()),
            Self::Push(velocity) => velocity,
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod tests {
    use super::*;

    #[test]
    fn every_member_but_the_version_may_be_left_out() {
        let flow = FlowFile::parse(r#"{"version": 1}"#).unwrap();
        assert_eq!(
            (flow.steps(), flow.gravity, flow.accuracy),
            (120, DVec3::ZERO, Accuracy::SecondOrder)
        );
        let text = r#"{"version": 1, "dye": [{"select": "all", "color": [0.5, 0, 1]}],
            "velocity": [{"select": "all", "spin": {"axis": [0, 2, 0], "rate": 3, "center": [1, 0, 0]}},
                         {"select": {"vertices": [0]}, "push": [1, 2, 3]}],
            "gravity": [0, -9.81, 0], "viscosity": 0.1, "confinement": 2, "step": 0.0166667, "seconds": 2}"#;
        let flow = FlowFile::parse(text).unwrap();
        assert_eq!(flow.steps(), 120);
        assert_eq!(flow.velocity[0].motion.at(DVec3::ZERO), DVec3::new(0.0, 0.0, 3.0));
        assert_eq!(flow.velocity[1].motion.at(DVec3::ZERO), DVec3::new(1.0, 2.0, 3.0));
    }

    #[test]
    fn faults_are_named_by_their_place() {
        for (members, says) in [
            (r#""dyes": []"#, "dyes"),
            (r#""dye": [{"select": "all", "color": [0, 2, 0]}]"#, "dye[0].color"),
            (r#""dye": [{"select": "all"}]"#, "color"),
            (r#""velocity": [{"select": "all"}]"#, "velocity[0]"),
            (
                r#""velocity": [{"select": "all", "spin": {"axis": [0, 0, 0], "rate": 1}}]"#,
                "velocity[0].spin.axis",
            ),
            (r#""step": 0"#, "step"),
            (r#""seconds": 1e9"#, "seconds"),
            (r#""viscosity": -1"#, "viscosity"),
            (r#""advection": "third-order""#, "advection"),
        ] {
            let said = FlowFile::parse(&format!("{{\"version\": 1, {members}}}"))
                .unwrap_err()
                .to_string();
            assert!(said.contains(says), "{said}");
        }
        assert!(
            FlowFile::parse(r#"{"version": 3}"#)
                .unwrap_err()
                .to_string()
                .contains("version")
        );
    }
}

//! The fluid in a project, and the forces in its flow.

use std::sync::Arc;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::DVec3;
use pliant_mesh::Model;
use serde::{Deserialize, Serialize};

use crate::EditError;
use crate::document::{Dye, FlowOptions, Fluid};
use crate::format::stored_field::Field;

/// The fluid, as stored.
#[derive(Clone, PartialEq, Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StoredFlow {
    #[serde(default)]
    gravity: [f64; 3],
    #[serde(default)]
    viscosity: f64,
    #[serde(default)]
    confinement: f64,
    /// Four numbers a vertex: linear red, green and blue multiplied by the coverage, and the coverage.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    dye: Option<Field>,
    /// The same for the dye that was kept as vertex colours.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    kept: Option<Field>,
    /// Three numbers for each of the surface's triangles, base64 of little-endian f32.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    velocity_f32_base64: Option<String>,
}

impl StoredFlow {
    /// `None` for a fluid that is as in a fresh document.
    pub(super) fn of(fluid: &Fluid, options: &FlowOptions, model: &Model) -> Option<Self> {
        let dyes = |dyes: &Option<Arc<Vec<Dye>>>| {
            let dyes = dyes.as_ref()?;
            Field::of(model, |vertex| {
                let dye = dyes[vertex.index()];
                (dye != [0.0; 4]).then_some(dye.map(f64::from))
            })
        };
        let bytes = |velocity: &Arc<Vec<[f32; 3]>>| {
            let numbers = velocity.iter().flatten();
            let bytes: Vec<u8> = numbers.flat_map(|number| number.to_le_bytes()).collect();
            STANDARD.encode(bytes)
        };
        let stored = Self {
            gravity: options.gravity.to_array(),
            viscosity: options.viscosity,
            confinement: options.confinement,
            dye: dyes(&fluid.dye),
            kept: dyes(&fluid.kept),
            velocity_f32_base64: fluid.velocity.as_ref().map(bytes),
        };
        (stored != Self::default()).then_some(stored)
    }

    pub(super) fn options(&self) -> Result<FlowOptions, EditError> {
        let options = FlowOptions {
            gravity: DVec3::from_array(self.gravity),
            viscosity: self.viscosity,
            confinement: self.confinement,
        };
        match options.are_usable() {
            true => Ok(options),
            false => Err(EditError::Project(
                "`flow` has a force that is negative or not finite: save it again".to_owned(),
            )),
        }
    }

    pub(super) fn fluid(&self, model: &Model) -> Result<Fluid, EditError> {
        let dyes = |field: &Option<Field>, name: &str| field.as_ref().map(|field| field.dyes(name, model)).transpose();
        Ok(Fluid {
            dye: dyes(&self.dye, "flow.dye")?,
            kept: dyes(&self.kept, "flow.kept")?,
            velocity: self.velocity(model.surface.triangles.len())?.map(Arc::new),
        })
    }

    /// The velocity of each of `count` triangles. If another welding had another number of them, the fluid rests.
    fn velocity(&self, count: usize) -> Result<Option<Vec<[f32; 3]>>, EditError> {
        let Some(stored) = &self.velocity_f32_base64 else {
            return Ok(None);
        };
        let bytes = STANDARD.decode(stored).map_err(|error| {
            EditError::Project(format!(
                "`flow.velocity_f32_base64` is not base64 ({error}): save it again"
            ))
        })?;
        let numbers = bytes.chunks_exact(4);
        let numbers = numbers.map(|bytes| bytes.try_into().map_or(f32::NAN, f32::from_le_bytes));
        let numbers: Vec<f32> = numbers.collect();
        if !numbers.iter().all(|number| number.is_finite()) {
            return Err(EditError::Project(
                "`flow.velocity_f32_base64` has a number that is not finite: save it again".to_owned(),
            ));
        }
        let velocities: Vec<[f32; 3]> = numbers.chunks_exact(3).map(|v| [v[0], v[1], v[2]]).collect();
        Ok((velocities.len() == count).then_some(velocities))
    }
}

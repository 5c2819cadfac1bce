//! A flow on a model, step by step.

use std::path::Path;

use pliant_deform::Budget;
use pliant_editor::{Accuracy, FlowFile, FlowStart, Selection};
use pliant_flow::{Advection, Flow, FlowError, FlowSettings};
use pliant_mesh::{Cancel, Model, SurfaceVertex};

use crate::EngineError;
use crate::watch::Watch;

/// A flow that has begun.
#[derive(Debug)]
pub struct Flowing<'a> {
    flow: Flow<'a>,
    settings: FlowSettings,
    seconds: f64,
    file: &'a Path,
    model: &'a Model,
}

impl<'a> Flowing<'a> {
    /// Factors the model's Laplacian, pours the dye and sets the velocities. Refusals name `file`.
    ///
    /// # Errors
    /// A model without triangles, or one whose pressure can't be found; [`EngineError::Interrupted`].
    pub fn begin(
        (file, model): (&'a Path, &'a Model),
        (flow_file, start): (&FlowFile, &FlowStart),
        budget: Budget,
        watch: &Watch,
    ) -> Result<Self, EngineError> {
        let progress = watch.begin("binding");
        let bound = Flow::bind(&model.surface, &model.topology, budget, &progress, &watch.cancel);
        let mut flow = bound.map_err(|error| refused(file, model, error))?;
        begin(&mut flow, start, model);
        flow.project().map_err(|error| refused(file, model, error))?;
        Ok(Self {
            flow,
            settings: FlowSettings {
                gravity: flow_file.gravity,
                viscosity: flow_file.viscosity,
                confinement: flow_file.confinement,
                advection: match flow_file.accuracy {
                    Accuracy::FirstOrder => Advection::FirstOrder,
                    Accuracy::SecondOrder => Advection::SecondOrder,
                },
            },
            seconds: flow_file.step,
            file,
            model,
        })
    }

    /// Takes a step.
    ///
    /// # Errors
    /// A pressure that can't be found, a velocity past all numbers; [`EngineError::Interrupted`].
    pub fn step(&mut self, cancel: &Cancel) -> Result<(), EngineError> {
        let stepped = self.flow.step(self.seconds, &self.settings, cancel);
        stepped.map_err(|error| refused(self.file, self.model, error))
    }

    /// The flow in its present state.
    pub fn flow(&self) -> &Flow<'a> {
        &self.flow
    }

    /// A sentence about places where the surface was cut.
    pub fn warning(&self) -> Option<String> {
        let places = match self.flow.cut_vertices() {
            0 => return None,
            1 => "at 1 vertex".to_owned(),
            count => format!("at {count} vertices"),
        };
        Some(format!(
            "the fluid of different sheets stays apart {places} where triangles do not meet as on one surface"
        ))
    }
}

/// Pours the dye and sets the velocities.
fn begin(flow: &mut Flow<'_>, start: &FlowStart, model: &Model) {
    let shares = |selection: &Selection| {
        let mut shares = vec![0.0; model.surface.positions.len()];
        selection.iter().for_each(|vertex| shares[vertex.index()] = 1.0);
        shares
    };
    for (selection, colour) in &start.dye {
        flow.pour(&shares(selection), colour.to_array());
    }
    for (selection, motion) in &start.velocity {
        flow.add_velocity(&shares(selection), |position| motion.at(position));
    }
}

/// The refusal of a flow, which names vertices by the file's numbers.
pub(super) fn refused(file: &Path, model: &Model, error: FlowError) -> EngineError {
    match error {
        FlowError::Cancelled(_) => EngineError::Interrupted,
        other => EngineError::Flow {
            file: file.to_owned(),
            source: other.renumbered(|vertex| model.first_file_vertex(SurfaceVertex(vertex)).0),
        },
    }
}

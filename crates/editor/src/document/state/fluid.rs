//! The fluid of a document, and the forces in it.

use std::sync::Arc;

use pliant_mesh::SurfaceVertex;

use super::{Document, Repainted};
use crate::document::fluid::{Dye, FlowOptions, Fluid};
use crate::document::packed_fluid::rounded_dye;
use crate::document::version::Aspect;

impl Document {
    /// The fluid on the surface.
    pub fn fluid(&self) -> &Fluid {
        &self.content.fluid
    }

    /// The forces in its flow.
    pub fn flow_options(&self) -> &FlowOptions {
        &self.content.flow_options
    }

    /// Chooses the forces in the fluid's flow.
    pub(crate) fn set_flow_options(&mut self, options: FlowOptions) {
        self.content.flow_options = options;
    }

    /// Replaces the fluid.
    pub(crate) fn set_fluid(&mut self, mut fluid: Fluid) {
        if self.content.fluid != fluid {
            self.swap_fluid(&mut fluid);
        }
    }

    /// Changes the dye of some vertices, those that `change` returns, and rounds it as history keeps it.
    pub(crate) fn change_dye(&mut self, change: impl FnOnce(&mut [Dye]) -> Vec<SurfaceVertex>) {
        let count = self.content.paint.len();
        let dye = &mut self.content.fluid.dye;
        let dye = dye.get_or_insert_with(|| Arc::new(vec![[0.0; 4]; count]));
        let dye = Arc::make_mut(dye);
        let changed = change(dye.as_mut_slice());
        for vertex in &changed {
            let dye = &mut dye[vertex.index()];
            *dye = rounded_dye(*dye);
        }
        self.marks.mark(&[Aspect::Fluid]);
        self.repainted.note(changed.into_iter(), count);
    }

    /// Changes the velocities of the surface's triangles, of which there are `count`.
    pub(crate) fn change_velocity(&mut self, count: usize, change: impl FnOnce(&mut [[f32; 3]])) {
        let velocity = &mut self.content.fluid.velocity;
        let velocity = velocity.get_or_insert_with(|| Arc::new(vec![[0.0; 3]; count]));
        change(Arc::make_mut(velocity).as_mut_slice());
        self.marks.mark(&[Aspect::Fluid]);
    }

    pub(in crate::document) fn swap_fluid(&mut self, fluid: &mut Fluid) {
        std::mem::swap(fluid, &mut self.content.fluid);
        self.marks.mark(&[Aspect::Fluid]);
        self.repainted = Repainted::All;
    }

    pub(in crate::document) fn swap_flow_options(&mut self, options: &mut FlowOptions) {
        std::mem::swap(options, &mut self.content.flow_options);
    }
}

//! A stroke of the flow brush: it pours or washes colour and moves the fluid.
//!
//! A playing flow gets every dab with its next step, as if the brush were in the fluid. A paused one is changed at once:
//! the stroke is a step of the history, and only the firmest dab changes a vertex' dye.

use glam::{DVec2, DVec3};
use pliant_mesh::{Model, SurfaceVertex, face_normal};

use super::brush_speed::BrushSpeed;
use super::context::Context;
use super::firmness::firmness;
use super::flow_brush::{FlowAction, FlowBrush};
use super::stroke::{Stroke, StrokeGesture, firmest_on_one_side};
use crate::document::{Document, Dye, from_srgb};
use crate::input::Pointer;
use crate::jobs::{Poured, Splash};
use crate::workspace::Workspace;

/// The stroke's action.
#[derive(Debug)]
pub(super) struct FlowStroke {
    brush: FlowBrush,
    /// The firmest dab on each vertex in this stroke.
    firmest: Vec<f32>,
    speed: BrushSpeed,
}

impl FlowStroke {
    pub fn begin(context: &mut Context<'_>, pointer: Pointer) -> StrokeGesture<Self> {
        let mut brush = context.settings.flow_brush;
        if pointer.modifiers.ctrl {
            brush.action = FlowAction::Wash;
        } else if pointer.modifiers.shift {
            brush.action = FlowAction::Push;
        }
        let transaction = context.workspace.begin(match brush.action {
            FlowAction::PourAndPush | FlowAction::Pour => "Pour",
            FlowAction::Push => "Push",
            FlowAction::Wash => "Wash",
        });
        let stroke = Self {
            brush,
            firmest: vec![0.0; context.workspace.document.paint().len()],
            speed: BrushSpeed::default(),
        };
        StrokeGesture::begin(context, transaction, stroke, pointer)
    }

    /// The velocity of the brush, in world units per second.
    fn velocity(&mut self, context: &Context<'_>, to_px: DVec2) -> Option<DVec3> {
        let now_ms = context.workspace.jobs.now_ms();
        match context.workspace.pick(context.view, to_px) {
            Some(pick) => self.speed.at(pick.point, now_ms),
            None => {
                self.speed.leave();
                None
            }
        }
    }

    /// The fluid that is poured, if any.
    fn poured(&self) -> Option<Poured> {
        match self.brush.action {
            FlowAction::PourAndPush | FlowAction::Pour => Some(Poured::Dye(self.brush.colour.map(from_srgb))),
            FlowAction::Wash => Some(Poured::Clear),
            FlowAction::Push => None,
        }
    }

    /// Pours into the paused fluid.
    fn dye(&mut self, document: &mut Document, before: &Document, met: &[(SurfaceVertex, f64)]) {
        let poured: Dye = match self.poured() {
            None => return,
            Some(Poured::Clear) => [0.0; 4],
            Some(Poured::Dye([red, green, blue])) => [red, green, blue, 1.0].map(|value| value as f32),
        };
        let (firmest, before) = (&mut self.firmest, &before.fluid().dye);
        document.change_dye(|dye| {
            let mut changed = Vec::new();
            for (vertex, firmness) in met {
                let index = vertex.index();
                let firmness = *firmness as f32;
                if firmness <= firmest[index] {
                    continue;
                }
                firmest[index] = firmness;
                changed.push(*vertex);
                let old: Dye = before.as_ref().map_or([0.0; 4], |before| before[index]);
                dye[index] = std::array::from_fn(|k| old[k] + firmness * (poured[k] - old[k]));
            }
            changed
        });
    }
}

impl Stroke for FlowStroke {
    fn doing(&self, _: &Workspace) -> String {
        match self.brush.action {
            FlowAction::PourAndPush | FlowAction::Pour => "Pouring".to_owned(),
            FlowAction::Push => "Pushing".to_owned(),
            FlowAction::Wash => "Washing".to_owned(),
        }
    }

    fn dab(&mut self, context: &mut Context<'_>, before: &Document, way_px: [DVec2; 2]) {
        let Some(model) = context.workspace.model().cloned() else {
            return;
        };
        let strength = self.brush.strength * context.settings.pressure.unwrap_or(1.0);
        let falloff = self.brush.falloff;
        let met = firmest_on_one_side(context, way_px, |share| strength * firmness(falloff, share));
        let velocity = self.velocity(context, way_px[1]).filter(|_| self.brush.pushes());
        if met.is_empty() {
            return;
        }
        let workspace = &mut *context.workspace;
        if workspace.flow.is_playing() {
            let poured = self.poured();
            return workspace.splash(Splash {
                vertices: met,
                poured,
                velocity,
            });
        }
        self.dye(&mut workspace.document, before, &met);
        if let Some(velocity) = velocity {
            push(&mut workspace.document, &model, &met, velocity);
        }
    }

    fn goes_on_by_itself(&self, workspace: &Workspace) -> bool {
        workspace.flow.is_playing()
    }
}

/// Moves the paused fluid's velocity towards the tangential part of another, by the mean share of a triangle's corners.
fn push(document: &mut Document, model: &Model, met: &[(SurfaceVertex, f64)], towards: DVec3) {
    let triangles = &model.surface.triangles;
    let mut touched: Vec<u32> = met
        .iter()
        .flat_map(|(vertex, _)| model.topology.faces(*vertex, triangles))
        .collect();
    touched.sort_unstable();
    touched.dedup();
    let from_file = std::sync::Arc::clone(document.from_file());
    let share = |vertex: SurfaceVertex| {
        let place = met.binary_search_by_key(&vertex, |(vertex, _)| *vertex);
        place.map_or(0.0, |place| met[place].1)
    };
    document.change_velocity(triangles.len(), |velocities| {
        for triangle in touched {
            let corners = triangles[triangle as usize];
            let mean = corners.map(share).iter().sum::<f64>() / 3.0;
            let at = |vertex: SurfaceVertex| model.surface.positions[vertex.index()] + from_file[vertex.index()];
            let normal = face_normal(corners.map(at));
            let own = &mut velocities[triangle as usize];
            let old = DVec3::from_array(own.map(f64::from));
            let tangent = towards - normal * normal.dot(towards);
            *own = old.lerp(tangent, mean).as_vec3().to_array();
        }
    });
}

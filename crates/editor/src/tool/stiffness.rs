//! A stroke of the stiffness brush: towards a value, towards the neighbours, or back to 1.
//!
//! Stiffness spans six decades, so everything is blended in its logarithm. Within one stroke a vertex is as far on its
//! way as the firmest dab that met it: going over the same place again without letting go adds nothing, and a stroke
//! looks the same however many events the pointer sent. Smoothing alone adds up.

use std::sync::Arc;

use glam::DVec2;
use pliant_mesh::SurfaceVertex;

use super::Tool;
use crate::document::Transaction;
use crate::editor::Editor;
use crate::{Button, Pointer, STIFFNESS_RANGE};

/// What the stiffness brush does.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub enum StiffnessAction {
    /// Takes the surface towards the brush's value.
    #[default]
    Paint,
    /// Takes each vertex towards its neighbours.
    Smooth,
    /// Takes the surface back to 1.
    Erase,
}

/// The stiffness brush.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct StiffnessBrush {
    /// What it does.
    pub action: StiffnessAction,
    /// What it paints, in [`STIFFNESS_RANGE`].
    pub value: f64,
    /// How far one stroke goes, 0 to 1.
    pub strength: f64,
    /// How softly it ends at its rim: 0 is a hard rim, 1 falls off from the middle.
    pub falloff: f64,
}

impl Default for StiffnessBrush {
    fn default() -> Self {
        Self {
            action: StiffnessAction::default(),
            value: 10.0,
            strength: 1.0,
            falloff: 0.5,
        }
    }
}

impl StiffnessBrush {
    /// The brush with every number within its range; `None` where one is no number.
    pub(crate) fn clamped(self) -> Option<Self> {
        let is_usable = [self.value, self.strength, self.falloff]
            .iter()
            .all(|number| number.is_finite());
        is_usable.then(|| Self {
            value: self.value.clamp(*STIFFNESS_RANGE.start(), *STIFFNESS_RANGE.end()),
            strength: self.strength.clamp(0.0, 1.0),
            falloff: self.falloff.clamp(0.0, 1.0),
            ..self
        })
    }

    /// How firm the brush is at a share of its radius: 1 inside, 0 at the rim, a smooth step between.
    fn firmness(&self, share: f64) -> f64 {
        let inner = 1.0 - self.falloff;
        if share <= inner || self.falloff == 0.0 {
            return 1.0;
        }
        let t = ((1.0 - share) / self.falloff).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    }
}

/// A stroke that goes on.
#[derive(Debug)]
pub(crate) struct StiffnessStroke {
    transaction: Transaction,
    brush: StiffnessBrush,
    last_px: DVec2,
    /// The firmest that met each vertex in this stroke.
    firmest: Vec<f32>,
}

impl StiffnessStroke {
    pub(crate) fn begin(editor: &mut Editor, pointer: Pointer) -> Self {
        editor.engine.stop_binding();
        editor.engine.drop_solves();
        let mut brush = editor.stiffness_brush;
        if pointer.modifiers.ctrl {
            brush.action = StiffnessAction::Erase;
        }
        let transaction = editor.begin(match brush.action {
            StiffnessAction::Paint => "Paint stiffness",
            StiffnessAction::Smooth => "Smooth stiffness",
            StiffnessAction::Erase => "Erase stiffness",
        });
        let mut stroke = Self {
            transaction,
            brush,
            last_px: pointer.position_px,
            firmest: vec![0.0; editor.document.paint.len()],
        };
        stroke.dab(editor, pointer.position_px);
        stroke
    }

    pub(crate) fn moved(mut self: Box<Self>, editor: &mut Editor, pointer: Pointer) -> Tool {
        self.dab(editor, pointer.position_px);
        Tool::Stiffness(self)
    }

    pub(crate) fn released(mut self: Box<Self>, editor: &mut Editor, pointer: Pointer, button: Button) -> Tool {
        if button != Button::Primary {
            return Tool::Stiffness(self);
        }
        if pointer.position_px != self.last_px {
            self.dab(editor, pointer.position_px);
        }
        let document = &mut editor.document;
        if document
            .stiffness
            .as_ref()
            .is_some_and(|field| field.iter().all(|&value| value == 1.0))
        {
            document.stiffness = None;
        }
        self.transaction.commit(&editor.document, &mut editor.history);
        // Every dab has said what it recoloured.
        editor.known_stiffness.clone_from(&editor.document.stiffness);
        Tool::Idle
    }

    pub(crate) fn abort(self, editor: &mut Editor) {
        self.transaction.abort(&mut editor.document);
        editor.repainted = true;
    }

    fn dab(&mut self, editor: &mut Editor, to_px: DVec2) {
        let mut brush = std::mem::take(&mut editor.brush);
        let strength = self.brush.strength * editor.pressure;
        let mut met: Vec<(SurfaceVertex, f64)> = Vec::new();
        if let Some(picking) = editor.picking() {
            let firmness = |share| strength * self.brush.firmness(share);
            brush.stroke(&picking, self.last_px, to_px, &editor.brush_size(), |vertex, share| {
                met.push((vertex, firmness(share)));
            });
        }
        editor.brush = brush;
        self.last_px = to_px;
        met.retain(|(vertex, _)| editor.masks.may_be_painted(vertex.index()));
        if met.is_empty() {
            return;
        }
        // The shape that is shown was made with another stiffness: it is kept, as with every stroke.
        editor.document.apply_shape();
        // Who else holds the field would have it copied by every dab.
        editor.known_stiffness = None;
        let count = editor.document.paint.len();
        let before = self.transaction.before().stiffness.clone();
        let field = editor
            .document
            .stiffness
            .get_or_insert_with(|| Arc::new(vec![1.0; count]));
        let field = Arc::make_mut(field);
        if self.brush.action == StiffnessAction::Smooth {
            let Some(model) = &editor.engine.model else { return };
            // Every new value comes from old ones, whatever the order of the vertices.
            met.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(b.1.total_cmp(&a.1)));
            met.dedup_by_key(|(vertex, _)| *vertex);
            let smoothed: Vec<f64> = met
                .iter()
                .map(|&(vertex, firmness)| {
                    let own = field[vertex.index()].ln();
                    let neighbours = model.topology.neighbours(vertex);
                    let sum: f64 = neighbours.iter().map(|v| field[v.index()].ln()).sum();
                    let mean = if neighbours.is_empty() {
                        own
                    } else {
                        sum / neighbours.len() as f64
                    };
                    in_range((own + (mean - own) * firmness).exp())
                })
                .collect();
            for ((vertex, _), value) in met.iter().zip(smoothed) {
                field[vertex.index()] = value;
            }
            let smoothed: Vec<SurfaceVertex> = met.iter().map(|(vertex, _)| *vertex).collect();
            return editor.recolouring.add(&smoothed);
        }
        let goal = match self.brush.action {
            StiffnessAction::Erase => 1.0,
            _ => self.brush.value,
        };
        let mut changed = Vec::new();
        for (vertex, firmness) in met {
            let firmest = &mut self.firmest[vertex.index()];
            if firmness as f32 <= *firmest {
                continue;
            }
            *firmest = firmness as f32;
            changed.push(vertex);
            let start = before.as_ref().map_or(1.0, |field| field[vertex.index()]);
            field[vertex.index()] = if firmness >= 1.0 {
                goal
            } else {
                in_range((start.ln() + (goal.ln() - start.ln()) * firmness).exp())
            };
        }
        editor.recolouring.add(&changed);
    }
}

fn in_range(value: f64) -> f64 {
    value.clamp(*STIFFNESS_RANGE.start(), *STIFFNESS_RANGE.end())
}

//! Sizing the brush with the pointer: its circle stays, and the pointer pulls the rim.

use std::f64::consts::TAU;

use glam::DVec2;

use super::context::Context;
use super::gesture::{Gesture, Next};
use super::overlay::Lit;
use super::settings::ToolSettings;
use crate::input::{Button, Key, Modifiers, Pointer};
use crate::view::{Cursor, Readout, View};
use crate::workspace::Workspace;

const RIM_SEGMENTS: usize = 64;

/// A brush whose radius follows the pointer; a click keeps it.
#[derive(Debug)]
pub(crate) struct SizeBrush {
    centre_px: DVec2,
    radius_px: f64,
    before_px: f64,
}

impl SizeBrush {
    /// Begins with the pointer on the rim.
    pub(crate) fn begin(settings: &ToolSettings, pointer_px: DVec2) -> Self {
        let radius_px = settings.brush().radius_px;
        Self {
            centre_px: pointer_px - DVec2::X * radius_px,
            radius_px,
            before_px: radius_px,
        }
    }
}

impl Gesture for SizeBrush {
    fn cursor(&self) -> Cursor {
        Cursor::Move
    }

    fn lit(&self) -> Lit {
        Lit::Gizmo(None)
    }

    fn status(&self, _: &Workspace, _: &View) -> Option<String> {
        let radius = self.radius_px;
        Some(format!("Brush of {radius:.0} px: click to keep it, Esc to cancel"))
    }

    fn readout(&self, _: &Workspace, view: &View) -> Option<Readout> {
        let (camera, rim_px) = (view.camera(), self.centre_px + DVec2::X * self.radius_px);
        let ray = camera.ray(rim_px, view.viewport_px());
        let depth = camera.distance / ray.direction.dot(camera.forward());
        Some(Readout {
            at: ray.origin + ray.direction * depth,
            text: format!("{:.0} px", self.radius_px),
        })
    }

    fn outline_px(&self) -> Vec<DVec2> {
        let rim = (0..RIM_SEGMENTS).map(|step| TAU * step as f64 / RIM_SEGMENTS as f64);
        rim.map(|angle_rad| self.centre_px + DVec2::from_angle(angle_rad) * self.radius_px)
            .collect()
    }

    fn holds_camera(&self) -> bool {
        true
    }

    fn moved(&mut self, context: &mut Context<'_>, pointer: Pointer) -> Next {
        context
            .settings
            .set_brush_radius(pointer.position_px.distance(self.centre_px));
        self.radius_px = context.settings.brush().radius_px;
        Next::Stay
    }

    fn pressed(&mut self, context: &mut Context<'_>, pointer: Pointer, button: Button) -> Next {
        match button {
            Button::Primary => self.moved(context, pointer),
            Button::Secondary => {
                self.abort(context);
                Next::End
            }
            Button::Middle => return Next::Stay,
        };
        Next::End
    }

    fn key(&mut self, context: &mut Context<'_>, key: Key, _: Modifiers) -> Option<Next> {
        match key {
            Key::Escape => self.abort(context),
            Key::Enter => {}
            _ => return Some(Next::Stay),
        }
        Some(Next::End)
    }

    fn abort(&mut self, context: &mut Context<'_>) {
        context.settings.set_brush_radius(self.before_px);
    }
}

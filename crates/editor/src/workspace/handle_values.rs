//! The numbers of a handle, as a panel or a command sets them: where it stands, how it is turned, how far the surface
//! comes along, how it joins, how firmly it holds.

use pliant_deform::CONTINUITY_RANGE;

use crate::command::Reach;
use crate::document::HandleId;
use crate::document::rotation_of;
use crate::editor::Editor;
use crate::{HandleTransform, SOFT_RANGE};

impl Editor {
    pub(crate) fn transform_handle(&mut self, verb: &str, id: HandleId, transform: HandleTransform) {
        let Some(name) = self.document.handle(id).map(|handle| handle.name.clone()) else {
            return;
        };
        self.step(format!("{verb} {name}"), |editor| editor.put_handle(id, transform));
    }

    pub(crate) fn set_turn(&mut self, id: HandleId, turn_deg: glam::DVec3) {
        if !turn_deg.is_finite() {
            self.problem = Some("The handle's turn is not finite: enter other numbers.".to_owned());
            return;
        }
        let Some(handle) = self.document.handle(id) else { return };
        let HandleTransform::Trs {
            translation,
            scale,
            pivot,
            ..
        } = handle.transform
        else {
            self.problem = Some(format!(
                "{} is moved by a matrix: reset it to turn it by angles.",
                handle.name
            ));
            return;
        };
        let turned = HandleTransform::Trs {
            translation,
            rotation: rotation_of(turn_deg),
            scale,
            pivot,
        };
        self.step(format!("Turn {}", handle.name.clone()), |editor| {
            editor.put_handle(id, turned);
            editor.count_turn(id, turn_deg);
        });
    }

    /// Widening the region changes roles: the present shape becomes the rest shape first.
    pub(crate) fn set_reach(&mut self, id: HandleId, reach: Reach) {
        let (Reach::Radii(size) | Reach::Length(size)) = reach;
        if !(size.is_finite() && size >= 0.0) {
            self.problem = Some("A reach is a length of at least 0: enter another number.".to_owned());
            return;
        }
        if self.document.handle(id).is_none_or(|handle| handle.reach == reach) {
            return;
        }
        self.engine.drop_solves();
        self.change("Change reach", |document| {
            document.apply_shape();
            if let Some(handle) = document.handle_mut(id) {
                handle.reach = reach;
            }
        });
    }

    pub(crate) fn set_continuity(&mut self, id: HandleId, continuity: Option<f64>) {
        if continuity.is_some_and(|value| !CONTINUITY_RANGE.contains(&value)) {
            self.problem = Some("A continuity is from 0 (a hinge) to 2 (smooth): enter another number.".to_owned());
            return;
        }
        self.change("Change continuity", |document| {
            if document
                .handle(id)
                .is_some_and(|handle| handle.continuity != continuity)
            {
                document.settled &= !document.is_displaced();
                if let Some(handle) = document.handle_mut(id) {
                    handle.continuity = continuity;
                }
            }
        });
    }

    pub(crate) fn set_soft(&mut self, id: HandleId, soft: Option<f64>) {
        if soft.is_some_and(|weight| !SOFT_RANGE.contains(&weight)) {
            let (least, most) = (SOFT_RANGE.start(), SOFT_RANGE.end());
            self.problem = Some(format!(
                "A soft handle's weight is from {least} to {most}: enter another number."
            ));
            return;
        }
        self.change("Change softness", |document| {
            if document.handle(id).is_some_and(|handle| handle.soft != soft) {
                document.settled &= !document.is_displaced();
                if let Some(handle) = document.handle_mut(id) {
                    handle.soft = soft;
                }
            }
        });
    }
}

//! A pose by its name: the kept positions of handles and control points, and weights of examples.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DAffine3, DMat3, DQuat, DVec3};
use pliant_deform::{Attachment, Method};

use super::handle::{Handle, HandleId};
use super::handle_transform::HandleTransform;
use super::strength::Stance;
use super::turn::followed;

/// The largest deviation of a matrix that counts as a rotation.
const RIGID: f64 = 1e-12;

/// A kept pose. Handles that it does not name are not part of it.
#[derive(Clone, PartialEq, Debug)]
pub struct Pose {
    /// Its name, for a person.
    pub name: String,
    pub(crate) handles: BTreeMap<HandleId, Placed>,
    /// The moved positions of the attachments' points, by the attachments' names.
    pub(crate) controls: BTreeMap<&'static str, Arc<Vec<DVec3>>>,
    /// The weights of examples that bend the surface.
    pub(crate) weights: BTreeMap<&'static str, Vec<Option<f64>>>,
}

/// The stance of a handle, about its pivot at that time.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Placed {
    pub(crate) stance: Stance,
    pub(crate) pivot: DVec3,
}

impl Pose {
    /// The present state of handles and the method's attachments.
    pub(crate) fn of(
        name: String,
        handles: &[Handle],
        method: &Method,
        attachments: &BTreeMap<&'static str, Attachment>,
    ) -> Self {
        let (mut controls, mut weights) = (BTreeMap::new(), BTreeMap::new());
        for declared in method.declaration().attachments {
            match attachments.get(declared.name) {
                Some(Attachment::Shapes(examples)) if method.examples_bend() => {
                    weights.insert(declared.name, examples.weights.clone());
                }
                Some(own) => {
                    controls.extend(own.moved().map(|moved| (declared.name, Arc::clone(moved))));
                }
                None => {}
            }
        }
        Self {
            name,
            handles: handles.iter().map(|handle| (handle.id, Placed::of(handle))).collect(),
            controls,
            weights,
        }
    }

    /// The attachments with the pose's points and weights, for attachments whose number of points or weights is the
    /// same.
    pub(crate) fn attachments(
        &self,
        present: &Arc<BTreeMap<&'static str, Attachment>>,
    ) -> Arc<BTreeMap<&'static str, Attachment>> {
        let mut attachments = Arc::clone(present);
        for (name, own) in &**present {
            let posed = match own {
                Attachment::Shapes(examples) => {
                    let weights = self.weights.get(name).filter(|own| own.len() == examples.weights.len());
                    weights.map(|weights| {
                        let mut examples = examples.clone();
                        examples.weights.clone_from(weights);
                        Attachment::Shapes(examples)
                    })
                }
                Attachment::Mesh(_) | Attachment::Lattice(_) => {
                    let moved = self
                        .controls
                        .get(name)
                        .filter(|own| own.len() == attachments[name].point_count());
                    moved.map(|moved| own.with_moved(Arc::clone(moved)))
                }
            };
            if let Some(posed) = posed
                && posed != *own
            {
                Arc::make_mut(&mut attachments).insert(*name, posed);
            }
        }
        attachments
    }

    /// Keeps the pose's positions of handles when each handle's map of the rest shape becomes the new rest shape, with
    /// the handle's pivot at its image.
    pub(crate) fn rebase(&mut self, handles: &[Handle]) {
        for handle in handles {
            if let Some(placed) = self.handles.get_mut(&handle.id) {
                *placed = placed.rebased(handle.affine(), handle.centre());
            }
        }
    }
}

impl Placed {
    pub(crate) fn of(handle: &Handle) -> Self {
        Self {
            stance: Stance::of(handle),
            pivot: handle.pivot,
        }
    }

    /// The stance of a handle with this pivot: the map of positions stays the same.
    pub(crate) fn about(&self, pivot: DVec3) -> Stance {
        let mut stance = self.stance;
        if let HandleTransform::Trs { translation, .. } = &mut stance.transform
            && pivot != self.pivot
        {
            *translation = self.stance.transform.affine(self.pivot).transform_point3(pivot) - pivot;
        }
        stance
    }

    /// The same position relative to the rest shape that `made` has made of the former one.
    pub(super) fn rebased(self, made: DAffine3, pivot: DVec3) -> Self {
        let map = self.stance.transform.affine(self.pivot) * made.inverse();
        if !map.is_finite() {
            return self;
        }
        let rotation = DQuat::from_mat3(&map.matrix3).normalize();
        let is_rigid = DMat3::from_quat(rotation).abs_diff_eq(map.matrix3, RIGID);
        let (transform, turn_deg) = if is_rigid {
            let transform = HandleTransform::Trs {
                translation: map.transform_point3(pivot) - pivot,
                rotation,
                scale: DVec3::ONE,
                pivot: None,
            };
            (transform, followed(DVec3::ZERO, rotation))
        } else {
            (HandleTransform::Matrix(map), DVec3::ZERO)
        };
        Self {
            stance: Stance { transform, turn_deg },
            pivot,
        }
    }
}

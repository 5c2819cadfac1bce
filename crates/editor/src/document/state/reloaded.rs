//! A document on its mesh when that is read again: after another program has changed the file, with another joining of
//! its vertices, or with other triangles (cut, filled or joined).

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use glam::DVec3;
use pliant_deform::{Attachment, Budget, Loose};
use pliant_mesh::{Cancel, Cancelled, Model, SurfaceVertex};

use super::Document;
use crate::document::access::Access;
use crate::document::carried_examples::carry_examples;
use crate::document::content::{Content, Paint};
use crate::document::continuation::Continuation;
use crate::document::fluid::Fluid;
use crate::document::handle::{HandleId, PivotPlace};
use crate::document::kept_shape::KeptShape;
use crate::document::matching::Matching;

impl Document {
    /// The same regions and handles on the vertices of a new mesh that match its own, which has the present shape at
    /// rest, with the parts that are turned inside out turned there. They continue into new triangles. Handles rest at
    /// their visible positions. With it come sentences about what was lost.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub(crate) fn onto_new_mesh(
        &self,
        matching: &Matching,
        model: &Model,
        budget: Budget,
        cancel: &Cancel,
    ) -> Result<(Self, Vec<String>), Cancelled> {
        let mut applied = self.clone();
        applied.apply_shape();
        let mut lost: Vec<String> = self
            .attachments
            .keys()
            .filter(|name| !applied.attachments.contains_key(*name))
            .map(|name| format!("The {name} was removed, because it belongs to the former rest shape."))
            .collect();
        let shape = Arc::clone(&applied.content.from_file);
        let mut content = applied.onto(matching, Some(&shape)).content;
        let count = matching.of_new.len();
        content.rest = Arc::new(vec![DVec3::ZERO; count]);
        content.applied = false;
        content.settled = true;
        content.strength = None;
        content.inside_out = Arc::default();
        continue_into_new(&mut content, matching, model);
        let mut attachments = (*applied.content.attachments).clone();
        lost.extend(carry_examples(&mut attachments, matching, model, budget, cancel)?);
        content.attachments = Arc::new(attachments);
        let left: Vec<HandleId> = content.handles.iter().map(|handle| handle.id).collect();
        let gone = self.handles.iter().filter(|handle| !left.contains(&handle.id));
        lost.extend(gone.map(|handle| format!("{} was removed with its last vertex.", handle.name)));
        for handle in &mut content.handles {
            handle.parent = handle.parent.filter(|parent| left.contains(parent));
            handle.twin = handle.twin.filter(|twin| left.contains(&twin.handle));
        }
        Ok((content.into(), lost))
    }

    /// The document on the mesh from which its own was made by [`onto_new_mesh`](Self::onto_new_mesh), without that
    /// change: `shape` is the shape that the former mesh had then, and `inside_out` its parts that were turned.
    pub(crate) fn onto_former_mesh(&self, matching: &Matching, shape: &[DVec3], inside_out: &BTreeSet<u32>) -> Self {
        let mut in_file = vec![DVec3::ZERO; self.paint.len()];
        for (vertex, shape) in matching.of_new.iter().zip(shape) {
            if let Some(vertex) = vertex {
                in_file[*vertex as usize] = -*shape;
            }
        }
        let mut former = self.onto(matching, Some(&in_file));
        let turned = former.inside_out.symmetric_difference(inside_out).copied().collect();
        former.set_inside_out(Arc::new(turned));
        former
    }

    /// Makes a handle of the vertices of a new mesh that match none of the former one. Closed parts of it that face
    /// inwards are turned inside out, because a cut or a merge could no longer tell. What was there before and is not
    /// painted rests, whatever the handle touches.
    pub(crate) fn hold_new_part(&mut self, name: &str, matching: &Matching, model: &Model) -> Option<HandleId> {
        let new = (0..).zip(&matching.of_new).filter(|(_, old)| old.is_none());
        let new: Vec<SurfaceVertex> = new.map(|(vertex, _)| SurfaceVertex(vertex)).collect();
        if new.is_empty() {
            return None;
        }
        let sum: DVec3 = new.iter().map(|vertex| model.surface.positions[vertex.index()]).sum();
        let id = self.add_handle();
        self.change_handle(id, |handle| {
            handle.name = name.to_owned();
            handle.pivot = sum / new.len() as f64;
        });
        self.paint_vertices(new.iter().map(|vertex| (*vertex, Paint::Handle(id))));
        let mut parts = self.loose_parts().clone();
        let former = (0..).zip(&matching.of_new_part).filter(|(_, old)| old.is_some());
        former.for_each(|(part, _)| {
            parts.entry(part).or_insert(Loose::Rest);
        });
        self.set_loose(self.loose(), parts);
        let is_new = |part: &&u32| matching.of_new_part[**part as usize].is_none();
        let mut turned = (*self.content.inside_out).clone();
        turned.extend(model.inside_out.iter().filter(is_new));
        self.set_inside_out(Arc::new(turned));
        Some(id)
    }

    /// Puts the pivots that belong in the middle of their handles there, after a change of vertices. The handles rest.
    pub(crate) fn centre_pivots(&mut self, model: &Model) {
        let mut sums: BTreeMap<HandleId, (DVec3, f64)> = BTreeMap::new();
        for (paint, position) in self.content.paint.iter().zip(&model.surface.positions) {
            if let Paint::Handle(id) = paint {
                let (sum, count) = sums.entry(*id).or_default();
                (*sum, *count) = (*sum + *position, *count + 1.0);
            }
        }
        self.change_handles(|handles| {
            for handle in handles
                .iter_mut()
                .filter(|handle| handle.pivot_place == PivotPlace::Centroid)
            {
                if let Some((sum, count)) = sums.get(&handle.id) {
                    handle.pivot = *sum / *count;
                }
            }
        });
    }

    /// The same regions, handles and shapes on the vertices that match its own; the others are fixed. If the file was
    /// saved since it was opened, `saved` are the displacements at that time (an entry per surface vertex of this
    /// document), and the rest shape is the file's without them.
    pub(crate) fn onto(&self, matching: &Matching, saved: Option<&[DVec3]>) -> Self {
        let map = Map(matching);
        let mut content = Content {
            handles: self.handles.clone(),
            next_handle: self.next_handle,
            method: self.method.clone(),
            tips: self.tips,
            loose: self.loose,
            poses: Arc::clone(&self.poses),
            animation: self.animation.clone(),
            flow_options: self.flow_options,
            // The fluid's velocity belongs to the old triangles: it rests.
            fluid: Fluid {
                dye: self.fluid.dye.as_ref().map(|dye| Arc::new(map.field(dye, [0.0; 4]))),
                velocity: None,
                kept: self.fluid.kept.as_ref().map(|kept| Arc::new(map.field(kept, [0.0; 4]))),
            },
            strength: self.strength.clone(),
            paint: Arc::new(map.field(&self.paint, Paint::Bare)),
            stiffness: self.stiffness.as_ref().map(|field| Arc::new(map.field(field, 1.0))),
            continuity: self.continuity.as_ref().map(|field| {
                let highest = *pliant_deform::CONTINUITY_RANGE.end();
                Arc::new(map.field(field, highest))
            }),
            from_rest: map.moved(&self.from_rest),
            kept: self.kept.as_ref().map(|kept| {
                Arc::new(KeptShape {
                    shape: map.moved(&kept.shape),
                    corrections: kept.corrections.as_ref().map(|corrections| map.moved(corrections)),
                    ..KeptShape::clone(kept)
                })
            }),
            applied: self.applied || saved.is_some(),
            // The rest shape may differ now.
            settled: false,
            ..Content::new(matching.of_new.len())
        };
        content.rest = match saved {
            Some(saved) => {
                let rest: Vec<DVec3> = self
                    .rest
                    .iter()
                    .zip(saved)
                    .map(|(rest, saved)| *rest - *saved)
                    .collect();
                map.moved(&rest)
            }
            None => map.moved(&self.rest),
        };
        let mut attachments = (*self.attachments).clone();
        for attachment in attachments.values_mut() {
            if let Attachment::Shapes(examples) = attachment {
                for shape in Arc::make_mut(&mut examples.shapes) {
                    shape.displacements = map.moved(&shape.displacements);
                }
            }
        }
        content.attachments = Arc::new(attachments);
        let parts = || {
            (0..)
                .zip(&matching.of_new_part)
                .filter_map(|(new, old)| Some((new, (*old)?)))
        };
        let loose = parts().filter_map(|(new, old)| Some((new, *self.loose_parts.get(&old)?)));
        content.loose_parts = Arc::new(loose.collect());
        let turned = parts().filter(|(_, old)| self.inside_out.contains(old));
        content.inside_out = Arc::new(turned.map(|(new, _)| new).collect());
        content.access = Arc::new(self.access_onto(matching));
        let is_there = |paint: &Paint| content.paint.contains(paint);
        let left: Vec<_> = content
            .handles
            .iter()
            .filter(|handle| is_there(&Paint::Handle(handle.id)))
            .cloned()
            .collect();
        content.handles = left;
        content.into()
    }

    /// The hidden and locked objects of a new mesh: those that were so before. A part that is isolated stays so if it
    /// is still one part and everything in the new mesh was there before.
    fn access_onto(&self, matching: &Matching) -> Access {
        let objects = |of: &BTreeSet<u32>| {
            let new = (0..).zip(&matching.of_new_object);
            let own = new.filter(|(_, old)| old.is_some_and(|old| of.contains(&old)));
            own.map(|(new, _)| new).collect()
        };
        let isolated = self
            .access
            .isolated
            .filter(|_| matching.of_new_part.iter().all(Option::is_some));
        let isolated = isolated.and_then(|alone| {
            let mut own = (0..).zip(&matching.of_new_part).filter(|(_, old)| **old == Some(alone));
            own.next().filter(|_| own.next().is_none()).map(|(new, _)| new)
        });
        Access {
            hidden: objects(&self.access.hidden),
            locked: objects(&self.access.locked),
            isolated,
            small: self.access.small,
        }
    }
}

/// Continues paint, stiffness, continuity and dye into the new triangles of former parts.
fn continue_into_new(content: &mut Content, matching: &Matching, model: &Model) {
    let continuation = Continuation::of(matching, model);
    continuation.paint(Arc::make_mut(&mut content.paint).as_mut_slice());
    for field in [&mut content.stiffness, &mut content.continuity].into_iter().flatten() {
        continuation.numbers(Arc::make_mut(field).as_mut_slice());
    }
    for dye in [&mut content.fluid.dye, &mut content.fluid.kept].into_iter().flatten() {
        continuation.dye(Arc::make_mut(dye).as_mut_slice());
    }
}

/// Fields of the old mesh's vertices on the new one's.
struct Map<'a>(&'a Matching);

impl Map<'_> {
    fn field<T: Copy>(&self, old: &[T], otherwise: T) -> Vec<T> {
        let of_new = self.0.of_new.iter();
        of_new
            .map(|vertex| vertex.map_or(otherwise, |vertex| old[vertex as usize]))
            .collect()
    }

    fn moved(&self, old: &[DVec3]) -> Arc<Vec<DVec3>> {
        Arc::new(self.field(old, DVec3::ZERO))
    }
}

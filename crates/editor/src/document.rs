//! What is saved and undone: the paint, the handles, the options, and the shape they have brought about.
//!
//! The [`Document`] holds what a person has said and what has come of it. What follows from it alone, and can be
//! computed again at any time (the region around the handles, the factorisation), is not in it.
//!
//! Cloning is cheap: the long vectors are shared until one side changes.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DAffine3, DMat3, DQuat, DVec3};
use pliant_deform::{Arap, CONTINUITY_RANGE, Loose, Method};

use crate::handle_colour::handle_colour;
use crate::turn::followed;
use crate::{Access, HandleTransform, Reach};

/// A handle's number for as long as the document lives.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct HandleId(pub u16);

/// What was painted on a vertex.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub enum Paint {
    /// Nothing: free where a handle reaches, held still elsewhere.
    #[default]
    Bare,
    /// Held still, whatever reaches it.
    Fixed,
    /// Free to bend.
    Free,
    /// A part of a handle.
    Handle(HandleId),
}

/// A handle: a part of the surface that is moved as a whole.
#[derive(Clone, PartialEq, Debug)]
pub struct Handle {
    /// Its number.
    pub id: HandleId,
    /// Its name, for a person.
    pub name: String,
    /// Its colour, sRGB with alpha.
    pub colour: [u8; 4],
    /// Where it was put, from the rest shape, about its pivot.
    pub transform: HandleTransform,
    /// Its turn as a person counts it, in degrees about x, y and z: full turns included. It means the rotation of the
    /// transform.
    pub turn_deg: DVec3,
    /// The point that its turns and scales leave alone, on the rest shape, in world space.
    pub pivot: DVec3,
    /// Where the pivot stands when the handle's vertices change.
    pub pivot_place: PivotPlace,
    /// How far along the surface it takes the surface along.
    pub reach: Reach,
    /// Its weight, in [`crate::SOFT_RANGE`], if it only pulls at its vertices.
    pub soft: Option<f64>,
    /// Whether its colour and its gizmo are shown.
    pub visible: bool,
    /// Whether it is kept from being moved, painted and deleted.
    pub locked: bool,
    /// With which continuity the surface joins it, in [`pliant_deform::CONTINUITY_RANGE`]; `None` is what the document
    /// says of its vertices.
    pub continuity: Option<f64>,
    /// The handle that does the same on the other side of a plane.
    pub twin: Option<Twin>,
}

/// Where a handle's pivot stands.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub enum PivotPlace {
    /// At the mean of its vertices.
    #[default]
    Centroid,
    /// At the middle of its border with the rest of the surface: an arm turns about its shoulder.
    Border,
    /// Where a person put it.
    Picked,
}

/// A handle's other half.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Twin {
    /// The handle.
    pub handle: HandleId,
    /// The plane between both.
    pub plane: MirrorPlane,
}

/// A plane across an axis of the world.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct MirrorPlane {
    /// 0, 1, 2 for x, y, z.
    pub axis: usize,
    /// Where it crosses the axis, in world units.
    pub at: f64,
}

impl MirrorPlane {
    /// What a handle on the other side does when one on this side does `transform`.
    pub(crate) fn mirrored_transform(&self, transform: HandleTransform) -> HandleTransform {
        let mut flip = DVec3::ONE;
        flip[self.axis] = -1.0;
        match transform {
            HandleTransform::Trs {
                translation,
                rotation,
                scale,
                pivot,
            } => {
                // A rotation's axis turns the other way round in a mirror.
                let axis = -(rotation.xyz() * flip);
                let rotation = if rotation.xyz() == DVec3::ZERO {
                    rotation
                } else {
                    DQuat::from_xyzw(axis.x, axis.y, axis.z, rotation.w)
                };
                HandleTransform::Trs {
                    translation: translation * flip,
                    rotation,
                    scale,
                    pivot: pivot.map(|pivot| self.mirrored(pivot)),
                }
            }
            HandleTransform::Matrix(matrix) => {
                let mut shift = DVec3::ZERO;
                shift[self.axis] = 2.0 * self.at;
                let mirror = DAffine3 {
                    matrix3: DMat3::from_diagonal(flip),
                    translation: shift,
                };
                HandleTransform::Matrix(mirror * matrix * mirror)
            }
        }
    }

    /// The point on the other side.
    pub fn mirrored(&self, point: DVec3) -> DVec3 {
        let mut other = point;
        other[self.axis] = 2.0 * self.at - point[self.axis];
        other
    }
}

impl Handle {
    /// A handle without vertices yet, at rest.
    pub(crate) fn new(id: HandleId, name: String) -> Self {
        Self {
            id,
            name,
            colour: handle_colour(id.0),
            transform: HandleTransform::IDENTITY,
            turn_deg: DVec3::ZERO,
            pivot: DVec3::ZERO,
            pivot_place: PivotPlace::default(),
            reach: Reach::default(),
            soft: None,
            visible: true,
            locked: false,
            continuity: None,
            twin: None,
        }
    }

    /// The transform as a map of world positions of the rest shape.
    pub fn affine(&self) -> DAffine3 {
        self.transform.affine(self.pivot)
    }

    /// Puts it somewhere, and counts its turn on from where it was.
    pub(crate) fn put(&mut self, transform: HandleTransform) {
        self.turn_deg = match transform {
            // Back at rest it has not turned at all.
            _ if transform.is_identity() => DVec3::ZERO,
            HandleTransform::Trs { rotation, .. } => followed(self.turn_deg, rotation),
            HandleTransform::Matrix(_) => DVec3::ZERO,
        };
        self.transform = transform;
    }

    /// Whether it is anywhere else than where it rests.
    pub fn is_displaced(&self) -> bool {
        !self.transform.is_identity()
    }

    /// Where its pivot is now, in world space.
    pub fn centre(&self) -> DVec3 {
        self.affine().transform_point3(self.pivot)
    }
}

/// The edited state of one mesh. Every vector has one element per surface vertex.
#[derive(Clone, Debug)]
pub struct Document {
    pub(crate) paint: Arc<Vec<Paint>>,
    pub(crate) handles: Vec<Handle>,
    /// The next handle's number.
    pub(crate) next_handle: u16,
    /// Painted stiffness; `None` is 1 everywhere.
    pub(crate) stiffness: Option<Arc<Vec<f64>>>,
    /// With which continuity the surface joins what holds it; `None` is the highest everywhere.
    pub(crate) continuity: Option<Arc<Vec<f64>>>,
    pub(crate) method: Method,
    pub(crate) loose: Loose,
    /// What single parts do that nothing holds, by their component's number, in place of `loose`.
    pub(crate) loose_parts: Arc<BTreeMap<u32, Loose>>,
    /// What is hidden and locked.
    pub(crate) access: Arc<Access>,
    /// The rest shape's displacements from the file's.
    pub(crate) rest: Arc<Vec<DVec3>>,
    /// Whether a shape was applied: without, `rest` is zero.
    pub(crate) applied: bool,
    /// The present shape's displacements from the rest shape.
    pub(crate) from_rest: Arc<Vec<DVec3>>,
    /// The sum of both, what is drawn: follows from them.
    pub(crate) from_file: Arc<Vec<DVec3>>,
    /// Whether `from_rest` is final for the handles' transforms.
    pub(crate) settled: bool,
}

impl Document {
    /// A fresh document: everything is held still. It bends by smooth ARAP, which turns and moves at once.
    pub fn new(vertex_count: usize) -> Self {
        let zero = Arc::new(vec![DVec3::ZERO; vertex_count]);
        Self {
            paint: Arc::new(vec![Paint::Bare; vertex_count]),
            handles: Vec::new(),
            next_handle: 0,
            stiffness: None,
            continuity: None,
            method: Arap::first_choice().into(),
            loose: Loose::default(),
            loose_parts: Arc::default(),
            access: Arc::default(),
            rest: Arc::clone(&zero),
            applied: false,
            from_rest: Arc::clone(&zero),
            from_file: zero,
            settled: true,
        }
    }

    /// What was painted on each surface vertex.
    pub fn paint(&self) -> &[Paint] {
        &self.paint
    }

    /// The handles, in the order in which they were made.
    pub fn handles(&self) -> &[Handle] {
        &self.handles
    }

    /// The handle with this number.
    pub fn handle(&self, id: HandleId) -> Option<&Handle> {
        self.handles.iter().find(|handle| handle.id == id)
    }

    /// A new handle without vertices, the last of the list.
    pub(crate) fn add_handle(&mut self) -> HandleId {
        let id = HandleId(self.next_handle);
        self.next_handle = self.next_handle.saturating_add(1);
        self.handles
            .push(Handle::new(id, format!("handle {}", u32::from(id.0) + 1)));
        id
    }

    pub(crate) fn handle_mut(&mut self, id: HandleId) -> Option<&mut Handle> {
        self.handles.iter_mut().find(|handle| handle.id == id)
    }

    /// Painted stiffness per surface vertex; `None` is 1 everywhere.
    pub fn stiffness(&self) -> Option<&[f64]> {
        self.stiffness.as_ref().map(|field| field.as_slice())
    }

    /// With which continuity the surface joins what holds it, per surface vertex; `None` is the highest everywhere.
    pub fn continuity(&self) -> Option<&[f64]> {
        self.continuity.as_ref().map(|field| field.as_slice())
    }

    /// The method and its options.
    pub fn method(&self) -> &Method {
        &self.method
    }

    /// What components that nothing holds do.
    pub fn loose(&self) -> Loose {
        self.loose
    }

    /// What single components do that nothing holds, in place of [`Document::loose`].
    pub fn loose_parts(&self) -> &BTreeMap<u32, Loose> {
        &self.loose_parts
    }

    /// The continuity per surface vertex, with that of handles which say one of their own; `None` is the highest
    /// everywhere.
    pub fn joints(&self) -> Option<Vec<f64>> {
        let own: BTreeMap<HandleId, f64> = self
            .handles
            .iter()
            .filter_map(|handle| Some((handle.id, handle.continuity?)))
            .collect();
        if own.is_empty() {
            return self.continuity.as_ref().map(|field| field.to_vec());
        }
        let highest = *CONTINUITY_RANGE.end();
        let painted = self.paint.iter().enumerate();
        let joint = |(vertex, paint): (usize, &Paint)| match paint {
            Paint::Handle(id) if own.contains_key(id) => own[id],
            _ => self.continuity.as_ref().map_or(highest, |field| field[vertex]),
        };
        Some(painted.map(joint).collect())
    }

    /// What of the file is hidden and locked.
    pub fn access(&self) -> &Access {
        &self.access
    }

    /// The rest shape's displacements from the file's shape, per surface vertex.
    pub fn rest(&self) -> &[DVec3] {
        &self.rest
    }

    /// The present shape's displacements from the rest shape, per surface vertex.
    pub fn from_rest(&self) -> &[DVec3] {
        &self.from_rest
    }

    /// The present shape's displacements from the file's shape, per surface vertex: what is drawn.
    pub fn from_file(&self) -> &Arc<Vec<DVec3>> {
        &self.from_file
    }

    /// Whether a shape was applied, so that the rest shape is another than the file's.
    pub fn is_applied(&self) -> bool {
        self.applied
    }

    /// Whether the shape is final for the handles' transforms.
    pub fn is_settled(&self) -> bool {
        self.settled
    }

    /// Whether the present shape is another than the rest shape.
    pub fn is_displaced(&self) -> bool {
        !self.settled || self.handles.iter().any(Handle::is_displaced)
    }

    /// Makes the present shape the rest shape. No drawn vertex moves; the handles' pivots go along.
    pub(crate) fn apply_shape(&mut self) {
        if !self.is_displaced() {
            return;
        }
        self.rest = Arc::clone(&self.from_file);
        self.applied = true;
        self.from_rest = Arc::new(vec![DVec3::ZERO; self.rest.len()]);
        self.settled = true;
        for handle in &mut self.handles {
            handle.pivot = handle.centre();
            handle.put(HandleTransform::IDENTITY);
        }
    }

    /// Shows a shape that the handles have brought about.
    pub(crate) fn show(&mut self, from_rest: Arc<Vec<DVec3>>, from_file: Arc<Vec<DVec3>>) {
        self.from_rest = from_rest;
        self.from_file = from_file;
    }

    /// Computes what is drawn from the rest shape and the displacements from it.
    pub(crate) fn refresh_from_file(&mut self) {
        self.from_file = sum_of_shapes(self.applied.then_some(&self.rest), &self.from_rest);
    }
}

/// What is drawn: the rest shape's displacements, if there are any, plus those from it.
///
/// Where nothing is added the bits of the rest shape stay, so that applying a shape moves nothing.
pub(crate) fn sum_of_shapes(rest: Option<&Arc<Vec<DVec3>>>, from_rest: &Arc<Vec<DVec3>>) -> Arc<Vec<DVec3>> {
    match rest {
        None => Arc::clone(from_rest),
        Some(rest) => Arc::new(
            rest.iter()
                .zip(from_rest.iter())
                .map(|(&rest, &more)| if more == DVec3::ZERO { rest } else { rest + more })
                .collect(),
        ),
    }
}

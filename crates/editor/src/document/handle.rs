//! A handle: a part of the surface that is moved as a whole, with all its settings.

use std::sync::Arc;

use glam::{DAffine3, DVec3};
use pliant_mesh::MirrorPlane;

use super::bend_range::FREE_BEND_DEG;
use super::handle_colour::handle_colour;
use super::handle_line::HandleLine;
use super::handle_transform::HandleTransform;
use super::turn::followed;

/// A handle's number for as long as the document lives.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct HandleId(pub u16);

/// A handle: a part of the surface that is moved as a whole.
#[derive(Clone, PartialEq, Debug)]
pub struct Handle {
    /// Its number.
    pub id: HandleId,
    /// Its name, for a person.
    pub name: String,
    /// Its colour, sRGB with alpha.
    pub colour: [u8; 4],
    /// Its transform from the rest shape, about its pivot.
    pub transform: HandleTransform,
    /// Its turn in degrees about x, y and z, full turns included. It is equal to the transform's rotation.
    pub turn_deg: DVec3,
    /// The fixed point of its turns and scales, on the rest shape, in world space.
    pub pivot: DVec3,
    /// The place of the pivot when the handle's vertices change.
    pub pivot_place: PivotPlace,
    /// The distance along the surface within which it moves the surface.
    pub reach: Reach,
    /// Its weight, in [`crate::SOFT_RANGE`], if it only pulls at its vertices.
    pub soft: Option<f64>,
    /// True if its colour and its gizmo are shown.
    pub visible: bool,
    /// True if it is locked against being moved, painted and deleted.
    pub locked: bool,
    /// True if it is a pin: it holds its vertices at their visible positions and can't be moved.
    pub is_pin: bool,
    /// The continuity with which the surface joins it, in [`pliant_deform::CONTINUITY_RANGE`]; `None` is the document's
    /// continuity at its vertices.
    pub continuity: Option<f64>,
    /// The handle with the mirrored motion on the other side of a plane.
    pub twin: Option<Twin>,
    /// The handle with which it rides along.
    pub parent: Option<HandleId>,
    /// The least and the most bend at its joint in degrees, from its parent's bone to its own, while both are parts of a
    /// limb that is pulled as a whole.
    pub bend_deg: [f64; 2],
    /// The line that its vertices follow before its transform moves them.
    pub line: Option<HandleLine>,
    /// The unit direction along which it is free, in world space: its transform holds it across this direction only, and
    /// it slides along it to where the energy is least.
    pub free_along: Option<DVec3>,
    /// The places at which a footprint holds its vertices in the shown frame of a sequence, in world space, whatever its
    /// transform.
    pub(crate) held: Option<Arc<Vec<DVec3>>>,
}

/// The place of a handle's pivot.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub enum PivotPlace {
    /// At the mean of its vertices.
    #[default]
    Centroid,
    /// At the middle of its border with the rest of the surface: an arm turns about its shoulder.
    Border,
    /// At a place that a person chose.
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

/// The most radii of a handle that [`Reach::Found`], [`Reach::Feature`] and [`Reach::Part`] are.
pub(crate) const PART_RADII: f64 = 3.0;

/// The distance along the surface within which a handle moves the surface.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub enum Reach {
    /// To the end of the feature that the handle is on, where the surface around it widens or, unless it is a limb, in a
    /// concave crease; at most three radii. On a limb it ends a little beyond the place where the limb meets another one,
    /// as a thigh meets the other one in the crotch, and not on the other one.
    #[default]
    Found,
    /// This distance in world units, where ways across concave creases and beyond the end of a limb count as longer and
    /// none leads to a limb beside it, as for [`Reach::Found`] (0: only the painted vertices).
    Bounded(f64),
    /// To the end of the feature, wherever limbs meet. No new handle has it: it is that of older projects.
    Feature,
    /// This distance in world units, where ways across concave creases count as longer, as they do for
    /// [`Reach::Feature`] (0: only the painted vertices).
    Creased(f64),
    /// To the end of the part that the handle is on, where the surface around it widens, across any creases; at most three
    /// radii. No new handle has it: it is that of older projects.
    Part,
    /// This many of the handle's own radii (above 0).
    Radii(f64),
    /// This distance in world units (0: only the painted vertices).
    Length(f64),
}

impl Handle {
    /// A handle without vertices, at rest.
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
            is_pin: false,
            continuity: None,
            twin: None,
            parent: None,
            bend_deg: FREE_BEND_DEG,
            line: None,
            free_along: None,
            held: None,
        }
    }

    /// The transform as a map of world positions of the rest shape.
    pub fn affine(&self) -> DAffine3 {
        self.transform.affine(self.pivot)
    }

    /// Sets its transform, and continues to count its turn.
    pub(crate) fn put(&mut self, transform: HandleTransform) {
        self.turn_deg = match transform {
            // At rest its turn is zero.
            _ if transform.is_identity() => DVec3::ZERO,
            HandleTransform::Trs { rotation, .. } => followed(self.turn_deg, rotation),
            HandleTransform::Matrix(_) => DVec3::ZERO,
        };
        self.transform = transform;
        // Who moves it by hand lets it go.
        self.held = None;
    }

    /// Returns true if a binding depends on nothing in which the lines of both differ: on the curve at rest and its
    /// crease, or on the whole sketch.
    pub(crate) fn line_binds_as(&self, other: &Self) -> bool {
        match (&self.line, &other.line) {
            (Some(HandleLine::Curve(own)), Some(HandleLine::Curve(other))) => own.binds_as(other),
            (own, other) => own == other,
        }
    }

    /// Brings it back to its rest position, its line too.
    pub(crate) fn come_to_rest(&mut self) {
        self.put(HandleTransform::IDENTITY);
        self.line = self.line.as_ref().and_then(HandleLine::at_rest);
    }

    /// Makes its present position its rest position.
    pub(crate) fn apply(&mut self) {
        let affine = self.affine();
        self.line = self.line.as_ref().and_then(|line| line.applied(&affine));
        self.pivot = self.centre();
        self.put(HandleTransform::IDENTITY);
    }

    /// Makes it a pin. It moves nothing around it, and has no twin.
    pub(crate) fn pin(&mut self) {
        self.is_pin = true;
        self.name = format!("pin {}", u32::from(self.id.0) + 1);
        self.reach = Reach::Length(0.0);
        self.twin = None;
        self.free_along = None;
    }

    /// Moves the pivot to a point of the rest shape; the map of positions stays the same.
    pub(crate) fn move_pivot(&mut self, pivot: DVec3) {
        let affine = self.affine();
        // A translation is the same about every pivot, to the bit.
        if let HandleTransform::Trs {
            translation,
            rotation,
            scale,
            ..
        } = &mut self.transform
            && (rotation.xyz() != DVec3::ZERO || *scale != DVec3::ONE)
        {
            *translation = affine.transform_point3(pivot) - pivot;
        }
        self.pivot = pivot;
    }

    /// Its free direction, if it is not held otherwise: by a line, or as a pin.
    pub(crate) fn freedom(&self) -> Option<DVec3> {
        self.free_along.filter(|_| self.line.is_none() && !self.is_pin)
    }

    /// Returns true if it is away from its rest position.
    pub fn is_displaced(&self) -> bool {
        !self.transform.is_identity() || self.held.is_some() || self.line.as_ref().is_some_and(|line| !line.is_rest())
    }

    /// The present position of its pivot, in world space.
    pub fn centre(&self) -> DVec3 {
        self.affine().transform_point3(self.pivot)
    }
}

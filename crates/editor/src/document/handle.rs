//! A handle: a part of the surface that is moved as a whole, with all that a person chose for it.

use glam::{DAffine3, DVec3};
use pliant_mesh::MirrorPlane;

use super::handle_colour::handle_colour;
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
    /// Whether it is a pin: it holds its vertices where they were seen, and nobody moves it.
    pub is_pin: bool,
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

/// How far along the surface a handle takes the surface along.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Reach {
    /// This many of the handle's own radii (above 0).
    Radii(f64),
    /// This far in world units (0: only what is painted).
    Length(f64),
}

impl Default for Reach {
    fn default() -> Self {
        Self::Radii(3.0)
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
            is_pin: false,
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

    /// Makes it a pin. It takes nothing along, and moves with no twin.
    pub(crate) fn pin(&mut self) {
        self.is_pin = true;
        self.name = format!("pin {}", u32::from(self.id.0) + 1);
        self.reach = Reach::Length(0.0);
        self.twin = None;
    }

    /// Puts the pivot at a point of the rest shape; the map of positions stays the same.
    pub(crate) fn move_pivot(&mut self, pivot: DVec3) {
        let affine = self.affine();
        if let HandleTransform::Trs { translation, .. } = &mut self.transform
            && *translation != affine.transform_point3(pivot) - pivot
        {
            *translation = affine.transform_point3(pivot) - pivot;
        }
        self.pivot = pivot;
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

//! The transforms of an instance's vertices from the mesh's own space into the world.

use std::borrow::Cow;

use glam::{DAffine3, DMat3};

/// The transforms of an instance's vertices.
#[derive(Clone, PartialEq, Debug)]
pub(crate) enum Pose {
    /// One by their node.
    Node(DAffine3),
    /// One for each vertex; glTF ignores the node's.
    Skin(SkinPose),
}

/// The transforms of skinned vertices: weighted means of those of their joints.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct SkinPose {
    transforms: Vec<DAffine3>,
    is_mirrored: bool,
}

impl SkinPose {
    /// The pose of these vertices.
    pub fn of(transforms: Vec<DAffine3>) -> Self {
        let signs = |sign: f64| {
            let determinants = transforms.iter().map(|transform| transform.matrix3.determinant());
            determinants.filter(|determinant| determinant * sign > 0.0).count()
        };
        let is_mirrored = signs(-1.0) > signs(1.0);
        Self {
            transforms,
            is_mirrored,
        }
    }

    /// The transform of each vertex.
    pub fn transforms(&self) -> &[DAffine3] {
        &self.transforms
    }
}

/// The linear part of a vertex's transform, and its inverse.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Linear {
    pub world_from_mesh: DMat3,
    pub mesh_from_world: DMat3,
}

impl Linear {
    /// The linear part of a transform; `None` if it has no inverse.
    fn of(transform: &DAffine3) -> Option<Self> {
        is_invertible(transform).then(|| Self {
            world_from_mesh: transform.matrix3,
            mesh_from_world: transform.matrix3.inverse(),
        })
    }
}

/// The linear parts of the transforms of an instance's vertices.
pub(crate) enum Linears<'a> {
    /// The node's, computed once.
    Same(Option<Linear>),
    /// One for each vertex.
    Each(&'a SkinPose),
}

impl Linears<'_> {
    /// The linear part of an element's transform; `None` if it has no inverse.
    pub fn at(&self, element: usize) -> Option<Cow<'_, Linear>> {
        match self {
            // Copying both matrices for each vertex took 4% of the time of reading a file with normals.
            Self::Same(linear) => linear.as_ref().map(Cow::Borrowed),
            Self::Each(skin) => Linear::of(&skin.transforms[element]).map(Cow::Owned),
        }
    }
}

impl Pose {
    /// The different transforms: a node's single one, or each element's.
    pub fn transforms(&self) -> &[DAffine3] {
        match self {
            Self::Node(world_from_node) => std::slice::from_ref(world_from_node),
            Self::Skin(skin) => skin.transforms(),
        }
    }

    /// The transform of an element.
    pub fn at(&self, element: usize) -> DAffine3 {
        match self {
            Self::Node(world_from_node) => *world_from_node,
            Self::Skin(skin) => skin.transforms[element],
        }
    }

    /// The linear parts of the elements' transforms.
    pub fn linear(&self) -> Linears<'_> {
        match self {
            Self::Node(world_from_node) => Linears::Same(Linear::of(world_from_node)),
            Self::Skin(skin) => Linears::Each(skin),
        }
    }

    /// Returns true if the triangles appear with the opposite winding to the stored one; for a skin, if more of
    /// its vertices are mirrored than not.
    pub fn is_mirrored(&self) -> bool {
        match self {
            Self::Node(world_from_node) => world_from_node.matrix3.determinant() < 0.0,
            Self::Skin(skin) => skin.is_mirrored,
        }
    }

    /// The inverse transform for each element.
    pub fn inverse(&self) -> impl Fn(usize) -> DAffine3 + '_ {
        let of_node = match self {
            Self::Node(world_from_node) => world_from_node.inverse(),
            Self::Skin(_) => DAffine3::IDENTITY,
        };
        move |element| match self {
            Self::Node(_) => of_node,
            Self::Skin(skin) => skin.transforms[element].inverse(),
        }
    }

    /// The number of vertices that a skin flattens, whose moves can't be undone.
    pub fn flattened_count(&self) -> usize {
        match self {
            Self::Node(_) => 0,
            Self::Skin(skin) => skin
                .transforms
                .iter()
                .filter(|transform| !is_invertible(transform))
                .count(),
        }
    }
}

/// A determinant below this share of the product of the axes' lengths is a transform that flattens to a plane or less.
const FLAT: f64 = 1e-12;

/// Returns true if a transform has an inverse.
pub(crate) fn is_invertible(transform: &DAffine3) -> bool {
    let DMat3 { x_axis, y_axis, z_axis } = transform.matrix3;
    let volume = x_axis.length() * y_axis.length() * z_axis.length();
    let determinant = transform.matrix3.determinant();
    transform.is_finite() && determinant.abs() > FLAT * volume && transform.inverse().is_finite()
}

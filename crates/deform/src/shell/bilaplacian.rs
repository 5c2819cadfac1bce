//! Options of the linear shell (survey, section 2): what the surface is made of, and on which operator.

/// The linear shell A d = 0 between what is held and the handles, with
///
/// A = k_s (−L) + k_b (−L)(−M⁻¹ L)ⁿ⁻¹,
///
/// which at order n = 2 is (−k_s L + k_b L M⁻¹ L) d = 0 (survey, equation 8). A is symmetric and positive definite on
/// what is solved for. Lengths are measured in diagonals of the surface's bounding box, so neither coefficient depends
/// on the model's unit, and only their ratio shows in the shape; the energy ½ dᵀ A d has no unit.
///
/// Painted stiffness s scales the energy's density, ½ ∫ k_s s |∇d|² + k_b s |Δd|² at order 2 and s |∇Δd|² at order 3: a
/// part of stiffness 10 resists bending ten times as much, and turns with what holds it.
#[derive(Clone, PartialEq, Debug)]
#[non_exhaustive]
pub struct Bilaplacian {
    /// k_s, the resistance to stretching, in units of k_b per squared diagonal at order 2 and per the fitting power of
    /// it at the others: finite, from 0. Default 0.
    pub stretching: f64,
    /// k_b, the resistance to what the order names: finite, from 0. With 0 there is only stretching, a membrane.
    /// Default 1.
    pub bending: f64,
    /// Which derivative of the displacement is kept small. Default: bending.
    pub order: ShellOrder,
    /// How the Laplacian is discretised. Default: cotangents and vertex areas.
    pub discretisation: Discretisation,
    /// Which triangles it is made on. Default: the surface's own.
    pub triangulation: Triangulation,
    /// From 0, as the surface lies in space, to 1, as if it were stretched along the principal axes of the part that may
    /// move until that varied alike along all of them, though by no more than a factor 10: stiffer along what is long
    /// (Botsch & Kobbelt 2004). Default 0.
    pub anisotropy: f64,
}

/// The order n of the shell: its surfaces join what is held with continuity Cⁿ⁻¹ (Botsch & Kobbelt 2004).
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub enum ShellOrder {
    /// n = 1, −L d = 0: least area. Joins with a crease.
    Membrane,
    /// n = 2, L M⁻¹ L d = 0: least curvature. Joins with equal tangents.
    #[default]
    ThinPlate,
    /// n = 3, −L M⁻¹ L M⁻¹ L d = 0: least change of curvature. Joins with equal curvature.
    CurvatureVariation,
}

/// The weights w_ij and areas M_ii of the Laplacian (survey, section 5.1).
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub enum Discretisation {
    /// w_ij = 1, M_ii = Σ_j w_ij: blind to the triangles' shapes. Up to one factor for the whole surface, which makes
    /// it agree with the others where all triangles are equilateral; edges at a boundary count half, as they do there.
    Uniform,
    /// w_ij = ½ (cot α + cot β), M_ii the same for all: blind to how dense the vertices are.
    Cotangent,
    /// w_ij = ½ (cot α + cot β), M_ii the vertex' own area (survey, equation 7).
    #[default]
    CotangentArea,
}

/// The triangles that the Laplacian is made on; their vertices are the surface's.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub enum Triangulation {
    /// The surface's.
    #[default]
    AsIs,
    /// The surface's, with edges flipped within it until no weight is negative, except at edges with more or less than
    /// two triangles (Fisher et al. 2006).
    IntrinsicDelaunay,
    /// The surface's tufted cover, flipped: no weight is negative on any triangles (Sharp & Crane 2020).
    Tufted,
}

impl Triangulation {
    /// Every triangulation, the default first.
    pub const ALL: [Self; 3] = [Self::AsIs, Self::IntrinsicDelaunay, Self::Tufted];

    /// Its name in an edit.
    pub fn name(self) -> &'static str {
        match self {
            Self::AsIs => "as-is",
            Self::IntrinsicDelaunay => "intrinsic-delaunay",
            Self::Tufted => "tufted",
        }
    }
}

impl Bilaplacian {
    /// The power of L in the system: the order, or 1 where nothing but stretching is left.
    pub fn operator_power(&self) -> u32 {
        if self.bending == 0.0 { 1 } else { self.order.number() }
    }
}

impl Default for Bilaplacian {
    fn default() -> Self {
        Self {
            stretching: 0.0,
            bending: 1.0,
            order: ShellOrder::default(),
            discretisation: Discretisation::default(),
            triangulation: Triangulation::default(),
            anisotropy: 0.0,
        }
    }
}

impl ShellOrder {
    /// Every order, by rising number.
    pub const ALL: [Self; 3] = [Self::Membrane, Self::ThinPlate, Self::CurvatureVariation];

    /// n: 1, 2 or 3.
    pub fn number(self) -> u32 {
        match self {
            Self::Membrane => 1,
            Self::ThinPlate => 2,
            Self::CurvatureVariation => 3,
        }
    }
}

impl Discretisation {
    /// Every discretisation, the best last.
    pub const ALL: [Self; 3] = [Self::Uniform, Self::Cotangent, Self::CotangentArea];

    /// Its name in an edit.
    pub fn name(self) -> &'static str {
        match self {
            Self::Uniform => "uniform",
            Self::Cotangent => "cotangent",
            Self::CotangentArea => "cotangent-area",
        }
    }
}

//! Options of the bi-Laplacian [BS08, section 2]: the material, and the operator's discretisation.

use crate::option::{Choice, Choices, Number, OptionType, Whole, named_choices, options};
use crate::systems::plate_energy::PlateEnergy;
use crate::{Discretisation, OptionKind, OptionValue, TriangulationKind};

/// The largest coefficient.
const LARGEST: f64 = 1e12;

/// The option `stretching`, which methods that bend by the bi-Laplacian share.
pub(crate) const STRETCHING: Number = Number {
    default: 0.0,
    range: [0.0, LARGEST],
    unit: "k_b/d²",
    help: "resistance k_s to stretching, where d is the size of the bending part (a rod's length, a ball's diagonal)",
};

options! {
    /// The bi-Laplacian A d = 0 between the fixed vertices and the handles, with
    ///
    /// A = k_s (−L) + k_b (−L)(−M⁻¹ L)ⁿ⁻¹,
    ///
    /// which at order n = 2 is (−k_s L + k_b L M⁻¹ L) d = 0 [BS08, equation 8]. A is symmetric and positive definite on
    /// the solved vertices. Lengths are measured in sizes of the bending part, so neither coefficient depends on the
    /// model's unit. The shape depends only on their ratio; the energy ½ dᵀ A d has no unit.
    ///
    /// Painted stiffness s scales the energy's density, ½ ∫ k_s s |∇d|² + k_b s |Δd|² at order 2 and s |∇Δd|² at order
    /// 3: a part of stiffness 10 resists bending ten times as much, and turns with its surroundings.
    pub struct Bilaplacian {
        /// The derivative of the displacement that is kept small.
        order: BilaplacianOrder = Choice {
            default: BilaplacianOrder::ThinPlate,
            help: "the resisted change: of the area, of the curvature, or of its variation",
        },
        /// k_b, the resistance to the order's derivative. With 0 there is only stretching, a membrane.
        bending: f64 = Number {
            default: 1.0,
            range: [0.0, LARGEST],
            unit: "",
            help: "resistance k_b to the change that `order` names",
        },
        /// k_s, the resistance to stretching, in units of k_b per squared size at order 2 and per the fitting power
        /// of it at the others.
        stretching: f64 = STRETCHING,
        /// The discretisation of the Laplacian.
        discretisation: Discretisation = Choice {
            default: Discretisation::CotangentArea,
            help: "weights of the Laplacian",
        }; advanced,
        /// The triangles of the Laplacian.
        triangulation: TriangulationKind = Choice {
            default: TriangulationKind::AsIs,
            help: "triangles of the Laplacian: the mesh's own, or triangles without negative weights (\"tufted\" also \
                   on non-manifold meshes)",
        }; advanced,
        /// From 0, the surface as it is in space, to 1, as if it were stretched along the principal axes of the part
        /// that may move until that varied alike along all of them, though by at most a factor of 10: stiffer along
        /// long axes \[BK04\].
        anisotropy: f64 = Number {
            default: 0.0,
            range: [0.0, 1.0],
            unit: "",
            help: "extra stiffness along long axes: 0 is none, 1 is as if the part that may move were as wide as it \
                   is long",
        }; advanced,
        /// The way of putting details back on the bent base.
        detail: Detail = Choice {
            default: Detail::None,
            help: "motion of details: none (\"none\", they shear), along the normals of the smooth surface below \
                   them (\"normal-displacements\"), with their volume over it kept (\"displacement-volumes\"), or deformed \
                   like it (\"deformation-transfer\")",
        },
        /// The order k of the smooth base L^k x = 0. Only `detail` uses it.
        base_order: BilaplacianOrder = Choice {
            default: BilaplacianOrder::ThinPlate,
            help: "for details: smoothness of the surface below them, from a membrane to the least change of \
                   curvature",
        }; advanced; only_with("detail", &["normal-displacements", "displacement-volumes", "deformation-transfer"]),
        /// ℓ, the length of the base's fairing, in sizes of the bending part: details that are shorter than about six
        /// times this are bent as details, and limbs whose radius is longer stay whole in the base.
        base_length: f64 = Number {
            default: 0.05,
            range: [0.001, 10.0],
            unit: "sizes of the bending part",
            help: "for details that are displaced: smoothing of the surface below them, as a length, in sizes of the \
                   bending part (a rod's length, a ball's diagonal); above the radius of a limb, the limb shrinks to a \
                   line below them",
        }; only_with("detail", &["normal-displacements", "displacement-volumes"]),
        /// The most corrections of displacement volumes in a frame; they end earlier if the volumes are met or a
        /// correction helps little.
        volume_iterations: u32 = Whole {
            default: 8,
            range: [1, 1000],
            help: "for \"displacement-volumes\": the most corrections of the volumes",
        }; advanced; only_with("detail", &["displacement-volumes"]),
    }
}

/// The order n of the bi-Laplacian: its surfaces join the fixed part with continuity Cⁿ⁻¹ \[BK04\].
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum BilaplacianOrder {
    /// n = 1, −L d = 0: least area. Joins with a crease.
    Membrane,
    /// n = 2, L M⁻¹ L d = 0: least curvature. Joins with equal tangents.
    ThinPlate,
    /// n = 3, −L M⁻¹ L M⁻¹ L d = 0: least change of curvature. Joins with equal curvature.
    CurvatureVariation,
}

named_choices! {
    /// The motion of geometric detail with a bent surface: the detail is the difference between the surface and its
    /// smooth base B, the bi-Laplacian bends B, and the detail is put back on the bent base [BS08, section 2.4].
    pub enum Detail {
        /// The surface itself is bent; its details shear.
        None = "none",
        /// Each vertex is displaced along the base's normal from the nearest point of the base [BS08, equation 9].
        NormalDisplacements = "normal-displacements",
        /// Like normal displacements, then corrected until the prisms between the base's triangles and the surface's
        /// have their volumes of rest \[BK03\].
        DisplacementVolumes = "displacement-volumes",
        /// Each triangle takes on the deformation gradient of the base's triangle, and a Poisson system joins them
        /// [BSPG06, SP04].
        DeformationTransfer = "deformation-transfer",
    }
}

impl Bilaplacian {
    /// The values of `base_length` that a slider offers.
    pub const FINE_TO_SMOOTH: [f64; 2] = [0.005, 0.5];

    /// The power of the ordering: that of the highest power among its systems.
    pub fn ordering_power(&self) -> u32 {
        match self.detail {
            Detail::None => self.operator_power(),
            _ => self.operator_power().max(self.base_order.number()),
        }
    }

    /// The energy of the system.
    pub(crate) fn energy(&self) -> PlateEnergy {
        PlateEnergy {
            power: self.operator_power(),
            bending: self.bending,
            stretching: self.stretching,
            discretisation: self.discretisation,
        }
    }

    /// The power of L in the system: the order, or 1 if only stretching is left.
    pub fn operator_power(&self) -> u32 {
        if self.bending == 0.0 { 1 } else { self.order.number() }
    }
}

impl BilaplacianOrder {
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

impl OptionType for BilaplacianOrder {
    fn to_value(self) -> OptionValue {
        OptionValue::Whole(self.number())
    }

    fn of_value(value: OptionValue) -> Option<Self> {
        let is_it = |order: &Self| value == OptionValue::Whole(order.number());
        Self::ALL.into_iter().find(is_it)
    }
}

impl Choices for BilaplacianOrder {
    const KIND: OptionKind = OptionKind::Numbered {
        choices: &[(1, "membrane"), (2, "thin plate"), (3, "least change of curvature")],
    };
}

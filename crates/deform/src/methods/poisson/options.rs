//! The options of gradient-based editing.

use crate::option::{Choice, named_choices, options};

options! {
    /// Options of gradient-based editing.
    pub struct Poisson {
        /// The spreading of the handles' rotations and stretches.
        propagation: Propagation = Choice {
            default: Propagation::Harmonic,
            help: "spreading of the handles' turns and stretches: even (\"harmonic\"), by distance along the surface \
                   (\"geodesic\"), or with stiffly painted parts turning as a whole (\"material\")",
        },
    }
}

impl Poisson {
    /// The window's choice: stiff parts turn as a whole. Where nothing is painted it is the harmonic spreading.
    pub fn first_choice() -> Self {
        Self {
            propagation: Propagation::Material,
        }
    }
}

named_choices! {
    /// The weights with which the handles' rotations and stretches spread: 1 on a handle, 0 on fixed vertices and on
    /// other handles. If nothing is fixed they sum to 1.
    pub enum Propagation {
        /// L w = 0, independent of the painted stiffness [ZRKS05; BS08, section 3.2.2].
        Harmonic = "harmonic",
        /// By the distances D along the surface, w_h = D_h⁻¹ / (D_fixed⁻¹ + Σ_k D_k⁻¹): for one handle D_fixed /
        /// (D_fixed + D_h) [YZX+04; BS08, section 3.2.1].
        Geodesic = "geodesic",
        /// L_s w = 0 with the painted stiffness s as conductance, so that w hardly changes on stiff parts
        /// [PJS06; BS08, section 3.2.3].
        Material = "material",
    }
}

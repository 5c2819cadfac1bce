//! The transforms of prims: the operations of `xformOpOrder`, the first outermost.

use glam::{DAffine3, DMat3, DMat4, DQuat, DVec3};

use super::fault::Fault;
use super::layer::Prim;
use super::values::{numbers, words};

/// A prim's transform, and whether it ignores those of the prims above it.
pub(super) struct Local {
    pub transform: DAffine3,
    pub resets: bool,
}

/// A prim's own transform.
///
/// # Errors
/// An operation that is animated or unknown.
pub(super) fn local(text: &[u8], prim: &Prim) -> Result<Local, Fault> {
    let mut local = Local {
        transform: DAffine3::IDENTITY,
        resets: false,
    };
    let Some(order) = prim.properties.get("xformOpOrder") else {
        return Ok(local);
    };
    for name in words(text, &order.value)? {
        if name == "!resetXformStack!" {
            local = Local {
                transform: DAffine3::IDENTITY,
                resets: true,
            };
            continue;
        }
        let value = prim.properties.get(&name);
        let kind = name.split(':').nth(1).unwrap_or_default();
        let (Some(value), false) = (value, prim.properties.contains_key(&format!("{name}.timeSamples"))) else {
            return Err(unsupported(&name));
        };
        let numbers = numbers(text, &value.value)?;
        let operation = operation(kind, &numbers).ok_or_else(|| unsupported(&name))?;
        local.transform *= operation;
    }
    Ok(local)
}

fn unsupported(name: &str) -> Fault {
    Fault::Unsupported {
        feature: format!("the transform {}", crate::quoted(name)),
        remedy: "export it with its transforms applied and without animation, or as .glb".to_owned(),
    }
}

/// One operation. Angles are in degrees, and rows of matrices are the images of the axes.
fn operation(kind: &str, numbers: &[f64]) -> Option<DAffine3> {
    let vector = || numbers.first_chunk::<3>().map(|numbers| DVec3::from(*numbers));
    let turn = |axis: u8, degrees: f64| {
        let angle = degrees.to_radians();
        match axis {
            b'X' => DMat3::from_rotation_x(angle),
            b'Y' => DMat3::from_rotation_y(angle),
            _ => DMat3::from_rotation_z(angle),
        }
    };
    Some(match kind {
        "transform" => {
            let matrix = DMat4::from_cols_array(numbers.first_chunk()?);
            let is_affine = matrix.row(3) == glam::DVec4::W;
            return is_affine.then(|| DAffine3::from_mat4(matrix));
        }
        "translate" => DAffine3::from_translation(vector()?),
        "scale" => DAffine3::from_scale(vector()?),
        "orient" => {
            let [w, x, y, z] = *numbers.first_chunk()?;
            DAffine3::from_quat(DQuat::from_xyzw(x, y, z, w).normalize())
        }
        "rotateX" | "rotateY" | "rotateZ" => DAffine3::from_mat3(turn(kind.as_bytes()[6], *numbers.first()?)),
        "rotateXYZ" | "rotateXZY" | "rotateYXZ" | "rotateYZX" | "rotateZXY" | "rotateZYX" => {
            let angles = vector()?;
            // The first axis turns first.
            let turns = kind.as_bytes()[6..]
                .iter()
                .map(|&axis| turn(axis, angles[usize::from(axis - b'X')]));
            DAffine3::from_mat3(turns.fold(DMat3::IDENTITY, |before, turn| turn * before))
        }
        _ => return None,
    })
}

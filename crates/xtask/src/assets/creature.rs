//! The sample: a small long-necked animal with ears, four legs, a crest along its back and a tail to bend.
//!
//! A unit is a metre. The creature stands on y = 0, faces +z and is a smooth union of round cones. Legs, ears and eyes
//! are modelled at x > 0 and mirrored; skin and tail differ between the sides.

use super::limb::{Limb, smooth_knots};
use super::noise::{fractal, gradient, scales, white};
use super::solid::Solid;
use super::solid::{chain, ellipsoid, mix, round_cone, smooth_difference, smooth_union, sphere, srgb, step};
use super::vector::{Vec3, v};

/// The creature's parts whose layout is precomputed.
pub struct Creature {
    neck: Limb,
    tail: Limb,
    fore_leg: Limb,
    hind_leg: Limb,
    /// Base and tip of each plate of the crest, with the radius at the base.
    crest: Vec<(Vec3, Vec3, f64)>,
}

const HEAD: Vec3 = v(0.0, 0.955, 0.545);
const EYE: Vec3 = v(0.086, 0.980, 0.610);
const EYE_RADIUS: f64 = 0.046;
/// Scales to the metre.
const SCALES: f64 = 27.0;

impl Creature {
    /// Places the parts.
    pub fn new() -> Self {
        let neck = Limb::through(
            &[
                (v(0.0, 0.42, 0.10), 0.17),
                (v(0.0, 0.54, 0.27), 0.125),
                (v(0.0, 0.70, 0.37), 0.088),
                (v(0.0, 0.84, 0.43), 0.076),
                (v(0.0, 0.93, 0.49), 0.078),
            ],
            6,
        );
        let tail = Limb::through(
            &[
                (v(0.0, 0.43, -0.20), 0.17),
                (v(0.0, 0.40, -0.38), 0.118),
                (v(0.01, 0.33, -0.56), 0.082),
                (v(0.03, 0.26, -0.74), 0.062),
                (v(0.07, 0.225, -0.91), 0.049),
                (v(0.14, 0.235, -1.06), 0.041),
                (v(0.22, 0.29, -1.17), 0.036),
                (v(0.29, 0.37, -1.22), 0.033),
            ],
            6,
        );
        let fore_leg = Limb::through(
            &[
                (v(0.10, 0.42, 0.14), 0.100),
                (v(0.135, 0.26, 0.165), 0.076),
                (v(0.145, 0.13, 0.150), 0.062),
                (v(0.148, 0.06, 0.160), 0.060),
            ],
            4,
        );
        let hind_leg = Limb::through(
            &[
                (v(0.10, 0.42, -0.20), 0.125),
                (v(0.145, 0.27, -0.17), 0.098),
                (v(0.155, 0.14, -0.215), 0.066),
                (v(0.155, 0.06, -0.205), 0.062),
            ],
            4,
        );
        let mut creature = Self {
            neck,
            tail,
            fore_leg,
            hind_leg,
            crest: Vec::new(),
        };
        creature.crest = creature.lay_out_crest();
        creature
    }

    /// Plates from the nape to near the tail's tip, largest over the shoulders, leaning back.
    fn lay_out_crest(&self) -> Vec<(Vec3, Vec3, f64)> {
        // Points and outward directions along the spine, a few millimetres apart.
        let mut spine: Vec<(Vec3, Vec3)> = Vec::new();
        let mut knots = [
            v(0.0, 0.86, 0.44),
            v(0.0, 0.72, 0.37),
            v(0.0, 0.57, 0.22),
            v(0.0, 0.47, 0.06),
            v(0.0, 0.44, -0.12),
        ]
        .map(|at| (at, 0.0))
        .to_vec();
        knots.extend(self.tail.knots.iter().skip(5).step_by(6));
        let axis: Vec<Vec3> = smooth_knots(&knots, 6).into_iter().map(|knot| knot.0).collect();
        for pair in axis.windows(2) {
            for part in 0..6 {
                let along = (pair[1] - pair[0]).normalized();
                let up = (v(0.0, 1.0, 0.0) - along * along.y).normalized();
                let mut p = pair[0].lerp(pair[1], f64::from(part) / 6.0) + up * 0.4;
                for _ in 0..40 {
                    p = p - up * (0.9 * self.torso(p));
                }
                spine.push((p, (up - along * 0.05).normalized()));
            }
        }
        let mut plates: Vec<(Vec3, Vec3, f64)> = Vec::new();
        let (mut since, mut last) = (f64::INFINITY, spine[0].0);
        for (i, &(here, up)) in spine.iter().enumerate() {
            since += (here - last).length();
            last = here;
            let share = i as f64 / spine.len() as f64;
            let size = 0.024 + 0.046 * step(-0.05, 0.34, share) * step(0.92, 0.40, share);
            if since > size * 1.30 + 0.008 && share < 0.93 {
                let back = (spine[(i + 1).min(spine.len() - 1)].0 - here).normalized();
                plates.push((
                    here - up * (size * 0.2),
                    here + (up + back * 0.5).normalized() * (size * 0.75),
                    size * 0.58,
                ));
                since = 0.0;
            }
        }
        plates
    }

    /// Trunk, neck and tail, which carry the crest.
    fn torso(&self, p: Vec3) -> f64 {
        let trunk = round_cone(p, v(0.0, 0.405, -0.14), 0.205, v(0.0, 0.435, 0.10), 0.185);
        let width = 0.10;
        let d = smooth_union(trunk, self.neck.distance(p, trunk + width), width);
        smooth_union(d, self.tail.distance(p, d + width), width)
    }

    fn head(&self, p: Vec3) -> f64 {
        let q = in_head(p).mirrored();
        let skull = ellipsoid(q, HEAD, v(0.112, 0.102, 0.118));
        let muzzle = ellipsoid(q, v(0.0, 0.912, 0.660), v(0.082, 0.062, 0.086));
        let cheek = sphere(q, v(0.062, 0.905, 0.585), 0.058);
        let mut head = smooth_union(smooth_union(skull, muzzle, 0.07), cheek, 0.04);
        let nostril = ellipsoid(q, v(0.030, 0.940, 0.737), v(0.011, 0.009, 0.014));
        head = smooth_difference(head, nostril, 0.012);
        head += 0.009 * self.mouth(q);
        head = smooth_union(head, sphere(q, EYE, EYE_RADIUS), 0.006);
        smooth_union(head, lids(q), 0.010) * HEAD_SCALE
    }

    /// The mouth's groove: 1 inside, 0 a centimetre away. It curls up at its corners.
    fn mouth(&self, q: Vec3) -> f64 {
        let back = 0.755 - q.z;
        let curl = (back - 0.10).max(0.0);
        let height = 0.884 + 0.55 * back * back + 1.3 * curl * curl;
        step(0.011, 0.001, (q.y - height).abs()) * step(0.595, 0.625, q.z)
    }

    fn ears(&self, p: Vec3) -> f64 {
        let q = in_head(p).mirrored();
        // A leaf: a chain squeezed along its thin direction, hollowed towards the front.
        let (root, tip) = (EAR_ROOT, v(0.222, 1.115, 0.440));
        let squeeze = |p: Vec3| p + EAR_FRONT * (0.9 * EAR_FRONT.dot(p - root));
        let belly = root.lerp(tip, 0.52) + v(0.010, 0.006, 0.0);
        let leaf = chain(
            squeeze(q),
            &[(root, 0.026), (squeeze(belly), 0.052), (squeeze(tip), 0.012)],
        ) * 0.6;
        let hollow = ellipsoid(q, belly + EAR_FRONT * 0.040, v(0.048, 0.040, 0.028));
        smooth_difference(leaf, hollow, 0.016) * HEAD_SCALE
    }

    fn feet(&self, p: Vec3) -> f64 {
        let q = p.mirrored();
        let foot = |at: Vec3| {
            let sole = ellipsoid(q, at + v(0.0, 0.036, 0.015), v(0.070, 0.044, 0.082));
            let toes = [v(-0.044, 0.026, 0.076), v(0.002, 0.028, 0.094), v(0.047, 0.026, 0.074)];
            toes.iter().fold(sole, |d, &toe| {
                smooth_union(d, ellipsoid(q, at + toe, v(0.025, 0.027, 0.032)), 0.016)
            })
        };
        foot(v(0.150, 0.0, 0.165)).min(foot(v(0.157, 0.0, -0.200)))
    }

    fn crest(&self, p: Vec3) -> f64 {
        self.crest.iter().fold(f64::INFINITY, |d, &(base, tip, radius)| {
            if 0.8 * ((p - base).length() - 0.12) > d {
                return d;
            }
            // Plates are flat: wider along the body than across.
            let squeeze = |p: Vec3| v(base.x + (p.x - base.x) * 1.35, p.y, p.z);
            d.min(round_cone(squeeze(p), base, radius, squeeze(tip), radius * 0.46) * 0.8)
        })
    }

    /// Distance to the body without skin detail. Parts too far away to change the minimum are skipped.
    fn smooth(&self, p: Vec3) -> f64 {
        let q = p.mirrored();
        let away = |centre: Vec3, radius: f64| (q - centre).length() - radius;
        let mut d = self.torso(p);
        if away(v(0.13, 0.25, 0.15), 0.32) < d {
            d = smooth_union(d, self.fore_leg.distance(q, d + 0.055), 0.055);
        }
        if away(v(0.13, 0.25, -0.19), 0.34) < d {
            d = smooth_union(d, self.hind_leg.distance(q, d + 0.055), 0.055);
        }
        if away(v(0.15, 0.04, 0.18), 0.18) < d || away(v(0.157, 0.04, -0.18), 0.18) < d {
            d = smooth_union(d, self.feet(p), 0.03);
        }
        d = smooth_union(d, self.crest(p), 0.018);
        d = smooth_union(d, ellipsoid(p, BOB, v(0.058, 0.060, 0.058)), 0.03);
        if away(v(0.0, 0.97, 0.60), 0.34) < d {
            d = smooth_union(d, self.ears(p), 0.02);
            d = smooth_union(d, self.head(p), 0.035);
        }
        d
    }

    /// Weight of the scales at `p`: back and sides, not the face, the ears or the feet.
    fn scaliness(&self, p: Vec3) -> f64 {
        let h = in_head(p);
        let face = step(0.24, 0.13, (h - v(0.0, 0.93, 0.65)).length());
        let ears = step(0.125, 0.095, (h.mirrored() - v(0.155, 1.08, 0.47)).length());
        (1.0 - 0.9 * face) * (1.0 - 0.9 * ears) * step(0.06, 0.16, p.y)
    }

    /// Weight of the underside (belly, throat, tail) at `p`.
    fn underside(&self, p: Vec3) -> f64 {
        // The normal of the smooth body, not of single scales.
        let far = 0.02;
        let rise = |axis: Vec3| (self.smooth(p + axis * far) - self.smooth(p - axis * far)) / (2.0 * far);
        let normal = v(rise(v(1.0, 0.0, 0.0)), rise(v(0.0, 1.0, 0.0)), rise(v(0.0, 0.0, 1.0))).normalized();
        let wobble = 0.15 * gradient(p * 9.0, 71);
        let legs = step(0.09, 0.15, p.mirrored().x) * step(0.44, 0.32, p.y);
        let throat = step(0.10, 0.25, p.z) * step(0.35, 0.60, normal.z + wobble) * step(0.55, 0.35, normal.x.abs());
        step(-0.30, -0.62, normal.y + wobble).max(throat * step(1.0, 0.9, p.y)) * (1.0 - legs)
    }

    /// White, iris and pupil, each with a soft edge, and a highlight above.
    fn eye_colour(&self, q: Vec3) -> Vec3 {
        let gaze = v(0.46, 0.02, 0.89).normalized();
        let out = (q - EYE).normalized();
        let across = (out - gaze).length();
        let iris = mix(
            srgb(0x6b3510),
            srgb(0xeaa53a),
            step(0.35, 0.75, across - 0.35 * (out.y - gaze.y)),
        );
        let mut colour = mix(iris, srgb(0xf6f1e6), step(0.78, 0.88, across));
        colour = mix(srgb(0x120c0a), colour, step(0.46, 0.56, across));
        let glint = (out - (gaze + v(-0.20, 0.36, 0.0)).normalized()).length();
        mix(srgb(0xffffff), colour, step(0.16, 0.26, glint))
    }
}

/// Scale of the head, which is larger than modelled, as in most young animals.
const HEAD_SCALE: f64 = 1.16;
/// The point where the head joins the neck, which scaling keeps fixed.
const NAPE: Vec3 = v(0.0, 0.915, 0.50);
/// Direction in which the ears open (at x > 0).
const EAR_FRONT: Vec3 = v(-0.25, 0.35, 0.903);
/// The base of an ear (at x > 0).
const EAR_ROOT: Vec3 = v(0.072, 1.020, 0.515);
/// The ball at the tail's tip.
const BOB: Vec3 = v(0.305, 0.395, -1.232);

/// Maps a point to the head's model space.
fn in_head(p: Vec3) -> Vec3 {
    NAPE + (p - NAPE) * (1.0 / HEAD_SCALE)
}

/// Upper and lower lid: shells around the eye, cut open towards the gaze.
fn lids(q: Vec3) -> f64 {
    let out = q - EYE;
    let upper = -out.dot(v(-0.10, 0.90, -0.42)) + 0.010;
    let lower = out.dot(v(0.10, 0.86, 0.50)) + 0.024;
    smooth_difference(out.length() - EYE_RADIUS - 0.008, -upper.min(lower), 0.006)
}

impl Solid for Creature {
    fn distance(&self, p: Vec3) -> f64 {
        let smooth = self.smooth(p);
        if smooth.abs() > 0.06 {
            return smooth;
        }
        let detail = self.scaliness(p);
        let folds = 0.0030 * fractal(p * 11.0, 3, 5);
        let plates = 0.0052 * (scales(p * SCALES, 23) - 0.5) * step(0.0, 1.0, detail);
        let pores = 0.0009 * fractal(p * 90.0, 2, 41);
        let eye = step(
            EYE_RADIUS + 0.004,
            EYE_RADIUS + 0.02,
            (in_head(p).mirrored() - EYE).length(),
        );
        smooth - (folds + plates + pores) * eye
    }

    fn bounds(&self) -> (Vec3, Vec3) {
        (v(-0.34, -0.03, -1.33), v(0.40, 1.24, 0.86))
    }

    fn colour(&self, p: Vec3, normal: Vec3) -> Vec3 {
        let q = in_head(p).mirrored();
        let (moss, teal, cream, plate) = (srgb(0x74b37f), srgb(0x2c7c85), srgb(0xf3e2ba), srgb(0xe8803c));
        let back = step(-0.25, 0.75, normal.y) * step(0.25, 0.5, p.y);
        let mut skin = mix(moss, teal, back * 0.85 + 0.15 * gradient(p * 6.0, 12));
        let spots = step(0.22, 0.32, gradient(p * 10.0 + v(3.1, 0.0, 7.7), 33)) * step(-0.2, 0.2, normal.y);
        skin = mix(skin, srgb(0x1b5567), spots * 0.7 * step(0.14, 0.26, p.y));
        skin = mix(skin, cream, self.underside(p) * step(1.02, 0.98, q.y));
        let muzzle = step(0.110, 0.065, (q - v(0.0, 0.890, 0.695)).length());
        skin = mix(skin, cream, muzzle * 0.9);
        let blush = step(0.055, 0.02, (q - v(0.098, 0.905, 0.625)).length());
        skin = mix(skin, srgb(0xe58f79), blush * 0.6);
        let ahead = if p.z < 0.0 { p.z + 0.200 } else { p.z - 0.165 };
        skin = mix(
            skin,
            srgb(0x4a3a35),
            step(0.056, 0.040, p.y) * step(0.072, 0.086, ahead),
        );
        // Grooves are darker, like the dust and shadow in a scan.
        skin = skin * (1.0 - 0.36 * (1.0 - scales(p * SCALES, 23)) * self.scaliness(p));
        skin = mix(plate, skin, step(0.003, 0.010, self.crest(p)));
        let outward = v(if p.x < 0.0 { -normal.x } else { normal.x }, normal.y, normal.z);
        let in_ear = step(0.012, 0.004, self.ears(p)) * step(0.30, 0.75, outward.dot(EAR_FRONT));
        skin = mix(
            skin,
            srgb(0xf0a893),
            in_ear * step(0.040, 0.070, (q - EAR_ROOT).length()) * 0.9,
        );
        skin = mix(skin, plate, step(0.078, 0.066, (p - BOB).length()));
        skin = mix(skin, srgb(0x6d3a34), self.mouth(q) * 0.85);
        skin = mix(
            skin,
            srgb(0x5a332e),
            step(0.017, 0.009, (q - v(0.030, 0.940, 0.737)).length()),
        );
        if (q - EYE).length() < EYE_RADIUS + 0.0035 {
            return self.eye_colour(q);
        }
        skin * (1.0 + 0.05 * gradient(p * 40.0, 90))
    }

    fn scanner_noise(&self, vertex: usize, p: Vec3) -> f64 {
        if (in_head(p).mirrored() - EYE).length() < EYE_RADIUS + 0.01 {
            0.0
        } else {
            white(vertex as u64, 7)
        }
    }
}

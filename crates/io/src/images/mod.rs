//! Decodes all images of a document within one memory budget: those that do not fit are decoded smaller.
//!
//! A few bytes may be an image of a gigabyte, and a document may have many. The headers give the sizes, so the decision
//! comes before any decoding: the largest images are halved until all of them fit beside the memory for decoding one.
//! Decoding then goes in rounds, each as wide as the budget allows.

pub(crate) mod decode;
mod ktx2;
pub(crate) mod pixels;

use std::collections::BinaryHeap;

use pliant_mesh::{Cancel, Cancelled};
use rayon::prelude::*;

use crate::images::decode::{Header, decode, header};
use crate::{ImageError, Rgba8};

/// The memory that a document's images may take during decoding, unless the caller chooses another: 2 GiB. Eight images
/// of 8192 by 8192 pixels stay whole.
pub const IMAGE_BYTES: u64 = 2 << 30;

/// An image, decoded.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct DecodedImage {
    /// Its pixels, smaller than stored if all images together would take too much.
    pub pixels: Rgba8,
    /// The stored width and height.
    pub stored_size: [u32; 2],
}

/// Decodes images, in parallel as far as `budget` bytes allow; each becomes pixels or a sentence.
///
/// # Errors
/// [`Cancelled`] soon after `cancel` is raised: before the next image, or when a decoder next reads.
pub fn decode_images(
    encoded: &[&[u8]],
    budget: u64,
    cancel: &Cancel,
) -> Result<Vec<Result<DecodedImage, ImageError>>, Cancelled> {
    let plans = plans(encoded, budget);
    let mut out = Vec::with_capacity(plans.len());
    let mut held = 0;
    cancel.check()?;
    while out.len() < plans.len() {
        let first = out.len();
        // At least one image, whose cost was compared with the budget.
        let mut cost = 0;
        let costs = plans[first..].iter().map(|plan| plan.as_ref().map_or(0, Plan::cost));
        let fit = costs.take_while(|of_one| {
            cost += of_one;
            held + cost <= budget
        });
        let count = fit.count().max(1);
        let round = first..first + count;
        out.par_extend(round.into_par_iter().map(|number| {
            let plan = plans[number].clone()?;
            // A raised flag fails the image here or during decoding; the check after the round reports it for all of
            // them.
            let pixels = decode(encoded[number], plan.halvings, cancel)?;
            Ok(DecodedImage {
                pixels,
                stored_size: [plan.header.width, plan.header.height],
            })
        }));
        cancel.check()?;
        let fresh = out[first..].iter().flatten();
        held += fresh.map(|image| image.pixels.pixels.len() as u64).sum::<u64>();
    }
    Ok(out)
}

/// Returns true if the bytes are a complete image.
pub(crate) fn decodes(encoded: &[u8]) -> bool {
    let decoded = decode_images(&[encoded], IMAGE_BYTES, &Cancel::new());
    decoded.is_ok_and(|images| images.iter().all(Result::is_ok))
}

/// The plan for decoding an image.
#[derive(Clone, Copy)]
struct Plan {
    header: Header,
    halvings: u32,
}

impl Plan {
    /// The largest number of bytes that it takes.
    fn cost(&self) -> u64 {
        self.header.decoding_bytes + self.header.pixel_bytes(self.halvings)
    }
}

/// Every image, halved until all of them fit.
fn plans(encoded: &[&[u8]], budget: u64) -> Vec<Result<Plan, ImageError>> {
    let plan = |encoded: &&[u8]| {
        let header = header(encoded)?;
        if header.decoding_bytes >= budget {
            return Err(ImageError {
                reason: format!(
                    "its {} by {} pixels take {} MiB, more than the {} MiB for all images together",
                    header.width,
                    header.height,
                    header.decoding_bytes >> 20,
                    budget >> 20
                ),
            });
        }
        Ok(Plan { header, halvings: 0 })
    };
    let mut plans: Vec<Result<Plan, ImageError>> = encoded.iter().map(plan).collect();
    let sound = || plans.iter().flatten();
    let largest = sound().map(|plan| plan.header.decoding_bytes).max().unwrap_or(0);
    let room = budget - largest;
    let mut needed: u64 = sound().map(|plan| plan.header.pixel_bytes(0)).sum();
    // The largest first; the last of equal ones.
    let mut by_size: BinaryHeap<(u64, usize)> = (plans.iter().enumerate())
        .filter_map(|(number, plan)| Some((plan.as_ref().ok()?.header.pixel_bytes(0), number)))
        .collect();
    while needed > room
        && let Some((bytes, number)) = by_size.pop()
    {
        if let Ok(plan) = &mut plans[number] {
            plan.halvings += 1;
            let smaller = plan.header.pixel_bytes(plan.halvings);
            if smaller == bytes {
                // Only single pixels are left.
                break;
            }
            needed -= bytes - smaller;
            by_size.push((smaller, number));
        }
    }
    plans
}

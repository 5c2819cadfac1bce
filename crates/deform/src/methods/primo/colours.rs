//! Bodies in classes that share no joint, so that those of a class can move at once.

use super::joints::Joints;

/// Prisms that turn without touching each other.
#[derive(Debug)]
pub(crate) struct Colours {
    classes: Vec<Vec<u32>>,
}

impl Colours {
    /// Colours the solved prisms one by one.
    pub fn of(joints: &Joints) -> Self {
        const NONE: usize = usize::MAX;
        let mut colour_of = vec![NONE; joints.count()];
        let mut classes: Vec<Vec<u32>> = Vec::new();
        for prism in 0..joints.count() {
            let taken = |colour: usize| {
                let mut others = joints.sides(prism).iter().map(|side| side.other as usize);
                others.any(|other| other < joints.count() && colour_of[other] == colour)
            };
            let colour = (0..classes.len())
                .find(|&colour| !taken(colour))
                .unwrap_or(classes.len());
            if colour == classes.len() {
                classes.push(Vec::new());
            }
            classes[colour].push(prism as u32);
            colour_of[prism] = colour;
        }
        Self { classes }
    }

    /// The prisms of each colour.
    pub fn classes(&self) -> &[Vec<u32>] {
        &self.classes
    }
}

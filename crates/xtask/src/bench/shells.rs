//! Discrete shells against a direct Gauss–Newton of the same energy in Python (`tests/peer/shells.py`), with the
//! example `shells` of `deform`: the scenes of [BS08].
//!
//! Both start from a blend of the handle's motion, Pliant's with its own weights, the peer's with harmonic ones, and
//! end when a step gains less than 10⁻⁷ of the energy, the peer after 40 steps at the latest: compare their energies.

use super::arap::copied;
use super::beside::data;
use super::scale::Scale;
use super::table::{Row, measured};
use crate::process::output;

/// One row per scene and program.
pub fn rows(_: Scale) -> Result<Vec<Row>, String> {
    let survey = data().join("survey");
    if !survey.is_dir() {
        return Ok(vec![Row::default().text("says", "not here: the folder PLIANT_DATA")]);
    }
    let script = crate::root::root().join("tests/peer/shells.py").display().to_string();
    let all = std::thread::available_parallelism().map_or(1, usize::from).to_string();
    let mut rows = Vec::new();
    for scene in ["bar", "cylinder", "cactus"] {
        let off = copied(&survey, scene)?.display().to_string();
        let peer = output("python3", &[&script, &off]).and_then(|line| Row::parse(&line));
        let named = Row::default().text("program", "scipy and libigl");
        rows.push(match peer {
            Some(row) => named.and(row),
            None => named.text("says", "not installed: pip install libigl numpy scipy"),
        });
        let ours = measured("pliant-deform", "shells", &[off, all.clone()])?;
        let ours = ours.into_iter();
        rows.extend(ours.map(|row| Row::default().text("program", "Pliant").and(row)));
    }
    Ok(rows)
}

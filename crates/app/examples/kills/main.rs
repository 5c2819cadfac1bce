//! Kills saves of every kind at random moments, and runs pairs of saves at once:
//! `cargo build --release && cargo run --release -p pliant-app --example kills -- KILLS PAIRS SEED`.

#![allow(clippy::print_stdout, reason = "it tells its figures")]

mod trial;

use std::process::ExitCode;

use trial::{Rig, Tally};

fn main() -> ExitCode {
    let mut numbers = std::env::args().skip(1).map(|word| word.parse::<u64>().unwrap_or(0));
    let kills = numbers.next().unwrap_or(100) as usize;
    let pairs = numbers.next().unwrap_or(100) as usize;
    let seed = numbers.next().unwrap_or(1);
    match run(kills, pairs, seed) {
        Ok(()) => ExitCode::SUCCESS,
        Err(sentence) => {
            println!("{sentence}");
            ExitCode::FAILURE
        }
    }
}

fn run(kills: usize, pairs: usize, seed: u64) -> Result<(), String> {
    let own = std::env::current_exe().map_err(|error| error.to_string())?;
    let folder = own.parent().and_then(|examples| examples.parent()).unwrap_or(&own);
    let mut rig = Rig::new(&folder.join("pliant"), seed)?;
    let mut tally = Tally::default();
    rig.kills(kills, &mut tally)?;
    println!(
        "{kills} kills: {} times the old state, {} times the new one, nothing else; {} left something, which the next save cleared away",
        tally.old, tally.new, tally.left_over
    );
    let mut tally = Tally::default();
    rig.pairs(pairs, &mut tally)?;
    println!(
        "{pairs} pairs: {} times the first, {} times the second, nothing mixed",
        tally.old, tally.new
    );
    Ok(())
}

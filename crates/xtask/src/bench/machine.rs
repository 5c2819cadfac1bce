//! The measuring machine, for captions: its processor, its vectors, and the cache of each core.

use std::fs;

/// "2 cores, AMD EPYC, AVX-512, 1024K of second-level cache a core"; facts that the system doesn't report are left out.
pub fn machine() -> String {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let cache = fs::read_to_string("/sys/devices/system/cpu/cpu0/cache/index2/size").unwrap_or_default();
    of(
        cores,
        &fs::read_to_string("/proc/cpuinfo").unwrap_or_default(),
        cache.trim(),
    )
}

fn of(cores: usize, processor: &str, cache: &str) -> String {
    let value = |name: &str| {
        let line = processor.lines().find(|line| line.starts_with(name))?;
        Some(line.split_once(':')?.1.trim())
    };
    let mut parts = vec![format!("{cores} cores")];
    parts.extend(value("model name").map(str::to_owned));
    let has = |flag: &str| value("flags").is_some_and(|flags| flags.split(' ').any(|own| own == flag));
    let vectors = [("avx512f", "AVX-512"), ("avx2", "AVX2")];
    parts.extend(
        vectors
            .into_iter()
            .find(|(flag, _)| has(flag))
            .map(|(_, name)| name.to_owned()),
    );
    if !cache.is_empty() {
        parts.push(format!("{cache} of second-level cache a core"));
    }
    parts.join(", ")
}

#[cfg(test)]
mod tests {
    use super::of;

    #[test]
    fn what_the_system_tells_is_said() {
        let processor = "processor\t: 0\nmodel name\t: AMD EPYC\nflags\t\t: fpu avx2 fma\n";
        assert_eq!(
            of(2, processor, "512K"),
            "2 cores, AMD EPYC, AVX2, 512K of second-level cache a core"
        );
        assert_eq!(of(4, "", ""), "4 cores");
    }
}

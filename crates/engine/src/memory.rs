//! The memory that the machine has left for solving.

use std::fs;
use std::path::Path;

use pliant_deform::Budget;

/// The memory that binding may use: the solver's own budget, or the system's remaining memory if that is less.
///
/// Linux grants more memory than there is and kills the program once it is used, so waiting for a failed allocation
/// would be too late. If the system does not report its memory, it is the solver's own budget.
pub fn budget() -> Budget {
    budget_within(None)
}

/// Like [`budget`], with `most` bytes instead of the solver's own budget, if a person has set them.
pub fn budget_within(most: Option<u64>) -> Budget {
    let own = Budget::of_most(most);
    let left = [left_in_machine(), left_in_group(), left_to_process()]
        .into_iter()
        .flatten()
        .min();
    Budget {
        bytes: left.map_or(own.bytes, |left| left.min(own.bytes)),
        ..own
    }
}

/// The bytes of a text such as `8GB`, `1.5GiB` or `500MB`.
///
/// # Errors
/// One sentence if it is not such a text.
pub fn bytes(text: &str) -> Result<u64, String> {
    const UNITS: [(&str, f64); 4] = [
        ("GiB", (1_u64 << 30) as f64),
        ("MiB", (1_u64 << 20) as f64),
        ("GB", 1e9),
        ("MB", 1e6),
    ];
    let parsed = UNITS.iter().find_map(|(unit, size)| {
        let number: f64 = text.strip_suffix(unit)?.trim().parse().ok()?;
        (number > 0.0 && number * size < 1e18).then_some((number * size) as u64)
    });
    parsed.ok_or_else(|| "give a number and a unit, such as 8GB, 1.5GiB or 500MB".to_owned())
}

/// The memory that the machine has available, swap included.
fn left_in_machine() -> Option<u64> {
    let text = fs::read_to_string("/proc/meminfo").ok()?;
    let kilobytes = |name| number(&text, name);
    Some((kilobytes("MemAvailable:")? + kilobytes("SwapFree:").unwrap_or(0)) * 1024)
}

/// Three quarters of the remainder of the process's own limits of addresses and of data (`ulimit -v` and `-d`):
/// allocators reserve more than they return.
fn left_to_process() -> Option<u64> {
    let limits = fs::read_to_string("/proc/self/limits").ok()?;
    let status = fs::read_to_string("/proc/self/status").ok()?;
    left_of_limits(&limits, &status).map(|left| left / 4 * 3)
}

fn left_of_limits(limits: &str, status: &str) -> Option<u64> {
    let pairs = [("Max address space", "VmSize:"), ("Max data size", "VmData:")];
    let left = pairs.map(|(limit, used)| Some(number(limits, limit)?.saturating_sub(1024 * number(status, used)?)));
    left.into_iter().flatten().min()
}

/// The remainder of the limits of the process's control groups (usually a container's): the least of all its groups.
fn left_in_group() -> Option<u64> {
    let groups = fs::read_to_string("/proc/self/cgroup").ok()?;
    let limits = groups.lines().filter_map(|line| {
        let mut parts = line.splitn(3, ':').skip(1);
        let (controllers, path) = (parts.next()?, parts.next()?);
        let (root, limit, used) = if controllers.is_empty() {
            ("/sys/fs/cgroup", "memory.max", "anon ")
        } else if controllers.split(',').any(|name| name == "memory") {
            ("/sys/fs/cgroup/memory", "memory.limit_in_bytes", "total_rss ")
        } else {
            return None;
        };
        let groups = Path::new(path).ancestors();
        let groups = groups.map(|group| Path::new(root).join(group.strip_prefix("/").unwrap_or(group)));
        groups.filter_map(|group| left_of(&group, limit, used)).min()
    });
    limits.min()
}

/// A group's limit less its memory in use; the system's file cache does not count as used.
fn left_of(group: &Path, limit: &str, used: &str) -> Option<u64> {
    let limit: u64 = fs::read_to_string(group.join(limit)).ok()?.trim().parse().ok()?;
    let stat = fs::read_to_string(group.join("memory.stat")).ok()?;
    Some(limit.saturating_sub(number(&stat, used)?))
}

/// The number after a name at the beginning of a line.
fn number(text: &str, name: &str) -> Option<u64> {
    let rest = text.lines().find_map(|line| line.strip_prefix(name))?;
    rest.split_whitespace().next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_is_found_by_its_whole_name() {
        let text = "MemFree: 5 kB\nMemAvailable:   12345 kB\nanon_thp 7\nanon 8\n";
        assert_eq!(number(text, "MemAvailable:"), Some(12345));
        assert_eq!(number(text, "anon "), Some(8));
        assert_eq!(number(text, "SwapFree:"), None);
    }

    #[test]
    fn bytes_are_a_number_and_a_unit() {
        assert_eq!(bytes("8GB"), Ok(8_000_000_000));
        assert_eq!(bytes("1.5GiB"), Ok(3 << 29));
        assert_eq!(bytes("500 MB"), Ok(500_000_000));
        for wrong in ["", "8", "GB", "-1GB", "0MB", "NaNGB", "infGB", "8gb", "1e30GB"] {
            assert!(bytes(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn what_is_asked_for_replaces_the_solver_s_own_budget() {
        assert_eq!(budget_within(Some(1000)).bytes, 1000);
    }

    #[test]
    fn a_group_leaves_its_limit_without_what_is_in_use() {
        let folder = tempfile::tempdir().unwrap_or_else(|error| panic!("{error}"));
        let write = |name: &str, text: &str| {
            fs::write(folder.path().join(name), text).unwrap_or_else(|error| panic!("{error}"));
        };
        write("memory.stat", "file 4000\nanon 300\n");
        write("memory.max", "max\n");
        assert_eq!(left_of(folder.path(), "memory.max", "anon "), None);
        write("memory.max", "1000\n");
        assert_eq!(left_of(folder.path(), "memory.max", "anon "), Some(700));
        write("memory.max", "200\n");
        assert_eq!(left_of(folder.path(), "memory.max", "anon "), Some(0));
    }

    #[test]
    fn a_process_s_own_limits_leave_what_it_does_not_use() {
        let limits = |size: &str, data: &str| {
            format!(
                "Limit  Soft Limit\nMax data size   {data}  unlimited  bytes\nMax address space   {size}   unlimited  bytes\n"
            )
        };
        let status = "VmPeak:\t 9000 kB\nVmSize:\t    100 kB\nVmData:\t     10 kB\n";
        assert_eq!(left_of_limits(&limits("unlimited", "unlimited"), status), None);
        assert_eq!(
            left_of_limits(&limits("1024000", "unlimited"), status),
            Some(900 * 1024)
        );
        assert_eq!(left_of_limits(&limits("1024000", "20480"), status), Some(10 * 1024));
        assert_eq!(left_of_limits(&limits("1024", "unlimited"), status), Some(0));
    }

    #[test]
    fn the_solver_never_gets_more_than_its_own_budget() {
        let budget = budget();
        assert!(
            budget.bytes > 0 && budget.bytes <= Budget::default().bytes,
            "{budget:?}"
        );
    }
}

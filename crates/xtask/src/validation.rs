//! The tests of pictures once more, under Vulkan's validation layer: any of its messages is a failure.
//!
//! Missing barriers, or sizes that a driver happens to round up, show on some cards alone; the layer sees them on every
//! one.

use std::path::Path;
use std::time::Instant;

use crate::verdict::Verdict;
use crate::{process, system};

/// The tests of pictures, one process each.
const TESTS: [&str; 5] = ["pictures", "overlays", "picks", "large", "weak"];

/// The layer's message that it is active, and that it also checks for missing barriers.
const AT_WORK: [&str; 2] = [
    "Khronos Validation Layer Active",
    "VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION",
];

/// Runs them on the software driver.
pub fn pictures(verdict: &mut Verdict) {
    let Some(driver) = system::software_vulkan_driver().filter(|_| system::has_validation_layer()) else {
        verdict
            .skip("pictures under validation (Mesa's software driver or Khronos' validation layer is not installed)");
        return;
    };
    for test in TESTS {
        let started = Instant::now();
        let name = format!("{test} under validation");
        let folder = process::target_folder().join("tmp/validation").join(test);
        let log = folder.join("log.txt");
        if let Err(sentence) = configure(&folder, &log) {
            verdict.record(&name, Err(sentence), started);
            continue;
        }
        let mut command = process::cargo(&["test", "--locked", "--workspace", "--test", test]);
        command
            .env("VK_DRIVER_FILES", &driver)
            .env("VK_ICD_FILENAMES", &driver)
            .env("VK_INSTANCE_LAYERS", "VK_LAYER_KHRONOS_validation")
            .env("VK_LAYER_SETTINGS_PATH", &folder)
            // wgpu would intercept the layer's messages, and it names its shaders' language, which older layers don't
            // know.
            .env("WGPU_VALIDATION", "0")
            .env("WGPU_DEBUG", "0");
        verdict.tests(&name, &mut command);
        let said = std::fs::read_to_string(&log).map_err(|e| format!("{} can't be read: {e}.", log.display()));
        verdict.record(&name, said.and_then(|said| judge(&said)), started);
    }
}

/// Sets the layer's checks, and its output file.
fn configure(folder: &Path, log: &Path) -> Result<(), String> {
    let settings = format!(
        "khronos_validation.enables = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT\n\
         khronos_validation.debug_action = VK_DBG_LAYER_ACTION_LOG_MSG\n\
         khronos_validation.report_flags = error,warn,info\n\
         khronos_validation.log_filename = {}\n",
        log.display()
    );
    let written = std::fs::create_dir_all(folder)
        .and_then(|()| std::fs::write(log, ""))
        .and_then(|()| std::fs::write(folder.join("vk_layer_settings.txt"), settings));
    written.map_err(|e| format!("{} can't be written: {e}.", folder.display()))
}

/// An error if the layer had messages, or if it was not active.
fn judge(log: &str) -> Result<(), String> {
    let mut complaints = log
        .lines()
        .filter(|line| line.contains("Validation Error") || line.contains("Validation Warning"));
    if let Some(first) = complaints.next() {
        return Err(format!(
            "Vulkan's validation layer complains {} times: {first}",
            1 + complaints.count()
        ));
    }
    if !AT_WORK.iter().all(|words| log.contains(words)) {
        return Err("Vulkan's validation layer was not at work.".to_owned());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_log_passes_if_the_layer_was_at_work_and_silent() {
        let silent = format!(
            "Validation Information: | {}:\n    Current Enables: {}.\n",
            AT_WORK[0], AT_WORK[1]
        );
        assert_eq!(judge(&silent), Ok(()));
        assert!(judge("").is_err());
        assert!(judge(&silent.replace(AT_WORK[1], "None")).is_err());
        for word in ["Error", "Warning"] {
            let log = format!("{silent}SYNC-HAZARD-WRITE-AFTER-WRITE: Validation {word}: [ ... ]\n");
            assert!(
                judge(&log).is_err_and(|sentence| sentence.contains("SYNC-HAZARD")),
                "{log}"
            );
        }
    }
}

"""Lists the crates of Cargo.lock as sources of a Flatpak, so that cargo builds without a network: cargo_sources.py [LOCK]."""

import json
import sys
import tomllib
from pathlib import Path

REGISTRY = "registry+https://github.com/rust-lang/crates.io-index"
VENDORED = "cargo/vendor"
CONFIGURATION = f"""[source.crates-io]
replace-with = "vendored"

[source.vendored]
directory = "{VENDORED}"
"""


def sources(lock):
    """The sources in flatpak-builder's words: an archive and its checksum for each crate, and cargo's configuration."""
    listed = []
    for package in tomllib.loads(lock)["package"]:
        if "source" not in package:
            continue  # One of the workspace's own.
        name, version = package["name"], package["version"]
        if package["source"] != REGISTRY:
            raise SystemExit(f"{name} comes from {package['source']}: only crates of the registry can be listed")
        folder = f"{VENDORED}/{name}-{version}"
        listed.append(
            {
                "type": "archive",
                "archive-type": "tar-gzip",
                "url": f"https://static.crates.io/crates/{name}/{name}-{version}.crate",
                "sha256": package["checksum"],
                "dest": folder,
            }
        )
        # Cargo takes a vendored crate only with this file.
        checksums = json.dumps({"package": package["checksum"], "files": {}})
        listed.append(
            {"type": "inline", "contents": checksums, "dest": folder, "dest-filename": ".cargo-checksum.json"}
        )
    listed.append({"type": "inline", "contents": CONFIGURATION, "dest": "cargo", "dest-filename": "config.toml"})
    return listed


if __name__ == "__main__":
    lock = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parents[2] / "Cargo.lock"
    print(json.dumps(sources(lock.read_text()), indent=1))

#!/usr/bin/env bash
# Builds VeriPB, the proof checker, into build/veripb with cargo (some minutes). Only the tests of
# proofs use it, and they skip without it.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
version=3.0.2

if ! command -v cargo >/dev/null 2>&1; then
    echo "cargo is missing (Debian: apt-get install cargo, or rustup for a newer one)" >&2
    exit 1
fi
cargo install --locked --version "$version" --root "$root/build/veripb" veripb
echo "VeriPB $version is $root/build/veripb/bin/veripb"

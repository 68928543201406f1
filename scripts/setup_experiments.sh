#!/usr/bin/env bash
# scripts/setup_experiments.sh [PACKAGE...]: a Python environment in build/experiments-venv with what
# the reports' plots need (matplotlib, numpy) and what spreads a campaign over machines (snakemake
# with its Slurm plugin). Without it reports come without plots. With names only those packages are
# installed: scripts/setup_experiments.sh matplotlib numpy
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
environment="$root/build/experiments-venv"
requirements="$root/experiments/requirements.txt"

if [ ! -x "$environment/bin/python" ]; then
    if ! python3 -m venv "$environment"; then
        rm -rf "$environment"
        echo "Python's venv is missing. On Debian, as root, type: apt-get install python3-venv" >&2
        exit 1
    fi
fi

wanted=()
if [ "$#" -eq 0 ]; then
    wanted=(-r "$requirements")
else
    for name in "$@"; do
        line=$(grep -E "^$name==" "$requirements") || {
            echo "unknown package '$name'; $requirements lists them" >&2
            exit 2
        }
        wanted+=("$line")
    done
fi
"$environment/bin/python" -m pip install --quiet --disable-pip-version-check "${wanted[@]}"
"$environment/bin/python" -m pip list --disable-pip-version-check |
    grep -iE '^(matplotlib|numpy|snakemake|snakemake-executor-plugin-slurm) '

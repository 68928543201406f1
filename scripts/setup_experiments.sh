#!/usr/bin/env bash
# scripts/setup_experiments.sh [PACKAGE...]: a Python environment in build/experiments-venv with what
# the reports' plots need (matplotlib, numpy) and what spreads a campaign over machines (snakemake
# with its Slurm plugin). Without it reports come without plots. With names only those packages are
# installed: scripts/setup_experiments.sh matplotlib numpy
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/python_environment.sh
. "$root/scripts/python_environment.sh"
make_environment experiments-venv experiments/requirements.txt "$@"

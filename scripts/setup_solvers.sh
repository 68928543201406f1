#!/usr/bin/env bash
# scripts/setup_solvers.sh [PACKAGE...]: a Python environment in build/solvers-venv with HiGHS, SCIP,
# CP-SAT and Gurobi, for comparisons. Nothing else needs it: without it these solvers say that they
# are missing. With names (highspy, pyscipopt, ortools, gurobipy) only those are installed.
# GLPK, clasp and toulbar2 come from Debian: apt-get install glpk-utils clasp toulbar2.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/python_environment.sh
. "$root/scripts/python_environment.sh"
make_environment solvers-venv solvers/python/requirements.txt "$@"

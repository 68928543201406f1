#!/usr/bin/env bash
# scripts/setup_solvers.sh [PACKAGE...]: a Python environment in build/solvers-venv with HiGHS, SCIP,
# CP-SAT and Gurobi, for comparisons. Nothing else needs it: without it these solvers say that they
# are missing. With names (highspy, pyscipopt, ortools, gurobipy) only those are installed.
# GLPK, clasp and toulbar2 come from Debian: apt-get install glpk-utils clasp toulbar2.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
environment="$root/build/solvers-venv"
requirements="$root/solvers/python/requirements.txt"

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
    grep -iE '^(gurobipy|highspy|ortools|pyscipopt) '

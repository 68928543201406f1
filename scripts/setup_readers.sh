#!/usr/bin/env bash
# scripts/setup_readers.sh [PACKAGE...]: a Python environment in build/readers-venv with gmsh, meshio,
# PyMeshLab and VTK (400 MB), which the tests of exported meshes open files with. Without one of them
# its tests skip. With names only those are installed: scripts/setup_readers.sh gmsh meshio
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/python_environment.sh
. "$root/scripts/python_environment.sh"
make_environment readers-venv tests/readers/requirements.txt "$@"

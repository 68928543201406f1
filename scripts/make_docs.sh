#!/usr/bin/env bash
# scripts/make_docs.sh: the documentation as a site in build/site, to be opened from the disk or put on
# any server. Guide and results from the Markdown files, commands from the program's --help, the
# library's pages from its headers if doxygen is installed. Needs Python with venv, and the program
# (built by ./run) or SCALEFCN_PROGRAM.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/python_environment.sh
. "$root/scripts/python_environment.sh"
program="${SCALEFCN_PROGRAM:-$root/build/release/bin/scalefcn}"
if [ ! -x "$program" ]; then
    echo "$program is missing: build it first (./run), or name one with SCALEFCN_PROGRAM" >&2
    exit 1
fi

if [ ! -x "$root/build/docs-venv/bin/mkdocs" ]; then
    make_environment docs-venv docs/site/requirements.txt
fi

# Sources keep their places, so that links in them work here and there.
cd "$root"
sources=build/site-sources
rm -rf "$sources" build/site
mkdir -p "$sources"
cp README.md ARCHITECTURE.md CONTRIBUTING.md LICENSE docs/site/style.css "$sources/"
find docs results -type f \( -name '*.md' -o -name '*.png' -o -name '*.svg' -o -name '*.json' \) -exec cp --parents -t "$sources" {} +
python3 scripts/command_reference.py "$program" "$sources/reference"
{
    echo "# The library"
    echo
    if command -v doxygen >/dev/null 2>&1; then
        doxygen docs/site/Doxyfile
        echo "[All headers, classes and functions](../library/index.html), from the sources."
    else
        echo "Not in this copy of the site: doxygen was not installed when it was made."
        echo "no pages of the library: doxygen is missing (Debian: apt-get install doxygen)" >&2
    fi
    echo "[Architecture](../ARCHITECTURE.md) says how the parts fit together."
} >"$sources/reference/library.md"
build/docs-venv/bin/mkdocs --quiet build --strict --config-file docs/site/mkdocs.yml
echo "build/site/index.html"

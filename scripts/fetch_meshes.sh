#!/usr/bin/env bash
# scripts/fetch_meshes.sh NAME... | --corpora: meshes of Debian's package libcgal-demo (CC0) into
# build/meshes, without installing the package. NAME with or without .off; --corpora: all that
# experiments/corpora use.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=scripts/setup.sh
. "$root/scripts/setup.sh"

if [ "$#" -eq 0 ]; then
    sed -n '2,4s/^# //p' "$0" >&2
    exit 2
fi

names=()
for name in "$@"; do
    if [ "$name" = --corpora ]; then
        while read -r found; do names+=("$found.off"); done < <(
            grep -ho 'cgal:[A-Za-z0-9_-]*' "$root"/experiments/corpora/*.toml |
                cut -d: -f2 | sort -u
        )
    else
        case "$name" in
        *.*) names+=("$name") ;;
        *) names+=("$name.off") ;;
        esac
    fi
done
mkdir -p "$mesh_folder"
if ! fetch_meshes "${names[@]}"; then
    echo "cannot be fetched: ${names[*]}; is apt-get there, and do they exist in libcgal-demo?" >&2
    exit 1
fi
printf '%s\n' "${names[@]/#/$mesh_folder/}"

#!/usr/bin/env bash
# Bundles the 3D viewer of the reports into build/viewer/viewer.js, with Node.js (18 or newer) and npm.
# Without it reports have pictures only.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

for program in node npm; do
    if ! command -v "$program" >/dev/null 2>&1; then
        echo "$program is missing (Debian: apt-get install nodejs npm)" >&2
        exit 1
    fi
done
if ! node -e 'process.exit(parseInt(process.versions.node) >= 18 ? 0 : 1)'; then
    echo "Node.js $(node --version) is too old: 18 or newer is needed" >&2
    exit 1
fi

cd "$root/viewer"
if ! cmp -s package-lock.json node_modules/.installed.json; then
    npm ci --no-audit --no-fund --loglevel=error
    cp package-lock.json node_modules/.installed.json
fi
mkdir -p "$root/build/viewer"
node build.mjs "$root/build/viewer/viewer.js"
echo "build/viewer/viewer.js: $(wc -c <"$root/build/viewer/viewer.js") bytes"

#!/usr/bin/env bash
# scripts/list_problems.sh DIR: name and content hash of each problem of a campaign, sorted.
set -euo pipefail

if [ "$#" -ne 1 ] || [ ! -f "$1/plan.json" ]; then
    echo "usage: scripts/list_problems.sh DIR, where scalefcn-experiment has made a plan" >&2
    exit 2
fi
python3 -c '
import json, sys
for problem in json.load(open(sys.argv[1]))["problems"]:
    print(problem["name"], problem["hash"])
' "$1/plan.json" | sort

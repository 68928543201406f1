# Sourced by scripts that set up a Python environment. Expects $root to be the project folder.
# shellcheck shell=bash
# shellcheck disable=SC2154  # root comes from the script that sources this

# make_environment NAME REQUIREMENTS [PACKAGE...]: build/NAME with the packages of a requirements file,
# or with those of them that are named; prints their versions.
make_environment() {
    local environment="$root/build/$1" requirements="$root/$2" name line wanted=()
    shift 2
    if [ ! -x "$environment/bin/python" ]; then
        if ! python3 -m venv "$environment"; then
            rm -rf "$environment"
            echo "Python's venv is missing. On Debian, as root, type: apt-get install python3-venv" >&2
            exit 1
        fi
    fi
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
        grep -iE "^($(grep -oE '^[A-Za-z0-9_-]+' "$requirements" | paste -sd '|')) "
}

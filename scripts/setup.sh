# Sourced by ./run and ./test: installs what is missing, fetches meshes, configures and builds.
# Expects $root to be the project folder.
# shellcheck shell=bash
# shellcheck disable=SC2034,SC2154  # set here and used there, or the other way round

build_folder="$root/build/release"
mesh_folder="${SCALEFCN_MESHES:-$root/build/meshes}"
program="$build_folder/bin/scalefcn"

build_packages=(g++ make cmake ninja-build pkg-config libeigen3-dev libopenmesh-dev libcgal-dev
    libtbb-dev nlohmann-json3-dev libcli11-dev libfmt-dev libpng-dev zlib1g-dev coinor-libcbc-dev
    libtomlplusplus-dev libsqlite3-dev)
test_packages=(libgtest-dev python3 glpk-utils)

say() { printf '== %s\n' "$*"; }

is_installed() {
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]
}

# install_packages NAME...: those that are missing, with apt-get; says what to type if it may not.
install_packages() {
    if ! command -v dpkg-query >/dev/null 2>&1; then
        say "not a Debian system: taking for granted what Debian calls: $*"
        return 0
    fi
    local missing=() as_root=() name
    for name in "$@"; do
        is_installed "$name" || missing+=("$name")
    done
    [ "${#missing[@]}" -gt 0 ] || return 0
    if [ "$(id -u)" -ne 0 ]; then
        if ! command -v sudo >/dev/null 2>&1 || ! sudo -v; then
            {
                echo "Some packages are missing. As root, type:"
                echo "  apt-get update && apt-get install -y --no-install-recommends ${missing[*]}"
                echo "then start again."
            } >&2
            exit 1
        fi
        as_root=(sudo)
    fi
    say "installing: ${missing[*]}"
    "${as_root[@]}" apt-get update -q
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
        apt-get install -y -q --no-install-recommends "${missing[@]}"
}

# How many compilers fit: one a processor, and 1.5 GiB of memory for each.
job_count() {
    local processors memory
    processors=$(nproc 2>/dev/null || echo 1)
    memory=$(awk '/MemAvailable/ { print int($2 / 1572864) }' /proc/meminfo 2>/dev/null || echo 1)
    [ "${memory:-1}" -ge 1 ] || memory=1
    if [ "$memory" -lt "$processors" ]; then echo "$memory"; else echo "$processors"; fi
}

# configure ON|OFF: with or without tests. A configured folder only changes if it has to.
configure() {
    local cache="$build_folder/CMakeCache.txt"
    if [ -e "$build_folder/build.ninja" ]; then
        if [ "$1" = OFF ] || grep -q '^SCALEFCN_BUILD_TESTS:BOOL=ON' "$cache"; then return 0; fi
    fi
    say "configuring"
    (cd "$root" && cmake --preset release -DSCALEFCN_BUILD_TESTS="$1" >/dev/null)
}

# build [--target NAME]: the output goes to a log, of which a failure shows the end.
build() {
    local log="$build_folder/build.log"
    say "building; the first time takes some minutes (log: $log)"
    if ! cmake --build "$build_folder" -j "$(job_count)" "$@" 2>&1 | tee "$log" | show_progress; then
        grep -n -A 5 -m 5 'error' "$log" >&2 || tail -n 30 "$log" >&2
        exit 1
    fi
}

# Ninja's "[12/80]" on a terminal, one line that is redrawn; nothing in a pipe.
show_progress() {
    if [ -t 1 ]; then
        awk '/^\[[0-9]+\/[0-9]+\]/ { printf "\r%s ", $1; fflush() } END { printf "\r" }'
    else
        cat >/dev/null
    fi
}

# fetch_meshes NAME...: from Debian's libcgal-demo into build/meshes. Returns 1 if that fails.
fetch_meshes() {
    local name missing=() scratch
    for name in "$@"; do
        [ -s "$mesh_folder/$name" ] || missing+=("data/meshes/$name")
    done
    [ "${#missing[@]}" -gt 0 ] || return 0
    command -v apt-get >/dev/null 2>&1 || return 1
    say "fetching example meshes (Debian package libcgal-demo, 24 MB)"
    scratch="$mesh_folder/download"
    rm -rf "$scratch"
    mkdir -p "$scratch"
    if ! download_package libcgal-demo "$scratch"; then
        rm -rf "$scratch"
        return 1
    fi
    if ! dpkg-deb --fsys-tarfile "$scratch"/libcgal-demo_*.deb |
        tar -xO ./usr/share/doc/libcgal-dev/data.tar.gz |
        tar -xz -C "$scratch" "${missing[@]}"; then
        rm -rf "$scratch"
        return 1
    fi
    mv "$scratch"/data/meshes/* "$mesh_folder"/
    rm -rf "$scratch"
}

# download_package NAME FOLDER: without installing it. Package lists may be missing on a fresh
# system where nothing had to be installed.
download_package() {
    (
        cd "$2" || exit 1
        apt-get download -q "$1" >download.log 2>&1 && exit 0
        if [ "$(id -u)" -eq 0 ]; then
            apt-get update -q >>download.log 2>&1 || exit 1
        fi
        apt-get download -q "$1" >>download.log 2>&1
    )
}

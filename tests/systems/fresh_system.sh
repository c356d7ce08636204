#!/usr/bin/env bash
# fresh_system.sh SUITE [STEP…]: makes a bare system beside this one (bookworm, trixie: Debian 12, 13; noble: Ubuntu
# 24.04) and there runs, from a clone of the last commit,
#   1 2 3      the README's commands for a checkout, by their order
#   technique  after 1: scripts/new_technique, with what scripts/setup --technique installs
#   container  what containers/Containerfile runs, each stage in a bare system of its own
#   arm64      compiles every source, and links the program, for an ARM processor, in a bare system of its own (trixie)
#   wheel      the README's commands without a compiler, with the wheel of build/dist, in a bare system of its own
#   bundle     the bundle of build/dist, in another: both say how long each step takes, and are of an older system than trixie
# or only the steps that are named. build/dist is what scripts/release makes of this machine's build/release; where neither is
# there, wheel and bundle are left out.
# GFXREPRO_SYSTEMS  the folder for systems and for the compiler's cache, which stays (default build/systems)
# Needs root, mmdebstrap and a mount namespace. Exit 77: skipped, the last line says why.
set -euo pipefail
suite=$1
shift
source=$(cd "$(dirname "$0")/../.." && pwd)
systems=${GFXREPRO_SYSTEMS:-$source/build/systems}
dist=$source/build/dist
program=$source/build/release/gfxrepro
steps=${*:-1 2 technique 3 container $([ "$suite" != trixie ] || echo arm64) $([ ! -e "$dist" ] && [ ! -x "$program" ] || echo wheel bundle)}

skip() { echo "skipped: $*"; exit 77; }
[ "$(id -u)" = 0 ] || skip "a chroot needs root"
command -v mmdebstrap >/dev/null || skip "mmdebstrap is not installed (scripts/setup --tests installs it)"
unshare --mount true 2>/dev/null || skip "this machine grants no mount namespace"

root=$systems/$suite
cache=$systems/ccache-$suite
mkdir -p "$systems" "$cache"
trap 'rm -rf --one-file-system "$root" "$root-final" "$root-arm64" "$root-bare"' EXIT

# bare FOLDER: a minimal system with certificates, from the servers that mmdebstrap knows for the suite.
bare() {
    if [ "$suite" = noble ]; then
        local key=/usr/share/keyrings/ubuntu-archive-keyring.gpg
        [ -e $key ] || skip "$key is not here to check Ubuntu's packages with"
        set -- "$1" --components=main,universe
    fi
    rm -rf --one-file-system "$1"
    if ! mmdebstrap --quiet --variant=minbase --include=apt,ca-certificates "${@:2}" "$suite" "$1" >"$systems/$suite.log" 2>&1; then
        tail -n 20 "$systems/$suite.log" >&2
        ! grep -qE 'Could not (resolve|connect)|Failed to fetch|Unable to connect' "$systems/$suite.log" || skip "the packages of $suite cannot be reached"
        exit 1
    fi
    # An installed system knows itself and its name; a Slurm asks for that (tests/slurm), a test of downloads for the former.
    printf '%s\n' "127.0.0.1 localhost" "127.0.1.1 $(hostname -s)" >>"$1/etc/hosts"
}

# with_source FOLDER: a bare system with a clone of the last commit.
with_source() {
    bare "$1"
    # A checkout may be another user's; git takes that from a file alone.
    printf '[safe]\n\tdirectory = *\n' >"$systems/gitconfig"
    GIT_CONFIG_GLOBAL=$systems/gitconfig git clone --quiet --no-hardlinks "$source" "$1/src"
}

# inside FOLDER COMMAND: in the system, with the clone as the current folder. A mount of its own: a test makes namespaces in it.
inside() {
    unshare --mount bash -c 'mount --bind "$1" "$1"
        for name in proc dev sys; do mount --rbind "/$name" "$1/$name"; done
        mkdir -p "$1/home/.cache/ccache" && mount --bind "$2" "$1/home/.cache/ccache"
        exec env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/home \
            "$(command -v chroot)" "$1" sh -ec "cd /src; $3"' _ "$1" "$cache" "$2"
}

# stage_commands N: what the N-th stage of the Containerfile runs.
stage_commands() { awk -v n="$1" '/^FROM /{s++} s == n && sub(/^RUN /, "")' "$source/containers/Containerfile"; }

# readme_block N: its N-th block of commands.
readme_block() { awk -v n="$1" '/^```/ {inside = /^```sh/ ? ++blocks == n : 0; next} inside' "$source/README.md"; }

# without_compiler KIND: a bare system with the file of build/dist of that kind, and a user without rights.
without_compiler() {
    [ ! -x "$program" ] || [ "$dist/SHA256SUMS" -nt "$program" ] || "$source/scripts/release" "$dist"
    (cd "$dist" && sha256sum --quiet -c SHA256SUMS)
    bare "$root-bare"
    chroot "$root-bare" useradd --create-home someone
    mkdir "$root-bare/src"
    cp "$dist"/*"$1" "$root-bare/home/someone/"
}

# timed COMMAND [USER]: in the bare system, with what it took on a line of its own.
timed() {
    local begin=${EPOCHREALTIME/./} code=0 command=$1
    [ -z "${2:-}" ] || command="cd ~$2 && exec runuser -u $2 -- env HOME=/home/$2 sh -ec '$1'"
    inside "$root-bare" "$command" || code=$?
    # A claim that fails is a result.
    [ $code -eq 0 ] || { [ $code -eq 1 ] && [[ $1 == *reproduce* ]]; } || exit $code
    echo "== $suite: $step: $(((${EPOCHREALTIME/./} - begin) / 1000)) ms: $1"
}

# A report of the only run of someone: pictures, and what the kept results say of its verdicts.
require_report() {
    local run=("$root-bare"/home/someone/runs/*/)
    grep -q 'class="shot"' "${run[0]}report.html" || { echo "FAILED: the report has no picture"; exit 1; }
    ! grep -q ',not known,' "${run[0]}claims.csv" || { echo "FAILED: the kept results were not found"; exit 1; }
}

[[ ! " $steps " =~ \ (1|2|3|container)\  ]] || with_source "$root"
for step in $steps; do
    echo "== $suite: $step"
    case $step in
    [1-3])
        command=$(sed -n '/^```sh/,/^```/{/^scripts/p}' "$source/README.md" | sed -n "${step}{s/ *#.*//;p}")
        [ -n "$command" ] || { echo "FAILED: the README has no command $step"; exit 1; }
        echo "$command"
        code=0
        inside "$root" "$command" || code=$?
        # A claim that fails is a result.
        [ $code -eq 0 ] || { [ $code -eq 1 ] && [[ $command == *reproduce* ]]; } || exit $code
        ;;
    technique)
        inside "$root" "scripts/setup --technique && scripts/new_technique contact_shadows && git checkout --quiet . && git clean --quiet -fd"
        ;;
    container)
        inside "$root" "$(stage_commands 1)"
        bare "$root-final"
        mkdir "$root-final/src"
        cp "$root/gfxrepro.deb" "$root-final/"
        mkdir -p "$root-final/usr/share/glvnd/egl_vendor.d"
        cp "$source/containers/10_nvidia.json" "$root-final/usr/share/glvnd/egl_vendor.d/"
        inside "$root-final" "$(stage_commands 2)"
        inside "$root-final" "cd /work; exec runuser -u $(sed -n 's/^USER //p' "$source/containers/Containerfile") -- env HOME=/tmp sh -ec 'gfxrepro doctor
            gfxrepro run /usr/share/gfxrepro/configs/smoke/template.yaml --device software --quiet --out run; gfxrepro table run'"
        ;;
    arm64)
        with_source "$root-arm64"
        inside "$root-arm64" '
            export DEBIAN_FRONTEND=noninteractive CMAKE_CXX_COMPILER_LAUNCHER=ccache
            dpkg --add-architecture arm64
            apt-get update -qq
            libraries=$(sed -n "/^[a-z_]*packages=/,/^)/p" scripts/setup | grep -oE "(lib|nlohmann)[a-z0-9+-]*-dev" |
                while read -r package; do
                    # What holds headers alone is of no processor.
                    apt-cache policy "$package:arm64" | grep -q "Candidate: [0-9]" && package=$package:arm64
                    echo "$package"
                done)
            apt-get install -y -qq --no-install-recommends g++-aarch64-linux-gnu cmake ninja-build ccache python3-minimal $libraries >/dev/null
            cmake --preset arm64
            cmake --build --preset arm64 -- --quiet gfxrepro $(ninja -C build/arm64 -t targets all | sed -n "s/: CXX_COMPILER.*//p")'
        ;;
    wheel)
        without_compiler .whl
        mapfile -t commands < <(readme_block 1)
        timed "${commands[0]%#*} >/dev/null"
        timed "${commands[1]}" someone
        timed "env/bin/gfxrepro doctor" someone
        timed "${commands[2]}" someone
        require_report
        inside "$root-bare" "cd /home/someone; env/bin/python -c \"import glob, gfxrepro; print(gfxrepro.__version__, len(gfxrepro.load(sorted(glob.glob('runs/*/'))[0]).records), 'records')\""
        ;;
    bundle)
        without_compiler .tar.xz
        timed "apt-get update -qq && apt-get install -y -qq libegl-mesa0 libgl1-mesa-dri xz-utils >/dev/null"
        timed "tar -xf gfxrepro-*.tar.xz" someone
        timed "gfxrepro-*/gfxrepro doctor" someone
        timed "gfxrepro-*/gfxrepro reproduce zju2005/figure-4.4 --profile quick" someone
        require_report
        ;;
    *) echo "fresh_system.sh: unknown step '$step'" >&2; exit 2 ;;
    esac
done
echo "passed: $suite: $steps"

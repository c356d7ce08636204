#!/usr/bin/env bash
# bundle_test.sh SURROUNDINGS SOURCE BUILD: the bundle measures the smoke config as the build does. Exit 77: skipped.
#   without_environment: `env -i`, every library from the bundle but the C library's
#   beside_a_newer_cpp_library: the node's libstdc++ is taken where it is newer, and not where it is older
#   packed: the archive is under 32 MiB and has the bundle
#   in_a_bare_root: chroot into a folder of the bundle, the C library and Mesa; needs root
set -euo pipefail
surroundings=$1 source=$2 build=$3
skip() { echo "skipped: $*"; exit 77; }
fail() { echo "FAILED: $*"; exit 1; }
D=$(mktemp -d)
trap 'rm -rf "$D"' EXIT
"$source/scripts/bundle" "$D/bundle" "$build"
c_library='(linux-vdso|ld-linux.*|libc|libm|libdl|libpthread|librt|libresolv|libutil)\.so[.0-9]*'

# The tables of the run in $1 are those of the build's own run.
require_same_tables() {
    "$build/gfxrepro" run "$source/configs/smoke/template.yaml" --device software --quiet --out "$D/build-run" >/dev/null
    "$build/gfxrepro" table "$D/build-run" >/dev/null
    cmp "$D/build-run/tables/sweep-smoke-template.csv" "$1/tables/sweep-smoke-template.csv" || fail "other tables"
    # The same program with the same shaders: a run that one of them began may be gone on with by the other.
    [ "$(grep -o '"hash": "[0-9a-f]*"' "$D/build-run/plan.json")" = "$(grep -o '"hash": "[0-9a-f]*"' "$1/plan.json")" ] ||
        fail "the bundle's plan has another hash than the build's"
}

case $surroundings in
without_environment)
    cd /
    strange=$(env -i LD_TRACE_LOADED_OBJECTS=1 "$D/bundle/gfxrepro" |
        grep -vE "^\s*(/\S*/)?$c_library( |$)" | grep -v "=> $D/bundle/lib/" || true)
    [ -z "$strange" ] || fail "not from the bundle: $strange"
    env -i "$D/bundle/gfxrepro" run "$D/bundle/configs/smoke/template.yaml" --device software --quiet --out "$D/run"
    env -i "$D/bundle/gfxrepro" table "$D/run"
    require_same_tables "$D/run"
    ;;
beside_a_newer_cpp_library)
    cd "$D"
    used() { env -i LD_DEBUG=files "$D/bundle/gfxrepro" --version 2>&1 | grep 'calling init: .*libstdc++' | tail -n 1; }
    called() { # its file and the link to it
        mv "$D"/bundle/lib/libstdc++.so.6.0.* "$D/bundle/lib/$1"
        ln -sf "$1" "$D/bundle/lib/libstdc++.so.6"
    }
    [[ $(used) == *"$D/bundle/lib/"* ]] || fail "of the same release, but not its own: $(used)"
    called libstdc++.so.6.0.1
    [[ $(used) == *libstdc++* && $(used) != *"$D/bundle/lib/"* ]] || fail "older, and still its own: $(used)"
    env -i "$D/bundle/gfxrepro" run "$D/bundle/configs/smoke/template.yaml" --device software --quiet --out "$D/run"
    env -i "$D/bundle/gfxrepro" table "$D/run"
    require_same_tables "$D/run"
    called libstdc++.so.6.0.999
    [[ $(used) == *"$D/bundle/lib/"* ]] || fail "newer, and not its own: $(used)"
    ;;
packed)
    "$source/scripts/bundle" --tar "$D/packed" "$build"
    [ "$(stat -c %s "$D/packed.tar.xz")" -lt $((32 << 20)) ] || fail "$(stat -c %s "$D/packed.tar.xz") bytes"
    mkdir "$D/elsewhere"
    tar -C "$D/elsewhere" -xf "$D/packed.tar.xz"
    diff -r --no-dereference "$D/packed" "$D/elsewhere/packed" || fail "other files"
    ;;
in_a_bare_root)
    [ "$(id -u)" = 0 ] || skip "a chroot needs root"
    unshare --mount true 2>/dev/null || skip "this machine grants no mount namespace, so no /proc in a chroot"
    mesa=$(ldconfig -p | sed -n 's/.*libEGL_mesa\.so\.0.* => //p' | head -n 1)
    [ -n "$mesa" ] || skip "Mesa's EGL driver is not installed"
    R=$D/root
    mkdir -p "$R"/{proc,dev,tmp,usr/lib,usr/lib64}
    ln -s usr/lib usr/lib64 "$R" # Mesa looks in /usr/lib for what is found in /lib
    mv "$D/bundle" "$R/gfxrepro"
    # A driver takes what is loaded already, here the bundle's; of the rest, what its own libraries need.
    copy() { [ -e "$R/gfxrepro/lib/${1##*/}" ] || { mkdir -p "$R$(dirname "$1")" && cp -L "$1" "$R$1"; }; }
    drivers=$(dirname "$mesa")/dri
    for file in "$mesa" "$drivers/swrast_dri.so" "$build/gfxrepro"; do
        for library in $(ldd "$file" | grep -oE '/\S+'); do
            if [ "$file" != "$build/gfxrepro" ] || [[ ${library##*/} =~ ^$c_library$ ]]; then copy "$library"; fi
        done
    done
    for file in "$mesa" "$drivers/swrast_dri.so" "$drivers/kms_swrast_dri.so" /usr/share/glvnd/egl_vendor.d/50_mesa.json; do copy "$file"; done
    inside() { # no shell in there: the program alone
        unshare --mount bash -c 'mount --rbind /proc "$1/proc" && mount --rbind /dev "$1/dev" && root=$1 && shift &&
            exec env -i "$(command -v chroot)" "$root" /gfxrepro/gfxrepro "$@"' _ "$R" "$@"
    }
    inside doctor | head -n 12
    inside run /gfxrepro/configs/smoke/template.yaml --device software --quiet --out /tmp/run
    inside table /tmp/run
    require_same_tables "$R/tmp/run"
    ;;
esac
echo "passed"

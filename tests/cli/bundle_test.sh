#!/usr/bin/env bash
# bundle_test.sh SURROUNDINGS SOURCE BUILD: the bundle measures the smoke config as the build does. Exit 77: skipped.
#   without_environment: `env -i`, every library from the bundle but the C library's
#   beside_a_newer_cpp_library: the node's libstdc++ is taken where it is newer, and not where it is older
#   released: scripts/release; its archive is under 32 MiB and has the bundle, with the notices of what is in it; its wheel,
#     installed by pip in an environment of its own, is the program and the Python package
#   in_a_bare_root: chroot into a folder of the bundle, the C library and Mesa; needs root
set -euo pipefail
surroundings=$1 source=$2 build=$3
skip() { echo "skipped: $*"; exit 77; }
fail() { echo "FAILED: $*"; exit 1; }
D=$(mktemp -d)
trap 'rm -rf "$D"' EXIT
[ "$surroundings" = released ] || "$source/scripts/bundle" "$D/bundle" "$build"
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

# A report of the program $1 knows what a checkout's knows: the kept results are beside its configs, and no more of them than it reads.
require_kept_results() {
    local folder=$2/results
    diff -r <(cd "$source/results" && find sensitivity calibration -name '*.csv' -exec sha256sum {} + | sort) \
        <(cd "$folder" && find . -type f -printf '%P\0' | xargs -0 sha256sum | sort) || fail "other kept results"
    env -i HOME="$D" "$1" reproduce zju2005/2.4.1 --profile quick --device software --quiet --out "$D/judged" >"$D/judged.txt" || [ $? = 1 ] || fail "not judged"
    ! grep 'is not known' "$D/judged.txt" || fail "the kept results are not found"
}

# The notices in $1 are of code that is compiled in, and of all libraries in $2.
require_notices() {
    [ -n "$(command -v dpkg-query)" ] || return 0
    for package in libglm-dev libcli11-dev nlohmann-json3-dev libnanoflann-dev; do
        [ -s "$1/$package" ] || fail "no notice of $package"
    done
    ldd "$build/gfxrepro" | awk '$2 == "=>" {print $3}' | while read -r library; do
        [ -e "$2/${library##*/}" ] || continue
        library=$(realpath "$library")
        package=$(dpkg-query -S "*${library#/usr}" | sed -n '1s/:.*//p')
        [ -s "$1/$package" ] || fail "no notice of $package, which ${library##*/} is of"
        grep -q "^| $package | $(dpkg-query -W -f='${Version} | ${source:Package} | ${source:Version} |' "$package" | head -n 1)" "$1/README.md" ||
            fail "$package is not in the list"
    done
    for licence in $(grep -rhoE 'common-licenses/(GPL|LGPL|Apache)-[0-9.]*[0-9]' "$1" | sort -u); do
        [ -s "$1/$licence" ] || fail "no text of $licence"
    done
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
    require_kept_results "$D/bundle/gfxrepro" "$D/bundle"
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
    # So does the copy that a submission makes of it, without the link: no run has one.
    submitted() {
        rm -rf "$D/submitted"
        env -i "$D/bundle/gfxrepro" submit "$D/bundle/configs/smoke/template.yaml" --device software --engine commands --out "$D/submitted" >/dev/null
        env -i LD_DEBUG=files "$D/submitted/submitted-program/gfxrepro" --version 2>&1 | grep 'calling init: .*libstdc++' | tail -n 1
    }
    newer=$(submitted)
    [[ $newer == *"/submitted-program/lib/"* ]] || fail "newer, and not the copy's own: $newer"
    called libstdc++.so.6.0.1
    older=$(submitted)
    [[ $older == *libstdc++* && $older != *"/submitted-program/lib/"* ]] || fail "older, and still the copy's own: $older"
    [ -z "$(find "$D/submitted" -type l)" ] || fail "links: $(find "$D/submitted" -type l)"
    for script in commands.txt merge.sh; do env -i PATH="$PATH" sh "$D/submitted/$script" >/dev/null; done
    env -i "$D/bundle/gfxrepro" table "$D/submitted"
    cmp "$D/build-run/tables/sweep-smoke-template.csv" "$D/submitted/tables/sweep-smoke-template.csv" || fail "other tables of the submission"
    ;;
released)
    python=
    for one in python3 /usr/bin/python3; do ! "$one" -c 'import hatchling' 2>/dev/null || { python=$one && break; }; done
    [ -n "$python" ] || skip "hatchling is not installed"
    "$python" -m venv "$D/env" >/dev/null || skip "python3-venv is not installed"
    command -v dpkg-shlibdeps >/dev/null || skip "dpkg-dev is not installed"
    (cd "$D" && "$source/scripts/release" dist "$build")
    cd "$D/dist"
    sha256sum --quiet -c SHA256SUMS
    version=$("$build/gfxrepro" --version | cut -d ' ' -f 2)
    wheels=("gfxrepro-$version-py3-none-manylinux_2_"*"_$(uname -m).whl")
    [ "$(find . -type f | wc -l)" = 4 ] && [ "$(cut -c 67- SHA256SUMS | wc -l)" = 3 ] || fail "other files: $(ls)"
    for file in "${wheels[@]}" "gfxrepro_${version}_"*.deb "gfxrepro-$version-linux-$(uname -m).tar.xz"; do
        grep -q "  $file\$" SHA256SUMS || fail "no sum of $file"
    done
    ! command -v lintian >/dev/null || lintian --fail-on error ./*.deb || fail "lintian"

    archive=gfxrepro-$version-linux-$(uname -m)
    [ "$(stat -c %s "$archive.tar.xz")" -lt $((32 << 20)) ] || fail "$(stat -c %s "$archive.tar.xz") bytes"
    tar -C "$D" -xf "$archive.tar.xz"
    "$source/scripts/bundle" "$D/bundle" "$build"
    diff -r --no-dereference "$D/bundle" "$D/$archive" || fail "other files"
    require_notices "$D/$archive/licenses" "$D/$archive/lib"
    # A folder of something else is left as it is.
    mkdir "$D/mine"
    touch "$D/mine/kept"
    ! "$source/scripts/notices" "$D/mine" "$build" 2>/dev/null && [ -e "$D/mine/kept" ] || fail "notices took a folder of something else"
    # A library that nobody knows is refused rather than passed on without its notice.
    cp "$(ldd "$build/gfxrepro" | awk '/libfmt/ {print $3}')" "$D/libmine.so"
    ! "$source/scripts/notices" "$D/notices" "$build" "$D/libmine.so" 2>"$D/refused" || fail "libmine.so has a notice"
    grep -qx "notices: $D/libmine.so is of no Debian package, so its notice is not known" "$D/refused" || fail "$(cat "$D/refused")"

    env -i HOME="$D" PATH=/usr/bin:/bin "$D/env/bin/pip" install --quiet --disable-pip-version-check --no-index "./${wheels[0]}"
    command=$D/env/bin/gfxrepro
    program=$(echo "$D"/env/lib/python3.*/site-packages/gfxrepro/program)
    cmp "$program/gfxrepro" "$build/gfxrepro" || fail "another program"
    require_notices "$program/licenses" "$program/lib"
    # The kind of the wheel: no library asks for a newer C library than it names, one for that very one, and what is not in
    # the wheel is what PEP 600 lets it expect.
    newest=$(objdump -T "$program/gfxrepro" "$program"/lib/* | grep -oE 'GLIBC_2\.[0-9]+' | sort -uV | tail -n 1)
    [[ ${wheels[0]} == *"manylinux_${newest#GLIBC_}_"* || ${wheels[0]} == *"manylinux_2_${newest#GLIBC_2.}_"* ]] || fail "${wheels[0]} needs $newest"
    strange=$(env -i LD_TRACE_LOADED_OBJECTS=1 "$program/gfxrepro" |
        grep -vE "^\s*(/\S*/)?($c_library|libstdc\+\+\.so\.6|libgcc_s\.so\.1)( |$)" | grep -v "=> $program/lib/" || true)
    [ -z "$strange" ] || fail "not from the wheel: $strange"

    cd "$D"
    [ "$("$command" --version)" = "$("$build/gfxrepro" --version)" ] || fail "another version"
    [ "$("$D/env/bin/python" -c 'import gfxrepro; print(gfxrepro.__version__)')" = "$version" ] || fail "another version of the package"
    env -i HOME="$D" "$command" run "$program/configs/smoke/template.yaml" --device software --quiet --out "$D/run"
    env -i HOME="$D" "$command" table "$D/run"
    require_same_tables "$D/run"
    require_kept_results "$command" "$program"
    "$D/env/bin/python" -c 'import gfxrepro, sys; assert gfxrepro.load(sys.argv[1], as_frames=False).records' "$D/run"
    # Exit codes, words and signals are the program's.
    said=$("$command" reprodcue 2>&1) && fail "no error" || [ $? = 2 ] || fail "another exit code"
    [ "$said" = "$("$build/gfxrepro" reprodcue 2>&1 || true)" ] || fail "said $said"
    { sleep 0.5; code=0; "$command" man || code=$?; echo $code >"$D/unread"; } | true
    [ "$(cat "$D/unread")" = 141 ] || fail "nobody read it, and it ended with $(cat "$D/unread")"
    ended() { # of a run of $1 that SIGTERM ends: what it ignores and catches, what it is, its exit code
        local run=$D/long-$RANDOM code=0
        "$1" run "$program/configs/smoke/template.yaml" --device software --quiet --set measure.processes=500 --out "$run" &
        for ((tenths = 0; tenths < 600; ++tenths)); do [ "$(wc -l 2>/dev/null <"$run/records.csv")0" -lt 20 ] || break; sleep 0.1; done
        sed -n 's/^\(SigIgn\|SigCgt\)/\1/p' "/proc/$!/status"
        sha256sum <"/proc/$!/exe"
        kill -TERM $!
        wait $! || code=$?
        echo "exit code $code"
    }
    diff <(ended "$build/gfxrepro") <(ended "$command") || fail "other signals or another end"
    ended "$command" | grep -qx 'exit code 130' || fail "not ended by the signal"

    "$D/env/bin/pip" uninstall --quiet --yes gfxrepro
    [ ! -e "$program" ] && [ ! -e "$command" ] || fail "uninstalling leaves something"
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

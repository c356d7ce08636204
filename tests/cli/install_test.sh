#!/usr/bin/env bash
# install_test.sh SOURCE BUILD: what `cmake --install` puts into a folder runs from there alone. Where a mount namespace
# is granted, source and build are hidden from it; elsewhere they are only not looked at.
set -euo pipefail
source=$1 build=$2
fail() { echo "FAILED: $*"; exit 1; }
D=$(mktemp -d)
trap 'rm -rf "$D"' EXIT
cmake --install "$build" --prefix "$D/first" >/dev/null
mv "$D/first" "$D/moved" # it may be moved, too
P=$D/moved

installed() {
    local hide="mount -t tmpfs none '$source' && mount -t tmpfs none '$build' 2>/dev/null || true"
    if unshare --mount true 2>/dev/null; then
        unshare --mount bash -c "cd '$D' && $hide; [ ! -e '$build/gfxrepro' ] || exit 70; exec env -i HOME='$D' PATH=/usr/bin:/bin \"\$@\"" _ "$P/bin/gfxrepro" "$@"
    else
        (cd "$D" && env -i HOME="$D" PATH=/usr/bin:/bin "$P/bin/gfxrepro" "$@")
    fi
}

configs=$P/share/gfxrepro/configs
[ "$(installed list configs | grep -vc "^$configs/")" = 0 ] || fail "configs of another place: $(installed list configs | head -n 1)"
[ "$(installed list tables | wc -l)" = "$("$build/gfxrepro" list tables | wc -l)" ] || fail "not every table"
installed check "$configs/smoke/template.yaml" "$configs/zju2005/table-2.1.yaml"
installed run "$configs/smoke/template.yaml" --device software --quiet --out "$D/run"
installed table "$D/run"
for file in bin/gfxrepro share/gfxrepro/shaders/template share/gfxrepro/configs/schema/experiment.json \
    share/gfxrepro/scripts/fetch-assets share/gfxrepro/scripts/nightly share/man/man1/gfxrepro.1.gz share/doc/gfxrepro/copyright share/doc/gfxrepro/changelog.gz share/doc/gfxrepro/CITATION.cff \
    share/gfxrepro/results/sensitivity share/gfxrepro/results/calibration/city.csv \
    share/bash-completion/completions/gfxrepro share/zsh/vendor-completions/_gfxrepro share/fish/vendor_completions.d/gfxrepro.fish; do
    [ -s "$P/$file" ] || [ -d "$P/$file" ] || fail "$file is not installed"
done
gunzip -c "$P/share/man/man1/gfxrepro.1.gz" | cmp - <("$build/gfxrepro" man) || fail "the man page is an old one"
[ -z "$(find "$P/share/gfxrepro/results" -type f ! -name '*.csv')" ] || fail "of the results, more than a report reads"
[ -z "$(command -v dpkg-query)" ] || [ -s "$P/share/doc/gfxrepro/licenses/libglm-dev" ] || fail "no notice of glm"
bash -n "$P/share/bash-completion/completions/gfxrepro"
echo passed

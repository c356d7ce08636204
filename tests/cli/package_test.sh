#!/usr/bin/env bash
# package_test.sh SOURCE BUILD: the Debian package in a fresh Debian. Exit 77: skipped.
set -euo pipefail
# It loads some 200 MB of packages and takes minutes.
[ -n "${GFXREPRO_TEST_PACKAGE:-}" ] || { echo "skipped: set GFXREPRO_TEST_PACKAGE=1 to make a Debian system for it"; exit 77; }
exec "$1/scripts/package" --check "$2"

"""public_files_test.py PROGRAM: reads every model and picture below the folder $GFXREPRO_PUBLIC_FILES, such as other people's
test files, and says of each kind how many were read, read with a warning, refused, crashed the program, or hung it.
GFXREPRO_PUBLIC_FILES_OUT: also a CSV file with each file's outcome and first line of message."""
import collections
import concurrent.futures
import csv
import os
import pathlib
import subprocess
import sys

MODELS = {".glb", ".gltf", ".hgt", ".las", ".laz", ".obj", ".off", ".ply", ".stl", ".tif", ".tiff", ".xyz"}
PICTURES = {".exr", ".hdr", ".jpeg", ".jpg", ".pbm", ".pfm", ".pgm", ".png", ".pnm", ".ppm", ".tga", ".tif", ".tiff"}
OUTCOMES = ("read", "warned", "refused", "crashed", "hung")
LIMIT_S = 60
REFUSED = 2  # the exit code of what is wrong with a file


def outcome(program, path):
    """One of OUTCOMES, and the line that tells why; of what may be a height map or a picture the better."""
    kind = path.suffix.lower()
    found = [outcome_of([program, "scene", path])] if kind in MODELS else []
    if kind in PICTURES and (not found or found[0][0] == "refused"):
        found.append(outcome_of([program, "image", "info", path]))
    return found[-1]


def outcome_of(command):
    try:
        done = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=LIMIT_S)
    except subprocess.TimeoutExpired:
        return "hung", f"no end after {LIMIT_S} s"
    if done.returncode == 0:
        warnings = [line for line in (done.stdout + done.stderr).splitlines() if line.startswith("warning")]
        return ("warned", warnings[0]) if warnings else ("read", "")
    lines = done.stderr.splitlines()
    # What is refused is refused in words.
    isRefused = done.returncode == REFUSED and lines and lines[0].startswith("gfxrepro: ")
    return ("refused" if isRefused else "crashed"), lines[0] if lines else f"exit code {done.returncode}"


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    folder = os.environ.get("GFXREPRO_PUBLIC_FILES")
    if not folder:
        print("skipped: GFXREPRO_PUBLIC_FILES names no folder of models and pictures")
        return 77
    files = sorted(path for path in pathlib.Path(folder).rglob("*") if path.suffix.lower() in MODELS | PICTURES and path.is_file())
    if not files:
        print(f"{folder}: no models or pictures")
        return 1
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        found = list(pool.map(lambda path: outcome(program, path), files))
    counts = collections.Counter((path.suffix.lower(), what) for path, (what, _) in zip(files, found))
    print("kind  " + "".join(f"{what:>9}" for what in OUTCOMES))
    for kind in sorted({kind for kind, _ in counts}):
        print(f"{kind:<6}" + "".join(f"{counts[kind, what]:>9}" for what in OUTCOMES))
    print("all   " + "".join(f"{sum(counts[kind, what] for kind in MODELS | PICTURES):>9}" for what in OUTCOMES))
    if table := os.environ.get("GFXREPRO_PUBLIC_FILES_OUT"):
        with open(table, "w", newline="") as out:
            csv.writer(out).writerows([("file", "outcome", "why"), *((path, *one) for path, one in zip(files, found))])
    bad = [f"{what} {path}: {why}" for path, (what, why) in zip(files, found) if what in ("crashed", "hung")]
    print("\n".join(bad))
    return 1 if bad else 0


sys.exit(main())

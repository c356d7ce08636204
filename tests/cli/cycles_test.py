"""The configs of configs/external for Cycles, Blender's path tracer, by a Blender that is installed: ground truths are what it draws, and a light
that stands elsewhere is found; its error falls over the samples.

Usage: cycles_test.py SOURCE GFXREPRO. Exit 77: skipped, without Blender or the NumPy that it needs.
"""
import csv
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

SOURCE, PROGRAM = (pathlib.Path(argument) for argument in sys.argv[1:])
CONFIGS = SOURCE / "configs/external"
ENVIRONMENT = os.environ | {"PATH": f"{PROGRAM.parent}:{os.environ['PATH']}"}


def verdicts(config, run, *options):
    """Of the claims, by their names."""
    done = subprocess.run([PROGRAM, "reproduce", config, "--out", run, *options], env=ENVIRONMENT, capture_output=True, text=True)
    if done.returncode > 1:
        sys.exit(f"{config} {options}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
    print((run / "tables" / f"sweep-{config.stem}.md").read_text())
    with (run / "claims.csv").open(newline="", encoding="utf-8") as file:
        return {row["claim"]: row["verdict"] for row in csv.DictReader(file)}


def expect(found, *wanted):
    if set(found) != set(wanted):
        sys.exit(f"the claims came out as {found}")


if not shutil.which("blender") or subprocess.run(["/usr/bin/python3", "-c", "import numpy"], capture_output=True).returncode != 0:
    print("skipped: Blender or the NumPy that it needs is not installed")
    sys.exit(77)
with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder)
    expect(verdicts(CONFIGS / "cycles-truths.yaml", folder / "run").values(), "holds")

    def altered(name, before, after):
        """The experiment in a folder of its own, with another text in the place of one."""
        (folder / name).mkdir()
        for file in ("cycles-truths.yaml", "cycles-truths.py"):
            (folder / name / file).write_text((CONFIGS / file).read_text(encoding="utf-8").replace(before, after), encoding="utf-8")
        return folder / name / "cycles-truths.yaml"

    moved = altered("moved", "(35, 60, 1.5, 1)", "(36, 60, 1.5, 1)")
    expect([verdicts(moved, folder / "run-moved", "--only", "truth=soft shadows", "--only", "scene=shadows/object_on_plane")["shadows"]], "fails")
    if os.environ.get("GFXREPRO_ASSETS"):  # its mirrors see the windows
        room = altered("room", "indoor/bathroom, view: overview", "indoor/real_living_room, view: camera")
        expect([verdicts(room, folder / "run-room", "--only", "scene=indoor/real_living_room")["mirrors"]], "holds")
    said = subprocess.run(["blender", "--version"], capture_output=True, text=True, check=True).stdout
    if [int(part) for part in said.split()[1].split(".")[:2]] >= [4, 2]:
        print("left out: cycles-samples.yaml, as from 4.2 on no sampling pattern of Blender is computed")
        sys.exit(0)
    expect(verdicts(CONFIGS / "cycles-samples.yaml", folder / "samples").values(), "holds")

"""What the witnesses share: whether Blender is there, and a call of it that runs the caller's own file."""
import json
import os
import shutil
import subprocess
import sys


def blender_or_skip():
    """Blender's path. Exits with 77, skipped, without it or the system Python's NumPy, which it needs."""
    blender = shutil.which("blender")
    if not blender:
        print("skipped: Blender is not installed")
        sys.exit(77)
    if subprocess.run(["/usr/bin/python3", "-c", "import numpy"], stderr=subprocess.DEVNULL).returncode != 0:
        print("skipped: NumPy, which Blender needs, is not installed")
        sys.exit(77)
    return blender


def found_in(blender, script, folder, *arguments):
    """What the script, called in Blender with the folder, writes into its found.json."""
    subprocess.run([blender, "-b", "--factory-startup", "-noaudio", "--python-exit-code", "1", "-P", script, "--", folder, *arguments],
                   check=True, stdout=subprocess.DEVNULL, env=os.environ | {"PATH": "/usr/bin:/bin"})
    with open(os.path.join(folder, "found.json"), encoding="utf-8") as file:
        return json.load(file)

"""drivers_test.py WHAT PROGRAM SOURCE FOLDER [LIBRARY]: the smoke configs, and those of configs/ beside this file, on more
than one driver.

WHAT  software  runs them on the software device into FOLDER/software, keeps every GL program that they link, and looks for
                hazards at every draw (LIBRARY: keep_programs and check_hazards)
      zink      runs them on zink, Mesa's OpenGL through Vulkan, on lavapipe: no quality may differ from software's by more
                than a picture's last bits
      gpu       runs them on the software device that calls itself a GPU (LIBRARY: pretended_gpu): no quality
                may differ
      glslang   compiles the kept programs by glslang, whose reading of the language is a strict one, for OpenGL and to
                SPIR-V; every file of a stage is in one of them
      hazards   of what draws and dispatches did, nothing is left to chance (hazards/hazards.h)
Exit 77: skipped, the last line says why.
"""
import concurrent.futures
import csv
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

WHAT, PROGRAM = sys.argv[1:3]
SOURCE, FOLDER = map(pathlib.Path, sys.argv[3:5])
LIBRARY = sys.argv[5:]
PROGRAMS = FOLDER / "programs"
HAZARDS = FOLDER / "hazards.txt"
LAVAPIPE = pathlib.Path("/usr/share/vulkan/icd.d")

KEY = ["frame", "repeat", "process", "pass", "metric"]
# Mesa 22.3's zink reads a count back before it is drawn (voxelization-mixed: the run says so), and ends invocations at a
# barrier for memory in divergent flow (the ray tracer on the device finds nothing): both are gone in 25.0.
ZINK_22_FAILS = ["voxelization-mixed", "clustered_reflections", "reflection_reuse"]
# What a frame has to read back, by what drew or was dispatched before, and why.
READ_IN_FRAMES = {"clustered_reflections/cluster_cameras.comp.glsl": "sizes of clusters that are drawn one by one, as the thesis has it",
                  "reflections/gbuffer.frag.glsl": "what is clustered, or traced, on the CPU",
                  "reflection_reuse/list_cells.comp.glsl": "on software devices alone: the draws that are split there",
                  "kit/prefix_sum.comp.glsl": "the size of soft shadows' mesh, whose buffers are made then"}
# What a driver may take or count otherwise.
UNITS_OF_TIME = re.compile("ms|.*/s")
STORAGE_BLOCK = re.compile(r"\s*layout\(std430[^)]*\)[\w ]* buffer \w+")
OWN_COUNTS = re.compile("(.*_)?memory_bytes|work_.*|draw_calls")


def skip(why):
    print("skipped:", why)
    sys.exit(77)


def configs(without):
    files = sorted((SOURCE / "configs/smoke").glob("*.yaml")) + sorted((SOURCE / "tests/drivers/configs").glob("*.yaml"))
    return [file for file in files if file.stem not in without]


def measure(name, device, environment, without=()):
    out = FOLDER / name
    shutil.rmtree(out, ignore_errors=True)
    command = [PROGRAM, "run", *configs(without), "--device", device, "--quiet", "--out", out]
    run = subprocess.run(command, env=os.environ | environment, stderr=subprocess.PIPE, text=True)
    print(run.stderr, end="")
    assert run.returncode == 0, f"exit code {run.returncode}"
    return run.stderr.splitlines()[0]  # names the device


def read(name, what):
    return json.loads((FOLDER / name / f"{what}.json").read_text())


def qualities(name):
    """The value of each quality, by what was asked for (a case's id holds the class of its device) and KEY."""
    asked = {case["id"]: json.dumps([case["experiment"], case["scene"], case["given"]])
             for case in read(name, "plan")["cases"]}
    with open(FOLDER / name / "records.csv", newline="") as file:
        return {(asked[row["case"]], *(row[column] for column in KEY)): row["value"]
                for row in csv.DictReader(file)
                if not UNITS_OF_TIME.fullmatch(row["unit"]) and not OWN_COUNTS.fullmatch(row["metric"])}


def compare(name, without=(), tolerance=0.0):
    expected, found = qualities("software"), qualities(name)
    left_out = tuple(f'["sweep/{kind}-{config}"' for config in without for kind in ("smoke", "drivers"))
    expected = {key: value for key, value in expected.items() if not key[0].startswith(left_out)}
    def differs(key):
        values = expected.get(key), found.get(key)
        if values[0] == values[1]:
            return False
        # A percentile is the difference of one pixel, of which no mean takes the edge.
        allowed = 10 * tolerance if key[-1].startswith("error_p") else tolerance
        return None in values or not abs(float(values[0]) - float(values[1])) <= allowed * abs(float(values[0]))

    differing = [key for key in expected.keys() | found.keys() if differs(key)]
    for key in differing[:20]:
        print(*key, "software:", expected.get(key), f"{name}:", found.get(key))
    print(f"{len(expected)} qualities, {len(differing)} differ")
    assert expected and not differing


def find_hazards(file):
    lines = set(file.read_text().splitlines())
    hazards = sorted(line for line in lines if line.startswith("hazard: ") and
                     not ("reads back within a frame" in line and line.endswith(tuple(READ_IN_FRAMES))))
    print(*hazards, sep="\n")
    print(f"{len(lines) - len(hazards)} programs drew or were dispatched, {len(hazards)} hazards")
    assert len(lines) > len(hazards) and not hazards


def storage_blocks(texts):
    """How many blocks the doctor asks of each stage, and how many a shader of it has at most."""
    asked = re.search(r"kUsedStorageBlocks\{(.*?)\}", (SOURCE / "runner/cli/advice.cpp").read_text(), re.DOTALL)[1]
    stages = {"vertex": "vert", "tessellationControl": "tesc", "tessellationEvaluation": "tese", "fragment": "frag", "compute": "comp"}
    asked = {stages[stage]: int(count) for stage, count in re.findall(r"\.(\w+) = (\d+)", asked)}
    has = {stage: max(sum(bool(STORAGE_BLOCK.match(line)) for line in text) for text in texts[stage]) for stage in asked}
    return asked, has


def compile_strictly():
    validator = shutil.which("glslangValidator") or skip("glslangValidator is not here (scripts/setup --tests installs it)")
    programs = {}
    for file in PROGRAMS.iterdir():
        programs.setdefault(file.stem, []).append(file)
    commands = [[validator, *options, *stages] for _, stages in sorted(programs.items())
                for options in (["-l"], ["-G", "-l", "--aml", "--amb", "-o", os.devnull])]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        runs = list(pool.map(lambda command: subprocess.run(command, capture_output=True, text=True), commands))
    refused = [run for run in runs if run.returncode != 0 or "WARNING" in run.stdout]
    for run in refused:
        print(*run.args, run.stdout, run.stderr)
    texts = {}
    for stages in programs.values():
        for file in stages:
            texts.setdefault(file.suffix[1:], []).append(set(file.read_text().splitlines()))
    stage_files = sorted(file for folder in ("engine", "techniques") for stage in texts
                         for file in (SOURCE / folder).rglob(f"*.{stage}.glsl"))
    asked, has = storage_blocks(texts)
    print(f"storage blocks of a stage: {has}")
    assert asked == has, f"doctor asks for {asked}"
    unseen = [file for file in stage_files if not any(lines_of(file) <= text for text in texts[file.suffixes[-2][1:]])]
    print(f"{len(programs)} programs, {len(refused)} refused; {len(stage_files)} files of stages, {len(unseen)} in none:")
    print(*unseen, sep="\n")
    assert programs and not refused and not unseen


def lines_of(file):
    """Those that are the same in every program."""
    return {line for line in file.read_text().splitlines() if not line.startswith("#")}


if WHAT == "software":
    shutil.rmtree(PROGRAMS, ignore_errors=True)
    PROGRAMS.mkdir(parents=True)
    HAZARDS.unlink(missing_ok=True)
    keeping = {"LD_PRELOAD": ":".join(LIBRARY), "KEPT_PROGRAMS": str(PROGRAMS), "HAZARDS": str(HAZARDS)}
    measure("software", "software", keeping)
    preview = [PROGRAM, "scene", "shapes/torus", "--device", "software", "--render", FOLDER / "preview.png"]
    subprocess.run(preview, env=os.environ | keeping, check=True)
elif WHAT == "zink":
    vulkan = list(LAVAPIPE.glob("lvp_icd*.json")) or skip("Mesa's lavapipe is not here (scripts/setup --tests installs it)")
    mesa = int(read("software", "manifest")["gl"]["mesa_version"].split(".")[0])
    without = ZINK_22_FAILS if mesa < 25 else []
    device = measure("zink", "software", {"MESA_LOADER_DRIVER_OVERRIDE": "zink", "LIBGL_ALWAYS_SOFTWARE": "1",
                                          "VK_ICD_FILENAMES": str(vulkan[0]), "NODEVICE_SELECT": "1",
                                          "XDG_RUNTIME_DIR": str(FOLDER)},
                     without)
    assert "zink" in device, device
    # A last bit of a picture's values is the compiler's: means of them moved by up to 1e-6.
    compare("zink", without, tolerance=1e-5)
elif WHAT == "hazards":
    find_hazards(HAZARDS)
elif WHAT == "gpu":
    hazards = FOLDER / "hazards-gpu.txt"
    hazards.unlink(missing_ok=True)
    device = measure("gpu", "gpu", {"LD_PRELOAD": ":".join(LIBRARY), "HAZARDS": str(hazards)})
    assert "Pretended GPU" in device, device
    find_hazards(hazards)
    compare("gpu")
else:
    compile_strictly()

"""scripts/measure-reference keeps what is complete, goes on with what is not, and takes what decides most first."""

import importlib.machinery
import importlib.util
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

SOURCE, PROGRAM = (pathlib.Path(argument) for argument in sys.argv[1:3])

CONFIG = """table: {paper}/{number}
title: A table
technique: mock
output: {{width: 8, height: 8}}
params: {{pause_ms: {pause_ms}}}
sweep: {{number: [1, 2, 3]}}
measure: {{lane: quality}}
layout: {{rows: [number], columns: {{number: {{metric: number}}}}}}
claims:
{claims}
"""
CLAIM = "  {name}: {{says: it grows, origin: {origin}, trend: number, over: number, direction: increasing}}\n"


def table(root, number, pause_ms, origins):
    claims = "".join(CLAIM.format(name=f"c{i}", origin=origin) for i, origin in enumerate(origins))
    file = root / "configs" / "paper" / f"table-{number}.yaml"
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(CONFIG.format(paper="paper", number=number, pause_ms=pause_ms, claims=claims), encoding="utf-8")
    return file


def started(root, *arguments, **options):
    environment = {**os.environ, "GFXREPRO_ROOT": str(root), "GFXREPRO_DATA": str(root)}
    return subprocess.Popen([SOURCE / "scripts/measure-reference", *arguments], env=environment, text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options)


def measure(root, *arguments, program=PROGRAM, **options):
    process = started(root, "--program", program, "--name", "mock", *arguments, **options)
    out, err = process.communicate(timeout=120)
    return process.returncode, out, err


def script():
    """The script as a module."""
    sys.dont_write_bytecode = True
    loader = importlib.machinery.SourceFileLoader("measure_reference", str(SOURCE / "scripts/measure-reference"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("measure_reference", loader))
    loader.exec_module(module)
    return module


def processes_of(text):
    """Those that live and have the text in their command line."""
    return [file for file in pathlib.Path("/proc").glob("[0-9]*/cmdline") if text in read_if_there(file)]


def read_if_there(file):
    try:
        return file.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return ""


def wait_until(is_so, what):
    for _ in range(400):
        if is_so():
            return
        time.sleep(0.05)
    raise AssertionError(what)


def rows_of(kept, file, table):
    return [row for row in script().keeping.rows_of(kept / f"{file}.csv") if row["table"] == table]


def lines_of(out):
    return [line.removeprefix("measure-reference: ") for line in out.splitlines() if line.startswith("measure-reference: ")]


with tempfile.TemporaryDirectory() as folder:
    root = pathlib.Path(folder)
    (root / "results").mkdir()
    (root / "configs/scenes").mkdir(parents=True)
    mark = "<!-- begin verdicts (by a script) -->\n<!-- end verdicts -->\n"
    (root / "README.md").write_text(mark, encoding="utf-8")
    (root / "results/README.md").write_text(mark, encoding="utf-8")
    (root / "scripts").mkdir()
    (root / "scripts/update_verdicts").symlink_to(SOURCE / "scripts/update_verdicts")
    quick = table(root, 1, 0, ["ours"])
    slow = table(root, 2, 1500, ["document", "ours"])

    # The table with more claims of its document has the first turn, which is too short for it.
    code, out, err = measure(root, "--budget", "20s", "--piece", "3s", "paper")
    kept = root / "results/reference/mock/paper"
    assert code == 0, (code, out, err)
    assert [line.split(":")[0] for line in lines_of(out)] == ["paper-table-1", "paper-table-2"], out
    for name in ("paper/1", "paper/2"):
        assert {row["verdict"] for row in rows_of(kept, "claims", name)} == {"holds"}, name
        assert [cell["measured"] for cell in rows_of(kept, "cells", name)] == ["1", "2", "3"], name
        line, = rows_of(kept, "runs", name)
        assert line["command"] == f"gfxrepro reproduce {name.replace('/', '/table-')} --profile paper --device auto", line
    run, = (root / "runs/reference").glob("*/paper/paper-table-2")
    assert len(script().json_of(run / "manifest.json")["invocations"]) > 1, "table 2 was not gone on with"
    assert sorted(file.name for file in kept.iterdir()) == ["cells.csv", "claims.csv", "runs.csv"]

    readme = (root / "results/README.md").read_text(encoding="utf-8")
    assert readme.count("| mock | [paper](reference/mock/paper.md) | 2 | ") == 1, readme
    verdicts = (root / "results/reference/mock/paper.md").read_text(encoding="utf-8")
    assert "**holds** it grows (c0)" in verdicts and "**holds** it grows (c1, " in verdicts, verdicts

    # A call that has no time left says what is left and keeps nothing twice.
    code, out, err = measure(root, "--budget", "0.01s", "--profile", "full", "paper/2")
    assert code == 4 and lines_of(out)[-1].startswith("left: paper/table-2; "), (code, out, err)
    assert not (root / "results/reference/mock/full").exists()

    # A piece in which no case ends is not tried again for ever.
    code, out, err = measure(root, "--piece", "0.5s", "--profile", "full", "paper/2")
    assert code == 4 and "no case ended within a piece" in out, (code, out, err)

    for arguments, message in ((["--budget", "soon"], "'soon' is not a time; allowed: 90s, 20m, 1.5h"),
                               (["--name", "../x"], "'../x' is no name; allowed: small letters, digits, '.' and '-'")):
        code, out, err = measure(root, *arguments)
        assert code == 2 and message in err, (code, err)
    code, out, err = measure(root, "--device", "17", "paper/1")
    assert code in (2, 3) and "17" in err, (code, out, err)

    # SIGTERM ends what was started, too; the run is gone on with.
    table(root, 3, 200, ["document", "ours"])
    runs = root / "runs/reference"
    process = started(root, "--program", PROGRAM, "--name", "mock", "--profile", "full", "paper/3")
    wait_until(lambda: any('"start"' in read_if_there(log) for log in runs.glob("*/full/paper-table-3/journal.jsonl")), "no case began")
    process.send_signal(signal.SIGTERM)
    out, err = process.communicate(timeout=60)
    assert process.returncode == 130 and "Traceback" not in err, (process.returncode, out, err)
    wait_until(lambda: not processes_of(folder), "what was started goes on")

    # A run is in the folder of its device, however that was asked for.
    run, = runs.glob("*/full/paper-table-3")
    module = script()
    keeping = module.keeping
    assert run.parent.parent.name == keeping.device_name(module.json_of(run / "manifest.json"), keeping.clock_ghz()), run
    began = module.json_of(run / "manifest.json")["started"]
    code, out, err = measure(root, "--profile", "full", "--budget", "0.01s", "--device", "software", "paper/3")
    assert code == 4 and list(runs.glob("*/full/paper-table-3*")) == [run], (code, out, err)

    # By another build or of another device it is set aside, and the table begins anew.
    shutil.copytree(next(folder / "shaders" for folder in PROGRAM.parents if (folder / "shaders").is_dir()), root / "shaders")
    (root / "shaders/another.glsl").touch()
    code, out, err = measure(root, "--profile", "full", "paper/1", "paper/3")
    assert code == 0 and "set aside as paper-table-3.1" in out, (code, out, err)
    assert "paper-table-3: begun anew: the run that is there is by another build, " in out, out
    kept = root / "results/reference/mock/full"
    assert module.json_of(run.with_name("paper-table-3.1") / "manifest.json")["started"] == began
    assert rows_of(kept, "runs", "paper/3")[0]["started"] != began

    # What is kept is not measured again by any build, unless that is asked for; then from the start.
    shutil.rmtree(root / "shaders")
    code, out, err = measure(root, "--profile", "full", "paper/1", "paper/3")
    assert code == 0 and lines_of(out)[0] == "kept already: paper/table-3 paper/table-1; --again measures them anew", (code, out, err)
    assert not run.with_name("paper-table-1.1").exists()
    for _ in range(2):  # by the other build, then by the same
        code, out, err = measure(root, "--profile", "full", "--again", "paper/1")
        assert code == 0 and "paper-table-1: begun anew: " in out and "paper-table-1: kept" in out, (code, out, err)
    assert "begun anew: the run that is there is kept; set aside as paper-table-1.2" in out, out

    # That of another device by the same name is none of this one.
    lines = (kept / "runs.csv").read_text(encoding="utf-8")
    manifest = module.json_of(run.with_name("paper-table-1") / "manifest.json")
    (kept / "runs.csv").write_text(lines.replace(manifest["cpu"], "Another Processor"), encoding="utf-8")
    (run.with_name("paper-table-1") / "manifest.json").write_text(json.dumps({**manifest, "cpu": "Another Processor"}), encoding="utf-8")
    code, out, err = measure(root, "--profile", "full", "paper/1")
    assert code == 0 and "begun anew: the run that is there is of another device, llvmpipe" in out, (code, out, err)
    assert rows_of(kept, "runs", "paper/1")[0]["cpu"] == manifest["cpu"]

    # What did not finish is not kept, also where whoever starts the script ignores the ends of children.
    table(root, 4, "0, behaviour: throw", ["ours"])
    for options in ({}, {"preexec_fn": lambda: signal.signal(signal.SIGCHLD, signal.SIG_IGN)}):
        code, out, err = measure(root, "--profile", "full", "paper/4", **options)
        assert code == 4 and "paper-table-4: exit code 4: not kept" in out, (code, out, err)
        assert not rows_of(kept, "runs", "paper/4"), options

    # Where it cannot be built, and where there is no such program.
    build = root / "scripts/reproduce-paper-tables"
    build.write_text("#!/bin/sh\necho 'setup: apt-get is not here' >&2\nexit 2\n", encoding="utf-8")
    build.chmod(0o755)
    process = started(root, "paper/1")
    out, err = process.communicate(timeout=60)
    assert process.returncode == 2, (process.returncode, err)
    assert err == ("setup: apt-get is not here\n"
                   "measure-reference: gfxrepro was not built; --program FILE names one that is built already\n"), err
    code, out, err = measure(root, "paper/1", program=root / "nowhere")
    assert code == 2 and f"'{root}/nowhere' is no program that can be run" in err, (code, err)

# Names of devices: two chips have two, and those of kept results stay what they are.
for renderer, name in (
        ("NVIDIA H100 80GB HBM3/PCIe/SSE2", "nvidia-h100-80gb-hbm3"),
        ("NVIDIA TITAN V/PCIe/SSE2", "nvidia-titan-v"),
        ("Mesa Intel(R) Arc(tm) A770 Graphics (DG2)", "mesa-intel-arc-a770-graphics"),
        ("Mesa Intel(R) UHD Graphics 620 (KBL GT2)", "mesa-intel-uhd-graphics-620"),
        ("Mesa Intel(R) Graphics (RPL-P)", "mesa-intel-graphics-rpl-p"),
        ("Mesa Intel(R) Iris(R) Xe Graphics (TGL GT2)", "mesa-intel-iris-xe-graphics-tgl-gt2"),
        ("AMD Radeon Graphics (radeonsi, renoir, LLVM 15.0.6, DRM 3.49, 6.1.0-13-amd64)", "amd-radeon-graphics-renoir"),
        ("AMD Radeon Graphics (radeonsi, raphael_mendocino, ACO, DRM 3.57, 6.8.0)", "amd-radeon-graphics-raphael-mendocino"),
        ("AMD Radeon(TM) Graphics (renoir, LLVM 15.0.7, DRM 3.49, 6.1.0)", "amd-radeon-graphics-renoir"),
        ("AMD RENOIR (DRM 3.40.0, 5.10.0-28-amd64, LLVM 11.0.1)", "amd-renoir"),
        ("AMD Radeon RX 6800 XT (radeonsi, navi21, LLVM 15.0.7, DRM 3.49, 6.1.0)", "amd-radeon-rx-6800-xt"),
        ("zink Vulkan 1.3(AMD Radeon Graphics (RADV RENOIR))", "zink-amd-radeon-graphics-radv-renoir"),
        ("D3D12 (NVIDIA GeForce RTX 3080)", "d3d12-nvidia-geforce-rtx-3080")):
    manifest = {"device_class": "gpu", "gl": {"renderer": renderer}}
    assert script().keeping.device_name(manifest, 2.6) == name, (renderer, script().keeping.device_name(manifest, 2.6))
kept = list((SOURCE / "results/reference").glob("*/*/runs.csv"))
assert kept
for file in kept:
    name = file.parent.parent.name
    ghz = re.search(r"-([\d.]+)ghz-", name)
    for line in script().keeping.rows_of(file):
        gl = {"renderer": line["device"], "mesa_version": line["gl"].rpartition("Mesa ")[2]}
        manifest = {"device_class": line["class"], "gl": gl, "cpu": line["cpu"], "cores": line["cores"]}
        assert script().keeping.device_name(manifest, float(ghz[1]) if ghz else 2.6) == name, line

"""scripts/keep takes every cell of a run, puts it in the place of the same table, and refuses what nobody could measure again."""

import csv
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

SOURCE, PROGRAM = (pathlib.Path(argument) for argument in sys.argv[1:3])

CONFIG = """table: paper/{number}
title: A table
technique: mock
output: {{width: 8, height: 8}}
params: {{{params}}}
sweep: {{number: [1, 2]}}
measure: {{lane: quality}}
layout:
  rows: [number]
  columns: {{value: {{metric: number}}, both: {{metric: number, format: "{{min}}/{{max}}"}}}}
printed: {{values: "number,value\\n1,1.5\\n"}}
claims: {{grows: {{says: it grows, origin: ours, trend: value, over: number, direction: increasing}}}}
"""
MARK = "<!-- begin verdicts (by a script) -->\n<!-- end verdicts -->\n"


def keep(*arguments):
    said = subprocess.run([SOURCE / "scripts/keep", *arguments], env={**os.environ, "GFXREPRO_ROOT": str(root)}, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    return said.returncode, said.stdout, said.stderr


def measured(number, params="pause_ms: 0", code=0):
    file = root / "configs/paper" / f"table-{number}.yaml"
    file.write_text(CONFIG.format(number=number, params=params), encoding="utf-8")
    run = root / f"run-{number}"
    shutil.rmtree(run, ignore_errors=True)
    said = subprocess.run([PROGRAM, "reproduce", file, "--out", run, "--quiet"], env={**os.environ, "GFXREPRO_DATA": str(root)},
                          stdout=subprocess.DEVNULL)
    assert said.returncode == code, said.returncode
    return run


def kept(file):
    with open(root / "results/reference/mock/full" / f"{file}.csv", encoding="utf-8", newline="") as lines:
        return list(csv.DictReader(lines))


def git(*arguments):
    return subprocess.run(["git", "-c", "user.name=A", "-c", "user.email=a@b", "-C", root, *arguments], check=True, text=True,
                          stdout=subprocess.PIPE).stdout.strip()


with tempfile.TemporaryDirectory() as folder:
    root = pathlib.Path(folder)
    for name in ("results/sensitivity", "scripts", "configs/paper", "configs/scenes"):
        (root / name).mkdir(parents=True)
    for name in ("README.md", "results/README.md"):
        (root / name).write_text(MARK, encoding="utf-8")
    (root / "scripts/update_verdicts").symlink_to(SOURCE / "scripts/update_verdicts")
    one, two = measured(1), measured(2)

    # Every cell, with what is printed beside it; the command without folders of this machine.
    code, out, err = keep("--name", "mock", one, two)
    assert code == 0, (code, out, err)
    cells = [cell for cell in kept("cells") if cell["table"] == "paper/1"]
    said = [(cell["row"], cell["column"], cell["printed"], cell["measured"]) for cell in cells]
    assert said == [("number=1", "value", "1.5", "1"), ("number=1", "both_min", "", "1"), ("number=1", "both_max", "", "1"),
                    ("number=2", "value", "", "2"), ("number=2", "both_min", "", "2"), ("number=2", "both_max", "", "2")], said
    assert [run["table"] for run in kept("runs")] == ["paper/1", "paper/2"] and folder not in kept("runs")[0]["command"].split("--")[1:], kept("runs")
    assert "--out" not in kept("runs")[0]["command"], kept("runs")
    assert [(claim["table"], claim["verdict"]) for claim in kept("claims")] == [("paper/1", "holds"), ("paper/2", "holds")]
    assert "**holds** it grows (grows, ours)" in (root / "results/reference/mock/full.md").read_text(encoding="utf-8")

    # Of the same table once more it takes the place; another table stays as it was.
    before = [run for run in kept("runs") if run["table"] == "paper/2"]
    manifest = json.loads((one / "manifest.json").read_text(encoding="utf-8"))
    (one / "manifest.json").write_text(json.dumps({**manifest, "started": "2030-01-01T00:00:00Z"}), encoding="utf-8")
    assert keep("--name", "mock", "--command", "gfxrepro reproduce paper/1", one)[0] == 0
    assert [run["command"] for run in kept("runs") if run["started"].startswith("2030")] == ["gfxrepro reproduce paper/1"]
    assert [run for run in kept("runs") if run["table"] == "paper/2"] == before and len(kept("cells")) == 12

    # What is refused leaves everything as it was, also what is named before it.
    crash = measured(3, "pause_ms: 0, behaviour: throw", code=4)
    half = root / "half"
    shutil.copytree(two, half)
    lines = (half / "records.csv").read_text(encoding="utf-8").splitlines(keepends=True)
    case = lines[-1].split(",")[1]
    (half / "records.csv").write_text("".join(line for line in lines if f",{case}," not in line), encoding="utf-8")
    bare = root / "bare"
    shutil.copytree(two, bare)
    shutil.rmtree(bare / "tables")
    state = kept("runs"), kept("cells"), kept("claims")
    for run, message in ((root / "nowhere", f"{root}/nowhere is no run directory: No such file or directory: {root}/nowhere/manifest.json"),
                         (crash, f"{crash}: paper/3, number=1, value: error"),
                         (half, f"{half} has 1 of 2 cases left: gfxrepro run --resume {half}"),
                         (bare, f"{bare} has no table of paper/2: gfxrepro tables {bare}")):
        assert keep("--name", "mock", one, run) == (2, "", f"keep: {message}; nothing is kept\n"), keep("--name", "mock", one, run)
    code, out, err = keep("--name", "A b", one)
    assert code == 2 and "'A b' is no name; allowed: small letters, digits, '.' and '-'" in err, (code, err)

    # In a repository: by a program that it can build again.
    git("init", "-q")
    git("add", "README.md")
    git("commit", "-q", "-m", "a")
    commit = git("rev-parse", "--short=12", "HEAD")
    for found, message in ((commit + "-dirty", f"{one} was measured by a program built from changed files ({commit}-dirty)"),
                           ("0123456789ab", f"{one} was measured by a program of the commit 0123456789ab, which is not in the history of this repository")):
        (one / "manifest.json").write_text(json.dumps({**manifest, "commit": found}), encoding="utf-8")
        assert keep("--name", "mock", one) == (2, "", f"keep: {message}; nothing is kept\n"), keep("--name", "mock", one)
    assert (kept("runs"), kept("cells"), kept("claims")) == state
    (one / "manifest.json").write_text(json.dumps({**manifest, "commit": commit}), encoding="utf-8")
    assert keep("--name", "mock", one)[0] == 0 and kept("runs")[0]["commit"] == commit

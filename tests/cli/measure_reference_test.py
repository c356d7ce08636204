"""scripts/measure-reference keeps what is complete, goes on with what is not, and takes what decides most first."""

import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile

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


def measure(root, *arguments):
    environment = {**os.environ, "GFXREPRO_ROOT": str(root), "GFXREPRO_DATA": str(root)}
    result = subprocess.run([SOURCE / "scripts/measure-reference", "--program", PROGRAM, "--name", "mock", *arguments],
                            env=environment, capture_output=True, text=True, timeout=120)
    return result.returncode, result.stdout, result.stderr


def lines_of(out):
    return [line.removeprefix("measure-reference: ") for line in out.splitlines() if line.startswith("measure-reference: ")]


with tempfile.TemporaryDirectory() as folder:
    root = pathlib.Path(folder)
    (root / "results").mkdir()
    (root / "configs/scenes").mkdir(parents=True)
    mark = "<!-- begin verdicts (by a script) -->\n<!-- end verdicts -->\n"
    (root / "README.md").write_text(mark, encoding="utf-8")
    (root / "results/README.md").write_text("| folder | on | by |\n| --- | --- | --- |\n| reference/other/quick | x | y |\n\n" + mark,
                                            encoding="utf-8")
    (root / "scripts").mkdir()
    (root / "scripts/update_verdicts").symlink_to(SOURCE / "scripts/update_verdicts")
    quick = table(root, 1, 0, ["ours"])
    slow = table(root, 2, 1500, ["document", "ours"])

    # The table with more claims of its document has the first turn, which is too short for it.
    code, out, err = measure(root, "--budget", "20s", "--piece", "3s", "paper")
    kept = root / "results/reference/mock/paper"
    assert code == 0, (code, out, err)
    assert [line.split(":")[0] for line in lines_of(out)] == ["paper-table-1", "paper-table-2"], out
    for name in ("paper-table-1", "paper-table-2"):
        with open(kept / name / "claims.csv", encoding="utf-8", newline="") as rows:
            assert {row["verdict"] for row in csv.DictReader(rows)} == {"holds"}, name
        assert list((kept / name / "tables").glob("*.csv")) and list((kept / name / "tables").glob("*.md"))
        manifest = (kept / name / "manifest.json").read_text(encoding="utf-8")
        assert folder not in manifest, manifest
    assert len(json.loads(manifest)["invocations"]) > 1, "table 2 was not gone on with"
    assert not list(kept.glob("*/records.csv"))

    readme = (root / "results/README.md").read_text(encoding="utf-8")
    assert readme.count("| reference/mock/paper/TABLE | ") == 1, readme
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

"""What results/reference keeps of the profile quick are the values of this program: kept_values_test.py SOURCE PROGRAM [all].

Fast tables, one of each technique, are measured again; with `all`, each kept table of a document whose cases are not timed. What is no
time depends on the program and the driver alone, so that each cell is the kept one to 1e-4 of it. Skipped where another driver draws.
"""

import importlib.machinery
import importlib.util
import json
import math
import pathlib
import subprocess
import sys
import tempfile

SOURCE, PROGRAM = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
SAMPLE = ["xie2017/4.3", "xie2017/figure-16", "xie2017/figure-18", "xie2017/figure-22", "xie2017/figure-36", "zhang2012/figure-12",
          "zju2005/4.3", "zju2005/figure-2.6", "zju2005/figure-3.14"]
TOLERANCE = 1e-4
SKIPPED = 77


def load_keep():
    loader = importlib.machinery.SourceFileLoader("keep", str(SOURCE / "scripts" / "keep"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("keep", loader))
    sys.dont_write_bytecode = True
    loader.exec_module(module)
    return module


def key(cell):
    return cell["table"], cell["row"], cell["source"], cell["column"]


def is_same(kept, new):
    if not kept or not new:
        return kept == new
    try:
        return math.isclose(float(kept), float(new), rel_tol=TOLERANCE, abs_tol=1e-12)
    except ValueError:
        return kept == new


def main():
    keep = load_keep()
    folders = [file.parent for file in (SOURCE / "results" / "reference").glob("llvmpipe*/quick/runs.csv")]
    folder = max(folders, key=lambda one: len(keep.rows_of(one / "runs.csv")))
    runs = {run["table"]: run for run in keep.rows_of(folder / "runs.csv")}
    tables = SAMPLE
    if sys.argv[3:] == ["all"]:
        planned = json.loads(subprocess.run([PROGRAM, "plan", "--json", "--profile", "quick", "--device", "software",
                                             *(table for table in runs if not table.startswith("sweep/"))],
                                            check=True, capture_output=True, text=True).stdout)
        timed = {case["experiment"] for case in planned["cases"] if case["measure"]["lane"] == "timing"}
        tables = sorted({case["experiment"] for case in planned["cases"]} - timed)
    with tempfile.TemporaryDirectory() as scratch:
        run = pathlib.Path(scratch) / "run"
        done = subprocess.run([PROGRAM, "reproduce", *tables, "--profile", "quick", "--device", "software", "--quiet", "--out", run],
                              capture_output=True, text=True, check=False)
        if done.returncode not in (0, 1):
            sys.exit(f"exit code {done.returncode}\n{done.stdout}{done.stderr}")
        manifest = json.loads((run / "manifest.json").read_text(encoding="utf-8"))
        if manifest["gl"]["version"] != runs[tables[0]]["gl"]:
            print(f"another driver: {manifest['gl']['version']}, kept {runs[tables[0]]['gl']}")
            sys.exit(SKIPPED)
        new = {}
        for table in tables:
            for cell in keep.Cells(run / "tables" / f"{table.replace('/', '-')}.csv", table).rows:
                new[key(cell)] = cell
    kept = {key(cell): cell for cell in keep.rows_of(folder / "cells.csv") if cell["table"] in tables}
    differ = [f"{' | '.join(k)}: {what} kept {kept.get(k, {}).get(what)}, now {new.get(k, {}).get(what)}"
              for k in sorted(kept.keys() | new.keys()) for what in ("printed", "measured")
              if not is_same(kept.get(k, {}).get(what, ""), new.get(k, {}).get(what, ""))]
    measured = sum(bool(cell.get("measured")) for cell in new.values())
    print("\n".join([f"{measured} measured cells of {len(tables)} tables, {len(differ)} of them differ", *differ[:40]]))
    if differ or measured < 5 * len(tables):
        sys.exit("keep a run of this program (scripts/keep), or find what changed")


if __name__ == "__main__":
    main()

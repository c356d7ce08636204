"""A small document, its data folder and its runs, for the tests of what a run leaves."""

import os
import shutil
import subprocess

TABLE = """
table: demo2026/{number}
title: "{title}"
technique: mock
measure: {measure}
sweep:
  number: [1, 2, 3]
  behaviour: [ok, throw]
layout:
  rows: number
  columns: {{ok: {{where: {{behaviour: ok}}}}, throw: {{where: {{behaviour: throw}}}}{columns}}}
  cell: {{metric: number, format: "{{median:.1f}}"}}
plots: [{{x: number, y: ok}}]
printed:
  hardware: "a <machine>"
  values: |
    number,ok
    1,2.0
    2,2.0
claims:
  H: {{says: the first is small, origin: document, bound_from: text, bound: ok, at_most: 5, at: {{number: 1}}}}
  F: {{says: the third is small, origin: document, bound_from: text, bound: ok, at_most: 2, at: {{number: 3}},
      because: {{verdict: fails, reason: three is not below two}}}}
  U: {{says: what was thrown is small, origin: document, bound_from: text, bound: throw, at_most: 2}}
  G: {{says: on a GPU it is faster, origin: ours, bound: ok, at_most: 1, profile: paper}}
assumptions:
  view: {{value: front, range: front or back, why: the paper does not say}}
"""


def write(data, title, measure, columns="", behind_second=""):
    """Tables 1 and 2 of the document demo2026 as a data folder; what stands behind the second is of it alone."""
    (data / "configs" / "scenes").mkdir(parents=True)
    (data / "configs" / "demo2026").mkdir()
    (data / "shaders").mkdir()
    for number in (1, 2):
        text = TABLE.format(number=number, title=title, measure=measure, columns=columns)
        (data / "configs" / "demo2026" / f"table-{number}.yaml").write_text(text + (behind_second if number == 2 else ""))


def call(program, data, *arguments):
    return subprocess.run([program, *map(str, arguments)], env={**os.environ, "GFXREPRO_DATA": str(data)},
                          capture_output=True, text=True, check=False)


def reproduce(program, data, folder, name="demo2026"):
    """A run; half of its cases throw."""
    shutil.rmtree(folder, ignore_errors=True)
    result = call(program, data, "reproduce", name, "--device", "software", "--quiet", "--profile", "quick", "--out", folder)
    assert result.returncode == 4 and (folder / "report.html").exists(), result.stdout + result.stderr
    return folder

"""gfxrepro.load of a run of the mock program, beside what `export --tidy` writes of the same run."""

import contextlib
import csv
import math
import os
import pathlib
import re
import sqlite3
import subprocess
import tempfile
import unittest

import gfxrepro

CONFIG = """sweep_of: mine
title: Mine
technique: mock
sweep:
  number: [1, 2, 3]
  behaviour: [ok, throw]
measure: {lane: quality, repeats: 2}
layout: {rows: [number, behaviour], columns: {number: {metric: number}}}
"""


def program(*arguments):
    return subprocess.run([os.environ["GFXREPRO_MOCK_PROGRAM"], *map(str, arguments)], capture_output=True, text=True)


class Load(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        root = pathlib.Path(cls.folder.name)
        config = root / "mine.yaml"
        config.write_text(CONFIG)
        cls.run_folder = root / "run"
        ended = program("run", config, "--device", "software", "--out", cls.run_folder)
        assert ended.returncode == 4, ended.stderr  # three cases throw
        cls.tidy = root / "tidy"
        ended = program("export", cls.run_folder, "--tidy", "--out", cls.tidy)
        assert ended.returncode == 0, ended.stderr

    def rows_of(self, name):
        with open(self.tidy / name, newline="", encoding="utf-8") as stream:
            return list(csv.DictReader(stream))

    def test_types_are_kept(self):
        run = gfxrepro.load(self.run_folder, as_frames=False)
        self.assertEqual(len(run.cases), 6)
        self.assertEqual([(case["number"], case["behaviour"]) for case in run.cases][:3],
                         [(1, "ok"), (1, "throw"), (2, "ok")])
        self.assertIsInstance(run.cases[0]["number"], int)
        self.assertEqual(run.cases[0]["output.width"], 512)
        self.assertEqual(run.axes, {"sweep/mine": ["number", "behaviour"]})
        self.assertIn("commit", run.manifest)
        values = {row["case_id"]: row["value"] for row in run.records if row["metric"] == "number"}
        for case in run.cases:
            self.assertEqual(values.get(case["case_id"]), case["number"] if case["behaviour"] == "ok" else None)
        failed = [row for row in run.records if row["status"] == "error"]
        self.assertEqual(len(failed), 3)
        self.assertIsNone(failed[0]["value"])
        self.assertIn("nothing works", failed[0]["message"])

    def test_the_program_exports_the_same(self):
        run = gfxrepro.load(self.run_folder, as_frames=False)
        for own, exported in ((run.cases, self.rows_of("cases.csv")), (run.records, self.rows_of("records.csv"))):
            self.assertEqual(list(own[0]), list(exported[0]))
            self.assertEqual(len(own), len(exported))
            for a, b in zip(own, exported):
                for name, value in a.items():
                    self.assertNotIn("{", b[name])
                    if isinstance(value, bool):
                        self.assertEqual(b[name], "true" if value else "false")
                    elif isinstance(value, (int, float)):
                        self.assertEqual(float(b[name]), value)
                    else:
                        self.assertEqual(b[name], value or "")

    def test_frames_of_pandas(self):
        try:
            import pandas
        except ImportError:
            self.assertIsInstance(gfxrepro.load(self.run_folder).cases, list)
            with self.assertRaises(ImportError):
                gfxrepro.load(self.run_folder, as_frames=True)
            self.skipTest("pandas is not installed")
        run = gfxrepro.load(self.run_folder)
        self.assertIsInstance(run.cases, pandas.DataFrame)
        self.assertTrue(pandas.api.types.is_integer_dtype(run.cases["number"]))
        joined = run.records.merge(run.cases, on="case_id")
        medians = joined[joined["metric"] == "number"].groupby(run.axes["sweep/mine"])["value"].median()
        self.assertEqual(medians.to_dict(), {(1, "ok"): 1.0, (2, "ok"): 2.0, (3, "ok"): 3.0})
        self.assertTrue(math.isnan(run.records.loc[run.records["status"] == "error", "value"].iloc[0]))
        readme = (pathlib.Path(__file__).parents[2] / "python" / "README.md").read_text()
        lines = next(block for block in re.findall(r"```python\n(.*?)```", readme, re.DOTALL) if "sqlite3" in block)
        names = {"run": run, "sqlite3": sqlite3}
        exec(lines.replace("run.sqlite", ":memory:"), names)  # pylint: disable=exec-used
        with contextlib.closing(names["database"]) as database:
            found = database.execute("SELECT number, typeof(number), value FROM measured "
                                     "WHERE metric = 'number' ORDER BY number").fetchall()
            with self.assertRaises(sqlite3.IntegrityError):
                database.execute("INSERT INTO cases SELECT * FROM cases")
        self.assertEqual(found, [(number, "integer", float(number)) for number in (1, 2, 3)])

    def test_a_cut_unit_is_left_out_and_a_broken_one_is_named(self):
        with tempfile.TemporaryDirectory() as name:
            copy = pathlib.Path(name)
            for file in ("plan.json", "manifest.json"):
                (copy / file).write_bytes((self.run_folder / file).read_bytes())
            head, *rows = (self.run_folder / "records.csv").read_text().splitlines(keepends=True)
            # Units stand in the order in which they ended: one of several rows goes first.
            several = next(row for row in csv.DictReader([head, *rows]) if int(row["rows"]) > 2)
            rows.sort(key=lambda row: row.split(",")[1] != several["case"])
            lines = [head, *rows]
            whole = len(gfxrepro.load(self.run_folder, as_frames=False).records)
            (copy / "records.csv").write_text("".join(lines[:3]))
            self.assertEqual(gfxrepro.load(copy, as_frames=False).records, [])
            content = "".join(lines[:4]).encode()  # a write may end within any row
            for size in range(len(lines[0]), len(content)):
                (copy / "records.csv").write_bytes(content[:size])
                self.assertEqual(gfxrepro.load(copy, as_frames=False).records, [], content[:size][-30:])
            (copy / "records.csv").write_text("".join([lines[0], *lines[2:]]))
            with self.assertRaisesRegex(ValueError, r"records.csv:2: case c[0-9a-f]{12}, process 0 has \d+ of \d+ rows"):
                gfxrepro.load(copy, as_frames=False)
            (copy / "records.csv").write_text("".join(lines))
            self.assertEqual(len(gfxrepro.load(copy, as_frames=False).records), whole)

    def test_no_run(self):
        with tempfile.TemporaryDirectory() as name:
            with self.assertRaisesRegex(ValueError, r"is no run folder \(it has no plan.json\)"):
                gfxrepro.load(name)
            (pathlib.Path(name) / "plan.json").write_text("{")
            with self.assertRaisesRegex(ValueError, "plan.json: "):
                gfxrepro.load(name)


if __name__ == "__main__":
    unittest.main()

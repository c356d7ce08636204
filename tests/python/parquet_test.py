"""gfxrepro.parquet of a run of the mock program."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import gfxrepro
from gfxrepro import parquet

CONFIG = """sweep_of: mine
title: Mine
technique: mock
sweep:
  number: [1, 2]
  behaviour: [ok, throw]
measure: {lane: quality}
"""


class Parquet(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        root = pathlib.Path(cls.folder.name)
        (root / "mine.yaml").write_text(CONFIG)
        cls.run_folder = root / "run"
        subprocess.run([os.environ["GFXREPRO_MOCK_PROGRAM"], "run", root / "mine.yaml", "--device", "software", "--out",
                        cls.run_folder], capture_output=True, text=True)

    def test_types(self):
        self.assertEqual(parquet.typed([1, None, -2]), ("int64", [1, None, -2]))
        self.assertEqual(parquet.typed([1, 2**64 - 1]), ("uint64", [1, 2**64 - 1]))
        self.assertEqual(parquet.typed([True, None]), ("bool", [True, None]))
        self.assertEqual(parquet.typed([1, None, 0.5]), ("float64", [1.0, None, 0.5]))
        self.assertEqual(parquet.typed(["a", None]), ("string", ["a", None]))
        self.assertEqual(parquet.typed(["a", 1, True]), ("string", ["a", "1", "true"]))
        self.assertEqual(parquet.typed([None]), ("string", [None]))
        self.assertEqual(parquet.typed([]), ("string", []))
        run = gfxrepro.load(self.run_folder, as_frames=False)
        of = {name: parquet.typed([case[name] for case in run.cases])[0] for name in run.cases[0]}
        self.assertEqual((of["number"], of["behaviour"], of["output.width"]), ("int64", "string", "int64"))

    def test_without_arrow_it_says_what_to_install(self):
        with tempfile.TemporaryDirectory() as name:
            (pathlib.Path(name) / "pyarrow.py").write_text("raise ImportError\n")
            environment = os.environ | {"PYTHONPATH": f"{name}:{os.environ['PYTHONPATH']}"}
            ended = subprocess.run([sys.executable, "-m", "gfxrepro.parquet", self.run_folder, name],
                                   capture_output=True, text=True, env=environment)
            self.assertEqual(ended.returncode, 2)
            self.assertEqual(ended.stderr, "gfxrepro.parquet: Parquet is written by pyarrow, which is not installed; "
                                           "install it by: pip install pyarrow\n")
            self.assertFalse((pathlib.Path(name) / "cases.parquet").exists())
        ended = subprocess.run([sys.executable, "-m", "gfxrepro.parquet"], capture_output=True, text=True)
        self.assertEqual((ended.returncode, ended.stderr), (2, "usage: python -m gfxrepro.parquet RUN FOLDER\n"))

    def test_the_files_are_what_load_gives(self):
        try:
            import pyarrow.parquet
        except ImportError:
            self.skipTest("pyarrow is not installed")
        with tempfile.TemporaryDirectory() as name:
            gfxrepro.to_parquet(self.run_folder, pathlib.Path(name) / "new")
            run = gfxrepro.load(self.run_folder, as_frames=False)
            for file, rows in (("cases", run.cases), ("records", run.records)):
                table = pyarrow.parquet.read_table(pathlib.Path(name) / "new" / f"{file}.parquet")
                self.assertEqual(table.to_pylist(), rows)
                if file == "cases":
                    self.assertEqual(table.schema.field("number").type, pyarrow.int64())


if __name__ == "__main__":
    unittest.main()

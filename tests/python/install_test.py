"""The Python package of the checkout alone, installed by pip in fresh environments with no package index in reach."""

import email
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
VERSION = re.search(r"^project\(gfxrepro VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(), re.M)[1]


def python_with(module):
    """This Python, or else the system's, which has the modules of the system's packages."""
    for python in (sys.executable, "/usr/bin/python3"):
        if subprocess.run([python, "-c", f"import {module}"], capture_output=True).returncode == 0:
            return python
    raise unittest.SkipTest(f"{module} is not installed")


class Install(unittest.TestCase):
    def setUp(self):
        self.python = python_with("hatchling")
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "elsewhere").mkdir()
        # The version is the project's: what builds the package looks for it beside its folder.
        self.source = shutil.copytree(ROOT / "python", self.folder / "checkout" / "python",
                                      ignore=shutil.ignore_patterns("__pycache__"))
        shutil.copy(ROOT / "CMakeLists.txt", self.folder / "checkout")

    def run_in(self, *command):
        environment = {"PATH": os.environ["PATH"], "HOME": str(self.folder), "PIP_DISABLE_PIP_VERSION_CHECK": "1",
                       "PIP_INDEX_URL": "http://127.0.0.1:9/"}
        return subprocess.run(command, capture_output=True, text=True, env=environment, cwd=self.folder / "elsewhere")

    def files(self):
        return sorted(file for file in self.source.rglob("*") if "__pycache__" not in file.parts)

    def environment(self, name):
        """Its Python. Of what pip would load, it has what builds the package: as packages of the system."""
        made = self.run_in(self.python, "-m", "venv", "--system-site-packages", self.folder / name)
        if made.returncode != 0:
            self.skipTest(f"python3-venv is not installed: {made.stdout.strip()[:200]}")
        return self.folder / name / "bin" / "python"

    def install(self, python, source):
        return self.run_in(python, "-m", "pip", "install", "--no-build-isolation", source)

    def test_pip_installs_the_checkout_without_a_network(self):
        python = self.environment("env")
        before = self.files()
        installed = self.install(python, self.source)
        self.assertEqual(installed.returncode, 0, installed.stderr)
        self.assertEqual(self.files(), before)  # a checkout stays as it is
        script = "import gfxrepro; print(gfxrepro.__file__, gfxrepro.__version__); gfxrepro.emit('a', 1, 'ms')"
        used = self.run_in(python, "-c", script)
        self.assertEqual(used.returncode, 0, used.stderr)
        where, line = used.stdout.splitlines()
        self.assertTrue(where.startswith(str(self.folder / "env")), where)
        self.assertTrue(where.endswith(" " + VERSION), where)
        self.assertEqual(line, '{"metric": "a", "value": 1, "unit": "ms"}')
        self.assertIn("no attribute 'nothing'", self.run_in(python, "-c", "import gfxrepro; gfxrepro.nothing").stderr)
        shown = self.run_in(python, "-m", "pip", "show", "--files", "gfxrepro").stdout
        for line in (f"Version: {VERSION}", "License: Apache-2.0", "Author: gfxrepro developers", "  gfxrepro/load_run.py",
                     "  gfxrepro/py.typed", f"  gfxrepro-{VERSION}.dist-info/licenses/LICENSE"):
            self.assertIn(line, shown.splitlines())
        # There is no program in it, and so no command.
        self.assertFalse((self.folder / "env" / "bin" / "gfxrepro").exists())
        started = self.run_in(python, "-m", "gfxrepro", "doctor")
        self.assertEqual((started.returncode, started.stdout), (2, ""))
        self.assertRegex(started.stderr, r"\Agfxrepro: .*/program/gfxrepro: No such file or directory; the Python package "
                                         r"alone has no program, a release's wheel has it\n\Z")
        removed = self.run_in(python, "-m", "pip", "uninstall", "--yes", "gfxrepro")
        self.assertEqual(removed.returncode, 0, removed.stderr)

    def test_a_source_archive_says_of_itself_what_an_index_reads(self):
        made = subprocess.run([self.python, "-m", "hatchling", "build", "-t", "sdist", "-d", self.folder], cwd=self.source,
                              capture_output=True, text=True)
        self.assertEqual(made.returncode, 0, made.stderr)
        archive = self.folder / f"gfxrepro-{VERSION}.tar.gz"
        with tarfile.open(archive) as files:
            said = email.message_from_binary_file(files.extractfile(f"gfxrepro-{VERSION}/PKG-INFO"))
        self.assertEqual((said["Name"], said["Version"], said["License"]), ("gfxrepro", VERSION, "Apache-2.0"))
        self.assertEqual((said["Requires-Python"], said["Description-Content-Type"]), (">=3.11", "text/markdown"))
        self.assertIn("gfxrepro.load(", said.get_payload())
        python = self.environment("from-archive")
        installed = self.install(python, archive)
        self.assertEqual(installed.returncode, 0, installed.stderr)
        self.assertEqual(self.run_in(python, "-c", "import gfxrepro; print(gfxrepro.__version__)").stdout, VERSION + "\n")

    def test_a_folder_without_its_checkout_is_refused(self):
        (self.folder / "checkout" / "CMakeLists.txt").unlink()
        refused = self.install(self.environment("refused"), self.source)
        self.assertNotEqual(refused.returncode, 0)
        self.assertIn("which says the version, is not there: install from the whole checkout", refused.stderr)


if __name__ == "__main__":
    unittest.main()

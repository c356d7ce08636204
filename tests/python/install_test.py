"""`pip install ./python` in a fresh environment, with no package index in reach."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

PACKAGE = pathlib.Path(__file__).resolve().parents[2] / "python"


class Install(unittest.TestCase):
    def test_pip_installs_the_checkout_without_a_network(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            made = subprocess.run([sys.executable, "-m", "venv", folder / "env"], capture_output=True, text=True)
            if made.returncode != 0:
                self.skipTest(f"python3-venv is not installed: {made.stdout.strip()[:200]}")
            source = shutil.copytree(PACKAGE, folder / "python")  # pip writes beside it
            environment = {"PATH": os.environ["PATH"], "HOME": name, "PIP_DISABLE_PIP_VERSION_CHECK": "1",
                           "PIP_INDEX_URL": "http://127.0.0.1:9/"}
            python = folder / "env" / "bin" / "python"
            installed = subprocess.run([python, "-m", "pip", "install", source], capture_output=True, text=True,
                                       env=environment, cwd=name)
            self.assertEqual(installed.returncode, 0, installed.stderr)
            script = "import gfxrepro; print(gfxrepro.__file__); gfxrepro.emit('a', 1, 'ms')"
            used = subprocess.run([python, "-c", script], capture_output=True, text=True, env=environment, cwd=name)
            self.assertEqual(used.returncode, 0, used.stderr)
            where, line = used.stdout.splitlines()
            self.assertTrue(where.startswith(str(folder / "env")), where)
            self.assertEqual(line, '{"metric": "a", "value": 1, "unit": "ms"}')
            shown = subprocess.run([python, "-m", "pip", "show", "--files", "gfxrepro"], capture_output=True, text=True,
                                   env=environment, cwd=name)
            self.assertIn("Version: 0.1.0", shown.stdout)
            self.assertIn("gfxrepro/load_run.py", shown.stdout)
            checked = subprocess.run([python, "-m", "pip", "uninstall", "--yes", "gfxrepro"], capture_output=True,
                                     text=True, env=environment, cwd=name)
            self.assertEqual(checked.returncode, 0, checked.stderr)


if __name__ == "__main__":
    unittest.main()

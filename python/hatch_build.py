"""What pip asks of the build that pyproject.toml cannot say: the version, and a wheel that carries the program, too.

Where gfxrepro/program/ has a bundle (scripts/release puts it there) the wheel is of this machine's kind and has the command
`gfxrepro`; elsewhere it is the Python package alone.
"""

import pathlib
import platform
import re
import subprocess

from hatchling.builders.hooks.plugin.interface import BuildHookInterface
from hatchling.metadata.plugin.interface import MetadataHookInterface

ROOT = pathlib.Path(__file__).resolve().parent
PROGRAM = ROOT / "gfxrepro" / "program" / "gfxrepro"


def version():
    """As the top CMakeLists.txt says it; in a source archive, which has none, as its PKG-INFO does."""
    for file, pattern in ((ROOT / "PKG-INFO", r"^Version: (.+)$"), (ROOT.parent / "CMakeLists.txt", r"^project\(gfxrepro VERSION (\S+)")):
        if file.is_file() and (found := re.search(pattern, file.read_text(encoding="utf-8"), re.M)):
            return found[1]
    raise OSError(f"{ROOT.parent / 'CMakeLists.txt'}, which says the version, is not there: install from the whole checkout")


def tag():
    """The oldest C library that has all that the program and the libraries beside it ask of it, as PEP 600 says it."""
    files = [PROGRAM, *sorted(file for file in (PROGRAM.parent / "lib").iterdir() if file.is_file())]
    needs = subprocess.run(["readelf", "--version-info", *files], capture_output=True, text=True, check=True).stdout
    minors = [int(minor) for minor in re.findall(r"\bGLIBC_2\.(\d+)", needs)]
    minors += [36] * ("GLIBC_ABI_DT_RELR" in needs)  # a way to pack relocations, since 2.36
    return f"py3-none-manylinux_2_{max(minors)}_{platform.machine()}"


class Metadata(MetadataHookInterface):
    def update(self, metadata):
        metadata["scripts"] = {"gfxrepro": "gfxrepro.__main__:main"} if PROGRAM.is_file() else {}


class Build(BuildHookInterface):
    def initialize(self, version, build_data):
        if self.target_name == "wheel" and PROGRAM.is_file():
            build_data["tag"] = tag()
            build_data["pure_python"] = False

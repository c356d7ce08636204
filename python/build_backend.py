"""Builds the wheel with the standard library alone, so that pip needs no network for it (PEP 517, 427)."""

import base64
import hashlib
import pathlib
import tarfile
import tomllib
import zipfile

ROOT = pathlib.Path(__file__).parent
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
NAME = f"{PROJECT['name']}-{PROJECT['version']}"
WHEEL = "Wheel-Version: 1.0\nGenerator: gfxrepro\nRoot-Is-Purelib: true\nTag: py3-none-any\n"


def metadata():
    lines = ["Metadata-Version: 2.1", f"Name: {PROJECT['name']}", f"Version: {PROJECT['version']}",
             f"Summary: {PROJECT['description']}", f"Requires-Python: {PROJECT['requires-python']}"]
    for extra, packages in PROJECT["optional-dependencies"].items():
        lines.append(f"Provides-Extra: {extra}")
        lines += [f'Requires-Dist: {package}; extra == "{extra}"' for package in packages]
    return "\n".join(lines) + "\n"


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    files = {f"gfxrepro/{path.name}": path.read_bytes() for path in sorted((ROOT / "gfxrepro").glob("*.py"))}
    files[f"{NAME}.dist-info/METADATA"] = metadata().encode()
    files[f"{NAME}.dist-info/WHEEL"] = WHEEL.encode()
    record = f"{NAME}.dist-info/RECORD"
    lines = []
    for name, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        lines.append(f"{name},sha256={digest},{len(content)}\n")
    files[record] = ("".join(lines) + f"{record},,\n").encode()
    wheel = f"{NAME}-py3-none-any.whl"
    with zipfile.ZipFile(pathlib.Path(wheel_directory) / wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return wheel


def build_sdist(sdist_directory, config_settings=None):
    sdist = f"{NAME}.tar.gz"
    with tarfile.open(pathlib.Path(sdist_directory) / sdist, "w:gz") as archive:
        for path in ["pyproject.toml", "build_backend.py", "README.md", *(ROOT / "gfxrepro").glob("*.py")]:
            archive.add(ROOT / path, f"{NAME}/{(ROOT / path).relative_to(ROOT)}")
    return sdist

"""scripts/new_technique writes a technique that is in style, registered, and compiles; tries it out, and says how to undo it.

Usage: new_technique_test.py SOURCE BUILD. Works in a copy; compiles as BUILD did the template.
"""

import json
import os
import pathlib
import shlex
import shutil
import subprocess
import sys
import tempfile

SOURCE, BUILD = (pathlib.Path(argument) for argument in sys.argv[1:])
NAME = "zonal_aa"  # sorts behind all others, and is short where the template's name is long


def run(*command, **options):
    return subprocess.run(command, capture_output=True, text=True, **options)


# Makes programs that say what they are asked; the test's fails where BROKEN is set.
PRETENDED_BUILD = f"""#!/bin/sh
echo "asked: build $*"
cd "$(dirname "$0")/.."
mkdir -p build/release/tests/techniques/{NAME}
for program in gfxrepro tests/techniques/{NAME}/test_{NAME}; do
    printf '#!/bin/sh\n[ "$1" = describe ] || echo "asked: $(basename $0) $*"\n' >build/release/$program
    chmod +x build/release/$program
done
[ -z "$BROKEN" ] || echo "exit 3" >>build/release/$program
"""


def undo(root, *options):
    """--remove leaves the tree as it was, but for the test's own programs."""
    undone = run(root / "scripts/new_technique", "--remove", NAME, *options)
    expect(undone.returncode == 0, undone.stderr)
    run("git", "-C", root, "checkout", "--quiet", "configs/schema", "configs/README.md")  # of a program that knows no schema
    left = run("git", "-C", root, "status", "--porcelain").stdout.splitlines()
    expect([line for line in left if line[3:] not in ("build/", "scripts/build", "scripts/__pycache__/")] == [],
           f"--remove leaves {left}")
    return undone.stdout


def expect(is_true, message):
    if not is_true:
        sys.exit(message)


def compiles(root, name, template):
    """The file compiles by the command that the template's took, its headers looked for in the copy first."""
    commands = json.loads((BUILD / "compile_commands.json").read_text())
    joined = f"/{pathlib.Path(template).parent}/CMakeFiles/"  # where a build compiles several files as one
    entry = next(one for one in commands if one["file"] == str(SOURCE / template) or joined in one["file"])
    words = shlex.split(entry["command"])
    words[words.index("-o"):words.index("-o") + 2] = ["-fsyntax-only"]
    at = next(i for i, word in enumerate(words) if word.startswith("-I"))
    words = words[:at] + [f"-I{root}"] + [str(root / name) if word == entry["file"] else word for word in words[at:]]
    result = run(*words, cwd=entry["directory"])
    expect(result.returncode == 0, f"{name} does not compile:\n{result.stderr}")


with tempfile.TemporaryDirectory() as folder:
    root = pathlib.Path(folder).resolve()
    for part in ("scripts", "techniques", "tests", "configs", "engine", "runner", "scenes"):
        shutil.copytree(SOURCE / part, root / part)
    for part in (".clang-format", "techniques/README.md"):
        shutil.copy(SOURCE / part, root / part)
    script = root / "scripts/new_technique"
    git = ("git", "-C", root, "-c", "user.name=test", "-c", "user.email=test@gfxrepro.invalid")
    for command in (["init", "--quiet"], ["add", "."], ["commit", "--quiet", "-m", "before"]):
        expect(run(*git, *command).returncode == 0, f"git {command} fails")

    for name, reason in {
            "ContactShadows": "is not snake_case, such as contact_shadows",
            "a__b": "is not snake_case, such as contact_shadows",
            "voxelization": "is taken: techniques/voxelization is there already",
            "class": "is a word of C++",
            "gl": "is taken: engine/gl/device.h has a namespace of that name"}.items():
        refused = run(script, name, "--write-only")
        expect(refused.returncode == 1 and refused.stderr == f"new_technique: '{name}' {reason}\n",
               f"{name}: {refused.stderr}")

    written = run(script, NAME, "--write-only")
    expect(written.returncode == 0, written.stderr)
    files = [path for part in ("techniques", "tests/techniques") for path in (root / part / NAME).rglob("*.*")]
    files += [root / f"configs/{kind}/{NAME}.yaml" for kind in ("smoke", "nightly")]
    files.append(root / f"configs/smoke/{NAME}-methods.yaml")
    expect(len(files) == 13, f"{len(files)} files: {files}")
    for path in files:
        expect("template" not in path.read_text().lower(), f"{path} speaks of the template")
    for path, line in {"techniques/CMakeLists.txt": f"        technique_{NAME}\n",
                       "tests/techniques/CMakeLists.txt": f"add_subdirectory({NAME})\n",
                       "techniques/registry.cpp": "        zonal_aa::kZonalAa,\n"}.items():
        expect((root / path).read_text().count(line) == 1, f"{path} lacks {line}")
    for check in ("check_layers", "check_style"):
        checked = run(root / "scripts" / check, root)
        expect(checked.returncode == 0, checked.stdout)
    # Every parameter that it begins with is written by its configs.
    schema = json.loads((root / "configs/schema/experiment.json").read_text())
    schema["definitions"][f"params_{NAME}"] = schema["definitions"]["params_template"]
    (root / "configs/schema/experiment.json").write_text(json.dumps(schema))
    checked = run(root / "scripts/check_style", root)
    expect(checked.returncode == 0, checked.stdout)
    compiles(root, f"techniques/{NAME}/{NAME}.cpp", "techniques/template/template.cpp")
    compiles(root, f"tests/techniques/{NAME}/{NAME}_test.cpp", "tests/techniques/template/template_test.cpp")
    expect(written.stdout.endswith(f": scripts/new_technique --remove {NAME}\n"), written.stdout)
    undo(root, "--write-only")
    for name, reason in {"template": "'template' is no technique that it has made", NAME: f"'{NAME}' is no technique that it has made",
                         "soft_shadows": "configs/presets/soft-shadows-calibration.yaml measures 'soft_shadows': it stays"}.items():
        stays = run(script, "--remove", name)
        expect(stays.returncode == 1 and stays.stderr == f"new_technique: {reason}\n", stays.stderr)

    # The steps of trying it out, with programs that only say what they were asked; one that fails ends them.
    (root / "scripts/build").write_text(PRETENDED_BUILD)
    tried = run(script, NAME)
    expect(tried.returncode == 0, f"{tried.stdout}\n{tried.stderr}")
    asked = [line for line in tried.stdout.splitlines() if line.startswith("asked: ")]
    expect(asked == [f"asked: build release gfxrepro test_{NAME}", f"asked: test_{NAME} --gtest_brief=1",
                     f"asked: gfxrepro check {root}/configs/nightly/{NAME}.yaml",
                     f"asked: gfxrepro reproduce {root}/configs/smoke/{NAME}-methods.yaml {root}/configs/smoke/{NAME}.yaml --device software"],
           asked)
    undo(root)
    failed = run(script, NAME, env={**os.environ, "BROKEN": "1"})
    expect(failed.returncode == 3 and failed.stderr == f"new_technique: test_{NAME} failed\n"
           and "asked: gfxrepro check" not in failed.stdout and "is there and registered" not in failed.stdout, failed)
    expect("asked: build release gfxrepro\n" in undo(root), "the program is built without it")

    without = root / "without"
    without.mkdir()
    (without / "c++").write_text("#!/bin/sh\n! grep -q gmock\n")
    (without / "c++").chmod(0o755)
    refused = run(script, NAME, env={**os.environ, "PATH": f"{without}:{os.environ['PATH']}"})
    expect(refused.returncode == 1 and not (root / "techniques" / NAME).exists() and refused.stderr ==
           "new_technique: GoogleTest is not here; scripts/setup --technique installs it\n", refused.stderr)
print("a new technique is in style and compiles")

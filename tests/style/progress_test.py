"""scripts/setup, build and test say how far they are, and of what fails what it said itself: progress_test.py SCRIPTS

In a small project of its own, with packages that are only pretended."""

import os
import pathlib
import pty
import re
import shutil
import subprocess
import sys
import tempfile

SCRIPTS = pathlib.Path(sys.argv[1])
PROJECT = """cmake_minimum_required(VERSION 3.25)
project(small LANGUAGES CXX)
enable_testing()
message(STATUS "Left out: test_large: Large is not here")
if(NEEDS)
    find_package(Nothing REQUIRED)
endif()
add_library(fine STATIC fine.cpp)
add_library(first STATIC EXCLUDE_FROM_ALL first.cpp)
add_library(second STATIC EXCLUDE_FROM_ALL second.cpp)
add_executable(unlinked EXCLUDE_FROM_ALL unlinked.cpp)
add_test(NAME unit.good COMMAND "${CMAKE_COMMAND}" -E echo "said by what passes")
add_test(NAME unit.bad COMMAND "${CMAKE_COMMAND}" -E cat nowhere.txt)
set_tests_properties(unit.good unit.bad PROPERTIES LABELS unit)
"""
SOURCES = {
    "fine.cpp": "#warning worth reading\nint fine() { return 0; }\n",
    "first.cpp": "int first() { return lost; }\n",
    "second.cpp": "".join(f"int number{i} = missing{i};\n" for i in range(12)),
    "unlinked.cpp": "int nowhere();\nint main() { return nowhere(); }\n",
}
PRESET = '{"name": "%s", "generator": "Ninja", "binaryDir": "${sourceDir}/build/${presetName}", "cacheVariables": {"NEEDS": "%s"}}'
APT = """#!/bin/sh
case "$*" in
*print-uris*) printf "'http://x/a.deb' a.deb 1500000 SHA256:0\\n'http://x/b.deb' b.deb 2600000 SHA256:0\\n" ;;
*update*) echo "dlstatus:0:10.0:Retrieving" ;;
*install*)
    printf 'dlstatus:1:50.5:Retrieving\\npmstatus:ninja-build:25.0:Unpacking\\nUnpacking ninja-build\\n'
    sleep 1.2
    [ -z "$BROKEN" ] || { echo "E: Unable to fetch some archives" >&2; exit 100; }
    ;;
esac
"""
# Six steps, of which the two that compile take all the time.
CMAKE = """#!/bin/sh
[ "$1" = --build ] || { mkdir -p build/release; exit; }
case "$*" in *" -n") wait=true ;; *) wait=sleep ;; esac
for i in 1 2 3 4; do echo "[$i/6] Copying $i"; done
$wait 5.5
echo "[5/6] Building CXX object first.o"
$wait 1.2
echo "[6/6] Building CXX object second.o"
"""


def expect(is_true, message):
    if not is_true:
        sys.exit(message)


def run(*command, cwd, **environment):
    return subprocess.run(command, capture_output=True, text=True, cwd=cwd, env={**os.environ, **environment}, timeout=120)


def on_a_terminal(*command, cwd, **environment):
    """What a terminal gets, and the exit status."""
    main, other = pty.openpty()
    process = subprocess.Popen(command, stdout=other, stderr=other, cwd=cwd, env={**os.environ, **environment})
    os.close(other)
    said = b""
    try:
        while part := os.read(main, 4096):
            said += part
    except OSError:  # Linux ends a terminal like that
        pass
    os.close(main)
    return said.decode().replace("\r\n", "\n"), process.wait()


def check_setup(folder):
    script = SCRIPTS / "setup"
    for word in ("--test", "-x", "NAME"):
        refused = run(script, word, cwd=folder)
        expect((refused.returncode, refused.stderr) ==
               (2, f"setup: unknown option '{word}'; --technique, --tests and --help alone are known\n"), refused)

    tools = folder / "tools"
    tools.mkdir()
    for name, text in {
            "dpkg-query": "#!/bin/sh\nfor word; do case $word in -*|cmake|ninja-build|dpkg-dev) ;; *) echo $word installed ;; esac; done\n"
                          "echo 'cmake config-files'\nexit 1\n",
            "apt-cache": "#!/bin/sh\nshift\nfor word; do printf '%s:\\n  Installed: (none)\\n  Candidate: ' $word\n"
                         "[ $word = dpkg-dev ] && echo '(none)' || echo 1.0-2; done\n",
            "id": "#!/bin/sh\necho 0\n", "apt-get": APT}.items():
        (tools / name).write_text(text)
        (tools / name).chmod(0o755)
    path = f"{tools}:{os.environ['PATH']}"
    for option in (), ("--technique",), ("--tests",):
        done = run(script, *option, cwd=folder, PATH=path)
        expect(done.returncode == 0 and done.stderr == "setup: this system's package sources do not have: dpkg-dev\n", done)
        lines = done.stdout.splitlines()
        expect(lines[0].startswith("setup: installing 2 of ") and lines[0].endswith(", with what they need 2 files, 4 MB to download"), done)
        expect(lines[1].startswith("setup: done in ") and len(lines) == 2, done)
    said, code = on_a_terminal(script, cwd=folder, PATH=path)
    expect(code == 0 and "\r\033[Ksetup: 2 packages: installing, 25 %, 1 s" in said and "Unpacking" not in said, repr(said))
    broken = run(script, cwd=folder, PATH=path, BROKEN="1")
    expect(broken.returncode == 100 and broken.stderr.splitlines()[1:] ==
           ["E: Unable to fetch some archives", "setup: 2 packages failed"], broken)


def check_build(folder):
    script = folder / "scripts/build"
    built = run(script, cwd=folder)
    expect(built.returncode == 0 and built.stdout.startswith(
        "build release: left out: test_large: Large is not here\nbuild release: 2 steps in "), built)
    expect(len(built.stderr.splitlines()) == 1 and "fine.cpp:1:2: warning: #warning worth reading" in built.stderr, built)
    expect(run(script, cwd=folder).stdout.endswith("build release: nothing to do\n"), "not up to date")

    failed = run(script, "release", "-k", "0", "first", "second", "unlinked", cwd=folder)
    expect(failed.returncode == 1, failed)
    end = "build release failed; the whole output: build/release/build.log\n"
    expect(failed.stderr.endswith(end), failed)
    units = sorted(failed.stderr.removesuffix(end).split("FAILED: "))  # in any order
    expect(units[1] == "first: first.cpp\nfirst.cpp:1:22: error: ‘lost’ was not declared in this scope\n", failed)
    lines = units[2].splitlines()
    expect(lines[0] == "second: second.cpp" and len(lines) == 12 and lines[11] == "(and 2 more such lines)", failed)
    expect(all(f"error: ‘missing{i}’" in line for i, line in enumerate(lines[1:11])), failed)
    expect(units[3].startswith("unlinked\n") and "undefined reference to `nowhere()'" in units[3], failed)
    expect(" -c " not in failed.stderr and " -c " in (folder / "build/release/build.log").read_text(), failed)

    said, code = on_a_terminal(script, "release", "first", cwd=folder)
    expect(code == 1 and "\r\033[Kbuild release: configuring\r\033[K" in said and "first.cpp:1:22: error:" in said, repr(said))
    unknown = run(script, "release", "fines", cwd=folder)
    expect(unknown.returncode == 1 and unknown.stderr.startswith("ninja: error: unknown target 'fines', did you mean 'fine'?\n"), unknown)
    tools = folder / "unequal"
    tools.mkdir()
    (tools / "cmake").write_text(CMAKE)
    (tools / "cmake").chmod(0o755)
    said, code = on_a_terminal(script, cwd=folder, PATH=f"{tools}:{os.environ['PATH']}")
    expect(code == 0 and not re.search("4 of 6, [^\r]* left", said) and re.search("5 of 6, (\\d+) s, about \\1 s left", said), repr(said))
    missing = run(script, "needy", cwd=folder)
    expect(missing.returncode == 1 and missing.stderr.startswith("CMake Error at CMakeLists.txt:6 (find_package):\n")
           and "compiler" not in missing.stdout, missing)


def check_test(folder):
    (folder / "scripts/setup").write_text("#!/bin/sh\n")
    tested = run(folder / "scripts/test", cwd=folder)
    expect(tested.returncode == 1, tested)
    expect("said by what passes" not in tested.stdout and tested.stdout.count("CMake Error: nowhere.txt") == 2, tested)
    verdict = "50% tests passed, 1 tests failed out of 2"
    begun = [line for line in tested.stdout.splitlines() if line.startswith("test: ")][:-5]
    expect(begun == ["test: 1 of 5: packages", "test: 2 of 5: build of ci", "test: 3 of 5: tests of ci",
                     "test: 4 of 5: build of sanitize", "test: 5 of 5: tests of sanitize"], tested)
    last = tested.stdout.splitlines()[-7:]
    expect([last[3].strip(), last[6].strip()] == [verdict, verdict], tested)
    expect(last[0].startswith("test: 1 of 5: packages, ") and last[2].endswith("s, FAILED"), tested)
    expect(run(folder / "scripts/test", "-R", "good", cwd=folder).returncode == 0, "a part of the tests fails")

    (folder / "fine.cpp").write_text("int fine() { return lost; }\n")
    broken = run(folder / "scripts/test", cwd=folder)
    expect(broken.returncode == 1 and "tests of ci" not in broken.stdout
           and broken.stdout.splitlines()[-1].startswith("test: 2 of 5: build of ci, "), broken)


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name).resolve()
    (folder / "scripts").mkdir()
    for script in ("build", "progress.sh", "setup", "test"):
        shutil.copy(SCRIPTS / script, folder / "scripts")
    (folder / "CMakeLists.txt").write_text(PROJECT)
    for file, text in SOURCES.items():
        (folder / file).write_text(text)
    presets = {preset: PRESET % (preset, "ON" if preset == "needy" else "OFF") for preset in ("release", "ci", "sanitize", "needy")}
    builds = ", ".join(f'{{"name": "{preset}", "configurePreset": "{preset}"}}' for preset in presets)
    (folder / "CMakePresets.json").write_text(
        f'{{"version": 4, "configurePresets": [{", ".join(presets.values())}], "buildPresets": [{builds}]}}')
    os.environ.update(CMAKE_CXX_COMPILER_LAUNCHER="env", LC_ALL="C.UTF-8")
    os.environ.pop("NINJA_STATUS", None)
    check_setup(folder)
    check_build(folder)
    check_test(folder)
print("setup, build and test say how far they are")

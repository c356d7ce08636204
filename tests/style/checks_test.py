"""check_layers and check_style find what they are there to find."""

import json
import pathlib
import subprocess
import sys
import tempfile

SCRIPTS = pathlib.Path(sys.argv[1])


def run(script, files, **options):
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, text in files.items():
            path = root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        result = subprocess.run([sys.executable, SCRIPTS / script, folder],
                                capture_output=True, text=True, **options)
        return result.returncode, result.stdout


def expect(script, files, wanted):
    code, output = run(script, files)
    if code != 1 or wanted not in output:
        sys.exit(f"{script} should have said {wanted!r}; exit {code}:\n{output}")


GOOD = {"engine/scene/a.h": '#pragma once\n#include "engine/image/image.h"\n',
        "runner/README.md": "", "engine/README.md": "", "engine/scene/README.md": ""}
for name in ("check_layers", "check_style"):
    code, output = run(name, GOOD)
    if code != 0:
        sys.exit(f"{name} found something in a good tree:\n{output}")

expect("check_layers", {"engine/scene/a.h": '#include "engine/gl/device.h"\n'},
       "engine/scene/a.h:1: engine/scene may not include engine/gl/device.h")
expect("check_layers", {"runner/report/a.cpp": "#include <EGL/egl.h>\n"},
       "runner/report/a.cpp:1: runner/report may not include EGL/egl.h")
expect("check_layers", {"techniques/a/a.cpp": '#include "techniques/b/b.h"\n'},
       "techniques/a/a.cpp:1: techniques/a may not include techniques/b/b.h")
for folder in ("techniques/a", "techniques/kit", "techniques/reflections", "techniques/external"):
    for hidden in ("runner/config/printed_section.h", "runner/claims/kinds/claim.h", "runner/tables/table.h"):
        expect("check_layers", {folder + "/a.cpp": f'#include "{hidden}"\n'},
               f"{folder}/a.cpp:1: {folder} may not include {hidden}")
for folder in ("runner/run", "engine/scene", "techniques/a"):
    expect("check_layers", {folder + "/a.cpp": '#include "scenes/city/parts.h"\n'},
           f"{folder}/a.cpp:1: {folder} may not include scenes/city/parts.h")
expect("check_layers", {"scenes/city/a.cpp": '#include "runner/technique/technique.h"\n'},
       "scenes/city/a.cpp:1: scenes may not include runner/technique/technique.h")
for folder, code in (("external", 0), ("a", 1)):
    if run("check_layers", {f"techniques/{folder}/a.h": '#include "runner/config/external_program.h"\n'})[0] != code:
        sys.exit(f"check_layers should have ended with {code} for techniques/{folder}")
# An exception holds one way.
expect("check_layers",
       {"techniques/reflection_reuse/a.cpp": '#include "techniques/clustered_reflections/b.h"\n',
        "techniques/clustered_reflections/a.cpp": '#include "techniques/reflection_reuse/b.h"\n'},
       "techniques/clustered_reflections/a.cpp:1: techniques/clustered_reflections may not include "
       "techniques/reflection_reuse/b.h\n")
expect("check_layers", {"techniques/marching/x.h": "", "engine/core/a.cpp": "// marching\n"},
       "engine/core/a.cpp: engine/ names the technique 'marching'")
expect("check_layers", {"engine/core/a.cpp": '#include "error.h"\n'},
       'engine/core/a.cpp:1: includes are root-relative, not "error.h"')
expect("check_layers", {"runner/config/case.h": '#include "engine/core/a.h"\n', "engine/core/a.h": "#include <nlohmann/json.hpp>\n"},
       "runner/config/case.h: reaches nlohmann/json.hpp")
WORKFLOW = ".github/workflows/a.yml"
for action in ("other/action@v1", "'other/action@main'", "other/action@0123abc", "actions/checkout@v4"):
    expect("check_style", {WORKFLOW: f"      - uses: {action}\n"},
           f"{WORKFLOW}:1: " + action.strip("'") + ": not pinned to a commit")
for action in ("./.github/own", "other/action@" + "0123456789" * 4 + "  # v1"):
    code, output = run("check_style", {**GOOD, WORKFLOW: f"permissions: {{}}\n      - uses: {action}\n"})
    if code != 0:
        sys.exit(f"check_style found something in {action}:\n{output}")
expect("check_style", {WORKFLOW: "jobs:\n  a:\n    permissions: {}\n"}, f"{WORKFLOW}: no permissions of its own")
PROJECT = {"CMakeLists.txt": "project(a VERSION 1.2.0 LANGUAGES CXX)\n"}
expect("check_style", {**PROJECT, "CHANGELOG.md": "# Changelog\n## [1.3.0] - 2026-01-01\n## [1.2.0] - 2025-01-01\n"},
       "CHANGELOG.md: its newest version is 1.3.0, and not the one of the top CMakeLists.txt\n")
code, output = run("check_style", {**GOOD, **PROJECT, "CHANGELOG.md": "## [1.2.0] - Unreleased\n## [1.1.0] - 2025-01-01\n"})
if code != 0:
    sys.exit(f"check_style found something in a good change log:\n{output}")
TABLE = "configs/x/a.yaml"
for says in ("… too", '"and so on"', "nor this", '"and, unlike it, that"'):
    expect("check_style", {TABLE: f"  A: {{says: {says}, origin: ours}}\n"},
           f"{TABLE}:1: a claim is read alone: say of what it goes on")
expect("check_style", {TABLE: "  A:\n    says: >-\n      and so on\n"}, f"{TABLE}:2: a claim is read alone: say of what it goes on")
expect("check_style", {TABLE: "printed:\n  values: |\n    a\nclaims:\n  A: {says: " + "x" * 150 + "}\n"},
       f"{TABLE}:5: 163 characters, at most 160\n")
expect("check_style", {TABLE: "printed:\n  values: |\n    " + "a," * 80 + "a\n"}, f"{TABLE}:3: 165 characters, at most 160\n")
for reason in ('"Edges. Pixels; lights."', ">-\n        Edges and\n        pixels. Lights. Others"):
    expect("check_style", {TABLE: f"    because:\n      verdict: fails\n      reason: {reason}\n"},
           f"{TABLE}:3: a reason of 3 sentences, at most 2: numbers stand in results/findings\n")
expect("check_style", {TABLE: 'printed: {remark: "text. full_ewa_ms is ours"}\n'},
       f"{TABLE}:1: 'full_ewa_ms' in a remark, which people read: say it in words")
expect("check_style", {TABLE: "printed:\n  remark: >-\n    text.\n\n    ray_traced is theirs\n  values: a_b\n"},
       f"{TABLE}:5: 'ray_traced' in a remark, which people read: say it in words\n")
expect("check_style", {TABLE: "title: What c_min decides\n"}, f"{TABLE}:1: 'c_min' in a title, which")
expect("check_style", {TABLE: "  A: {says: full_ewa is fast, ratio: a_b / c_d}\n"}, f"{TABLE}:1: 'full_ewa' in a says, which")
expect("check_style", {TABLE: "remark: see sweeps/a-b.yaml\n"}, f"{TABLE}:1: configs/sweeps has no 'a-b'\n")
FINDING = {"results/README.md": "", "results/findings/p.md": "# P\n## Table 2.1: V1\n"}
for place in ("p.md", "p.md#table-2", "q.md#table-21-v1"):
    expect("check_style", {**FINDING, TABLE: f"  because: {{shown_by: {place}}}\n"},
           f"{TABLE}:1: shown_by: results/findings has no heading '{place}'\n")
code, output = run("check_style", {**GOOD, **FINDING, "configs/README.md": "", "configs/x/README.md": "", "configs/sweeps/README.md": "",
                                   "configs/sweeps/soft_shadows-light.yaml": "", TABLE: "shown_by: p.md#table-21-v1\n"
    "  A: {says: soft shadows do, ratio: a_b / c_d}\n  remark: see sweeps/soft_shadows-light.yaml, a D3DFMT_32F\n"
    "printed:\n  values: |\n    " + "a," * 70 + "\n"})
if code != 0:
    sys.exit(f"check_style found something in good words:\n{output}")
MAY_STAY = ("env", "frames", "gpu", "here", "passes")  # of `program`
SCHEMA = {"configs/README.md": "", "configs/schema/README.md": "", "configs/x/README.md": "", "techniques/README.md": "",
          "techniques/a/README.md": "", "configs/schema/experiment.json": json.dumps({"definitions": {
              section: {"properties": {name: {} for name in names}} for section, names in
              {"params_a": ["size", "tau"], "sweep_a": ["zip"], "program": ["command", *MAY_STAY], "output": ["width"]}.items()}})}
BASE = "technique: a\nparams: {size: 1}\nsweep: {output.width: [1]}\nprogram:\n  command: b\n  images: {c: {frames: 2}}\n"
WRITES = {"configs/x/base.yaml": BASE, TABLE: "extends: [base.yaml]\nsweep:\n  tau: [1, 2]\n"}
WHY = "leave it out, or say in UNWRITTEN of scripts/check_style why it stays\n"
code, output = run("check_style", {**SCHEMA, **WRITES})
if code != 0:
    sys.exit(f"check_style found something in keys that are written:\n{output}")
for files, wanted in (({"configs/x/base.yaml": BASE}, "a: no shipped config writes 'tau': "),
                      ({**WRITES, TABLE: "technique: b\nextends: x/base.yaml\n# tau: 1\nsays: tau\n"}, "a: no shipped config writes 'tau': "),
                      *(({**WRITES, TABLE: "extends: x/base.yaml\n" + beside}, "a: no shipped config writes 'tau': ") for beside in
                        ("labels:\n  tau: words\n", "labels:\n  size: words\n\n  # more\n  tau: words\n", "labels: {size: 'a }', tau: b}\n",
                         "labels: {size: {of: a},\n  tau: b}\n", "claims:\n  C:\n    says: >-\n      with\n      tau: words\n", "says: 'of\n  tau: c'\n",
                         "layout: {columns: {tau: t}}\n")),
                      ({**WRITES, TABLE: WRITES[TABLE] + "tau: 1\n- odd\n"}, f"{TABLE}: is not read from this line on: - odd\n"),
                      ({TABLE: WRITES[TABLE]}, "program: no shipped config writes 'command': ")):
    expect("check_style", {**SCHEMA, **files}, wanted + WHY * wanted.endswith("': "))
expect("check_style", {**SCHEMA, **WRITES, TABLE: WRITES[TABLE] + "program:\n  frames: all\n"},
       "scripts/check_style: UNWRITTEN has program.frames, which a config writes, or nothing declares\n")
expect("check_style", {**SCHEMA, **WRITES, "scenes/city/b.cpp": 'a = params.getInt(\n    "blocks", 1);\n'},
       "b: no shipped config writes 'blocks': " + WHY)
expect("check_style", {"engine/core/a.h": "int x;\n"}, "engine/core/a.h: no #pragma once")
expect("check_style", {"engine/core/a.cpp": "\n" * 601}, "engine/core/a.cpp: 601 lines, at most 600")
for includes in ('#include <map>\n#include "engine/core/a.h"\n',
                 '#include "engine/core/a.h"\n#include "engine/core/b.h"\n#include <map>\n'):
    expect("check_style", {"engine/core/a.cpp": includes},
           "engine/core/a.cpp: includes are in another order than the own header, <…>, ours")
expect("check_style", {"engine/core/a.h": "#pragma once\n", "engine/core/a.cpp": '#include <map>\n'},
       "engine/core/a.cpp: includes are in another order than the own header, <…>, ours")
expect("check_style", {"engine/core/a.h": '#pragma once\n#include "engine/core/a.h"\n'},
       "engine/core/a.h: includes are in another order than the own header, <…>, ours")
for text, wanted in (("std::vector<int> a;", "std::vector, but neither it nor what it includes of ours includes vector"),
                     ("// a\nglm::ivec2 a;", "glm::ivec2, but neither it nor what it includes of ours includes glm/"),
                     ("#include <string_view>\nstd::string a;", "std::string, but neither it nor")):
    expect("check_style", {"engine/core/a.cpp": text + "\n", "engine/core/b.h": "#include <vector>\n"}, f"engine/core/a.cpp: {wanted}")
code, output = run("check_style", {"engine/README.md": "", "engine/core/README.md": "", "engine/core/b.h": "#pragma once\n#include <glm/vec2.hpp>\n",
    "engine/core/c.h": '#pragma once\n#include "engine/core/b.h"\n', "engine/core/a.cpp": '#include "engine/core/c.h"\nglm::vec2 a; // std::map\n',
    "engine/core/d.cpp": '#include "engine/core/b.h"\n#include "engine/core/c.h"\n'})
if code != 0:
    sys.exit(f"check_style found something in good includes:\n{output}")
for kind in ("int twice(int n) {\n", "template <class T>\nvoid twice(T n) {\n", "struct twice {\n", "constexpr int twice = 1;\n"):
    expect("check_style", {"engine/core/a.cpp": "namespace {\nint twice(long n) {\n}  // namespace\n",
                           "engine/core/b.cpp": "namespace {\n" + kind + "    twice(1);\n}  // namespace\n"},
           "engine/core/b.cpp: twice has a namesake in a.cpp")
expect("check_style", {"engine/core/CMakeLists.txt": "a(b\n    SOURCES b.cpp a.cpp\n    PUBLIC c)\n"},
       "engine/core/CMakeLists.txt: a.cpp stands behind b.cpp: sort the sources")
expect("check_style", {"techniques/a/README.md": "\n" * 71}, "techniques/a/README.md: 71 lines, at most 70")
# The data of a scene may be long, that of others not.
DATA = "// Longer than other files: the data of one scene.\n" + "int a;\n" * 600
expect("check_style", {"scenes/a.cpp": "\n" * 601}, "scenes/a.cpp: 601 lines, at most 600")
expect("check_style", {"engine/core/a.cpp": DATA}, "engine/core/a.cpp: 601 lines, at most 600")
code, output = run("check_style", {"scenes/README.md": "", "scenes/a.cpp": DATA})
if code != 0:
    sys.exit(f"check_style found something in a long scene:\n{output}")
expect("check_style", {"engine/core/a.cpp": "// TO" + "DO later\n"}, "engine/core/a.cpp:1: unfinished")
for line in ("a[0] = a[1] = 1u;", "b.x = a = c + 1;"):
    expect("check_style", {"techniques/a/a.glsl": line + "\n"}, "techniques/a/a.glsl:1: a chained assignment")
for line in ("i64vec3 edges[3];", "whole3 e[] = whole3[](a, b);"):
    expect("check_style", {"techniques/a/a.glsl": line + "\n"}, "techniques/a/a.glsl:1: an array of vectors of 64-bit")
GLSL = "for (int i = 0, j = 1; i <= j; ++i) a = b == c;\nvec2 low = a, high = b;\nivec3 e[3];  // i64vec3 e[3], a = b = c\n"
code, output = run("check_style", {"techniques/README.md": "", "techniques/a/README.md": "", "techniques/a/a.glsl": GLSL})
if code != 0:
    sys.exit(f"check_style found something in good GLSL:\n{output}")
for drawn in ("glm::vec2 a(random.uniform(), random.uniform());", "f(g(random_.index(3)), {random_.next(), 1});",
              "f({g(random.index(2), random.index(3))});", "f([&] { g(random.uniform(0, 1), -random.uniform()); });"):
    expect("check_style", {"engine/core/a.cpp": "int a;\n" + drawn + "\n"},
           "engine/core/a.cpp:2: two arguments draw: compilers differ in their order; braces have one\n")
DRAWS = """#include <glm/vec2.hpp>
const glm::vec2 a{random.uniform(0, 1), random.uniform()};
f({random.uniform(), random.index(3)}, 1);
// f(random.uniform(), random.uniform());
for (int i = random.index(2); i < 9; i += random.index(3))
  g(i, random.index(4));
f([&] { return random.uniform(); }, [&]() { return random.uniform(); });
"""
code, output = run("check_style", {"engine/README.md": "", "engine/core/README.md": "", "engine/core/a.cpp": DRAWS})
if code != 0:
    sys.exit(f"check_style found something in draws in their order:\n{output}")
expect("check_style", {"engine/core/a.cpp": ""}, "engine/core: no README.md")
ALONE = {"engine/core/a.h": "#pragma once\n", "engine/core/a.cpp": '#include "engine/core/a.h"\n', "engine/core/b.cpp": '#include "engine/core/a.h"\n'}
expect("check_style", ALONE, "engine/core/a.h: engine/core/b.cpp alone includes it: let it stand there\n")
expect("check_style", {**ALONE, "engine/core/a.cpp": ""}, "engine/core/a.h: engine/core/b.cpp alone includes it: let it stand there\n")
for more in ({"engine/core/c.cpp": ALONE["engine/core/b.cpp"]}, {"engine/core/a.cpp": ALONE["engine/core/a.cpp"] + "int a;\n" * 599}):
    code, output = run("check_style", {"engine/README.md": "", "engine/core/README.md": "", **ALONE, **more})
    if code != 0:
        sys.exit(f"check_style found something in a header that divides, or serves two:\n{output}")
# One version of clang-format decides; another is not asked, and that is said.
for version, wanted in {"14.0.6": (1, "runner/a.h:1:1: error: code should be clang-formatted\n"),
                        "19.1.7": (0, "style: formatting was not looked at: clang-format 14 is not here\nstyle: nothing found\n")}.items():
    with tempfile.TemporaryDirectory() as folder:
        stand_in = pathlib.Path(folder) / "clang-format"
        stand_in.write_text(f"#!/bin/sh\nif [ $1 = --version ]; then echo clang-format version {version}\n"
                            "else echo runner/a.h:1:1: error: code should be clang-formatted >&2; fi\n")
        stand_in.chmod(0o755)
        if run("check_style", GOOD, env={"PATH": folder}) != wanted:
            sys.exit(f"check_style asked clang-format {version}, or did not")
print("checks find violations")

"""scripts/new_document writes a document that every check takes as it is and that is measured at once; --remove undoes it.

Usage: new_document_test.py SOURCE GFXREPRO TEST_KEPT_VERDICTS. Works in a copy.
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

SOURCE, PROGRAM, KEPT = (pathlib.Path(argument) for argument in sys.argv[1:])
NAME = "newcomer2026"


def run(*command, **options):
    return subprocess.run(command, capture_output=True, text=True, **options)


def expect(is_true, message):
    if not is_true:
        sys.exit(message)


def ends_well(*command, **options):
    done = run(*command, **options)
    expect(done.returncode == 0, f"{command}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def contents(root):
    return {path.relative_to(root): path.read_bytes() for path in root.rglob("*") if path.is_file() and "__pycache__" not in path.parts}


with tempfile.TemporaryDirectory() as folder:
    root = pathlib.Path(folder).resolve() / "tree"
    for part in ("configs", "engine", "results", "runner", "scenes", "scripts", "techniques", "tests"):
        shutil.copytree(SOURCE / part, root / part, ignore=shutil.ignore_patterns("__pycache__"))
    for part in ("README.md", ".clang-format"):
        shutil.copy(SOURCE / part, root)
    before = contents(root)
    script = root / "scripts/new_document"

    def refused(reason, *arguments):
        done = run(script, *arguments)
        expect(done.returncode == 1 and done.stderr == f"{reason}\n", f"{arguments}: {done.stderr}")

    def undone():
        ends_well(script, "--remove", NAME)
        after = contents(root)
        expect(after == before, f"--remove leaves {[str(path) for path in after if after[path] != before.get(path)]}")

    def judged():
        """What names documents takes the new one as it is; its table is measured. Returns what the program printed."""
        expect(f"| `{NAME}`, " in (root / "README.md").read_text(), "README.md does not name it")
        for check in ([root / "scripts/update_verdicts", "--check", root], [root / "scripts/check_style", root]):
            ends_well(*check)
        said = ends_well(KEPT, env={**os.environ, "GFXREPRO_SOURCE": str(root)})
        expect(f"\n{NAME} was not looked at: no run of it is kept yet\n" in said, said)
        table = root / f"configs/{NAME}/table-1.yaml"
        ends_well(PROGRAM, "check", table)
        return ends_well(PROGRAM, "reproduce", table, "--device", "software", "--out", root.parent / "run")

    refused("new_document: 'New' is no name of a document, such as cigolle2014", "New")
    refused("new_document: 'zju2005' is taken: configs/zju2005 is there already", "zju2005")
    refused("new_document: there is no configs/smoke/none.yaml", NAME, "--technique", "none")
    refused("new_document: configs/smoke/soft_shadows.yaml has no layout whose rows are its swept axes: give it one first",
            NAME, "--technique", "soft_shadows")
    refused(f"new_document: configs/documents.yaml has no '{NAME}'", "--remove", NAME)
    kept = run(script, "--remove", "zhang2012").stderr
    expect(kept.endswith("has verdicts of zhang2012: it stays\n"), kept)
    expect(contents(root) == before, "what is refused leaves something")

    ends_well(script, NAME)
    said = judged()
    expect("claims: of the documents' own claims 1 holds; read off their numbers 5 hold\n" in said
           and "Of 12 printed cells of tables 12 were measured again" in said, said)
    table = (root.parent / f"run/tables/{NAME}-1.md").read_text()
    expect("; at bits 32: a discussion in the public tracker" in table, table)
    undone()

    shutil.rmtree(root.parent / "run")
    ends_well(script, NAME, "--technique", "template")
    expect("    brightness,mean\n    0.5,\n    1,\n" in (root / f"configs/{NAME}/table-1.yaml").read_text(), "no rows")
    expect("claims: of the documents' own claims 1 holds\n" in judged(), "the claim of the smoke config")
    undone()
print("a new document is checked, measured and taken away again")

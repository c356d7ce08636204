#!/usr/bin/env python3
"""A page's commands, run from the page: readme_test.py PAGE PROGRAM.

Blocks with the NAME of a file become files, blocks of ```sh are run line by line in one folder, in the order of the page. A block after
a line "<!-- not run by its test: REASON -->" is left out; one that is "a part of FILE" has lines of that file alone. Inline commands (`gfxrepro …`) must name commands and options that exist.
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

PAGE, PROGRAM = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
IS_GUIDE = PAGE.name == "GUIDE.md"  # whose tables are of papers: some of their claims cannot be told
LEFT_OUT = re.compile(r"<!-- not run by its test: (.+) -->")


def blocks(text):
    """(first line, language, name, lines, why it is left out) of each fenced block."""
    lines = text.split("\n")
    begin, reason = None, ""
    for number, line in enumerate(lines, 1):
        if begin is None and line.startswith("```"):
            words = line[3:].split()
            begin, language, name = number, (words or [""])[0], (words[1:] or [""])[0]
            before = next((l for l in reversed(lines[:number - 1]) if l.strip()), "")
            found = LEFT_OUT.fullmatch(before)
            reason = found.group(1) if found else ""
        elif begin is not None and line == "```":
            yield begin, language, name, lines[begin:number - 1], reason
            begin = None


def foreign(lines, file):
    """The lines that a file has not; outside of YAML however far they are indented."""
    def plain(line):
        return line if file.suffix == ".yaml" else line.strip()
    whole = {plain(line) for line in file.read_text().split("\n")}
    return [line for line in lines if plain(line) not in whole]


def unknown_words(text):
    """What inline commands name and the program does not know."""
    def help_of(*words):
        result = subprocess.run([PROGRAM, *words, "--help"], capture_output=True, text=True, check=False)
        return result.stdout if result.returncode == 0 else ""
    outside = re.sub(r"^```.*?^```$", "", text, flags=re.M | re.S)
    for command in re.findall(r"`(?:man |source <\()?gfxrepro ([^`]+)`", outside):
        words = command.replace(")", " ").split()
        if words[0].startswith("-"):
            continue
        known = help_of(words[0])
        if not known:
            yield f"`gfxrepro {command}`: no command '{words[0]}'"
        for option in words[1:]:
            name = option.split("=")[0]
            if name.startswith("--") and name not in known:
                yield f"`gfxrepro {command}`: no option '{name}'"


def main():
    text = PAGE.read_text()
    problems = list(unknown_words(text))
    ran = 0
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "bin").mkdir()
        (folder / "bin" / "gfxrepro").symlink_to(PROGRAM)
        here = folder / "here"
        here.mkdir()
        environment = {**os.environ, "PATH": f"{folder / 'bin'}:{os.environ['PATH']}"}
        for line, language, name, lines, reason in blocks(text):
            if reason:
                if part_of := re.fullmatch(r"a part of (\S+)", reason):
                    problems += [f"{PAGE.name}:{line}: not in {part_of.group(1)}: {l}" for l in foreign(lines, PAGE.parent / part_of.group(1))]
                print(f"{PAGE.name}:{line}: left out: {reason}")
            elif name:
                (here / name).write_text("\n".join(lines) + "\n")
            elif language == "sh":
                for number, command in enumerate(lines, line + 1):
                    start = time.monotonic()
                    done = subprocess.run(["bash", "-c", command], cwd=here, env=environment, capture_output=True,
                                          text=True, check=False)
                    print(f"{PAGE.name}:{number}: {command}  ({time.monotonic() - start:.1f} s, exit code {done.returncode})")
                    ran += 1
                    if done.returncode != 0 or not IS_GUIDE and re.search("^claims: .*ambiguous", done.stdout, re.M):
                        problems.append(f"{PAGE.name}:{number}: {command}\n{done.stdout}{done.stderr}")
            elif language == "yaml":
                problems.append(f"{PAGE.name}:{line}: a block of YAML without the name of its file")
        for report in ("my-scene.html",) if IS_GUIDE else ():
            page = (here / report).read_text() if (here / report).exists() else ""
            for what, pattern in (("a picture", 'class="shot"'), ("a curve", 'class="curve"><'),
                                  ("the user's title", "My model at three resolutions</h1>")):
                if pattern not in page:
                    problems.append(f"{report} has not {what}: {pattern}")
    if ran < (8 if IS_GUIDE else 2):
        problems.append(f"only {ran} commands were run")
    print("\n".join(problems))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""The page WATCHING.md, as it would be pasted: watching_test.py SOURCE PROGRAM.

Its config, its line of crontab and its workflow are taken from the page, and seven nights pass, by turns with the one and the other.
Rounds are fewer. `git` and `make` are stand-ins: tonight's renderer is a variant of the shipped one, and says its own time as it is told.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

SOURCE, PROGRAM = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
PAGE = (SOURCE / "WATCHING.md").read_text()
SHIPPED = (SOURCE / "configs/external/lit_ball.sh").read_text()
problems = []


def expect(condition, what):
    if not condition:
        problems.append(what)


def block(name):
    """The lines of the page's block of this name or language."""
    return re.search(rf"^```(?:\w+ )?{re.escape(name)}\n(.*?)^```$", PAGE, re.M | re.S)[1]


def renderer(ms=400, light=1.0, crashes=False):
    """The shipped program with a clock that is told, another lamp, or an end before its time."""
    text = re.sub(r"^us=.*$", f"us={ms}000", SHIPPED, flags=re.M).replace("/ samples)", f"/ samples * {light})")
    assert f"us={ms}000" in text and f"* {light}" in text
    return text.replace("set -e\n", "set -e\nkill -SEGV $$\n") if crashes else text


def rounds(command):
    """Two rounds a look, of which there are five."""
    assert " --renderer build " in command
    return command.replace(" --renderer build ", " --renderer build --rounds 2 ")


class Home:
    """A bundle of gfxrepro beside a checkout of the renderer."""

    def __init__(self, folder):
        self.home, self.checkout = folder, folder / "renderer"
        self.state = self.checkout / "runs/nightly"
        (folder / "gfxrepro/scripts").mkdir(parents=True)
        (folder / "gfxrepro/gfxrepro").symlink_to(PROGRAM)
        shutil.copy(SOURCE / "scripts/nightly", folder / "gfxrepro/scripts")
        self.checkout.mkdir()
        (self.checkout / "watched.yaml").write_text(block("watched.yaml"))
        (folder / "bin").mkdir()
        for name, text in (("git", "echo v1.2-3-gabc"), ("make", "mkdir -p build && cp lit_ball.sh build/"), ("gfxrepro", f'exec {PROGRAM} "$@"')):
            (folder / "bin" / name).write_text(f"#!/bin/sh\n{text}\n")
            (folder / "bin" / name).chmod(0o755)

    def shell(self, command, **environment):
        """As cron runs it: in the home folder, by sh, with few variables."""
        return subprocess.run(["/bin/sh", "-c", command], cwd=environment.pop("cwd", self.home), capture_output=True, text=True, check=False,
                              env={"HOME": str(self.home), "PATH": f"{self.home}/bin:/usr/bin:/bin", **environment})

    def by_cron(self, **variant):
        """What cron would send by mail."""
        (self.checkout / "lit_ball.sh").write_text(renderer(**variant))
        line = block("crontab").strip()
        assert re.match(r"(\S+ ){5}cd ", line) and "%" not in line
        return self.shell(rounds(line.split(" ", 5)[5])).stdout

    def by_workflow(self, accept="", **variant):
        """Exit code of the night, what its steps print, and the summary."""
        (self.checkout / "lit_ball.sh").write_text(renderer(**variant))
        summary = self.home / "summary"
        summary.write_text("")
        made, night, shown = [step for step in re.findall(r" run: (.*)$", block("watch.yml"), re.M) if "curl" not in step]
        self.shell(made, cwd=self.checkout)
        ended = self.shell(rounds(night), cwd=self.checkout, ACCEPT=accept)
        self.shell(shown, cwd=self.checkout, GITHUB_STEP_SUMMARY=str(summary))
        return ended.returncode, ended.stdout + ended.stderr, summary.read_text()

    def landed(self):
        return (self.state / "landed/lit_ball.sh").read_text()

    def night(self):
        return sorted(self.state.glob("2*"))[-1]


def expect_bisected(home, kept):
    """Of four commits the third makes it darker than what landed."""
    (home.home / "bin/git").unlink()  # from here on the real one
    if not shutil.which("git", path="/usr/bin:/bin"):
        return print("left out: git bisect, as git is not installed")
    who = "git -c user.name=a -c user.email=a@b"
    (home.checkout / ".gitignore").write_text("build\nruns\n")
    home.shell("git init -q && git add .gitignore watched.yaml", cwd=home.checkout)
    for number, text in enumerate((kept, kept + "# more\n", kept.replace("* 0.99", "* 0.9"), kept.replace("* 0.99", "* 0.9") + "# more\n")):
        (home.checkout / "lit_ball.sh").write_text(text)
        home.shell(f"git add lit_ball.sh && {who} commit -qm 'number {number}'", cwd=home.checkout)
    command = block("bisect").replace("TONIGHT GOOD", "HEAD HEAD~3").replace("--programs", "--programs --rounds 2")
    found = home.shell(command, cwd=home.checkout)
    expect(re.search(r"is the first bad commit\n(.*\n)*.*number 2", found.stdout), f"bisect: {found}")


def main():
    shipped = (SOURCE / "configs/external/watched.yaml").read_text()
    expect(shipped.split("\n", 1)[1] == block("watched.yaml"), "the page's config is not the shipped one")
    with tempfile.TemporaryDirectory() as folder:
        home = Home(pathlib.Path(folder))
        mail = home.by_cron()
        expect(mail == "" and home.landed() == renderer(), f"night 1: {mail}")
        code, said, _ = home.by_workflow()
        expect(code == 0 and "nightly: " not in said, f"night 2, A/A: {code} {said}")

        mail = home.by_cron(ms=500)
        expect("render_ms: slower × 1.250 [1.250, 1.250]" in mail, f"night 3: {mail}")
        expect(home.landed() == renderer(), "night 3: what is slower has landed")

        code, said, summary = home.by_workflow(light=0.99)
        expect(code == 1 and "picture/picture: changed: FLIP " in said, f"night 4: {code} {said}")
        expect("[before](pictures/" in summary, f"night 4: {summary}")
        expect(len(list(home.night().glob("pictures/**/*-flip.png"))) == 1 and home.landed() == renderer(), "night 4: no map, or landed")

        mail = home.by_cron(crashes=True)
        expect("lost: crash: " in mail and home.landed() == renderer(), f"night 5: {mail}")
        code, said, _ = home.by_workflow(accept="it must be", crashes=True)
        expect(code == 1 and "not accepted: " in said, f"night 5, accepted: {code} {said}")
        expect(home.landed() == renderer() and not (home.state / "accepted.csv").exists(), "night 5: a crash has landed")

        code, said, _ = home.by_workflow(accept="the lamp was too bright", light=0.99)
        expect(code == 0 and "accepted (the lamp was too bright)" in said, f"night 6: {code} {said}")
        kept = (home.state / "accepted.csv").read_text()
        expect(kept.endswith('Z,"v1.2-3-gabc",1,"the lamp was too bright"\n'), f"night 6: {kept}")
        mail = home.by_cron(light=0.99)
        expect(mail == "" and home.landed() == renderer(light=0.99), f"night 7: {mail}")

        (home.checkout / "yesterday").mkdir()
        (home.checkout / "yesterday/lit_ball.sh").write_text(renderer(ms=320))
        now = home.shell(block("sh").strip().replace("--programs", "--programs --rounds 2"), cwd=home.checkout)
        expect(now.returncode == 1 and "render_ms: slower × 1.250" in now.stdout, f"two builds now: {now}")
        expect_bisected(home, kept=renderer(light=0.99))
    print("\n".join(problems))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())

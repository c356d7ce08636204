"""containers_test.py SOURCE: what the Containerfile runs, the Apptainer definition runs, stage by stage; what .containerignore keeps
out of the former, the latter, whose %files reads no such list, takes away again."""
import pathlib
import sys


def container_stages(text):
    stages = []
    for line in text.splitlines():
        word, _, rest = line.partition(" ")
        if word == "FROM":
            stages.append([])
        elif word == "RUN":
            stages[-1].append(rest)
        elif word == "ENV":
            stages[-1].append("export " + rest)
    return stages


def apptainer_stages(text):
    stages, section = [], ""
    for line in text.splitlines():
        if line.startswith("Bootstrap:"):
            stages.append([])
            section = ""
        elif line.startswith("%"):
            section = line.split()[0]
        elif section in ("%post", "%environment") and line.strip() and line.strip() != "cd /src":
            stages[-1].append(line.strip())
    return stages


ignored = (pathlib.Path(sys.argv[1]) / ".containerignore").read_text().split()
folder = pathlib.Path(sys.argv[1]) / "containers"
text = (folder / "Containerfile").read_text()
assert "USER root" not in text and "\nUSER " in text.rpartition("\nRUN ")[2], "the image runs as root"
container = container_stages(text)
apptainer = apptainer_stages((folder / "gfxrepro.def").read_text())
assert [len(stage) for stage in container] == [1, 3], container
assert apptainer[0].pop(0) == "rm -rf " + " ".join(ignored), apptainer
assert container == apptainer, f"Containerfile: {container}\ngfxrepro.def: {apptainer}"

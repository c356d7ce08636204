"""update_verdicts says of each claim that does not hold why: by its config, else by the run."""

import csv
import pathlib
import subprocess
import sys
import tempfile

SCRIPT = pathlib.Path(sys.argv[1]) / "update_verdicts"
MARKERS = "<!-- begin verdicts -->\n<!-- end verdicts -->\n"
CLAIMS = [  # claim, verdict, the run's reason, the config's, what the page says
    ("A", "ambiguous", "worst at n 1; one sample of a time decides nothing", "",
     ". Why: One process a case ran, and a time is judged from six."),
    ("B", "ambiguous", "a range of 3 processes; an interval needs 6", "",
     ". Why: 3 processes a case ran, and a time is judged from six."),
    ("C", "ambiguous", "nearer to the bound than the noise of this table, 6.89 %; by the CPU time of the process", "",
     ". Why: What was measured is nearer to the bound than the noise of the table, 6.89 %."),
    ("D", "ambiguous", "the interval straddles the bound", "",
     ". Why: The interval of what was measured lies on both sides of the bound."),
    ("E", "ambiguous", "the interval straddles the bound", "A cause.", ". Why: A cause."),
    ("H", "ambiguous", "judged after the run; the interval reaches over the bound, so neither is sure", "",
     ". Why: The interval of what was measured lies on both sides of the bound."),
    ("F", "fails", "worst at n 1", "Another.", ". Why: Another."),
    ("G", "holds", "worst at n 1", "", ""),
    ("I", "fails", "worst at n 1", "an earlier cause", ". Why: It is so: in a config. ([numbers](../../findings/p.md#table-1-i))"),
]
CONFIG = """claims:
  F:
    says: it is so
  I:
    says: it is so
    because:
      - verdict: fails
        device: gpu
        reason: "of another: device"
      - verdict: fails
        profile: quick
        reason: >-
          It is so:
          in a config.
        shown_by: p.md#table-1-i
  J:
    says: next
"""

with tempfile.TemporaryDirectory() as folder:
    root = pathlib.Path(folder)
    kept = root / "results" / "reference" / "machine" / "run"
    kept.mkdir(parents=True)
    (root / "configs" / "p").mkdir(parents=True)
    (root / "configs" / "p" / "table-1.yaml").write_text(CONFIG)
    (root / "README.md").write_text(MARKERS)
    (root / "results" / "README.md").write_text(MARKERS)
    with open(kept / "claims.csv", "w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file)
        rows.writerow(["claim", "table", "profile", "origin", "verdict", "reason", "because", "says", "required"])
        for claim, verdict, reason, because, _ in CLAIMS:
            rows.writerow([claim, "p/1", "quick", "document", verdict, reason, because, "it is so", "x < 1"])
    old = root / "results" / "reference" / "old"
    old.mkdir()
    (old / "claims.csv").write_text("claim,table,profile,origin,verdict,reason,because,says,required\n"
                                    "A,p/1,quick,document,holds,,,it is so,x < 2\n"  # asks something else today
                                    "B,p/1,quick,ours,holds,,,it is so,x < 1\n"  # is the document's today
                                    "C,p/1,quick,document,holds,,,it is so,x < 1\n"
                                    "Z,p/1,quick,ours,holds,,,it is so,x < 1\n")
    subprocess.run([sys.executable, SCRIPT, root], check=True)
    lines = (root / "results" / "reference" / "machine" / "quick.md").read_text(encoding="utf-8").splitlines()
    for claim, verdict, _, _, why in CLAIMS:
        line = next((line for line in lines if f"({claim})" in line), "")
        if not line.endswith(f"**{verdict}** it is so ({claim}){why}"):
            sys.exit(f"of {claim} the page should have said {why!r}: {line!r}")
    counted = next(line for line in (root / "results" / "README.md").read_text(encoding="utf-8").splitlines() if "| old |" in line)
    if not counted.endswith("| 1 holds (what they rest on was not tried) (and 1 not counted, 2 by earlier forms of them) |"):
        sys.exit(f"claims that ask something else today, or are another's, should not count: {counted}")
    subprocess.run([sys.executable, SCRIPT, root, "--check"], check=True)
    text = (kept / "claims.csv").read_text(encoding="utf-8").splitlines()
    for rests_on, code in (("not tried", 0), ("not known", 1)):
        lines = [text[0] + ",rests_on"] + [f"{line},{rests_on}" for line in text[1:]]
        (kept / "claims.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
        said = subprocess.run([sys.executable, SCRIPT, root, "--check"], stdout=subprocess.PIPE, text=True)
        if said.returncode != code or said.stdout.startswith("results/reference/machine/run does not know") != bool(code):
            sys.exit(f"what rests on {rests_on!r} should have exit code {code}: {said.returncode}, {said.stdout!r}")
WEIGHED = """claim,table,profile,origin,verdict,reason,because,says,required,rests_on,rows,same_as,holds_on
A,p/1,quick,document,holds,,,it is so,x < 1,bias (of 2 tried),,,
B,p/1,quick,document,holds,,,it is so,x < 1,none of the 2 tried,1 of 4 values of scene,,
C,p/1,quick,document,holds,,,it is so,x < 1,none of the 2 tried,,p/1 A,
D,p/1,quick,document,fails,,a cause,it is so,x < 1,,1 of 4 values of scene,p/1 A,"3 of 4 scenes, not on tree"
K,p/1,quick,document,holds,,,it is so,x < 1,none of the 2 tried,,p/1 D,
E,p/1,quick,document,not-applicable,,,it is so,x < 1,,,,
F,p/1,quick,document,not-applicable,,,it is so,x < 1,,,,
G,p/1,quick,existence,holds,,,it is so,x < 1,not tried,,,
H,p/1,quick,document,holds,,,it is so,x < 1,not tried,,,
I,sweep/s,quick,document,fails,,a cause,it is so,x < 1,,,,
"""
ALL = ("Over every kept run together 5 of these statements were counted; of the others no run says more than a part, or\n"
       "they are said twice. 2 hold wherever they were judged, 2 fail wherever they were, 0 did either,\n"
       "0 were ambiguous at best and 1 never judged: 50 % of what was judged holds.\n")
with tempfile.TemporaryDirectory() as folder:
    root = pathlib.Path(folder)
    for device, profile, text in (("llvmpipe-1", "quick", WEIGHED),
                                  ("nvidia-1", "paper", WEIGHED.split("A,")[0] + "E,p/1,paper,document,fails,,a cause,it is so,x < 1,,,,\n")):
        (root / "results" / "reference" / device).mkdir(parents=True)
        (root / "results" / "reference" / device / "claims.csv").write_text(text)
    (root / "configs" / "p").mkdir(parents=True)
    (root / "configs" / "p" / "table-1.yaml").write_text("claims:\n  A:\n    says: s\n  C:\n    same_as: p/1 A\n  D:\n    says: s\n"
                                                            "  E:\n    says: s\n")
    for name in ("README.md", "results/README.md"):
        (root / name).write_text(MARKERS)
    subprocess.run([sys.executable, SCRIPT, root], check=True)
    counts = ("2 hold (1 of them on an assumption of ours, 1 not tried) · 1 fails (1 on some scenes alone) · "
              "2 not-applicable (on a GPU 1 fails, 1 never judged) (and 4 not counted)")
    for name, text in (("README.md", "| `p` | 8 | 2 | 3 | 1 | 2 |\n"), ("README.md", counts), ("results/README.md", ALL),
                       ("results/README.md", counts.replace("1 fails (1", "2 fail (1")),
                       ("results/reference/llvmpipe-1/quick.md", "holds** it is so (B, document, on 1 of 4 values of scene)\n"),
                       ("results/reference/llvmpipe-1/quick.md", "holds** it is so (C, document, counted as p/1 A)\n"),
                       ("results/reference/llvmpipe-1/quick.md", "holds** it is so (K, document, counted as p/1 D)\n"),
                       ("results/reference/llvmpipe-1/quick.md", "fails** it is so (D). It holds on 3 of 4 scenes, not on tree. Why: a cause\n"),
                       ("results/reference/llvmpipe-1/quick.md", "not-applicable** it is so (E). On nvidia-1, paper profile: fails\n")):
        if text not in (root / name).read_text(encoding="utf-8"):
            sys.exit(f"{name} should have said {text!r}:\n{(root / name).read_text(encoding='utf-8')}")
    text = (root / "configs" / "p" / "table-1.yaml").read_text()
    (root / "configs" / "p" / "table-1.yaml").write_text(text.replace("  D:\n", "  D-looser:\n"))
    for row, code in (("", 1), ("| p/1 D, now D-looser | x < 1 |\n\n", 0)):
        (root / "results" / "README.md").write_text(row + (root / "results" / "README.md").read_text())
        said = subprocess.run([sys.executable, SCRIPT, root], stdout=subprocess.PIPE, text=True)
        if said.returncode != code or said.stdout.startswith("p/1 D fails in results/reference and is asked no more: ") != bool(code):
            sys.exit(f"a claim that failed and is gone, with {row!r}, should have exit code {code}: {said.returncode}, {said.stdout!r}")
    (root / "configs" / "p" / "table-2.yaml").write_text("claims:\n  A:\n    same_as: p/1 C\n")
    said = subprocess.run([sys.executable, SCRIPT, root], stdout=subprocess.PIPE, text=True)
    if said.returncode != 1 or "configs/p/table-2.yaml: same_as: p/1 C names no claim, or one that" not in said.stdout:
        sys.exit(f"a claim that is the same as one that is the same should have been named: {said.stdout!r}")
print("each claim that does not hold has its reason")

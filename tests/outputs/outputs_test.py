#!/usr/bin/env python3
"""What other programs read of a run, judged by programs that are not ours: outputs_test.py MOCK_PROGRAM OUT.

pdflatex, xmllint and html5lib are Debian's; vnu (the W3C's checker of HTML, from npm) is taken where it is installed. What is
missing is said, and leaves its test out."""

import csv
import html.parser
import json
import pathlib
import re
import shutil
import subprocess
import sys
import unittest
import xml.etree.ElementTree

HERE = pathlib.Path(__file__).parent
sys.path.append(str(HERE.parent / "support"))
import demo

MOCK, OUT = sys.argv[1], pathlib.Path(sys.argv[2])
HTML5LIB = ["/usr/bin/python3"]  # Debian's modules are those of Debian's Python

def mock(*arguments, code=None):
    result = demo.call(MOCK, OUT / "data", *arguments)
    assert code is None or result.returncode == code, result.stdout + result.stderr
    return result


def needs(program):
    found = shutil.which(program)
    return unittest.skipUnless(found, f"{program} is not installed")


class Strict(html.parser.HTMLParser):
    """What browsers repair, and the standard forbids, of the kinds that a report could have."""

    VOID = {"meta", "link", "img", "input", "br", "hr"}
    LABELABLE = {"input", "select", "output", "button", "meter", "progress", "textarea"}

    def __init__(self, text):
        super().__init__()
        self.problems, self.ids, self.open = [], set(), []
        self.feed(text)
        self.close()
        if self.open:
            self.say(f"{self.open[-1][0]} is not closed")

    def say(self, problem):
        self.problems.append(f"line {self.getpos()[0]}: {problem}")

    def handle_starttag(self, tag, attrs):
        own = dict(attrs)
        if "id" in own:
            if own["id"] in self.ids:
                self.say(f"the id {own['id']} twice")
            self.ids.add(own["id"])
        if tag == "img" and not own.get("src"):
            self.say("img without src")
        if tag == "th" and "scope" not in own:
            self.say("th without scope")
        if tag.startswith("fe") and "class" in own:
            self.say(f"class on {tag}")
        if self.open:
            parent, children = self.open[-1]
            if parent == "figure" and "figcaption" in children[1:]:
                self.say(f"{tag} behind the caption of its figure")
            children.append(tag)
        for parent, children in self.open:
            if parent == "label" and tag in self.LABELABLE:
                children.append("control")
                if children.count("control") > 1:
                    self.say("two controls in a label")
        if tag not in self.VOID:
            self.open.append((tag, []))

    def handle_startendtag(self, tag, attrs):
        self.handle_starttag(tag, attrs)
        if tag not in self.VOID:
            self.open.pop()

    def handle_endtag(self, tag):
        if not self.open or self.open[-1][0] != tag:
            self.say(f"</{tag}> where {self.open[-1][0] if self.open else 'nothing'} is open")
        else:
            self.open.pop()


class Outputs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(OUT, ignore_errors=True)
        demo.write(OUT / "data", "Times & numbers, 50 % of them_all, to 10⁻⁴ or √2, Σ xᵢ ≤ ρ", "{repeats: 2, processes: 3}",
                   ", slow_ms: {metric: wall_time_ms, where: {behaviour: ok}}")
        cls.run_ = demo.reproduce(MOCK, OUT / "data", OUT / "run")
        cls.compared = OUT / "compared"
        mock("compare", cls.run_, cls.run_, "--out", cls.compared, "--history", OUT / "history.csv", code=4)
        mock("report", cls.run_, cls.run_, "--out", OUT / "two.html")
        mock("report", cls.run_, "--embed", "--out", OUT / "one.html")
        mock("history", OUT / "history.csv", "--out", OUT / "history.html", code=0)
        cls.pages = [cls.run_ / "report.html", OUT / "two.html", OUT / "one.html", OUT / "history.html", cls.compared / "report.html"]

    def test_pages_are_strict(self):
        for page in self.pages:
            self.assertEqual(Strict(page.read_text()).problems, [], page)

    def test_the_strict_reader_finds_each_kind(self):
        for bad in ("<img alt=''>", "<figure><p></p><figcaption></figcaption><p></p></figure>", "<p id='a'></p><p id='a'></p>",
                    "<label><input><output></output></label>", "<fefunca class='x'/>", "<p><b></p></b>", "<div>", "<th></th>"):
            self.assertNotEqual(Strict(bad).problems, [], bad)

    def test_pages_are_parsed_without_an_error(self):
        if subprocess.run([*HTML5LIB, "-c", "import html5lib"], capture_output=True, check=False).returncode:
            self.skipTest("html5lib is not installed")
        reads = ("import html5lib, sys\nfor name in sys.argv[1:]:\n    parser = html5lib.HTMLParser()\n"
                 "    parser.parse(open(name, 'rb'))\n    for error in parser.errors: print(name, error)")
        said = subprocess.run([*HTML5LIB, "-c", reads, *self.pages], capture_output=True, text=True, check=True).stdout
        self.assertEqual(said, "")

    @needs("vnu")
    def test_pages_are_valid(self):
        for page in self.pages:
            said = subprocess.run(["vnu", "--errors-only", page], capture_output=True, text=True, check=False).stderr
            # A mode of blending that browsers have, and vnu does not know.
            self.assertEqual([line for line in said.splitlines() if "plus-lighter" not in line], [], page)

    @needs("xmllint")
    def test_junit_has_what_both_schemas_ask_for(self):
        for file in (self.run_ / "junit.xml", self.compared / "junit.xml"):
            judged = subprocess.run(["xmllint", "--noout", "--schema", HERE / "junit.xsd", file], capture_output=True,
                                    text=True, check=False)
            self.assertEqual(judged.returncode, 0, judged.stderr)

    def test_junit_tells_cases_that_broke_from_claims_that_fail(self):
        suites = {s.get("name"): s for s in xml.etree.ElementTree.parse(self.run_ / "junit.xml").getroot()}
        cases, claims = suites["cases"], suites["claims"]
        counts = [(s.get("tests"), s.get("failures"), s.get("errors"), s.get("skipped")) for s in (cases, claims)]
        self.assertEqual(counts, [("12", "0", "6", "0"), ("8", "2", "0", "4")])
        self.assertTrue(all(float(test.get("time")) > 0 for test in cases.iter("testcase") if not len(test)))
        self.assertAlmostEqual(sum(float(test.get("time")) for test in cases.iter("testcase")), float(cases.get("time")), delta=0.01)
        for problem in [*cases.iter("error"), *claims.iter("failure")]:
            self.assertEqual(problem.text, problem.get("message"))
        self.assertEqual({problem.get("type") for problem in cases.iter("error")}, {"error"})

    def test_tests_of_a_comparison_have_short_names(self):
        tests = xml.etree.ElementTree.parse(self.compared / "junit.xml").getroot().iter("testcase")
        names = [test.get("name") for test in tests]
        self.assertGreater(len(names), 10)
        self.assertEqual(len(set(names)), len(names))
        self.assertEqual([name for name in names if "{" in name], [])

    def test_benchmarks_are_called_by_what_tells_them_apart(self):
        entries = json.loads((self.compared / "benchmark.json").read_text())
        names = [entry["name"] for entry in entries]
        self.assertEqual(len(set(names)), len(names))
        for entry in entries:
            self.assertNotIn("{", entry["name"])
            self.assertIn("number", json.loads(entry["extra"]))

    def test_no_number_can_be_read_of_a_case_id(self):
        with open(self.run_ / "cases.csv", encoding="utf-8") as file:
            ids = [row["case_id"] for row in csv.DictReader(file)]
        self.assertEqual(len(ids), 12)
        for name in ids:
            self.assertRegex(name, "^c[0-9a-f]{12}$")

    @needs("pdflatex")
    def test_tables_are_set_by_latex_and_fit(self):
        names = sorted(file.stem for file in (self.run_ / "tables").glob("*.tex"))
        self.assertEqual(len(names), 2)
        # What the head of each file gives to be pasted.
        pasted = [re.search(r"(?ms)^%   \\begin.*?^%   \\end\{\w+\*?\}$", (self.run_ / "tables" / f"{name}.tex").read_text())[0]
                  for name in names]
        document = "\n".join([
            r"\documentclass[a4paper]{article}", r"\usepackage[T1]{fontenc}", r"\usepackage[margin=15mm]{geometry}",
            r"\usepackage{booktabs,rotating,graphicx}", r"\begin{document}",
            *(re.sub("(?m)^%", "", text) for text in pasted),
            *(rf"\begin{{table}}\resizebox{{\linewidth}}{{!}}{{\input{{tables/{name}}}}}\end{{table}}" for name in names),
            r"A number in the text: \gfxrepro{demo2026/1/1/ok}, \gfxrepro{demo2026/1/1/ok/printed}.", r"\end{document}"])
        (self.run_ / "all.tex").write_text(document)
        set_ = subprocess.run(["pdflatex", "-interaction=nonstopmode", "-halt-on-error", "all.tex"], cwd=self.run_,
                              capture_output=True, text=True, errors="replace", check=False)
        self.assertEqual(set_.returncode, 0, set_.stdout[-2000:])
        self.assertNotIn("Overfull \\hbox", set_.stdout)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)

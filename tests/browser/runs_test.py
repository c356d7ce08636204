#!/usr/bin/env python3
"""Several runs side by side: reports, comparisons, kept results."""

import json
import shutil

import report_page
from report_page import GREY, LIGHT, LOADED, OUT, add_images, halves, make_run, run


class Runs(report_page.Pages):
    def test_runs_side_by_side(self):
        other = self.other()
        both = OUT / "both" / "report.html"
        both.parent.mkdir(exist_ok=True)
        result = run("report", self.folder, other, "--out", both, data=self.data)
        self.assertEqual(result.returncode, 4, result.stderr)  # as for one run: cases threw
        self.browser.open(both)
        self.assertEqual(self.shown(".said .claim"), 6)
        self.assertEqual(self.shown(".said .badge"), 6 + 3)
        self.assertEqual(self.browser.script("return document.querySelector('.differences').textContent"), "1 of 4 verdicts differ:")
        self.assertIn("A ✗ fails B ✓ holds", self.browser.script("return document.querySelector('.differences + ul li').innerText"))
        self.browser.screenshot(OUT / "both-overview.png")
        self.browser.open(both, "#demo2026-1")
        self.assertEqual(self.browser.script(
            "return [...document.querySelectorAll('#demo2026-1 .results thead .sub')].map(h => h.textContent)"),
            ["printed", "A", "B", "A", "B"])
        self.assertEqual(self.shown(".current .curve svg"), 1, "curves lie over one another")
        names = "return [...document.querySelectorAll('.current .curve .wide [data-name] text')].map(t => t.textContent)"
        self.assertEqual(self.browser.script(names), ["A: ok", "B: ok"])
        ratios = "return [...document.querySelectorAll('.current .of-runs')].map(r => r.textContent)"
        self.assertEqual(self.browser.script(ratios), ["÷ A 1"] * 3)
        self.assertEqual(self.browser.script("const ids = [...document.querySelectorAll('[id]')].map(e => e.id);"
                                             "return ids.length - new Set(ids).size"), 0, "ids that stand twice")
        self.browser.screenshot(OUT / "both.png")

    def test_pictures_of_two_runs_lie_in_one_gallery(self):
        folders = [make_run(self.data, OUT / f"gallery-{i}", "demo2026/1") for i in range(2)]
        for i, folder in enumerate(folders):
            cases = [case["id"] for case in json.loads((folder / "plan.json").read_text())["cases"]]
            images = []
            for case in cases:
                images += [(case, "result", "", halves((90 + 9 * i, 50, 50), GREY)), (case, "truth", "result", halves(LIGHT, GREY))]
            add_images(folder, images)
        page = OUT / "gallery" / "report.html"
        page.parent.mkdir(exist_ok=True)
        run("report", *folders, "--out", page, data=self.data)
        self.browser.open(page, "#demo2026-1")
        heads = self.browser.script("return [...document.querySelectorAll('.pictures thead th')].map(h => h.textContent)")
        self.assertEqual(heads, ["truth", "A, ok", "B, ok", "A, throw", "B, throw"])
        runs = "return [...document.querySelectorAll('.shot[data-name=result]')].map(s => s.dataset.run).join('')"
        self.assertEqual(self.browser.script(runs), "AB" * 6)
        self.assertEqual(len(self.browser.script("return [...document.querySelectorAll('.shot[data-name=truth]')]")), 3, "each truth once")
        self.browser.click(".shot[data-run=B]")
        self.browser.wait(LOADED)
        self.browser.screenshot(OUT / "gallery.png")

    def test_a_comparison_is_a_page(self):
        out = OUT / "compared"
        shutil.rmtree(out, ignore_errors=True)
        result = run("compare", self.folder, self.other(), "--out", out, data=self.data)
        self.assertIn("report: ", result.stdout, result.stderr)
        self.browser.open(out / "report.html")
        told = self.browser.script("return [...document.querySelectorAll('#overview .told')].map(p => p.textContent)")
        self.assertEqual(told[0], "1 of 4 verdicts differ:")
        self.assertRegex(told[1], r"^Of all that they recorded: .*\d+ same.*\.$")
        self.assertGreater(self.browser.script("return document.querySelectorAll('details .compared tbody tr').length"), 3)
        self.browser.screenshot(OUT / "compared.png")

    def test_axe_finds_no_fault(self):
        page = OUT / "for-axe.html"
        run("report", self.folder, self.other(), "--out", page, data=self.data)
        for fragment in ("", "#demo2026-1"):
            self.browser.open(page, fragment)
            self.judge_by_axe()

    def test_kept_results_stand_beside_a_run(self):
        kept = OUT / "kept" / "quick"
        shutil.rmtree(kept, ignore_errors=True)
        kept.mkdir(parents=True)
        shutil.copy(self.folder / "claims.csv", kept)
        (kept / "runs.csv").write_text("table,commit,started,class,device,gl,cpu,cores,scans,parameters,command\n"
                                       "demo2026/1,0123,2026-01-02T03:04:05Z,software,a device,4.5,a processor,2,,,gfxrepro reproduce\n")
        (kept / "cells.csv").write_text("table,row,source,column,printed,measured,low,high,bounds,status,marks\n"
                                        "demo2026/1,number=1,,ok,2,0.5,0.4,0.6,95 % interval,,\ndemo2026/1,number=2,,ok,2,4,,,,,\n")
        for command, page in (("report", OUT / "kept" / "report.html"), ("compare", OUT / "kept-compared")):
            shutil.rmtree(OUT / "kept-compared", ignore_errors=True)
            result = run(command, kept, self.folder, "--out", page, data=self.data)
            self.browser.open(page if page.suffix else page / "report.html", "#demo2026-1")
            self.assertEqual(self.browser.script("return [...document.querySelectorAll('.current .of-runs')].map(r => r.textContent)"),
                             ["÷ A 2", "÷ A 0.5"], result.stderr)
            self.assertEqual(self.browser.script("return document.querySelector('.differences').textContent"), "0 of 8 verdicts differ.")
            self.assertIn("a device", self.browser.script("return document.querySelector('#overview .machine').textContent"))


if __name__ == "__main__":
    report_page.main()

#!/usr/bin/env python3
"""The report in a real browser: report_test.py MOCK_PROGRAM OUT. Exit 77: something is not installed."""

import csv
import hashlib
import json
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import time
import unittest

import png
import webdriver

MOCK, OUT = sys.argv[1], pathlib.Path(sys.argv[2])
DARK, LIGHT, GREY = (100, 100, 100), (140, 140, 140), (120, 120, 120)
MANY = 1200  # images of the large report

TABLE = """
table: demo2026/{number}
title: "Times <b>&</b> numbers"
technique: mock
measure: {{repeats: 5}}
sweep:
  number: [1, 2, 3]
  behaviour: [ok, throw]
layout:
  rows: number
  columns: {{ok: {{where: {{behaviour: ok}}}}, throw: {{where: {{behaviour: throw}}}}}}
  cell: {{metric: number, format: "{{median:.1f}}"}}
plots: [{{x: number, y: ok}}]
printed:
  hardware: "a <machine>"
  values: |
    number,ok
    1,2.0
    2,2.0
claims:
  H: {{says: the first is small, origin: document, bound_from: text, bound: ok, at_most: 5, at: {{number: 1}}}}
  F: {{says: the third is small, origin: document, bound_from: text, bound: ok, at_most: 2, at: {{number: 3}},
      because: {{verdict: fails, reason: three is not below two}}}}
  U: {{says: what was thrown is small, origin: document, bound_from: text, bound: throw, at_most: 2}}
  G: {{says: on a GPU it is faster, origin: ours, bound: ok, at_most: 1, profile: paper}}
assumptions:
  view: {{value: front, range: front or back, why: the paper does not say}}
"""
DOCUMENTS = """
demo2026:
  title: A demonstration
  chapters:
    - {title: Chapter 1. Small things, has: [1]}
    - {title: Chapter 2. Quick things, has: [2]}
"""
QUICKER = "profiles: {quick: {params: {pause_ms: 1}}}\n"  # of the second table, which is thus not at what is printed


NOISY_PROGRAM = """
import random, struct, sys
out, width, height, frame, bias = sys.argv[1], *map(int, sys.argv[2:5]), float(sys.argv[5])
noise = random.Random(frame)
values = [v for _ in range(height) for x in range(width) for v in [noise.random() + (bias if 2 * x >= width else 0)] * 3]
open(out + "/result.pfm", "wb").write(b"PF\\n%d %d\\n-1.0\\n" % (width, height) + struct.pack(f"<{len(values)}f", *values))
"""
NOISY = """
sweep_of: noisy
title: Noisy pictures, of which one is brighter on the right
program:
  command: python3 {here}/noisy.py {out} {width} {height} {frame} {bias}
  params: {bias: {default: 0.0, min: 0, max: 1, unit: "1"}}
  images: {result: {file: result.pfm, truth: {bias: 0, frame: 1000, frames: 6}}}
output: {width: 32, height: 32, frames: 6}
sweep: {bias: [0, 0.1]}
measure: {processes: 1}
claims:
  same: {says: all pictures have the mean of the truth, same_mean: same_mean_p, false_alarms: 1%}
"""


def run(*arguments, data):
    return subprocess.run([MOCK, *map(str, arguments)], env={**os.environ, "GFXREPRO_DATA": str(data)},
                          capture_output=True, text=True, check=False)


def make_run(data, folder, name="demo2026"):
    shutil.rmtree(folder, ignore_errors=True)
    result = run("reproduce", name, "--device", "software", "--quiet", "--profile", "quick", "--out", folder, data=data)
    assert (folder / "report.html").exists(), result.stderr
    return folder


IMAGES = "case,table,frame,name,png,exr,title,truth_of,png_sha256,exr_sha256"


def add_images(folder, images, light=None):
    """Replaces the run's images by (case, name, truth_of, colour function) of 64² pixels. `light(x, y)` is the grey light of the
    first one's EXR."""
    rows = [IMAGES]
    for i, (case, name, truth_of, colour) in enumerate(images):
        file, exr = f"images/made/{i}.png", ""
        png.write(folder / file, 64, 64, colour)
        if light and i == 0:
            exr = f"images/made/{i}.exr"
            values = [value for y in reversed(range(64)) for x in range(64) for value in [light(x, y)] * 3]
            (folder / "light.pfm").write_bytes(b"PF\n64 64\n-1.0\n" + struct.pack(f"<{len(values)}f", *values))
            assert run("image", "convert", folder / "light.pfm", "--out", folder / exr, data=OUT / "data").returncode == 0
        rows.append(f'{case},demo2026/1,0,{name},{file},{exr},"demo2026/1 case {case}",{truth_of},{digest(folder / file)},')
    (folder / "images" / "index.csv").write_text("\n".join(rows) + "\n")


def digest(file):
    return hashlib.sha256(file.read_bytes()).hexdigest()


def srgb(value):
    """What a display shows of grey light."""
    value = min(1, 12.92 * value if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055)
    return (round(255 * value),) * 3


def linear(value):
    """The other way, of 8 bits above 10."""
    return ((value / 255 + 0.055) / 1.055) ** 2.4


LOADED = ("const images = [...document.querySelectorAll('.stage img')];"
          "return document.getElementById('viewer').open && images.length && images.every(i => i.complete)")


def halves(left, right):
    return lambda x, y: left if x < 32 else right


class Report(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(OUT, ignore_errors=True)
        cls.data = OUT / "data"
        (cls.data / "configs" / "scenes").mkdir(parents=True)
        (cls.data / "configs" / "demo2026").mkdir()
        for number in (1, 2):
            (cls.data / "configs" / "demo2026" / f"table-{number}.yaml").write_text(
                TABLE.format(number=number) + (QUICKER if number == 2 else ""))
        (cls.data / "shaders").mkdir()
        (cls.data / "configs" / "documents.yaml").write_text(DOCUMENTS)
        cls.folder = make_run(cls.data, OUT / "run")
        # Left A is darker than its truth, right it is equal; "other" is brighter on the left.
        add_images(cls.folder, [("c1", "result", "", halves(DARK, GREY)), ("c1", "truth", "result", halves(LIGHT, GREY)),
                             ("c2", "result", "", halves(LIGHT, GREY)), ("c2", "truth", "result", halves(DARK, GREY))])
        assert run("report", cls.folder, data=cls.data).returncode == 4  # cases threw
        cls.browser = cls.enterClassContext(webdriver.Browser())

    def setUp(self):
        self.browser.resize(1300, 900)
        self.browser.emulate()

    def tearDown(self):
        self.assertEqual(self.browser.complaints(), [])

    def open(self, fragment="", folder=None):
        return self.browser.open((folder or self.folder) / "report.html", fragment)

    def shown(self, selector):
        return self.browser.script(
            "return [...document.querySelectorAll(arguments[0])].filter(e => e.checkVisibility()).length", selector)

    def test_the_overview_shows_every_claim_once(self):
        self.open()
        with open(self.folder / "claims.csv", encoding="utf-8") as file:
            claims = list(csv.DictReader(file))
        self.assertEqual(len(claims), 8)
        self.assertEqual(self.shown(".said .claim"), 6, "those of the document, until one asks for others")
        self.browser.script("const s = document.querySelector('.filters [name=origin]'); s.value = '';"
                            "s.dispatchEvent(new Event('input', {bubbles: true}))")
        self.assertEqual(self.shown(".said .claim"), len(claims))
        for verdict in {c["verdict"] for c in claims}:
            self.assertEqual(self.shown(f".said .badge.{verdict}"), sum(c["verdict"] == verdict for c in claims))
        self.assertEqual(self.shown(".page"), 1)
        self.assertEqual(self.shown("b"), 0, "a title's markup must stay text")
        self.browser.screenshot(OUT / "overview.png")

    def test_the_first_screen_says_what_reproduced(self):
        self.open()
        for selector, words in ((".machine", "quick profile"), (".document h2", "demo2026. A demonstration"),
                                (".document p", "Of 6 statements of the document, 4 could be judged here: 2 hold, 2 fail."),
                                (".examples li:last-child", "Table 2 Times <b>&</b> numbers: “the third is small”"),
                                (".near figcaption", "How near: 2 printed numbers that are no times were measured"),
                                (".legend-of-verdicts", "a result, no error of the run")):
            self.assertIn(words, self.browser.script("return document.querySelector(arguments[0]).textContent", selector))
        self.assertEqual(self.browser.script("return [...document.querySelectorAll('.chapters li > span')].map(s => s.textContent)"),
                         ["Chapter 1. Small things", "Chapter 2. Quick things"])
        self.assertEqual(self.shown(".highlights img"), 2, "table 1 alone has pictures: of two claims")
        self.assertIn("fails", self.browser.script("return document.querySelector('.highlights figcaption').textContent"))
        bars = self.browser.script("return [...document.querySelector('.tally').children].map(s => [s.textContent, s.getBoundingClientRect().width])")
        self.assertEqual([text for text, _ in bars], ["✓ 2 hold", "✗ 2 fail", "○ 2 unmeasured"])
        self.near([width for _, width in bars], [bars[0][1]] * 3, 2)
        self.assertIn("three is not below two",
                      self.browser.script("return document.querySelector('.said .claim[data-verdict=fails] p').textContent"))
        self.assertLess(self.browser.script("return document.querySelector('.highlights').getBoundingClientRect().top"), 900,
                        "the pictures begin on the first screen")

    def test_keys_turn_pages_and_lead_the_focus(self):
        self.open()
        self.browser.press("\ue014")  # right
        self.browser.wait("return document.getElementById('demo2026-1').checkVisibility()")
        self.assertEqual(self.browser.script("return document.activeElement.textContent"), "Table 1. Times <b>&</b> numbers")
        self.browser.press("\ue014")
        self.browser.wait("return document.getElementById('demo2026-2').checkVisibility()")
        self.browser.press("\ue012")  # left
        self.browser.wait("return document.getElementById('demo2026-1').checkVisibility()")

    def test_verdicts_have_a_sign_and_a_word(self):
        self.open()
        found = set(map(tuple, self.browser.script(
            "return [...document.querySelectorAll('.legend-of-verdicts .badge')].map(b => b.textContent.split(' '))")))
        self.assertEqual(found, {("✓", "holds"), ("✗", "fails"), ("?", "ambiguous"), ("○", "unmeasured"), ("–", "not-applicable")})

    def test_pictures_lie_as_the_table_with_each_truth_once(self):
        folder = make_run(self.data, OUT / "pictures", "demo2026/1")
        cases = [case["id"] for case in json.loads((folder / "plan.json").read_text())["cases"]]
        self.assertEqual(len(cases), 6)  # three numbers, ok and throw
        images = []
        for i, case in enumerate(cases):
            images += [(case, "result", "", halves((20 * i, 50, 50), GREY)), (case, "truth", "result", halves(LIGHT, (0, 0, 20 * (i // 2))))]
        add_images(folder, images)
        run("report", folder, data=self.data)
        self.open("", folder)
        self.assertEqual(self.browser.script("return document.querySelector('.page.current').id"), "demo2026-1",
                         "a run of one table opens on its page")
        boxes = self.browser.script(
            "return [...document.querySelectorAll('.pictures img')].map(i => {"
            "const b = i.getBoundingClientRect(), s = i.closest('button');"
            "return [s.className, s.dataset.name || '', Math.round(b.left), Math.round(b.top), Math.round(b.width)]})")
        heads = self.browser.script("return [...document.querySelectorAll('.pictures thead th')].map(h => h.textContent)")
        self.assertEqual(heads, ["truth", "ok", "throw"])
        truths = [b for b in boxes if b[1] == "truth"]
        results = [b for b in boxes if b[1] == "result"]
        errors = [b for b in boxes if b[0] == "error"]
        self.assertEqual((len(truths), len(results), len(errors)), (3, 6, 6))
        for row in range(3):
            first, second = results[2 * row:2 * row + 2]
            self.assertEqual(truths[row][3], first[3])
            self.assertEqual(first[3], second[3])
            self.assertLess(truths[row][2], first[2])
            self.assertLess(first[2], second[2])
            self.assertGreater(errors[2 * row][3], first[3], "the error is below its picture")
            self.assertEqual(errors[2 * row][2], first[2])
        self.assertGreater(results[0][4], 250, "large")
        self.browser.click(".pictures tbody:nth-of-type(2) .error")
        self.browser.wait("return document.getElementById('viewer').open")
        self.assertEqual(self.browser.script("return document.querySelector('#viewer [value=flip-map]').checked"), True)
        # All methods of this truth in one place: ok, throw, the truth, and again.
        self.browser.press("1")
        self.browser.press("+")
        seen = "return [document.querySelector('#viewer [name=a]').selectedOptions[0].text, document.querySelector('.layers').style.transform]"
        places = [self.browser.script(seen)]
        for _ in range(3):
            self.browser.press("\ue015")  # down
            places.append(self.browser.script(seen))
        self.assertEqual(places[3], places[0])
        self.assertEqual(len({place for _, place in places}), 1, "nothing moves")
        names = [name for name, _ in places[:3]]
        self.assertEqual(sorted(name.split(" · ")[0] for name in names), ["result", "result", "truth"])
        self.assertEqual(len(set(names)), 3, names)
        self.browser.press("\ue013")  # up
        self.assertEqual(self.browser.script(seen), places[2])

    def test_one_file_to_send(self):
        folder = OUT / "sent"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        run("report", self.folder, "--embed", "--out", folder / "all.html", data=self.data)
        self.assertEqual([f.name for f in folder.iterdir()], ["all.html"])
        self.browser.open(folder / "all.html", "#demo2026-1")
        self.browser.wait("return [...document.querySelectorAll('#demo2026-1 img[src]')].every(i => i.complete && i.naturalWidth)")
        self.assertEqual(self.browser.script("return [...document.querySelectorAll('img[src]')].filter(i => !i.src.startsWith('data:')).length"), 0)

    def test_a_number_is_a_multiple_of_print_at_the_printed_parameters_alone(self):
        self.open()
        text = "return document.querySelector(arguments[0]).textContent"
        self.assertEqual(self.browser.script(text, "#overview .parameters"),
                         "Of 4 printed cells of tables 4 were measured again: 2 at the printed parameters; 2 at other parameters, which each table names.")
        for slug, line, ratios in (("demo2026-1", "Measured at the printed parameters.", 2),
                                   ("demo2026-2", "Measured at pause 1 ms (the config's 0).", 0)):
            self.open("#" + slug)
            self.assertEqual(self.browser.script(text, f"#{slug} .parameters"), line)
            self.assertEqual(self.shown(f"#{slug} .ratio"), ratios)

    def top(self, selector):
        return self.browser.script("return document.querySelector(arguments[0]).getBoundingClientRect().top", selector)

    def test_a_page_begins_with_its_verdict_and_leads_to_the_claims(self):
        for width, height in ((1440, 900), (1024, 800), (500, 844)):
            self.browser.resize(width, height)
            self.open("#demo2026-1")
            line = self.browser.script("return document.querySelector('#demo2026-1 .verdict-line').textContent")
            self.assertTrue(line.startswith("Of 3 statements of the document 1 holds ✓, 1 fails ✗, 1 was not measured ○."), line)
            self.assertLess(self.top("#demo2026-1 .verdict-line"), self.top("#demo2026-1 .results"))
            self.assertLess(self.top("#demo2026-1 .verdict-line"), 300, "on the first screen")
        self.browser.resize(1300, 500)
        self.browser.click("#demo2026-1 .mark.fails")
        self.browser.wait("return document.querySelector('.claim:target')")
        self.assertEqual(self.browser.script("return document.querySelector('.claim:target .says').textContent"), "the third is small")
        self.assertTrue(0 < self.top(".claim:target") < 500, "in sight")

    def test_a_point_of_how_near_leads_to_its_cell(self):
        self.open()
        self.assertEqual(self.shown(".near circle"), 2)
        self.browser.point(".near circle")
        self.browser.wait("return document.querySelector('.tip').checkVisibility()")
        self.assertEqual(self.browser.script("return document.querySelector('.tip').textContent"),
                         "Table 1, number 1: ok: 1 measured, 2 printed, ×0.5")
        self.browser.screenshot(OUT / "near.png")
        self.browser.click(".near a[tabindex] circle")
        self.browser.wait("return document.querySelector('td:target')")
        self.assertIn("1.0", self.browser.script("return document.querySelector('td:target').textContent"))
        self.assertEqual(self.shown("#demo2026-1"), 1)

    def test_a_curve_tells_its_numbers_and_can_be_taken_away(self):
        shutil.rmtree(OUT / "curves", ignore_errors=True)
        shutil.copytree(self.folder, OUT / "curves")
        data = OUT / "curves-data"
        shutil.rmtree(data, ignore_errors=True)
        shutil.copytree(self.data, data)
        config = data / "configs" / "demo2026" / "table-1.yaml"
        config.write_text(config.read_text().replace("plots: [{x: number, y: ok}]", "plots: [{x: number, y: [ok, throw]}]")
                          .replace("behaviour: throw", "behaviour: ok"))
        folder = make_run(data, OUT / "curves", "demo2026/1")
        for width, kind in ((1300, "wide"), (500, "narrow")):
            self.browser.resize(width, 900)
            self.open("", folder)
            numbers = self.browser.script("return [...document.querySelectorAll(`.curve .${arguments[0]} g[data-curve='0'] title`)].map(t => t.textContent)", kind)
            self.assertIn("ok: number 2, number 2", numbers)
            self.browser.point(f".curve .{kind} g[data-curve='0'] circle")
            self.browser.wait("return document.querySelector('.tip').checkVisibility()")
            self.assertIn(self.browser.script("return document.querySelector('.tip').textContent"), numbers)
            self.browser.screenshot(OUT / f"curve-{kind}.png")
            self.assertEqual(self.shown(f".curve .{kind} [data-curve]:not(.off)"), 2)
            self.browser.click(f".curve .{kind} [data-name='1'] text")
            self.browser.wait("return document.querySelector('.curve [data-curve=\"1\"].off')")
            self.assertEqual(self.browser.script("return document.querySelector('.curve [data-name=\"1\"]').getAttribute('aria-pressed')"), "false")
            self.browser.click(f".curve .{kind} [data-name='1'] text")
            self.browser.wait("return !document.querySelector('.curve .off')")

    def test_filters_choose_by_verdict_words_and_paper(self):
        self.open()
        for verdict in ("holds", "ambiguous", "unmeasured", "not-applicable"):
            self.browser.click(f".filters input[value={verdict}]")
        self.assertEqual(self.shown(".said .claim"), 2)
        self.assertEqual(self.shown(".said .badge.fails"), 2)
        self.assertEqual(self.browser.script("return document.querySelector('.filters output').value"), "2 of 8 claims")
        self.browser.type(".filters [name=text]", "no such words")
        self.assertEqual(self.shown(".said .of-page"), 0)
        self.open()
        self.browser.script("document.querySelector('.filters [name=origin]').value = ''")
        self.browser.type(".filters [name=text]", "GPU")
        self.assertEqual(self.shown(".said .claim"), 2)

    def test_each_page_has_a_title_of_its_own_and_a_first_heading(self):
        first = "return [document.title, document.querySelectorAll('.current h1, .current [aria-level=\"1\"]').length]"
        titles = set()
        for fragment in ("", "#demo2026-1", "#demo2026-2"):
            self.open(fragment)
            title, count = self.browser.script(first)
            titles.add(title)
            self.assertEqual(count, 1)
            levels = self.browser.script("return [...document.querySelectorAll('.current :is(h1, h2, h3, h4)')]"
                                         ".map(h => Number(h.ariaLevel || h.tagName[1]))")
            self.assertTrue(all(b - a <= 1 for a, b in zip([0, *levels], levels)), f"{fragment}: none is left out: {levels}")
        self.assertEqual(len(titles), 3, titles)

    def test_pages_turn(self):
        self.open()
        self.browser.click(".said h4 a[href='#demo2026-1']")
        self.browser.wait("return document.getElementById('demo2026-1').checkVisibility()")
        self.assertEqual(self.shown(".page"), 1)
        self.browser.click("nav .next")
        self.browser.wait("return document.getElementById('demo2026-2').checkVisibility()")
        self.assertEqual(self.browser.script("return document.querySelector('nav select').value"), "demo2026-2")
        self.browser.script("history.back()")
        self.browser.wait("return document.getElementById('demo2026-1').checkVisibility()")

    def test_rows_show_their_cases(self):
        self.open("#demo2026-1")
        self.assertEqual(self.shown(".cases-shown"), 0)
        self.browser.point("#demo2026-1 .results tbody tr:nth-child(2) td:nth-child(3)")
        self.browser.wait("return document.querySelector('.cases-shown').checkVisibility()")
        first = self.browser.script("return document.querySelector('.cases-shown .command').textContent")
        self.assertIn("--only number=2 --only behaviour=ok", first)
        self.assertEqual(self.shown(".cases-shown .case"), 2)
        self.assertIn("nothing works", self.browser.script("return document.querySelector('.cases-shown').textContent"))
        self.browser.screenshot(OUT / "cases.png")
        self.browser.point("#demo2026-1 h2")
        self.browser.wait("return !document.querySelector('.cases-shown').checkVisibility()")
        self.browser.click("#demo2026-1 .results tbody tr:nth-child(1)")
        self.browser.point("#demo2026-1 h2")
        self.assertEqual(self.shown(".cases-shown.kept .case"), 2)
        self.browser.click(".cases-shown .close")
        self.assertEqual(self.shown(".cases-shown"), 0)

    def test_the_command_runs_that_case_alone(self):
        self.open("#demo2026-1")
        case, command = self.browser.script(
            "const c = document.querySelector('#demo2026-1 .case');"
            "return [c.id.slice(2), c.querySelector('.command').textContent]")
        again = OUT / "again"
        shutil.rmtree(again, ignore_errors=True)
        done = subprocess.run(f"{command} --out {again}".replace("gfxrepro", MOCK, 1), shell=True, check=False,
                              env={**os.environ, "GFXREPRO_DATA": str(self.data)}, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(again / "records.csv", encoding="utf-8") as file:
            self.assertEqual({row["case"] for row in csv.DictReader(file)}, {case})

    def view(self, case):
        self.open("#demo2026-1")
        self.browser.click(f".shot[data-case={case}][data-name=result]")
        self.browser.wait(LOADED)

    def pixels(self, name):
        """The colours left and right of the middle of the first pane's image."""
        time.sleep(0.2)  # until the compositor has drawn
        self.browser.screenshot(OUT / f"{name}.png", ".stage")
        box = self.browser.script(
            "const i = document.querySelector('.pane .layers').getBoundingClientRect(),"
            "s = document.querySelector('.stage').getBoundingClientRect();"
            "return [i.left - s.left, i.top - s.top, i.width, i.height]")
        _, _, at = png.read(OUT / f"{name}.png")
        y = round(box[1] + box[3] / 2)
        return at(round(box[0] + box[2] / 4), y), at(round(box[0] + box[2] * 3 / 4), y)

    def set_gain(self, exponent):
        self.browser.script("const g = document.querySelector('[name=gain]'); g.value = arguments[0];"
                            "g.dispatchEvent(new Event('input', {bubbles: true}))", exponent)

    def near(self, found, expected, tolerance=3):
        for f, e in zip(found, expected):
            self.assertLessEqual(abs(f - e), tolerance, f"{found} is not {expected}")

    def test_the_viewer_pairs_an_image_with_its_truth(self):
        self.view("c1")
        self.assertEqual(self.browser.script("return document.querySelector('#viewer [name=b]').selectedOptions[0].text"),
                         "truth · case c1")
        left, right = self.pixels("viewer-side")
        self.near(left, DARK)
        self.near(right, GREY)
        self.assertEqual(self.shown(".stage .pane"), 2)
        self.browser.press("\ue00c")  # Escape
        self.browser.wait("return !document.getElementById('viewer').open")

    def test_flip_shows_one_then_the_other(self):
        self.view("c1")
        self.browser.press("2")
        self.near(self.pixels("viewer-flip-a")[0], DARK)
        self.browser.press("f")
        self.near(self.pixels("viewer-flip-b")[0], LIGHT)
        self.assertEqual(self.shown(".stage .pane"), 1)

    def test_the_slider_shows_a_left_and_b_right_of_it(self):
        self.view("c1")
        self.browser.press("3")
        self.near(self.pixels("viewer-slider")[0], DARK)
        self.browser.drag(".handle", -500, 0)
        self.near(self.pixels("viewer-slider-dragged")[0], LIGHT)

    def test_the_viewer_by_keys_alone(self):
        left, right, shift = "\ue012", "\ue014", "\ue008"
        focus = "document.querySelector(arguments[0]).focus()"
        value = "return document.querySelector('#viewer .bar').elements[arguments[0]].value"
        at = "return document.querySelector('.layers').style.transform"
        self.view("c1")
        shot = self.browser.script(value, "a")
        self.browser.script(focus, "#viewer [value=side]")
        self.browser.press(right)
        self.assertEqual((self.browser.script(value, "mode"), self.browser.script(value, "a")), ("flip", shot))
        self.browser.script(focus, "#viewer [name=a]")
        for key in "f3":  # may begin the name of a picture
            self.browser.press(key)
        self.assertEqual(self.browser.script(value, "mode"), "flip")
        self.assertEqual(self.shown(".stage.flipped"), 0)
        self.browser.script(focus, "#viewer [name=pixels]")
        before = self.browser.script(at)
        self.browser.press(right, held=shift)
        moved = self.browser.script(at)
        self.assertNotEqual(moved, before)
        self.browser.press(left, held=shift)
        self.assertEqual(self.browser.script(at), before)
        self.browser.press("3")
        self.browser.script(focus, ".handle")
        for _ in range(25):
            self.browser.press(left)
        self.assertEqual(self.browser.script("return document.querySelector('.handle').ariaValueNow"), "0")
        self.near(self.pixels("viewer-slider-by-keys")[0], LIGHT)
        self.assertGreater(self.shown(".keys kbd"), 5)

    def set_slider(self, name, value):
        self.browser.script("const s = document.querySelector(`#viewer [name=${arguments[0]}]`); s.value = arguments[1];"
                            "s.dispatchEvent(new Event('input', {bubbles: true}))", name, value)

    def lit(self, *arguments):
        """A report of two pictures; of the first the left is light of 0.25, and the right of 300, which a PNG shows as white."""
        folder = OUT / "lit"
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(self.folder, folder)
        add_images(folder, [("c1", "result", "", halves(srgb(0.25), (255,) * 3)), ("c1", "truth", "result", halves(srgb(0.25), GREY))],
                   lambda x, y: 0.25 if x < 32 else 300)
        run("report", folder, *arguments, data=self.data)
        self.browser.resize(700, 500)  # its screenshots are read in Python
        self.open("#demo2026-1", folder)
        self.browser.click(".shot[data-case=c1][data-name=result]")
        self.browser.wait(LOADED)
        return folder

    def test_exposure_brings_back_the_light_above_white(self):
        for arguments in ((), ("--embed",)):
            self.lit(*arguments)
            self.browser.press("2")
            self.near(self.pixels("viewer-lit")[1], (255, 255, 255), 0)
            for stops in (-1, -4, -9, -10):
                self.set_slider("exposure", stops)
                left, right = self.pixels(f"viewer-exposed{stops}")
                self.near(left, srgb(0.25 * 2 ** stops), 2)
                self.near(right, srgb(300 * 2 ** stops), 3)
            self.set_slider("gamma", 2)
            self.near(self.pixels("viewer-gamma")[1], srgb((300 * 2 ** -10) ** 0.5), 3)
            self.browser.point(".pane")
            self.browser.drag(".pane", 60, 0)
            self.assertRegex(self.browser.script("return document.querySelector('[name=pixel]').value"), r"A 255 255 255 \(light 30\d 30\d 30\d\)")
            self.browser.press("r")
            self.near(self.pixels("viewer-as-before")[1], (255, 255, 255), 0)
            self.set_slider("exposure", 1)
            self.near(self.pixels("viewer-brighter")[0], srgb(0.5), 2)

    def test_a_bias_is_shown_tile_by_tile_and_its_seeds_are_folded(self):
        noisy = OUT / "noisy"
        shutil.rmtree(noisy, ignore_errors=True)
        noisy.mkdir()
        (noisy / "noisy.py").write_text(NOISY_PROGRAM)
        (noisy / "noisy.yaml").write_text(NOISY)
        self.assertEqual(run("reproduce", noisy / "noisy.yaml", "--quiet", "--out", noisy / "run", data=self.data).returncode, 1)
        self.open("", noisy / "run")
        self.browser.screenshot(OUT / "same-mean.png")
        names = "return [...document.querySelectorAll('.shot')].filter(s => s.checkVisibility()).map(s => s.dataset.name)"
        self.assertEqual(self.browser.script(names), ["result mean difference"] * 2, "a map a case")
        self.assertEqual(len(self.browser.script("return [...document.querySelectorAll('details.further .shot')]")), 2 * 6 + 6,
                         "and the truth beside each frame")
        self.browser.click(".shot[data-title='bias 0.1']")
        self.browser.wait(LOADED)
        self.browser.press("2")
        left, right = self.pixels("viewer-same-mean")
        self.assertLess(max(left) - min(left), 90, f"nearly grey: {left}")
        self.assertGreater(right[2] - right[0], 90, f"blue, for it is brighter: {right}")

    def test_differences_are_of_what_is_exposed(self):
        self.lit()
        self.browser.press("5")
        self.set_slider("exposure", -10)
        left, right = self.pixels("viewer-exposed-difference")
        self.near(left, (0, 0, 0), 0)
        self.near(right, [a - b for a, b in zip(srgb(300 / 1024), srgb(linear(120) / 1024))], 3)

    def test_what_is_seen_stands_in_the_address(self):
        self.view("c1")
        state = ("return ['a', 'b', 'mode', 'exposure', 'gamma', 'gain'].map(n => document.querySelector('#viewer .bar').elements[n].value)"
                 ".concat(document.querySelector('.layers').style.transform)")
        self.browser.press("4")
        for name, value in (("exposure", -2.5), ("gamma", 1.3), ("gain", 3)):
            self.set_slider(name, value)
        self.browser.press("+")
        self.browser.press("\ue014", held="\ue008")
        before = self.browser.script(state)
        self.browser.wait("return location.hash.includes('at=')")
        address = self.browser.script("return location.hash")
        self.open(address)
        self.browser.wait(LOADED)
        self.assertEqual(self.browser.script("return document.querySelector('.page.current').id"), "demo2026-1")
        after = self.browser.script(state)
        self.assertEqual(after[:-1], before[:-1])
        numbers = lambda text: [float(number) for number in re.findall(r"-?[\d.]+", text)]
        self.near(numbers(after[-1]), numbers(before[-1]), 2)
        self.browser.press("\ue00c")  # Escape
        self.browser.wait("return location.hash === '#demo2026-1'")

    def test_a_picture_fills_its_pane_and_says_its_error(self):
        self.view("c1")
        widths = self.browser.script("return ['.pane', '.layers'].map(s => { const b = document.querySelector(s).getBoundingClientRect();"
                                     "return [b.width, b.height]; })")
        self.assertAlmostEqual(max(i / p for i, p in zip(widths[1], widths[0])), 1, delta=0.01)
        said = self.browser.script("return document.querySelector('#viewer [name=error]').value")
        shown = self.browser.script("return document.querySelector('.of-error figcaption').textContent")
        self.assertRegex(said, r"^FLIP 0\.\d+")
        self.assertAlmostEqual(float(said.split()[1]), float(re.search(r"FLIP ([\d.]+)", shown)[1]), delta=1e-4)

    def test_error_maps_show_sign_and_gain(self):
        grey = (222, 222, 222)
        for case, is_darker in (("c1", True), ("c2", False)):
            self.view(case)
            self.browser.press("4")
            self.set_gain(2)  # ×4: 4 · 40/255 = 0.63 of the way to the end
            left, right = self.pixels(f"viewer-signed-{case}")
            self.near(right, grey)
            self.assertEqual(left[0] > left[2], is_darker, f"red where A is darker, blue where brighter: {left}")
            middle, end = 222, (181, 5, 38) if is_darker else (59, 77, 191)
            part = 4 * 40 / 255
            self.near(left, [middle + part * (e - middle) for e in end], 5)
            self.set_gain(7)
            left, right = self.pixels(f"viewer-signed-128-{case}")
            self.near(right, grey, 1)  # equal stays grey at any gain
            self.near(left, end, 4)
        self.browser.press("5")
        self.set_gain(2)
        left, right = self.pixels("viewer-absolute")
        self.near(left, (160, 160, 160))  # 4 · |100 − 140|
        self.near(right, (0, 0, 0))

    def test_the_flip_map_and_its_legend(self):
        self.view("c1")
        self.browser.press("6")
        left, right = self.pixels("viewer-flip-map")
        self.assertGreater(sum(left), sum(right) + 60)
        self.near(right, (0, 0, 4))
        self.assertEqual(self.shown(".legend"), 1)
        self.browser.script("document.querySelector('#viewer [name=b]').value = 2;"
                            "document.querySelector('#viewer [name=b]').dispatchEvent(new Event('change', {bubbles: true}))")
        self.assertTrue(self.browser.script("return document.querySelector('[value=flip-map]').disabled"),
                        "images that are no pair have no map")

    def test_zoom_is_the_same_in_both_panes_and_shows_pixels(self):
        self.view("c1")
        for _ in range(12):
            self.browser.scroll(".pane", -100)
        transforms = self.browser.script("return [...document.querySelectorAll('.layers')].map(l => l.style.transform)")
        self.assertEqual(transforms[0], transforms[1])
        self.assertEqual(self.shown(".layers.pixels"), 2)
        _, _, at = (self.pixels("viewer-zoomed"), *png.read(OUT / "viewer-zoomed.png"))[1:]
        row = {at(x, 300) for x in range(40, 600)}
        self.assertLessEqual(row, {DARK, GREY}, "no colour between two pixels: they are not smoothed")
        self.browser.drag(".pane", 40, 30)
        moved = self.browser.script("return [...document.querySelectorAll('.layers')].map(l => l.style.transform)")
        self.assertEqual(moved[0], moved[1])
        self.assertNotEqual(moved[0], transforms[0])

    def test_nothing_is_asked_of_a_network_and_no_image_is_missing(self):
        self.open()
        self.browser.script("document.body.classList.remove('paged');"
                            "document.querySelectorAll('img').forEach(i => { i.loading = 'eager'; })")
        self.browser.wait("return [...document.querySelectorAll('.gallery img')].every(i => i.complete)")
        self.assertEqual(self.browser.script("return [...document.querySelectorAll('.gallery img')].filter(i => !i.naturalWidth).length"), 0)
        self.assertEqual(self.shown(".gallery img"), 4 + 2, "and two error maps")
        names = self.browser.script("return performance.getEntriesByType('resource').map(e => e.name)")
        self.assertEqual([n for n in names if not n.startswith(("file:", "data:"))], [])

    def test_narrow_dark_and_print(self):
        self.browser.resize(500, 900)  # Chromium's windows are not narrower
        for fragment in ("", "#demo2026-1"):
            self.open(fragment)
            self.assertLessEqual(self.browser.script("return document.documentElement.scrollWidth - innerWidth"), 0)
        self.assertEqual((self.shown(".current .narrow"), self.shown(".current .wide")), (1, 0), "of the curve")
        self.browser.screenshot(OUT / "narrow.png")
        self.browser.resize(1300, 900)
        self.assertEqual((self.shown(".current .narrow"), self.shown(".current .wide")), (0, 1), "of the curve")
        luminance = ("const c = getComputedStyle(document.body)[arguments[0]].match(/\\d+/g).map(Number);"
                     "return (c[0] + c[1] + c[2]) / 3")
        for scheme, is_dark in (("dark", True), ("light", False)):
            self.browser.emulate(scheme=scheme)
            self.open("#demo2026-1")
            self.assertEqual(self.browser.script(luminance, "backgroundColor") < 60, is_dark)
            self.assertEqual(self.browser.script(luminance, "color") > 180, is_dark)
            self.browser.screenshot(OUT / f"{scheme}.png")
        self.browser.emulate(media="print", scheme="dark")
        self.assertEqual(self.shown(".page"), 3, "print has all pages")
        self.assertEqual(self.shown("nav, .filters, .cases-shown"), 0)
        self.assertGreater(self.browser.script(luminance, "backgroundColor"), 240)

    def test_on_paper_no_table_is_cut_and_assumptions_stand_once(self):
        self.open("#demo2026-1")
        self.browser.script("for (const row of document.querySelectorAll('#demo2026-1 .results tr, #demo2026-2 .results tr')) {"
                            "  const count = row.closest('#demo2026-1') ? 20 : 60;"
                            "  for (let i = 0; i < count; ++i) row.append(row.lastElementChild.cloneNode(true)); }"
                            "dispatchEvent(new Event('beforeprint'))")
        self.browser.resize(680, 900)
        self.browser.emulate(media="print")
        widths = self.browser.script("return [...document.querySelectorAll('.scroll > table')].filter(t => t.checkVisibility())"
                                     ".map(t => [t.getBoundingClientRect().width, t.parentElement.classList.contains('across')])")
        self.assertGreater(len(widths), 3)
        for width, is_across in widths:
            self.assertLessEqual(width, 940.5 if is_across else 680.5)
        self.assertGreater(len([width for width, is_across in widths if is_across]), 0)
        self.assertEqual(self.shown(".assumed"), 1)
        self.assertIn("As said before: view.", self.browser.script("return document.querySelector('#demo2026-2').innerText"))
        self.assertNotIn("Point at a row", self.browser.script("return document.body.innerText"))
        self.browser.script("dispatchEvent(new Event('afterprint'))")
        self.browser.emulate()
        self.assertEqual((self.shown(".page"), self.shown(".of-paper")), (1, 0))

    def test_many_images_are_loaded_as_they_come_into_sight(self):
        folder = OUT / "many"
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(self.folder, folder)
        noise = os.urandom(3 * 96 * 96)
        rows = [IMAGES]
        pixel = lambda x, y: noise[3 * (96 * (y % 96) + x % 96):][:3]
        png.write(folder / "images/made/noise.png", 288, 288, pixel)
        png_sha256 = digest(folder / "images/made/noise.png")
        for i in range(MANY):
            file = f"images/made/many-{i}.png"
            shutil.copy(folder / "images/made/noise.png", folder / file)
            rows.append(f"c{i // 4},demo2026/1,0,n{i % 4},{file},,demo2026/1 case {i // 4},,{png_sha256},")
        (folder / "images" / "index.csv").write_text("\n".join(rows) + "\n")
        self.assertEqual(run("report", folder, data=self.data).returncode, 4)  # cases threw
        seconds = self.open("#demo2026-1", folder)
        print(f"\n{MANY} images, {(folder / 'report.html').stat().st_size / 1e6:.1f} MB of HTML: opened in {seconds:.2f} s", file=sys.stderr)
        self.assertEqual(self.browser.script("return document.querySelectorAll('.gallery img').length"), MANY)
        loaded = self.browser.script("return performance.getEntriesByType('resource').length")
        self.assertLess(loaded, MANY / 2, "only what is near the window is loaded")
        sources = self.browser.script("return [...document.querySelectorAll('.gallery img')].map(i => i.getAttribute('src'))")
        self.assertTrue(all((folder / s).is_file() for s in sources))
        self.browser.click(".shot[data-case=c250]")
        self.browser.wait("const i = document.querySelector('.stage .a img');"
                          "return i.complete && i.naturalWidth === 288 && document.getElementById('viewer').open")

    def other(self):
        """A run of table 1 whose third number is asked for less: its claim F holds."""
        data = OUT / "other-data"
        shutil.rmtree(data, ignore_errors=True)
        shutil.copytree(self.data, data)
        config = data / "configs" / "demo2026" / "table-1.yaml"
        config.write_text(config.read_text().replace("at_most: 2, at: {number: 3}", "at_most: 9, at: {number: 3}"))
        return make_run(data, OUT / "other", "demo2026/1")

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
    if webdriver.missing():
        print(f"skipped: {webdriver.missing()} is not installed (scripts/setup --tests installs it)")
        sys.exit(77)
    unittest.main(argv=[sys.argv[0], "-v"])

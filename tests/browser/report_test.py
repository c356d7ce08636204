#!/usr/bin/env python3
"""The pages of a report."""

import csv
import json
import os
import shutil
import subprocess
import sys
import unittest

import png
import report_page
import webdriver
from report_page import GREY, IMAGES, LIGHT, LOADED, MOCK, OUT, add_images, digest, halves, make_run, run

MANY = 1200  # images of the large report


class Report(report_page.Pages):
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

    def test_axe_finds_no_fault(self):
        for width, scheme in ((1300, "light"), (1300, "dark"), (500, "light")):
            self.browser.resize(width, 900)
            self.browser.emulate(scheme=scheme)
            for fragment in ("", "#demo2026-1"):
                self.open(fragment)
                self.judge_by_axe()
            self.browser.click(".shot")
            self.browser.wait(LOADED)
            self.judge_by_axe()

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

    def test_nothing_is_asked_of_a_network_and_no_image_is_missing(self):
        self.open()
        self.browser.script("document.body.classList.remove('paged');"
                            "document.querySelectorAll('img').forEach(i => { i.loading = 'eager'; })")
        self.browser.wait("return [...document.querySelectorAll('.gallery img')].every(i => i.complete)")
        self.assertEqual(self.browser.script("return [...document.querySelectorAll('.gallery img')].filter(i => !i.naturalWidth).length"), 0)
        self.assertEqual(self.shown(".gallery img"), 4 + 2, "and two error maps")
        names = self.browser.script("return performance.getEntriesByType('resource').map(e => e.name)")
        self.assertEqual([n for n in names if not n.startswith(("file:", "data:"))], [])

    @unittest.skipIf(webdriver.IS_FIREFOX, "media are emulated in Chromium alone")
    def test_narrow_dark_and_print(self):
        self.browser.resize(500, 900)  # Chromium's windows are not narrower
        for fragment in ("", "#demo2026-1"):
            self.open(fragment)
            self.assertLessEqual(self.browser.script("return document.documentElement.scrollWidth - innerWidth"), 0)
        self.assertEqual((self.shown(".current .narrow"), self.shown(".current .wide")), (1, 0), "of the curve")
        self.assertLessEqual(self.browser.script("const t = document.querySelector('.current .assumed').parentElement; return t.scrollWidth - t.clientWidth"), 0)
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

    @unittest.skipIf(webdriver.IS_FIREFOX, "media are emulated in Chromium alone")
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


if __name__ == "__main__":
    report_page.main()

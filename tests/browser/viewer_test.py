#!/usr/bin/env python3
"""The viewer of a report: pixels, keys, exposure, address."""

import re
import shutil
import sys

import png
import report_page
from report_page import DARK, GREY, LIGHT, LOADED, OUT, linear, run, srgb

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


class Viewer(report_page.Pages):
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


if __name__ == "__main__":
    report_page.main()

"""What the tests of the pages share: a run with pictures of known colours, opened in a browser. Each is called with
MOCK_PROGRAM OUT; exit 77: something is not installed."""

import hashlib
import pathlib
import shutil
import struct
import subprocess
import sys
import time
import unittest

import png
import webdriver

sys.path.append(str(pathlib.Path(__file__).parents[1] / "support"))
import demo

MOCK, OUT = sys.argv[1], pathlib.Path(sys.argv[2])
DARK, LIGHT, GREY = (100, 100, 100), (140, 140, 140), (120, 120, 120)

DOCUMENTS = """
demo2026:
  title: A demonstration
  chapters:
    - {title: Chapter 1. Small things, has: [1]}
    - {title: Chapter 2. Quick things, has: [2]}
"""
QUICKER = "profiles: {quick: {params: {pause_ms: 1}}}\n"  # of the second table, which is thus not at what is printed
IMAGES = "case,table,frame,name,png,exr,title,truth_of,png_sha256,exr_sha256"
LOADED = ("const images = [...document.querySelectorAll('.stage img')];"
          "return document.getElementById('viewer').open && images.length && images.every(i => i.complete)")


def axe():
    """The text of axe-core (npm install -g axe-core), which judges how a page can be used; None where it is not installed."""
    if not shutil.which("npm"):
        return None
    folder = subprocess.run(["npm", "root", "-g"], capture_output=True, text=True, check=True).stdout.strip()
    file = pathlib.Path(folder) / "axe-core" / "axe.min.js"
    return file.read_text() if file.exists() else None


def run(*arguments, data):
    return demo.call(MOCK, data, *arguments)


def make_run(data, folder, name="demo2026"):
    return demo.reproduce(MOCK, data, folder, name)


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


def halves(left, right):
    return lambda x, y: left if x < 32 else right


class Pages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(OUT, ignore_errors=True)
        cls.data = OUT / "data"
        demo.write(cls.data, "Times <b>&</b> numbers", "{repeats: 5}", behind_second=QUICKER)
        (cls.data / "configs" / "documents.yaml").write_text(DOCUMENTS)
        cls.folder = make_run(cls.data, OUT / "run")
        # Left A is darker than its truth, right it is equal; "other" is brighter on the left.
        add_images(cls.folder, [("c1", "result", "", halves(DARK, GREY)), ("c1", "truth", "result", halves(LIGHT, GREY)),
                             ("c2", "result", "", halves(LIGHT, GREY)), ("c2", "truth", "result", halves(DARK, GREY))])
        assert run("report", cls.folder, data=cls.data).returncode == 4  # cases threw
        cls.browser = cls.enterClassContext(webdriver.browser())

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

    def judge_by_axe(self):
        """What stands on the page that is open is found at fault by no rule."""
        text = axe()
        if not text:
            self.skipTest("axe-core is not installed")
        found = self.browser.script(text + "; return axe.run(document, {resultTypes: ['violations']}).then(result => result.violations"
                                    ".map(v => [v.id, v.nodes.map(n => n.html.slice(0, 200) + n.failureSummary)]))")
        self.assertEqual(found, [])

    def top(self, selector):
        return self.browser.script("return document.querySelector(arguments[0]).getBoundingClientRect().top", selector)

    def near(self, found, expected, tolerance=3):
        for f, e in zip(found, expected):
            self.assertLessEqual(abs(f - e), tolerance, f"{found} is not {expected}")

    def other(self):
        """A run of table 1 whose third number is asked for less: its claim F holds."""
        data = OUT / "other-data"
        shutil.rmtree(data, ignore_errors=True)
        shutil.copytree(self.data, data)
        config = data / "configs" / "demo2026" / "table-1.yaml"
        config.write_text(config.read_text().replace("at_most: 2, at: {number: 3}", "at_most: 9, at: {number: 3}"))
        return make_run(data, OUT / "other", "demo2026/1")

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


def main():
    if webdriver.missing():
        print(f"skipped: {webdriver.missing()} is not installed (scripts/setup --tests installs it)")
        sys.exit(77)
    unittest.main(argv=[sys.argv[0], "-v"])

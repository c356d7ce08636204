"""Where gfxrepro.emit writes, what, and what it refuses."""

import contextlib
import fractions
import io
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import threading
import unittest

import gfxrepro


class Emit(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.file = pathlib.Path(self.folder.name) / "metrics.jsonl"
        for name in ("GFXREPRO_METRICS_FD", "GFXREPRO_METRICS_FILE"):
            os.environ.pop(name, None)
            self.addCleanup(os.environ.pop, name, None)

    def lines_of(self, *calls):
        os.environ["GFXREPRO_METRICS_FILE"] = str(self.file)
        for arguments, named in calls:
            gfxrepro.emit(*arguments, **named)
        return [json.loads(line) for line in self.file.read_text().splitlines()]

    def test_a_line_a_number_at_the_end_of_the_file(self):
        self.file.write_text('{"metric": "before"}\n')
        lines = self.lines_of((("time_ms", 41.25, "ms"), {"pass_": "trace", "frame": 0}), (("größe", 3, "1"), {}))
        self.assertEqual(lines[1:], [{"metric": "time_ms", "pass": "trace", "frame": 0, "value": 41.25, "unit": "ms"},
                                     {"metric": "größe", "value": 3, "unit": "1"}])
        self.assertTrue(self.file.read_text().endswith("}\n"))

    def test_numbers_keep_their_digits(self):
        lines = self.lines_of((("a", 0.1 + 0.2, "1"), {}), (("b", 2**53 + 1, "1"), {}),
                              (("c", fractions.Fraction(1, 4), "1"), {}))
        self.assertEqual([line["value"] for line in lines], [0.1 + 0.2, 2**53 + 1, 0.25])

    def test_the_descriptor_comes_before_the_file(self):
        program = "import gfxrepro; gfxrepro.emit('a', 1, 'ms'); gfxrepro.emit('b', 2.5, '1', pass_='p')"
        reader, writer = os.pipe()
        environment = os.environ | {"GFXREPRO_METRICS_FD": str(writer), "GFXREPRO_METRICS_FILE": str(self.file)}
        subprocess.run([sys.executable, "-c", program], pass_fds=[writer], env=environment, check=True)
        os.close(writer)
        with open(reader) as stream:
            lines = [json.loads(line) for line in stream]
        self.assertEqual(lines, [{"metric": "a", "value": 1, "unit": "ms"},
                                 {"metric": "b", "pass": "p", "value": 2.5, "unit": "1"}])
        self.assertFalse(self.file.exists())

    def test_without_either_it_goes_to_the_standard_output(self):
        with contextlib.redirect_stdout(io.StringIO()) as out:
            gfxrepro.emit("a", 1, "ms")
        self.assertEqual(json.loads(out.getvalue()), {"metric": "a", "value": 1, "unit": "ms"})

    def test_lines_of_several_threads_stay_whole(self):
        os.environ["GFXREPRO_METRICS_FILE"] = str(self.file)
        threads = [threading.Thread(target=lambda: [gfxrepro.emit("m" * 500, i, "1") for i in range(100)])
                   for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        values = [json.loads(line)["value"] for line in self.file.read_text().splitlines()]
        self.assertEqual(sorted(values), sorted(4 * list(range(100))))

    def test_what_it_refuses(self):
        os.environ["GFXREPRO_METRICS_FILE"] = str(self.file)
        for arguments, named, error, words in [
                (("", 1, "ms"), {}, ValueError, "metric is ''; allowed: text of one line"),
                (("a\nb", 1, "ms"), {}, ValueError, r"metric is 'a\\nb'; allowed: text of one line"),
                ((7, 1, "ms"), {}, TypeError, "metric is 7; allowed: text"),
                (("a", 1, None), {}, TypeError, "unit is None; allowed: text"),
                (("a", float("nan"), "1"), {}, ValueError, "value is nan; allowed: a finite number"),
                (("a", float("inf"), "1"), {}, ValueError, "value is inf; allowed: a finite number"),
                (("a", True, "1"), {}, TypeError, "value is True; allowed: a number"),
                (("a", "1", "1"), {}, TypeError, "value is '1'; allowed: a number"),
                (("a", 1, "1"), {"frame": -1}, ValueError, "frame is -1; allowed: a whole number from 0"),
                (("a", 1, "1"), {"frame": 1.5}, TypeError, "integer"),
                (("a", 1, "1"), {"pass_": ""}, ValueError, "pass_ is ''; allowed: text of one line")]:
            with self.subTest(words), self.assertRaisesRegex(error, words):
                gfxrepro.emit(*arguments, **named)
        self.assertFalse(self.file.exists())

    def test_a_broken_descriptor_is_an_error(self):
        os.environ["GFXREPRO_METRICS_FD"] = "three"
        with self.assertRaisesRegex(ValueError, "GFXREPRO_METRICS_FD is 'three'; allowed: the number of a descriptor"):
            gfxrepro.emit("a", 1, "1")
        os.environ["GFXREPRO_METRICS_FD"] = "9999"
        with self.assertRaises(OSError):
            gfxrepro.emit("a", 1, "1")

    def test_numpy_numbers_are_numbers(self):
        try:
            import numpy
        except ImportError:
            self.skipTest("NumPy is not installed")
        lines = self.lines_of((("a", numpy.float32(0.5), "1"), {}), (("b", numpy.int64(7), "1"), {"frame": numpy.int32(1)}))
        self.assertEqual([line["value"] for line in lines], [0.5, 7])
        self.assertEqual(lines[1]["frame"], 1)


if __name__ == "__main__":
    unittest.main()

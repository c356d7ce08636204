"""What a program under test measures, a JSON line a number."""

import json
import math
import operator
import os
import sys
import typing

DESCRIPTOR = "GFXREPRO_METRICS_FD"
FILE = "GFXREPRO_METRICS_FILE"


def emit(metric: str, value: typing.SupportsFloat, unit: str, pass_: str | None = None, frame: int | None = None) -> None:
    """Says one number: {"metric": …, "pass": …, "frame": …, "value": …, "unit": …} on a line of its own.

    The line goes to the descriptor that GFXREPRO_METRICS_FD names; without it, it is appended to the file that
    GFXREPRO_METRICS_FILE names; without either (the program was started by hand) it goes to the standard output.
    Each call writes its whole line at once. `pass_` is a step of the program, `frame` a number from 0; what is not
    given is left out. `unit` is "1" for what has none. Any kind of real number will do, NumPy's too.
    Raises TypeError or ValueError for what is no finite number or no name, OSError where it cannot be written.
    """
    line: dict[str, typing.Any] = {"metric": _text("metric", metric)}
    if pass_ is not None:
        line["pass"] = _text("pass_", pass_)
    if frame is not None:
        line["frame"] = _frame(frame)
    line["value"] = _number(value)
    line["unit"] = _text("unit", unit)
    _write((json.dumps(line, ensure_ascii=False) + "\n").encode())


def _text(what, text):
    if not isinstance(text, str):
        raise TypeError(f"{what} is {text!r}; allowed: text")
    if not text or not text.isprintable():
        raise ValueError(f"{what} is {text!r}; allowed: text of one line")
    return text


def _frame(frame):
    if isinstance(frame, bool):
        raise TypeError(f"frame is {frame!r}; allowed: a whole number from 0")
    frame = operator.index(frame)
    if frame < 0:
        raise ValueError(f"frame is {frame}; allowed: a whole number from 0")
    return frame


def _number(value):
    if isinstance(value, (bool, str, bytes)) or value is None:
        raise TypeError(f"value is {value!r}; allowed: a number")
    number = operator.index(value) if hasattr(value, "__index__") else float(value)
    if not math.isfinite(number):
        raise ValueError(f"value is {number}; allowed: a finite number")
    return number


def _write(line):
    descriptor, file = os.environ.get(DESCRIPTOR), os.environ.get(FILE)
    if descriptor:
        if not descriptor.isascii() or not descriptor.isdigit():
            raise ValueError(f"{DESCRIPTOR} is {descriptor!r}; allowed: the number of a descriptor")
        _write_all(int(descriptor), line)
    elif file:
        opened = os.open(file, os.O_WRONLY | os.O_APPEND | os.O_CREAT | os.O_CLOEXEC, 0o644)
        try:
            _write_all(opened, line)
        finally:
            os.close(opened)
    else:
        sys.stdout.write(line.decode())
        sys.stdout.flush()


def _write_all(descriptor, line):
    while line:
        line = line[os.write(descriptor, line):]

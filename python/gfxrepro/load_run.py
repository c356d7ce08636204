"""A run folder as two tidy tables."""

import collections
import csv
import dataclasses
import io
import json
import os
import pathlib
import typing

CASE_COLUMNS = ("case_id", "experiment", "technique", "scene", "lane", "run_seed", "seeds",
                "processes_asked")
RECORD_COLUMNS = ("case_id", "process", "frame", "repeat", "lane", "pass", "metric", "unit", "value", "status",
                  "message")
WHOLE = ("process", "frame", "repeat")


@dataclasses.dataclass
class Run:
    """What load() gives. `cases` and `records` have the columns of `gfxrepro export --tidy`, joined by `case_id`."""

    cases: typing.Any                # a row a case, run or not: CASE_COLUMNS, then a column for every parameter
    records: typing.Any              # a row a number: RECORD_COLUMNS; frame and repeat are -1 for what is of the whole case
    axes: dict[str, list[str]]       # by experiment: the columns of `cases` that were swept
    manifest: dict[str, typing.Any]  # with what, on what and when it was made


def load(run: str | os.PathLike[str], as_frames: bool | None = None) -> Run:
    """The run in the folder `run`.

    Its tables are pandas' DataFrames where pandas is installed, else lists of dicts; `as_frames` asks for the one
    (True) or the other (False). Types are kept: whole numbers, numbers, booleans, text. What a case or record has
    not got is None in a dict, and missing in a frame, whose columns stay whole or boolean beside it (Int64, boolean).
    A unit whose rows were cut at the end of records.csv, because its run was killed, is left out.
    Raises ValueError where the folder is no run or its files contradict each other, and ImportError where frames are
    asked for and pandas is not there.
    """
    folder = pathlib.Path(run)
    if not (folder / "plan.json").is_file():
        raise ValueError(f"{folder}: is no run folder (it has no plan.json)")
    plan = _json(folder / "plan.json")
    cases = [_case(item) for item in plan["cases"]]
    columns: list[str] = list(CASE_COLUMNS)
    columns.extend(dict.fromkeys(name for case in cases for name in case if name not in CASE_COLUMNS))
    cases = [{name: case.get(name) for name in columns} for case in cases]
    records = _records(folder / "records.csv", {case["case_id"] for case in cases})
    axes = {}
    for item in plan["cases"]:
        own = axes.setdefault(item["experiment"], [])
        own += [axis for axis in item["axes"] if axis not in own]
    axes = {experiment: [_column(axis) if axis != "scene" else axis for axis in own] for experiment, own in axes.items()}
    if _wants_frames(as_frames):
        cases, records = _frame(cases, columns), _frame(records, RECORD_COLUMNS)
    return Run(cases, records, axes, _json(folder / "manifest.json"))


def _json(file):
    try:
        return json.loads(file.read_text(encoding="utf-8"))
    except ValueError as error:
        raise ValueError(f"{file}: {error}") from None


def _column(param):
    return "params." + param if param in CASE_COLUMNS else param


def _parts(name, value):
    """A column a part: of maps by their keys, of lists by place."""
    if isinstance(value, dict):
        for key, part in value.items():
            yield from _parts(f"{name}.{key}", part)
    elif isinstance(value, list):
        for place, part in enumerate(value):
            yield from _parts(f"{name}.{place}", part)
    else:
        yield name, value


def _case(item):
    swept = item["axes"].get("scene") if "stands_for" not in item else None
    case: dict[str, typing.Any] = {
        "case_id": item["id"], "experiment": item["experiment"], "technique": item["technique"],
        "scene": swept if swept is not None else item["scene"] if item["scene"] is not None else "",
        "lane": item["measure"]["lane"], "run_seed": int(item["seed"]),
        "seeds": item["measure"].get("seeds", ""),
        "processes_asked": int(item["measure"]["processes"])}
    width, height = item["output"]
    params = item["params"] | {"output": {"width": width, "height": height}}
    params |= {name: item[name] for name in ("stands_for", "scene_sample") if name in item}
    for param, value in params.items():
        case.update(_parts(_column(param), value))
    return case


def _records(file, case_ids):
    if not file.is_file():
        return []
    content = file.read_bytes()
    whole = content[:content.rfind(b"\n") + 1].decode()  # without a last row that was cut
    rows = list(csv.DictReader(io.StringIO(whole, newline="")))
    counts = collections.Counter((row["case"], row["process"]) for row in rows)
    records = []
    for line, row in enumerate(rows, 2):
        unit = row["case"], row["process"]
        if row["rows"] is None or counts[unit] != int(row["rows"]):
            if unit == (rows[-1]["case"], rows[-1]["process"]):
                continue
            raise ValueError(f"{file}:{line}: case {unit[0]}, process {unit[1]} has {counts[unit]} of {row['rows']} rows")
        if row["case"] not in case_ids:
            raise ValueError(f"{file}:{line}: the case {row['case']} is not in plan.json")
        record = {name: row["case" if name == "case_id" else name] for name in RECORD_COLUMNS}
        record.update({name: int(record[name]) for name in WHOLE})
        record["value"] = float(record["value"]) if record["value"] else None
        records.append(record)
    return records


def _wants_frames(as_frames):
    if as_frames is False:
        return False
    try:
        import pandas  # noqa: F401
    except ImportError:
        if as_frames:
            raise
        return False
    return True


def _frame(rows, columns):
    import pandas

    frame = pandas.DataFrame(rows, columns=list(columns))
    for name in columns:
        values = [row[name] for row in rows if row[name] is not None]
        if len(values) == len(rows) or not values:
            continue
        if all(isinstance(value, bool) for value in values):
            frame[name] = pandas.array([row[name] for row in rows], dtype="boolean")
        elif all(isinstance(value, int) and not isinstance(value, bool) for value in values):
            frame[name] = pandas.array([row[name] for row in rows], dtype="Int64")
    return frame

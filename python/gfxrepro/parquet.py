"""A run's tidy tables as Parquet files, by Arrow's library: python -m gfxrepro.parquet RUN FOLDER"""

import os
import pathlib
import sys

from .load_run import CASE_COLUMNS, RECORD_COLUMNS, load

NEEDED = "Parquet is written by pyarrow, which is not installed; install it by: pip install pyarrow"
LARGEST_INT64 = 2**63 - 1


def to_parquet(run: str | os.PathLike[str], folder: str | os.PathLike[str]) -> None:
    """Writes `cases.parquet` and `records.parquet` of the run folder `run` into `folder`, which is made.

    They have the columns and types of load(): whole numbers (int64, or uint64 where they need it), numbers (double),
    booleans, text; what a case or record has not got is null. A column of several kinds is text. Files of these names
    that are there are replaced. Raises ImportError where pyarrow is not installed, ValueError as load() does, and
    OSError where a file cannot be written.
    """
    try:
        import pyarrow
        import pyarrow.parquet
    except ImportError:
        raise ImportError(NEEDED) from None
    loaded = load(run, as_frames=False)
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    for name, rows, first in (("cases", loaded.cases, CASE_COLUMNS), ("records", loaded.records, RECORD_COLUMNS)):
        names = list(rows[0]) if rows else list(first)
        arrays = {}
        for column in names:
            kind, values = typed([row[column] for row in rows])
            arrays[column] = pyarrow.array(values, type=pyarrow.type_for_alias(kind))
        pyarrow.parquet.write_table(pyarrow.table(arrays), folder / f"{name}.parquet")


def typed(values):
    """Arrow's name of the type that holds all of the values, and the values as of that type."""
    kinds = {type(value) for value in values if value is not None}
    if kinds == {bool}:
        return "bool", values
    if kinds == {int}:
        is_large = max(value for value in values if value is not None) > LARGEST_INT64
        return "uint64" if is_large else "int64", values
    if kinds and kinds <= {int, float}:
        return "float64", [value if value is None else float(value) for value in values]
    return "string", [value if value is None or isinstance(value, str) else _text(value) for value in values]


def _text(value):
    return str(value).lower() if isinstance(value, bool) else str(value)


def main(arguments):
    if len(arguments) != 2 or arguments[0].startswith("-"):
        print("usage: python -m gfxrepro.parquet RUN FOLDER", file=sys.stderr)
        return 2
    try:
        to_parquet(*arguments)
    except (ImportError, OSError, ValueError) as error:
        print(f"gfxrepro.parquet: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

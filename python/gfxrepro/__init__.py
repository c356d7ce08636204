"""What a program under test says of itself (emit), and runs of gfxrepro as tidy frames (load)."""

import os
import typing

from .emit_metric import emit
from .load_run import Run, load

__all__ = ["Run", "emit", "load", "to_parquet"]
__version__: str


def to_parquet(run: str | os.PathLike[str], folder: str | os.PathLike[str]) -> None:
    """Writes cases.parquet and records.parquet of a run folder: see gfxrepro.parquet."""
    from .parquet import to_parquet as write  # `python -m gfxrepro.parquet` would find it imported already

    write(run, folder)


if not typing.TYPE_CHECKING:

    def __getattr__(name):
        """`__version__`, when it is asked for: a program that emits is timed, and this import takes longer than all else."""
        if name != "__version__":
            raise AttributeError(f"module 'gfxrepro' has no attribute {name!r}")
        import importlib.metadata

        return importlib.metadata.version("gfxrepro")

"""What a program under test says of itself (emit), and runs of gfxrepro as tidy frames (load)."""

from .emit_metric import emit
from .load_run import Run, load

__all__ = ["Run", "emit", "load", "to_parquet"]


def to_parquet(run, folder):
    """Writes cases.parquet and records.parquet of a run folder: see gfxrepro.parquet."""
    from .parquet import to_parquet as write  # `python -m gfxrepro.parquet` would find it imported already

    write(run, folder)

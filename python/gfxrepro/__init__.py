"""What a program under test says of itself (emit), and runs of gfxrepro as tidy frames (load)."""

from .emit_metric import emit
from .load_run import Run, load

__all__ = ["Run", "emit", "load"]

"""The command `gfxrepro`: the program that a wheel of scripts/release carries. Python gives its place to it."""

import os
import pathlib
import signal
import sys

PROGRAM = pathlib.Path(__file__).parent / "program" / "gfxrepro"


def main() -> int:
    # Python ignores these two, and who is started by it would, too.
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    signal.signal(signal.SIGXFSZ, signal.SIG_DFL)
    try:
        os.execv(PROGRAM, sys.argv)
    except OSError as error:
        print(f"gfxrepro: {PROGRAM}: {error.strerror}; the Python package alone has no program, a release's wheel has it",
              file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main())

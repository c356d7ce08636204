#!/usr/bin/env python3
"""Every script says what it does when it is asked for help, and does nothing else: scripts_help_test SCRIPTS"""

import os
import pathlib
import subprocess
import sys

failures = []
for script in sorted(pathlib.Path(sys.argv[1]).iterdir()):
    if not script.is_file() or not os.access(script, os.X_OK):
        continue
    for word in ("-h", "--help"):
        result = subprocess.run([script, word], capture_output=True, text=True, timeout=20)
        if result.returncode != 0 or script.name not in result.stdout or result.stderr:
            failures.append(f"{script.name} {word}: exit {result.returncode}, {result.stdout!r}, {result.stderr!r}")
print("\n".join(failures) or "every script has its help")
sys.exit(1 if failures else 0)

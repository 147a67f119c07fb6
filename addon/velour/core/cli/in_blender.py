"""The command line inside Blender: as a command (4.2 and newer) or as a script (any version).

blender --command velour VERB ...
blender -b --python-exit-code 1 -P .../velour/core/cli/in_blender.py -- VERB ...
"""

from __future__ import annotations

import importlib
import signal
import sys
from pathlib import Path


def main(arguments: list[str]) -> int:
    """Like main.main(), but Ctrl-C cancels: Blender hides it from Python and waits for the end."""
    from .main import main as run

    signal.signal(signal.SIGINT, signal.default_int_handler)
    return run(arguments)


def _run_as_script() -> int:
    """Finds the package by the path of this file, as `__name__` of a script does not tell it."""
    package = Path(__file__).resolve().parents[2]
    sys.path.insert(0, str(package.parent))
    own = importlib.import_module(f"{package.name}.core.cli.in_blender")
    begin = sys.argv.index("--") + 1 if "--" in sys.argv else len(sys.argv)
    return own.main(sys.argv[begin:])


if __name__ == "__main__":
    sys.exit(_run_as_script())

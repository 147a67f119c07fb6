"""The command line inside Blender: a command of 4.2 and newer, and a script for any.

blender --command velour VERB ...
blender -b --python-exit-code 1 -P .../velour/core/cli/in_blender.py -- VERB ...
"""

from __future__ import annotations

import importlib
import signal
import sys
from pathlib import Path


def main(arguments: list[str]) -> int:
    """As main.main(). Blender keeps Ctrl-C from Python and waits for the end; here it cancels."""
    from .main import main as run

    signal.signal(signal.SIGINT, signal.default_int_handler)
    return run(arguments)


def _run_as_script() -> int:
    """Of the package that this file lies in; `__name__` does not tell, as no package was imported."""
    package = Path(__file__).resolve().parents[2]
    sys.path.insert(0, str(package.parent))
    own = importlib.import_module(f"{package.name}.core.cli.in_blender")
    begin = sys.argv.index("--") + 1 if "--" in sys.argv else len(sys.argv)
    return own.main(sys.argv[begin:])


if __name__ == "__main__":
    sys.exit(_run_as_script())

"""Writes frame.pyz: the program for nodes, in one file that needs nothing else of this repository."""

from __future__ import annotations

import io
import zipfile
from pathlib import Path

from .job import replace_bytes

HERE = Path(__file__).resolve().parent
NAME = "frame.pyz"
_MODULES = ("__init__", "blender", "exr", "frame", "job", "ranges", "sources")
_MAIN = """\
import sys

if sys.version_info < (3, 9):
    sys.exit("farm: nodes need Python 3.9 or newer, and this is %d.%d" % sys.version_info[:2])
from farm.frame import main

sys.exit(main())
"""


def write(folder: Path) -> None:
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as archive:
        archive.writestr("__main__.py", _MAIN)
        for module in _MODULES:
            archive.write(HERE / f"{module}.py", f"farm/{module}.py")
    replace_bytes(folder / NAME, data.getvalue())

"""Writes .blend files: in this process if it is Blender, otherwise by a Blender of its own."""

from __future__ import annotations

import importlib
import subprocess
import sys
import tempfile
from pathlib import Path

from ..farm.blender import environment
from ..native.errors import refuse
from . import files

_WRITER = "operators.closure_file"  # a module for Blender's Python
_PROGRAM = """
import sys
sys.path.insert(0, sys.argv[-3])
import importlib
importlib.import_module(sys.argv[-2]).write_from(sys.argv[-1])
"""


def write_closures(path: Path, name: str, closures: dict, note: str, blender: str = "blender") -> None:
    """Writes a material whose node group holds the network of `closures`; `note` describes it as an asset."""
    request = {"name": name, "closures": closures, "note": note}
    files.write_atomic(path, lambda temporary: _write({**request, "path": str(temporary.resolve())}, blender))


def _write(request, blender):
    package = Path(__file__).resolve().parents[1]
    if "bpy" in sys.modules:
        importlib.import_module(f"..{_WRITER}", __package__).write(**request)
        return
    with tempfile.TemporaryDirectory() as folder:
        order = Path(folder) / "order.json"
        files.write_json(order, request)
        _run(blender, package, order)


def _run(blender, package, order):
    command = [blender, "-b", "--factory-startup", "--python-exit-code", "1", "--python-expr", _PROGRAM]
    arguments = ["--", str(package.parent), f"{package.name}.{_WRITER}", str(order)]
    try:
        done = subprocess.run(
            [*command, *arguments],
            capture_output=True,
            text=True,
            errors="replace",
            check=False,
            env=environment(blender),
        )
    except OSError as error:
        raise refuse(
            f"{blender}: Blender, which writes the .blend file, does not start ({error.strerror}); name it"
            " with --blender."
        ) from error
    if done.returncode != 0:
        lines = (done.stdout + done.stderr).strip().splitlines() or ["no message"]
        raise refuse(f"{blender} failed to write the .blend file: {lines[-1]}")

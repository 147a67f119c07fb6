"""Velour's options on Blender's command line: what follows "--", as Cycles has its own there."""

import argparse
import sys
from pathlib import Path

import bpy

from ..core.cli import numbers
from ..native.errors import refuse

_PREFIX = "--velour-"


class _Parser(argparse.ArgumentParser):
    def error(self, message):
        raise refuse(f"After --: {message}.")


def arguments():
    """parts, samples, memory; each None where it is not given. With a window none is: nobody waits there."""
    parser = _Parser(prog="blender", add_help=False, allow_abbrev=False)
    add = parser.add_argument
    add("--velour-parts", dest="parts", type=Path)
    add("--velour-samples", dest="samples", type=numbers.span)
    add("--velour-memory", dest="memory", type=numbers.size_in_bytes)
    behind = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv and bpy.app.background else []
    given, others = parser.parse_known_args(behind)
    unknown = next((each for each in others if each.startswith(_PREFIX)), None)
    if unknown:
        raise refuse(f"After --: there is no option {unknown}; --velour-parts, -samples and -memory are.")
    if given.samples and not given.parts:
        raise refuse("After --: --velour-samples needs a folder to keep them in: --velour-parts FOLDER.")
    return given

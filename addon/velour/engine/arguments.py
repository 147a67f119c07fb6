"""Velour's options on Blender's command line, after "--", like those of Cycles."""

import argparse
import sys
from pathlib import Path
from typing import NamedTuple

import bpy

from ..core.cli import numbers
from ..native.errors import refuse

_PREFIX = "--velour-"
_NAMES = "--velour-parts, --velour-keep-parts, --velour-samples, --velour-memory and --velour-strict-usage"


class _Parser(argparse.ArgumentParser):
    def error(self, message):
        raise refuse(f"Wrong arguments after --: {message}.")


class Share(NamedTuple):
    """Part `number`, from 1 on, of all samples in `count` parts."""

    number: int
    count: int

    def of(self, spp, split):
        """Range of samples of this part, in whole camera rays."""
        rays = -(-spp // split)
        if rays < self.count:
            raise refuse(
                f"Each pixel has {rays} camera rays ({spp} samples, {split} per ray), too few for"
                f" {self.count} parts; use fewer parts."
            )
        begin, end = (rays * number // self.count * split for number in (self.number - 1, self.number))
        return begin, min(end, spp)


def _samples(text):
    """BEGIN:END as a tuple, or K/N as a Share."""
    if "/" not in text:
        return numbers.span(text)
    number, count = map(numbers.whole(1, 1 << 20), text.split("/", 1))
    if number > count:
        raise argparse.ArgumentTypeError(f"{text!r}: the number of the part must be at most {count}")
    return Share(number, count)


def _folder(text):
    if not text:
        raise argparse.ArgumentTypeError("the name of the folder is empty")
    return Path(text)


def arguments():
    """`parts`, `keep_parts`, `samples`, `memory`, `strict_usage`; None or False if not given, or if there is
    a window."""
    parser = _Parser(prog="blender", add_help=False, allow_abbrev=False)
    add = parser.add_argument
    add("--velour-parts", dest="parts", type=_folder)
    add("--velour-keep-parts", dest="keep_parts", action="store_true")
    add("--velour-samples", dest="samples", type=_samples)
    add("--velour-memory", dest="memory", type=numbers.size_in_bytes)
    add("--velour-strict-usage", dest="strict_usage", action="store_true")
    behind = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv and bpy.app.background else []
    given, others = parser.parse_known_args(behind)
    unknown = next((each for each in others if each.startswith(_PREFIX)), None)
    if unknown:
        raise refuse(f"Wrong arguments after --: unknown option {unknown}; the options are {_NAMES}.")
    if given.samples and not given.parts:
        raise refuse(
            "Wrong arguments after --: --velour-samples needs a folder for the parts; add --velour-parts"
            " FOLDER."
        )
    return given

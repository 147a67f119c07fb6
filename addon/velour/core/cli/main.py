"""Parses, runs a verb, turns what goes wrong into one sentence and an honest status."""

from __future__ import annotations

import argparse
import os
import sys

from ...native import library
from ...native.errors import VelourError
from ...native.version import version_text
from . import (
    capture,
    compare,
    compress,
    export,
    fit,
    info,
    merge,
    observe,
    output,
    plot,
    render,
    tile,
    votf,
)
from .unfinished import UnfinishedError

_VERBS = {
    "info": (info, "what a measurement, BTF, model or observation holds"),
    "fit": (fit, "fit a model to a measurement"),
    "compare": (compare, "error of a model against a measurement or BTF"),
    "plot": (plot, "draw what a model is made of, its error or its albedo"),
    "render": (render, "render a mesh with a measured material under a world"),
    "merge": (merge, "make one picture of parts that render wrote"),
    "observe": (observe, "learn under which views and lights a scene shows its material"),
    "capture": (capture, "make a measurement of a modelled surface"),
    "votf": (votf, "add to a model the outline and the holes of a modelled surface"),
    "tile": (tile, "make a procedural tile of mesostructure as a mesh"),
    "export": (export, "write a BTF as a folder of pictures"),
    "compress": (compress, "fit a model to a BTF"),
}
_LEVELS = ("error", "warning", "info", "debug")
DONE, FAILED, UNFINISHED, INTERRUPTED = 0, 1, 3, 130


def main(arguments: list[str] | None = None) -> int:
    """The exit status: 0 done, 1 failed, 3 ended early, 130 interrupted. Wrong usage leaves with 2."""
    args = _parser().parse_args(arguments)
    try:
        output.set_up_log("error" if args.quiet else args.log_level)
        if args.simd:
            library.select_simd(args.simd)
        if args.json_file:
            output.check_writable(args.json_file)
        output.deliver(args, args.run(args))
        sys.stdout.flush()
        return DONE
    except UnfinishedError as error:
        return _fail(str(error), UNFINISHED)
    except KeyboardInterrupt:
        return _fail("Interrupted.", INTERRUPTED)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # or the flush at exit complains again
        return FAILED
    except (VelourError, OSError, MemoryError) as error:
        return _fail(_sentence(error), FAILED)


def _fail(sentence: str, status: int) -> int:
    if sys.stderr.isatty():
        sys.stderr.write("\r\x1b[K")  # what a progress bar may have left
    output.log.error("%s", sentence)
    return status


def _sentence(error: Exception) -> str:
    if isinstance(error, OSError) and error.filename is not None:
        return f"{error.filename}: {error.strerror}."
    return " ".join(str(error).split()) or type(error).__name__


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="velour", description="Measured materials: fit, judge and render.", allow_abbrev=False
    )
    parser.add_argument("--version", action="version", version=f"velour {version_text()}")
    verbs = parser.add_subparsers(title="verbs", metavar="VERB", required=True)
    for name, (module, help_text) in _VERBS.items():
        verb = verbs.add_parser(name, help=help_text, description=help_text, allow_abbrev=False)
        module.add_arguments(verb)
        _add_common(verb)
        verb.set_defaults(run=module.run)
    return parser


def _add_common(verb: argparse.ArgumentParser) -> None:
    group = verb.add_argument_group("everywhere")
    group.add_argument("--json", action="store_true", help="one JSON object on stdout and nothing else there")
    group.add_argument("--json-file", metavar="PATH", help="the JSON object in a file")
    group.add_argument("--quiet", action="store_true", help="no progress, no messages, no summary")
    group.add_argument("--log-level", choices=_LEVELS, default=_level_of_environment(), help="or VELOUR_LOG")
    group.add_argument("--simd", metavar="NAME", help="pin the instruction set (results depend on it)")


def _level_of_environment() -> str:
    level = os.environ.get("VELOUR_LOG", "").lower()
    return level if level in _LEVELS else "warning"

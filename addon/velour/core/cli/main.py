"""Parses, runs a verb, turns what goes wrong into one sentence and an honest status."""

from __future__ import annotations

import argparse
import importlib
import os
import sys

from ...native import library
from ...native.errors import VelourError
from ...native.version import version_text
from . import output
from .exit_status import DONE, FAILED, INTERRUPTED, UNFINISHED, UnfinishedError

_VERBS = {  # by module of this package
    "info": "what a measurement, BTF, model or observation holds",
    "fit": "fit a model to a measurement",
    "compare": "error of a model against a measurement or BTF",
    "plot": "draw what a model is made of, its error or its albedo",
    "render": "render a mesh with a measured material under a world",
    "merge": "make one picture of parts that render wrote",
    "observe": "learn under which views and lights a scene shows its material",
    "capture": "make a measurement of a modelled surface",
    "votf": "add to a model the outline and the holes of a modelled surface",
    "tile": "make a procedural tile of mesostructure as a mesh",
    "export": "write a BTF as a folder of pictures",
    "compress": "fit a model to a BTF",
}
_LEVELS = ("error", "warning", "info", "debug")


def main(arguments: list[str] | None = None) -> int:
    """The exit status: 0 done, 1 failed, 3 ended early, 130 interrupted. Wrong usage leaves with 2."""
    arguments = sys.argv[1:] if arguments is None else arguments
    args = _parser(arguments).parse_args(arguments)
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


def _parser(arguments: list[str]) -> argparse.ArgumentParser:
    """Adds only the options of the verb in `arguments`: importing the modules of all verbs takes time."""
    parser = argparse.ArgumentParser(
        prog="velour", description="Measured materials: fit, judge and render.", allow_abbrev=False
    )
    parser.add_argument("--version", action="version", version=f"velour {version_text()}")
    verbs = parser.add_subparsers(title="verbs", metavar="VERB", required=True)
    wanted = next((argument for argument in arguments if not argument.startswith("-")), None)
    for name, help_text in _VERBS.items():
        verb = verbs.add_parser(name, help=help_text, description=help_text, allow_abbrev=False)
        if name == wanted:
            _add_options(verb, name)
    return parser


def _add_options(verb: argparse.ArgumentParser, name: str) -> None:
    module = importlib.import_module(f".{name}", __package__)
    module.add_arguments(verb)
    _add_common(verb)
    verb.set_defaults(run=module.run)


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

"""Parses the arguments, runs a verb, and turns errors into one sentence and an exit status."""

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

_VERBS = {  # each is a module of this package
    "info": "show the contents of a measurement, BTF, model or scene usage",
    "fit": "fit a model to a BRDF measurement",
    "compare": "compute the error of a model against a measurement or BTF",
    "plot": "plot the lobes, the error, the albedo or the silhouette of a model",
    "render": "render a mesh with a measured material in an environment",
    "merge": "merge parts of an image that were rendered separately",
    "observe": "record the scene usage of a material: the views and lights under which a scene shows it",
    "capture": "capture the BTF of a modeled tile, or the BRDF of a microsurface",
    "votf": "add the silhouette (VOTF) of a modeled tile or a BTF to a model",
    "tile": "create a procedural mesostructure tile as a mesh",
    "export": "export a BTF as images, or a model for other programs",
    "compress": "fit a model to a BTF",
}
_LEVELS = ("error", "warning", "info", "debug")


def main(arguments: list[str] | None = None) -> int:
    """Returns the exit status: 0 done, 1 failed, 3 ended early, 130 interrupted. Wrong usage exits with 2."""
    arguments = sys.argv[1:] if arguments is None else arguments
    args = _parser(arguments).parse_args(arguments)
    try:
        output.set_up_log("error" if args.quiet else args.log_level)
        if args.simd:
            library.select_simd(args.simd)
        output.check_inputs_remain(args)
        output.check_outputs_differ(args)
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
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # or the flush at exit fails again
        return FAILED
    except (VelourError, OSError, MemoryError) as error:
        return _fail(_sentence(error), FAILED)


def _fail(sentence: str, status: int) -> int:
    if sys.stderr.isatty():
        sys.stderr.write("\r\x1b[K")  # erases what a progress bar may have left
    output.log.error("%s", sentence)
    return status


def _sentence(error: Exception) -> str:
    if isinstance(error, OSError) and error.filename is not None:
        return f"{error.filename}: {error.strerror}."
    return " ".join(str(error).split()) or type(error).__name__


def _parser(arguments: list[str]) -> argparse.ArgumentParser:
    """Adds only the options of the verb in `arguments`: importing the modules of all verbs takes time."""
    parser = argparse.ArgumentParser(
        prog="velour", description="Fits, evaluates and renders measured materials.", allow_abbrev=False
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
    verb.set_defaults(run=module.run, verb=name)


def _add_common(verb: argparse.ArgumentParser) -> None:
    group = verb.add_argument_group("common options")
    group.add_argument(
        "--json", action="store_true", help="print one JSON object to stdout, and nothing else"
    )
    group.add_argument("--json-file", metavar="PATH", help="write the JSON object to a file")
    group.add_argument(
        "--quiet", action="store_true", help="print no progress, no summary, and no messages except errors"
    )
    group.add_argument(
        "--log-level",
        choices=_LEVELS,
        default=_level_of_environment(),
        help="messages to print on stderr (default: $VELOUR_LOG, or warning)",
    )
    group.add_argument(
        "--simd",
        metavar="NAME",
        help="instruction set to use, which affects the last bits of results (default: the best one)",
    )


def _level_of_environment() -> str:
    level = os.environ.get("VELOUR_LOG", "").lower()
    return level if level in _LEVELS else "warning"

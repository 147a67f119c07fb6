"""Output of a verb: one JSON object or a summary on stdout, messages and progress on stderr."""

from __future__ import annotations

import argparse
import logging
import os
import sys
import tempfile
from collections.abc import Iterator
from itertools import combinations
from pathlib import Path

from .. import files
from ..verdict import with_text
from ..warning_table import COMMAND_LINE, sentences
from .progress import ProgressBar, ProgressLines

log = logging.getLogger("velour")


def set_up_log(level: str) -> None:
    handler = logging.StreamHandler(sys.stderr)
    handler.setFormatter(logging.Formatter("velour: %(message)s"))
    log.handlers[:] = [handler]
    log.propagate = False
    log.setLevel(level.upper())


def progress_of(args: argparse.Namespace) -> ProgressBar | ProgressLines | None:
    """A progress bar on a terminal; elsewhere log lines, at level info."""
    if args.quiet:
        return None
    if sys.stderr.isatty():
        return ProgressBar(sys.stderr)
    return ProgressLines(log) if log.isEnabledFor(logging.INFO) else None


def tell(args: argparse.Namespace, line: str) -> None:
    """Prints a line on a terminal; elsewhere logs it, at level info."""
    if args.quiet:
        return
    if sys.stderr.isatty():
        print(f"velour: {line}", file=sys.stderr)
    else:
        log.info("%s", line)


def warn(warnings: list[dict]) -> None:
    """Logs warnings of the library."""
    for sentence in sentences(warnings, COMMAND_LINE):
        log.warning("%s", sentence)


# Other names that JSON gives a number, for scripts that know it by them.
_SECOND_KEYS = {"psnr_held_out": "psnr_heldout"}


def deliver(args: argparse.Namespace, report: dict) -> None:
    """Writes the verb's report in all requested forms."""
    report = _with_sentences(report)
    known = {second: report[key] for key, second in _SECOND_KEYS.items() if key in report}
    if args.json_file:
        files.write_json(args.json_file, report | known)
    if args.json:
        print(files.json_text(report | known))
    elif not args.quiet:
        print(summary(report))


def _with_sentences(report: dict) -> dict:
    """The report with the sentences of its "warning_codes" ("warnings") and the text of its verdict."""
    told = {}
    for key, value in report.items():
        if key == "warning_codes":
            told["warnings"] = sentences(value, COMMAND_LINE)
        told[key] = with_text(report) if key == "verdict" and value and "text" not in value else value
    return told


def summary(report: dict) -> str:
    return "\n".join(_lines(report, ""))


def _lines(report: dict, indent: str):
    for key, value in report.items():
        if key == "verdict" and value:
            yield f"{indent}{key}: {value['text']}"
        elif isinstance(value, dict):
            yield f"{indent}{key}:"
            yield from _lines(value, indent + "  ")
        elif key == "warning_codes":
            continue  # "warnings" has their sentences
        elif key == "warnings":
            yield from (f"warning: {warning}" for warning in value)
        else:
            yield f"{indent}{key}: {_shown(value)}"


def _shown(value) -> str:
    if value is None:
        return "-"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.5g}"
    if isinstance(value, list):
        return ", ".join(map(_shown, value))
    return str(value)


# Names of arguments, by what their paths are for.
_OUTPUTS = ("output", "noisy_image", "json_file")
_INPUTS = (
    *("input", "file", "model", "parts", "subject", "measurement", "held_out", "merge"),
    *("mesh", "material", "proposal", "world", "reference", "full_model", "for_scene"),
)
_IN_PLACE = ("votf", "output", "material")  # verb, output and input: a model may get its silhouette in place


def check_inputs_remain(args: argparse.Namespace) -> None:
    """Raises OSError if an output would replace an input or, except models, a file in the folder of one."""
    for output, written in _existing(args, _OUTPUTS):
        for name, read in _existing(args, _INPUTS):
            if (args.verb, output, name) == _IN_PLACE:
                continue
            inside = read.is_dir() and written.suffix != ".velour" and _is_inside(written, read)
            if inside or written.samefile(read):
                raise OSError(
                    f"The output {written} would replace {'a file of ' if inside else ''}the input {read};"
                    " choose another name."
                )


def check_outputs_differ(args: argparse.Namespace) -> None:
    """Raises OSError if one output would replace another."""
    given = {name: path for name in _OUTPUTS if (path := getattr(args, name, None))}
    for (one, first), (other, second) in combinations(given.items(), 2):
        if os.path.realpath(first) == os.path.realpath(second):
            options = [f"--{name.replace('_', '-')}" for name in (one, other)]
            raise OSError(
                f"{' and '.join(options)} name the same file, {first}; choose another name for one."
            )


def _existing(args: argparse.Namespace, names: tuple[str, ...]) -> Iterator[tuple[str, Path]]:
    """The files and folders that the arguments `names` name. A tile is none, whatever lies beside it."""
    for name in names:
        value = getattr(args, name, None)
        for path in value if isinstance(value, list) else [value]:
            is_path = isinstance(path, str) and not (name == "subject" and _is_tile(path))
            if is_path and os.path.exists(path):
                yield name, Path(path)


def _is_tile(name: str) -> bool:
    from .subject import is_tile  # with numpy, which other verbs need not wait for

    return is_tile(name)


def _is_inside(path: Path, folder: Path) -> bool:
    return folder.resolve() in path.resolve().parents


def check_writable(path: str) -> None:
    """Raises OSError before the long work, not after it, if the result cannot be written.

    It creates a file, because permissions do not tell about read-only mounts and rules of file servers.
    """
    folder = Path(path).absolute().parent
    if not folder.is_dir():
        raise OSError(f"The folder {folder} of the output {path} does not exist; create it first.")
    if Path(path).is_dir():
        raise OSError(f"The output {path} is a folder; give the name of a file.")
    if Path(path).exists() and not Path(path).is_file():  # a device or a pipe would be replaced
        raise OSError(f"The output {path} is not a regular file; choose another name.")
    try:
        tempfile.TemporaryFile(dir=folder).close()
    except OSError as error:
        raise OSError(
            f"The folder {folder} of the output {path} is not writable ({error.strerror}); choose another"
            " one, or change its permissions."
        ) from error


def check_picture(path: str) -> None:
    """check_writable(), and that the extension names a format that images can be written in."""
    if Path(path).suffix not in (".exr", ".png"):
        raise OSError(
            f"The output {path} can only be written as .exr or .png; give it one of these extensions."
        )
    check_writable(path)

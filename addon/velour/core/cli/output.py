"""What a verb says: one JSON object or a summary on stdout, messages and progress on stderr."""

from __future__ import annotations

import argparse
import logging
import sys
import tempfile
from pathlib import Path

from .. import files
from .progress import ProgressBar, ProgressLines

log = logging.getLogger("velour")


def set_up_log(level: str) -> None:
    handler = logging.StreamHandler(sys.stderr)
    handler.setFormatter(logging.Formatter("velour: %(message)s"))
    log.handlers[:] = [handler]
    log.propagate = False
    log.setLevel(level.upper())


def progress_of(args: argparse.Namespace) -> ProgressBar | ProgressLines | None:
    """A bar where someone can see it, lines where a log wants to know."""
    if args.quiet:
        return None
    if sys.stderr.isatty():
        return ProgressBar(sys.stderr)
    return ProgressLines(log) if log.isEnabledFor(logging.INFO) else None


def tell(args: argparse.Namespace, line: str) -> None:
    """Where someone can see it, as the bar, or a log wants to know."""
    if args.quiet:
        return
    if sys.stderr.isatty():
        print(f"velour: {line}", file=sys.stderr)
    else:
        log.info("%s", line)


def deliver(args: argparse.Namespace, report: dict) -> None:
    """Hands the verb's report over in all forms asked for."""
    if args.json_file:
        files.write_json(args.json_file, report)
    if args.json:
        print(files.json_text(report))
    elif not args.quiet:
        print(summary(report))


def summary(report: dict) -> str:
    return "\n".join(_lines(report, ""))


def _lines(report: dict, indent: str):
    for key, value in report.items():
        if isinstance(value, dict):
            yield f"{indent}{key}:"
            yield from _lines(value, indent + "  ")
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


def check_writable(path: str) -> None:
    """Says before the long work, not after it, that the result cannot be written.

    Permissions do not tell: disks are mounted read-only, and servers have rules of their own.
    """
    folder = Path(path).absolute().parent
    if not folder.is_dir():
        raise OSError(f"The folder {folder} of the output {path} does not exist; make it first.")
    if Path(path).is_dir():
        raise OSError(f"The output {path} is a folder; name a file.")
    try:
        tempfile.TemporaryFile(dir=folder).close()
    except OSError as error:
        raise OSError(
            f"The folder {folder} of the output {path} cannot be written to ({error.strerror}); name another,"
            " or change its permissions."
        ) from error

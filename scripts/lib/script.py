"""Shared by the measuring scripts: options, the folder of kept results, handling of errors."""

from __future__ import annotations

import argparse
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import data_files
import provenance
from progress import Progress
from renders import Renders, Settings
from velour.core.machine import threads
from velour_cli import ROOT


@dataclass(frozen=True)
class Run:
    data: Path
    renders: Renders
    conditions: dict


def arguments(
    name: str,
    documents: Path,
    more: Callable[[argparse.ArgumentParser], None] = lambda _: None,
    part: str = "",
    **switches: str,
) -> argparse.Namespace:
    """`switches`: the script's own switches, by name with a help text; `more`: adds options with values.
    `part`: a part of the script, whose results are kept separately."""
    parser = argparse.ArgumentParser(prog=name)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--fresh", action="store_true")
    parser.add_argument("--output", metavar="FOLDER", type=Path)
    parser.add_argument("--work", metavar="FOLDER", type=Path)
    parser.add_argument("--seed", metavar="K", type=int, default=1)
    parser.add_argument("--threads", metavar="T", type=int, default=min(2, threads()))
    for switch, text in switches.items():
        parser.add_argument(f"--{switch}", action="store_true", help=text)
    more(parser)
    args = parser.parse_args()
    # A small version only tries the script; it must not replace the numbers of a full run.
    args.work = args.work or ROOT / "build" / name / part / ("quick" if args.quick else "full")
    args.output = args.output or (args.work / "documents" if args.quick else documents)
    return args


def start(args: argparse.Namespace, settings: Settings) -> Run:
    data = data_files.folder()
    renders = Renders(settings, Progress(), args.fresh)
    args.output.mkdir(parents=True, exist_ok=True)
    return Run(data, renders, provenance.conditions(settings.seed, settings.threads))


def guarded(
    name: str, main: Callable[[], int], stopped: str = "stopped; the next run goes on from here."
) -> int:
    try:
        return main()
    except data_files.NoDataError as absent:
        print(f"{name}: {absent}")
        return 0
    except KeyboardInterrupt:
        print(f"{name}: {stopped}", file=sys.stderr)
        return 130
    except subprocess.CalledProcessError as error:
        return error.returncode

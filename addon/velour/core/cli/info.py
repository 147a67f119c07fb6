"""velour info FILE"""

from __future__ import annotations

import argparse

from ...native import library


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", metavar="FILE", help="a measurement, a model or an observation")


def run(args: argparse.Namespace) -> dict:
    return library.file_info(args.file)

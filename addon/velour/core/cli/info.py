"""velour info PATH"""

from __future__ import annotations

import argparse

from ...native import library
from . import btf_options


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", metavar="PATH", help="measurement, BTF, model or scene usage")
    btf_options.add_arguments(parser)


def run(args: argparse.Namespace) -> dict:
    if not btf_options.given(args):
        return library.file_info(args.file)
    with btf_options.load(args.file, args) as btf:
        return btf.info()

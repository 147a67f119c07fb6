"""velour compress: a later version has it."""

from __future__ import annotations

import argparse

from . import later


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("input", metavar="BTF")
    parser.add_argument("-o", "--output", metavar="MODEL", required=True)
    parser.add_argument("--method", choices=("svd", "svd-view", "srbf", "tucker", "cta", "kcta"))
    for flag in ("--bytes", "--tolerance", "--clusters", "--k", "--memory"):
        parser.add_argument(flag, metavar="V")


def run(_args: argparse.Namespace) -> dict:
    raise later.refusal("compress", "fit makes models of BRDF measurements")

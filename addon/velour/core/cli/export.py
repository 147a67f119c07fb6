"""velour export BTF -o FOLDER"""

from __future__ import annotations

import argparse

from ...native import export_btf_job
from . import btf_options, output


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("btf", metavar="BTF", help="BTF to export: a folder, a CSV index or a .btf file")
    parser.add_argument("-o", "--output", metavar="FOLDER", required=True, help="folder to create")
    btf_options.add_arguments(parser)


def run(args: argparse.Namespace) -> dict:
    with btf_options.load(args.btf, args) as btf, export_btf_job(btf, args.output) as job:
        return job.run(output.progress_of(args))

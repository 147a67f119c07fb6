"""velour export BTF -o FOLDER, velour export MODEL --to TARGET -o PATH"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

from ...native import Model, export_btf_job
from ...native.errors import refuse
from .. import model_export
from . import btf_options, output


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("input", metavar="BTF|MODEL", help="BTF to write as images, or model to convert")
    parser.add_argument(
        "-o", "--output", metavar="PATH", required=True, help="folder to create, or file to write with --to"
    )
    parser.add_argument(
        "--to",
        choices=tuple(model_export.TARGETS),
        help="what to make of a model: OpenPBR (.mtlx), Blender's Principled BSDF (.json), glTF (.gltf), or"
        " nodes for Cycles and EEVEE (.blend)",
    )
    parser.add_argument(
        "--blender",
        metavar="PATH",
        default="blender",
        help="Blender that writes the .blend (default: blender)",
    )
    btf_options.add_arguments(parser)


def run(args: argparse.Namespace) -> dict:
    if args.to is None:
        with btf_options.load(args.input, args) as btf, export_btf_job(btf, args.output) as job:
            return job.run(output.progress_of(args))
    btf_options.refuse_given(args, args.input)
    target, path = model_export.TARGETS[args.to], Path(args.output)
    if path.suffix.lower() != target.suffix:
        raise refuse(
            f"{path}: --to {args.to} writes a {target.suffix} file; change the extension of the output."
        )
    output.check_writable(args.output)
    begin = time.monotonic()
    with Model.load(args.input) as model:
        if "texels" in model.info():
            raise refuse(f"{args.input} is the model of a BTF; --to {args.to} takes models of BRDFs.")
        request = model_export.Request(model, path, args.blender, output.progress_of(args))
        report = target.write(request)
    return {**report, "bytes": path.stat().st_size, "seconds": time.monotonic() - begin}

"""velour compress BTF -o MODEL"""

from __future__ import annotations

import argparse
import contextlib
from pathlib import Path

from ...native import compress_job, table
from . import btf_options, numbers, output, scene_options


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("input", metavar="BTF", help="BTF to fit: a folder, a CSV index or a .btf file")
    parser.add_argument(
        "-o", "--output", metavar="MODEL", required=True, help="model file to write (.velour)"
    )
    parser.add_argument(
        "--method",
        choices=table.COMPRESS_METHODS,
        help="srbf: multivariate SRBFs over a relief (default); kcta: clustered tensors, several per texel;"
        " cta: clustered tensors, one per texel; tucker: one tensor for all texels; svd: truncated SVD;"
        " svd-view: truncated SVD of each view",
    )
    parser.add_argument(
        "--companding",
        choices=table.COMPANDINGS,
        help="fit f itself (none) or its square root (default: root)",
    )
    parser.add_argument(
        "--tolerance", type=numbers.real(1e-6, 0.999), metavar="E",
        help="maximum relative L2 error of companded values; the smallest model that meets it is chosen",
    )  # fmt: skip
    size = parser.add_mutually_exclusive_group()
    size.add_argument(
        "--bytes", type=numbers.size_in_bytes, metavar="SIZE",
        help="maximum size of all coefficients in bytes, or with K, M, G, T (default: 1/400 of the BTF as"
        " half floats, 1/200 for svd; with --tolerance: as needed)",
    )  # fmt: skip
    size.add_argument(
        "--ratio", type=numbers.real(1, 1e9), metavar="R", help="like --bytes: 1/R of the BTF as half floats"
    )
    parser.add_argument(
        "--memory", type=numbers.size_in_bytes, metavar="SIZE",
        help="maximum memory of the fit in addition to the program, in bytes or with K, M, G, T (default:"
        " no limit)",
    )  # fmt: skip
    parser.add_argument(
        "--resume", action="store_true",
        help="continue an interrupted fit from MODEL.checkpoint",
    )  # fmt: skip
    parser.add_argument("--held-out", metavar="BTF", help="BTF with held-out pairs for validation")
    parser.add_argument(
        "--for-scene", metavar="SCENE.json",
        help="fit a scene model for this scene usage (written by velour observe)",
    )  # fmt: skip
    parser.add_argument(
        "--full-model",
        metavar="FULL",
        help="with --for-scene: the full model to start from (default: fitted first)",
    )
    numbers.add_job_arguments(parser)
    tensors = parser.add_argument_group("clustered tensors")
    tensors.add_argument(
        "--clusters", type=numbers.whole(1, 256), metavar="C",
        help="number of clusters for cta and kcta (default: the one with the smallest error)",
    )  # fmt: skip
    tensors.add_argument(
        "--members",
        type=numbers.whole(1, 8),
        metavar="K",
        help="clusters per texel for kcta (default: the number with the smallest error)",
    )
    tensors.add_argument(
        "--no-relief",
        action="store_true",
        help="place texels on the reference plane instead of the structure's surface",
    )
    btf_options.add_arguments(parser)


def run(args: argparse.Namespace) -> dict:
    output.check_writable(args.output)
    names = ("method", "companding", "tolerance", "bytes", "memory", "seed", "threads", "clusters", "members")
    options = {name: getattr(args, name) for name in names if getattr(args, name) is not None}
    checkpoint = Path(f"{args.output}.checkpoint")
    options |= {"checkpoint": checkpoint, "resume": int(args.resume)}
    if args.no_relief:
        options["no_relief"] = 1
    with contextlib.ExitStack() as handles:
        btf = handles.enter_context(btf_options.load(args.input, args))
        if args.ratio:
            options["bytes"] = max(1, int(btf.info()["raw_bytes"] / args.ratio))
        if args.held_out:
            options["held_out"] = handles.enter_context(btf_options.load(args.held_out, args))
        options |= scene_options.load(args, handles)
        job = handles.enter_context(compress_job(btf, **options))
        report = job.run(output.progress_of(args))
        handles.enter_context(job.result_model()).save(args.output)
        checkpoint.unlink(missing_ok=True)
    return report

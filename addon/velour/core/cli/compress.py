"""velour compress BTF -o MODEL"""

from __future__ import annotations

import argparse
import contextlib

from ...native import Btf, compress_job, table
from . import btf_options, numbers, output, scene_options


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("input", metavar="BTF", help="a folder, a CSV index or a .btf file")
    parser.add_argument("-o", "--output", metavar="MODEL", required=True, help="the model to write")
    parser.add_argument(
        "--method",
        choices=table.COMPRESS_METHODS,
        help="srbf: multivariate SRBFs over a relief (default); kcta: clustered tensors, of which a texel"
        " has a few; cta: one; tucker: one for all; svd: truncated singular values; svd-view: of each view"
        " for itself",
    )
    parser.add_argument(
        "--companding", choices=table.COMPANDINGS, help="sums of f itself or of its root; root"
    )
    parser.add_argument(
        "--tolerance", type=numbers.real(1e-6, 0.999), metavar="E",
        help="the smallest model whose relative L2 error of companded values is at most E, within --bytes",
    )  # fmt: skip
    size = parser.add_mutually_exclusive_group()
    size.add_argument(
        "--bytes", type=numbers.size_in_bytes, metavar="SIZE",
        help="bytes, or K, M, G, of all coefficients; 1:400 of the BTF as half floats (svd: 1:200), or a few",
    )  # fmt: skip
    size.add_argument(
        "--ratio", type=numbers.real(1, 1e9), metavar="R", help="the same: an R-th of the BTF as half floats"
    )
    parser.add_argument(
        "--memory", type=numbers.size_in_bytes, metavar="SIZE",
        help="bytes, or K, M, G, T, that the fit may hold at once beside the program itself; no limit",
    )  # fmt: skip
    parser.add_argument(
        "--resume", action="store_true",
        help="goes on with a fit to MODEL that was stopped: its stages are in MODEL.checkpoint",
    )  # fmt: skip
    parser.add_argument("--held-out", metavar="BTF", help="pairs that the fit does not see, to judge it by")
    parser.add_argument(
        "--for-scene", metavar="SCENE.json",
        help="as small as pictures of what was observed (velour observe) allow",
    )  # fmt: skip
    parser.add_argument(
        "--full-model", metavar="FULL", help="with --for-scene: the full model; without: it is fitted first"
    )
    parser.add_argument("--seed", type=numbers.seed, metavar="K")
    parser.add_argument("--threads", type=numbers.whole(0, 1024), metavar="T", help="0: all")
    tensors = parser.add_argument_group("clustered tensors")
    tensors.add_argument(
        "--clusters", type=numbers.whole(1, 256), metavar="C",
        help="cta, kcta; what leaves least within the bytes",
    )  # fmt: skip
    tensors.add_argument(
        "--members", type=numbers.whole(1, 8), metavar="K", help="kcta: clusters of a texel; the same"
    )
    tensors.add_argument(
        "--no-relief",
        action="store_true",
        help="texels of the reference plane, not of the structure's surface",
    )
    btf_options.add_arguments(parser)


def run(args: argparse.Namespace) -> dict:
    output.check_writable(args.output)
    names = ("method", "companding", "tolerance", "bytes", "memory", "seed", "threads", "clusters", "members")
    options = {name: getattr(args, name) for name in names if getattr(args, name) is not None}
    options |= {"checkpoint": f"{args.output}.checkpoint", "resume": int(args.resume)}
    if args.no_relief:
        options["no_relief"] = 1
    with contextlib.ExitStack() as handles:
        btf = handles.enter_context(btf_options.load(args.input, args))
        if args.ratio:
            options["bytes"] = max(1, int(btf.info()["raw_bytes"] / args.ratio))
        if args.held_out:
            options["held_out"] = handles.enter_context(Btf.load(args.held_out))
        options |= scene_options.load(args, handles)
        job = handles.enter_context(compress_job(btf, **options))
        report = job.run(output.progress_of(args))
        handles.enter_context(job.result_model()).save(args.output)
    return report

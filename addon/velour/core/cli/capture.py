"""velour capture --microsurface -o FILE"""

from __future__ import annotations

import argparse

from ...native import microsurface_job
from . import later, numbers, output


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("subject", metavar="TILE|MESH", nargs="?", help="a later version has it")
    parser.add_argument("-o", "--output", metavar="FILE", required=True, help="the measurement to write")
    parser.add_argument(
        "--microsurface", action="store_true", help="a virtual goniometer over a random surface"
    )
    parser.add_argument("--roughness", type=numbers.real(0.01, 1), metavar="R", help="Beckmann alpha")
    parser.add_argument("--metal", metavar="NAME", help="nickel, gold, copper, ...")
    parser.add_argument("--anisotropy", type=numbers.real(1, 100), metavar="A", help="alpha_x / alpha_y")
    parser.add_argument(
        "--base-albedo", type=numbers.reals(3, 0, 1), metavar="R,G,B", help="of a diffuse base"
    )
    parser.add_argument(
        "--base-share", type=numbers.real(0, 1), metavar="S", help="of the surface that is base"
    )
    parser.add_argument("--rays", type=numbers.whole(1, 2**63), metavar="N", help="camera-side rays in all")
    parser.add_argument("--seed", type=numbers.seed, metavar="K")
    parser.add_argument("--threads", type=numbers.whole(0, 1024), metavar="T", help="0: all")
    for flag in ("--texels", "--views", "--lights", "--samples", "--bounces", "--sides", "--memory"):
        later.add_later(parser, flag, "capture --microsurface instead", "V")
    parser.add_argument("--resume", action="store_true", help="a later version has it")


def run(args: argparse.Namespace) -> dict:
    if args.subject or args.resume or not args.microsurface:
        what = f"capture of {args.subject}" if args.subject else "capture of anything else"
        raise later.refusal(what, "capture --microsurface instead")
    output.check_writable(args.output)
    names = ("roughness", "metal", "anisotropy", "base_albedo", "base_share", "rays", "seed", "threads")
    options = {name: getattr(args, name) for name in names if getattr(args, name) is not None}
    with microsurface_job(args.output, **options) as job:
        return job.run(output.progress_of(args))

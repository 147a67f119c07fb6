"""velour capture TILE|MESH -o BTF; velour capture --microsurface -o FILE"""

from __future__ import annotations

import argparse

from ...native import Scene, capture_job, directions, microsurface_job
from ...native.errors import refuse
from . import numbers, output, subject

_MESOSTRUCTURE = (
    "texels", "views", "lights", "held_out", "samples", "bounces", "sides", "memory", "resume", "period",
    "origin", "metres_per_unit", "up", "base_color", "metallic", "ray_share",
)  # fmt: skip
_MICROSURFACE = ("metal", "anisotropy", "base_albedo", "base_share", "ior", "flake_roughness", "rays")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("subject", metavar="TILE|MESH", nargs="?", help=subject.HELP)
    parser.add_argument(
        "-o", "--output", metavar="BTF|FILE", required=True, help="the folder or file to write"
    )
    parser.add_argument("--seed", type=numbers.seed, metavar="K")
    parser.add_argument("--threads", type=numbers.whole(0, 1024), metavar="T", help="0: all")
    parser.add_argument(
        "--roughness",
        type=numbers.real(0, 1),
        metavar="R",
        help="of a mesh (0.5); --microsurface: Beckmann alpha",
    )
    _add_mesostructure(parser.add_argument_group("mesostructure"))
    _add_microsurface(parser.add_argument_group("micro-surface"))


def _add_mesostructure(group) -> None:
    group.add_argument("--texels", type=numbers.whole(1, 16384), metavar="N", help="along a side (128)")
    group.add_argument("--views", metavar="81|105|N", help="set of view directions (105)")
    group.add_argument("--lights", metavar="81|105|N", help="set of light directions (105)")
    group.add_argument(
        "--held-out",
        type=numbers.whole(1, 4096),
        metavar="N",
        help="N pairs to judge models by (64 is usual) in place of all pairs of views and lights",
    )
    group.add_argument(
        "--samples", type=numbers.whole(1, 16384), metavar="S", help="paths a texel and view (16)"
    )
    group.add_argument("--bounces", type=numbers.whole(0, 1024), metavar="B", help="interreflections (1)")
    group.add_argument("--sides", choices=("one", "two"), help="two by default where the tile is open")
    group.add_argument(
        "--memory",
        type=numbers.size_in_bytes,
        metavar="SIZE",
        help="bytes, or K, M, G, T, of a view's images (1G), beyond it in a file",
    )
    group.add_argument("--resume", action="store_true", help="goes on with the views that are there")
    subject.add_place_arguments(group)
    group.add_argument("--base-color", type=numbers.reals(3, 0, 1), metavar="R,G,B", help="of a mesh")
    group.add_argument("--metallic", type=numbers.real(0, 1), metavar="M", help="of a mesh")
    group.add_argument(
        "--ray-share", action="store_true", help="also measures the share of the bare ray tracer"
    )


def _add_microsurface(group) -> None:
    group.add_argument(
        "--microsurface", action="store_true", help="a virtual goniometer over a random surface"
    )
    group.add_argument("--metal", metavar="NAME", help="nickel, gold, copper, ...")
    group.add_argument("--anisotropy", type=numbers.real(1, 100), metavar="A", help="alpha_x / alpha_y")
    group.add_argument(
        "--base-albedo", type=numbers.reals(3, 0, 1), metavar="R,G,B", help="of a diffuse base"
    )
    group.add_argument(
        "--base-share", type=numbers.real(0, 1), metavar="S", help="of the surface that is base"
    )
    group.add_argument(
        "--ior", type=numbers.real(0, 3), metavar="N", help="of a clear surface over base and metal (none)"
    )
    group.add_argument(
        "--flake-roughness", type=numbers.real(0, 1), metavar="R", help="of metal below a clear surface (0.2)"
    )
    group.add_argument("--rays", type=numbers.whole(1, 2**63), metavar="N", help="camera-side rays in all")


def run(args: argparse.Namespace) -> dict:
    if bool(args.subject) == args.microsurface:
        raise refuse("Name a tile or a mesh to capture, or use --microsurface.")
    other = _MESOSTRUCTURE if args.microsurface else _MICROSURFACE
    for name in other:
        if getattr(args, name) not in (None, False):
            kind = "--microsurface" if args.microsurface else "a capture of mesostructure"
            raise refuse(f"--{name.replace('_', '-')} is no option of {kind}.")
    return _capture_microsurface(args) if args.microsurface else _capture_tile(args)


def _capture_microsurface(args: argparse.Namespace) -> dict:
    output.check_writable(args.output)
    with microsurface_job(
        args.output, **subject.given(args, *_MICROSURFACE, "roughness", "seed", "threads")
    ) as job:
        return job.run(output.progress_of(args))


def _capture_tile(args: argparse.Namespace) -> dict:
    if args.held_out and (args.views or args.lights):
        raise refuse("--held-out has directions of its own; leave --views and --lights away.")
    options = subject.given(args, "texels", "held_out", "samples", "bounces", "sides", "seed", "threads")
    for name in ("views", "lights"):
        if getattr(args, name):
            options[name] = directions(getattr(args, name))
    if args.memory is not None:
        options["memory_limit"] = args.memory
    with Scene() as scene:
        place = subject.add_to(scene, args)
        scene.commit()
        options.update(place, resume=int(args.resume), measure_ray_share=int(args.ray_share))
        with capture_job(scene, args.output, source=args.subject, **options) as job:
            return job.run(output.progress_of(args))

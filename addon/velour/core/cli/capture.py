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
        "-o",
        "--output",
        metavar="BTF|FILE",
        required=True,
        help="BTF folder to write; with --microsurface: measurement file",
    )
    numbers.add_job_arguments(parser)
    parser.add_argument(
        "--roughness",
        type=numbers.real(0, 1),
        metavar="R",
        help="roughness of a mesh (default: 0.5); with --microsurface: Beckmann alpha",
    )
    _add_mesostructure(parser.add_argument_group("mesostructure"))
    _add_microsurface(parser.add_argument_group("microsurface"))


def _add_mesostructure(group) -> None:
    group.add_argument(
        "--texels", type=numbers.whole(1, 16384), metavar="N", help="texels along each side (default: 128)"
    )
    group.add_argument("--views", metavar="81|105|N", help="set or number of view directions (default: 105)")
    group.add_argument(
        "--lights", metavar="81|105|N", help="set or number of light directions (default: 105)"
    )
    group.add_argument(
        "--held-out",
        type=numbers.whole(1, 4096),
        metavar="N",
        help="capture N held-out view-light pairs for validation (usually 64) instead of all pairs",
    )
    group.add_argument(
        "--samples", type=numbers.whole(1, 16384), metavar="S", help="paths per texel and view (default: 16)"
    )
    group.add_argument(
        "--bounces", type=numbers.whole(0, 1024), metavar="B", help="number of interreflections (default: 1)"
    )
    group.add_argument(
        "--sides",
        choices=("one", "two"),
        help="sides to capture (default: two if light can pass through the tile)",
    )
    group.add_argument(
        "--memory",
        type=numbers.size_in_bytes,
        metavar="SIZE",
        help="memory for the images of a view in bytes, or with K, M, G, T (default: 1G); larger images are"
        " kept in a file",
    )
    group.add_argument("--resume", action="store_true", help="continue an interrupted capture")
    subject.add_place_arguments(group)
    group.add_argument(
        "--base-color",
        type=numbers.reals(3, 0, 1),
        metavar="R,G,B",
        help="base color of a mesh (default: 0.8,0.8,0.8)",
    )
    group.add_argument(
        "--metallic", type=numbers.real(0, 1), metavar="M", help="metallic of a mesh (default: 0)"
    )
    group.add_argument(
        "--ray-share",
        action="store_true",
        help="also measure the fraction of time spent in the ray tracer itself",
    )


def _add_microsurface(group) -> None:
    group.add_argument(
        "--microsurface", action="store_true", help="measure a random microsurface with a virtual goniometer"
    )
    group.add_argument("--metal", metavar="NAME", help="metal of the surface: nickel, gold, copper, ...")
    group.add_argument(
        "--anisotropy",
        type=numbers.real(1, 100),
        metavar="A",
        help="ratio of the roughnesses, alpha_x / alpha_y",
    )
    group.add_argument(
        "--base-albedo", type=numbers.reals(3, 0, 1), metavar="R,G,B", help="albedo of a diffuse base"
    )
    group.add_argument(
        "--base-share",
        type=numbers.real(0, 1),
        metavar="S",
        help="fraction of the surface that is diffuse base",
    )
    group.add_argument(
        "--ior",
        type=numbers.real(0, 3),
        metavar="N",
        help="refractive index of a clear surface over base and metal (default: none)",
    )
    group.add_argument(
        "--flake-roughness",
        type=numbers.real(0, 1),
        metavar="R",
        help="Beckmann alpha of metal flakes below a clear surface (default: 0.2)",
    )
    group.add_argument(
        "--rays", type=numbers.whole(1, 2**63), metavar="N", help="total number of rays from the camera side"
    )


def run(args: argparse.Namespace) -> dict:
    if bool(args.subject) == args.microsurface:
        raise refuse("Give either a tile or mesh to capture, or --microsurface.")
    other = _MESOSTRUCTURE if args.microsurface else _MICROSURFACE
    for name in other:
        if getattr(args, name) is not None and getattr(args, name) is not False:
            kind = "--microsurface" if args.microsurface else "captures of mesostructure"
            raise refuse(f"--{name.replace('_', '-')} does not apply to {kind}; leave it out.")
    return _capture_microsurface(args) if args.microsurface else _capture_tile(args)


def _capture_microsurface(args: argparse.Namespace) -> dict:
    output.check_writable(args.output)
    with microsurface_job(
        args.output, **subject.given(args, *_MICROSURFACE, "roughness", "seed", "threads")
    ) as job:
        return job.run(output.progress_of(args))


def _capture_tile(args: argparse.Namespace) -> dict:
    if args.held_out and (args.views or args.lights):
        raise refuse("--held-out chooses its own directions; leave out --views and --lights.")
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

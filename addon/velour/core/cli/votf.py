"""velour votf TILE|MESH|BTF --material MODEL -o MODEL"""

from __future__ import annotations

import argparse
import contextlib
from pathlib import Path

from ...native import Model, Scene, votf_data_job, votf_job
from ...native.errors import refuse
from . import btf_options, numbers, output, subject

_OF_GEOMETRY = ("period", "origin", "up", "metres_per_unit", "seed")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "subject",
        metavar="TILE|MESH|BTF",
        help=subject.HELP + ", or a captured BTF, or BTF images with alpha",
    )
    parser.add_argument(
        "--material", metavar="MODEL", required=True, help="model of the structure's material (BRDF or BTF)"
    )
    parser.add_argument(
        "-o", "--output", metavar="MODEL", required=True, help="model file to write (.velour)"
    )
    parser.add_argument(
        "--texels",
        type=numbers.whole(4, 4096),
        metavar="N",
        help="resolution along x (default: 128; for a BTF its own)",
    )
    parser.add_argument(
        "--surface",
        type=numbers.real(),
        metavar="Z",
        help="height in the tile that is placed on the surface, in its units (default: 0); for a BTF, height"
        " above its lowest point",
    )
    parser.add_argument(
        "--check-views",
        type=numbers.whole(0, 65536),
        metavar="N",
        help="number of views in which the result is compared with traced rays, or with a BTF's own views"
        " (default: 64; 0: none)",
    )
    numbers.add_job_arguments(parser)
    btf_options.add_arguments(parser)
    subject.add_place_arguments(parser.add_argument_group("meshes"))


def run(args: argparse.Namespace) -> dict:
    output.check_writable(args.output)
    with contextlib.ExitStack() as handles:
        model = handles.enter_context(Model.load(args.material))
        job = handles.enter_context(_job(args, model, handles))
        report = job.run(output.progress_of(args))
        with job.result_model() as result:
            result.save(args.output)
    return report


def _job(args: argparse.Namespace, model: Model, handles: contextlib.ExitStack):
    given = {
        "source": args.subject,
        **subject.given(args, "texels", "surface", "check_views", "seed", "threads"),
    }
    if _is_data(args.subject):
        for name in _OF_GEOMETRY:
            if getattr(args, name) is not None:
                raise refuse(
                    f"--{name.replace('_', '-')} applies to tiles and meshes only; leave it out for the BTF"
                    f" {args.subject}."
                )
        return votf_data_job(handles.enter_context(btf_options.load(args.subject, args)), model, **given)
    btf_options.refuse_given(args, args.subject)
    scene = handles.enter_context(Scene())
    place = subject.add_to(scene, args)
    scene.commit()
    return votf_job(scene, model, **given, **place)


def _is_data(name: str) -> bool:
    """Whether `name` is a file or folder but not a mesh."""
    is_mesh = Path(name).suffix.lower() in subject.MESHES
    return Path(name).exists() and not is_mesh and not subject.is_tile(name)

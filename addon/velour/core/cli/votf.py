"""velour votf TILE|MESH --material MODEL -o MODEL"""

from __future__ import annotations

import argparse

from ...native import Model, Scene, votf_job
from . import numbers, output, subject


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("subject", metavar="TILE|MESH", help=subject.HELP)
    parser.add_argument(
        "--material", metavar="MODEL", required=True, help="what the structure is made of; of a BRDF or a BTF"
    )
    parser.add_argument("-o", "--output", metavar="MODEL", required=True, help="the model file to write")
    parser.add_argument("--texels", type=numbers.whole(4, 4096), metavar="N", help="along x (128)")
    parser.add_argument(
        "--surface",
        type=numbers.real(),
        metavar="Z",
        help="height in the tile that lies on the surface (0), its units",
    )
    parser.add_argument(
        "--check-views",
        type=numbers.whole(0, 65536),
        metavar="N",
        help="random views that the result is compared with rays under (64)",
    )
    parser.add_argument("--seed", type=numbers.seed, metavar="K")
    parser.add_argument("--threads", type=numbers.whole(0, 1024), metavar="T", help="0: all")
    subject.add_place_arguments(parser.add_argument_group("meshes"))


def run(args: argparse.Namespace) -> dict:
    output.check_writable(args.output)
    options = subject.given(args, "texels", "surface", "check_views", "seed", "threads")
    with Scene() as scene, Model.load(args.material) as model:
        options.update(subject.add_to(scene, args))
        scene.commit()
        with votf_job(scene, model, source=args.subject, **options) as job:
            report = job.run(output.progress_of(args))
            with job.result_model() as result:
                result.save(args.output)
    return report

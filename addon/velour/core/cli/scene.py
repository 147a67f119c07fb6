"""The scene of a verb: a mesh with one material under a world, and a camera."""

from __future__ import annotations

import argparse
import contextlib
import math

from ...native import Measurement, Model, Scene, library
from ...native.errors import refuse
from . import btf_options, numbers, texture_options

# A y-up mesh stands upright in the z-up world: (x, y, z) -> (x, -z, y), as in Blender's OBJ import.
_UP = {"y": ((1, 0, 0, 0), (0, 0, -1, 0), (0, 1, 0, 0)), "z": ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0))}

_OWN_SAMPLES = {"model": "a model", "btf": "a BTF"}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--mesh", metavar="M", required=True, help="mesh file (.obj or .ply)")
    parser.add_argument(
        "--up", choices=tuple(_UP), default="y", help="axis of the mesh that points up (default: y)"
    )
    parser.add_argument(
        "--material",
        metavar="MATERIAL",
        required=True,
        help="model, or measurement or BTF to render directly",
    )
    parser.add_argument(
        "--proposal",
        metavar="MODEL",
        help="with a measurement: model that directions are sampled from (default: a coarse fit)",
    )
    parser.add_argument(
        "--neighbors",
        type=numbers.whole(0, 16),
        default=0,
        metavar="K",
        help="views mixed by a per-view model (0: automatic)",
    )
    parser.add_argument("--world", metavar="HDR", required=True, help="equirectangular environment image")
    parser.add_argument(
        "--layer", default="", metavar="NAME", help="layer or channel of an OpenEXR environment"
    )
    parser.add_argument(
        "--world-rotation", type=numbers.real(), default=0.0, metavar="DEG",
        help="rotation of the environment about +z, counterclockwise seen from above (default: 0)",
    )  # fmt: skip
    parser.add_argument(
        "--camera", type=numbers.camera, metavar="EYE,TARGET,FOV",
        help="x,y,z,x,y,z,degrees in z-up world space (default: frames the mesh)",
    )  # fmt: skip
    btf_options.add_arguments(parser, "--btf-layer")
    parser.add_argument(
        "--memory", type=numbers.size_in_bytes, metavar="SIZE",
        help="memory limit in bytes, or with K, M, G, T: of a render (default: the system's limit), and of a"
        " BTF that is rendered directly (default: 4G)",
    )  # fmt: skip
    parser.add_argument(
        "--size",
        type=numbers.picture_size,
        default=(640, 480),
        metavar="WxH",
        help="pixels (default: 640x480)",
    )
    texture_options.add_arguments(parser)


def fill(scene: Scene, args: argparse.Namespace, handles: contextlib.ExitStack) -> int:
    """Fills and commits `scene`, whose resources `handles` owns. Returns the number of the material."""
    mesh = scene.load_mesh(args.mesh)
    material = _add_material(scene, args, handles)
    scene.add_instance(mesh, _UP[args.up], [material], texture_options.placements(args))
    turn = math.radians(-args.world_rotation)
    c, s = math.cos(turn), math.sin(turn)
    scene.set_world_file(args.world, 1.0, ((c, -s, 0), (s, c, 0), (0, 0, 1)), args.layer)
    aspect = args.size[0] / args.size[1]
    if args.camera:
        scene.look_at(args.camera.eye, args.camera.target, args.camera.fov, aspect)
    else:
        scene.frame_camera(aspect)
    scene.commit()
    texture_options.warn_of_missing_coordinates(scene, args.mesh)
    return material


def _add_material(scene: Scene, args: argparse.Namespace, handles: contextlib.ExitStack) -> int:
    kind = library.file_info(args.material)["kind"]
    if kind != "model" and (given := texture_options.given_shell(args)):
        raise refuse(
            f"{args.material} is not a model, so it has no silhouette (VOTF); leave out"
            f" {' and '.join(given)}."
        )
    if kind in _OWN_SAMPLES and args.proposal:
        what = _OWN_SAMPLES[kind]
        raise refuse(f"{args.material} is {what}, which is sampled without a proposal; leave out --proposal.")
    if kind == "btf":
        btf = handles.enter_context(btf_options.load(args.material, args))
        return scene.add_btf_material(btf, args.memory or 0)
    btf_options.refuse_given(args, args.material, "--btf-layer")
    if kind == "model":
        model = handles.enter_context(Model.load(args.material))
        material = scene.add_model_material(model, args.neighbors)
        texture_options.set_shell(scene, material, args)
        return material
    measurement = handles.enter_context(Measurement.load(args.material))
    proposal = handles.enter_context(Model.load(args.proposal)) if args.proposal else None
    return scene.add_measurement_material(measurement, proposal, args.neighbors)

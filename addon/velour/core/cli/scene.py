"""The scene that verbs look at: a mesh with one material under a world, and a camera."""

from __future__ import annotations

import argparse
import contextlib
import math

from ...native import Measurement, Model, Scene, library
from ...native.errors import refuse
from . import btf_options, numbers, texture_options

# A y-up model stands upright in the z-up world: (x, y, z) -> (x, -z, y), as Blender's OBJ import does it.
_UP = {"y": ((1, 0, 0, 0), (0, 0, -1, 0), (0, 1, 0, 0)), "z": ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0))}

_OWN_SAMPLES = {"model": "a model", "btf": "a BTF"}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--mesh", metavar="M", required=True, help="Wavefront OBJ")
    parser.add_argument(
        "--up", choices=tuple(_UP), default="y", help="the axis of the mesh that points up (y)"
    )
    parser.add_argument(
        "--material", metavar="MATERIAL", required=True, help="a model, or a measurement or BTF itself"
    )
    parser.add_argument(
        "--proposal", metavar="MODEL", help="with a measurement: the model that draws its samples"
    )
    parser.add_argument(
        "--neighbors", type=numbers.whole(0, 16), default=0, metavar="K", help="views mixed; 0: auto"
    )
    parser.add_argument("--world", metavar="HDR", required=True, help="equirectangular picture")
    parser.add_argument("--layer", default="", metavar="NAME", help="layer or channel of an OpenEXR world")
    parser.add_argument(
        "--world-rotation", type=numbers.real(), default=0.0, metavar="DEG",
        help="turns the world about +z, counter-clockwise seen from above",
    )  # fmt: skip
    parser.add_argument(
        "--camera", type=numbers.camera, metavar="EYE,TARGET,FOV",
        help="x,y,z,x,y,z,degrees in the z-up world; default: frames the mesh",
    )  # fmt: skip
    btf_options.add_arguments(parser, "--btf-layer")
    parser.add_argument(
        "--memory", type=numbers.size_in_bytes, metavar="SIZE",
        help="bytes, or K, M, G, T, that a render may take (what the system gives), and a BTF itself (4G)",
    )  # fmt: skip
    parser.add_argument(
        "--size", type=numbers.picture_size, default=(640, 480), metavar="WxH", help="640x480"
    )
    texture_options.add_arguments(parser)


def fill(scene: Scene, args: argparse.Namespace, handles: contextlib.ExitStack) -> int:
    """Fills and commits `scene`, which keeps what `handles` holds; the number of the material."""
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
        raise refuse(f"{args.material} is no model and has no shell; leave {' and '.join(given)} out.")
    if kind in _OWN_SAMPLES and args.proposal:
        what = _OWN_SAMPLES[kind]
        raise refuse(f"{args.material} is {what} and draws its own samples; leave --proposal out.")
    if kind == "btf":
        btf = handles.enter_context(btf_options.load(args.material, args))
        return scene.add_btf_material(btf, args.memory or 0)
    if kind == "model":
        model = handles.enter_context(Model.load(args.material))
        material = scene.add_model_material(model, args.neighbors)
        texture_options.set_shell(scene, material, args)
        return material
    measurement = handles.enter_context(Measurement.load(args.material))
    proposal = handles.enter_context(Model.load(args.proposal)) if args.proposal else None
    return scene.add_measurement_material(measurement, proposal, args.neighbors)

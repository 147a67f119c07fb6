"""The tile or mesh that a verb takes: its name and its placement."""

from __future__ import annotations

import argparse
from pathlib import Path

from ...native import Scene, Tile
from ...native.errors import refuse
from . import numbers

HELP = (
    "tile (weave, twill, satin, knit, net, chainmail, gravel, corduroy, velvet, leather, denim)"
    " or mesh file (.obj, .ply)"
)
# The up axis of the file becomes +z; y-up: (x, y, z) -> (x, -z, y), as in Blender's OBJ import.
_UP = {"y": ((1, 0, 0, 0), (0, 0, -1, 0), (0, 1, 0, 0)), "z": ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0))}
UPS = tuple(_UP)
MESHES = (".obj", ".ply")


def is_tile(name: str) -> bool:
    """Whether a subject is a tile: its name means the tile even if there is a folder of that name."""
    return any(kind["name"] == name.lower() for kind in Tile.kinds())


def add_place_arguments(group) -> None:
    group.add_argument(
        "--period",
        type=numbers.reals(2, 0),
        metavar="X,Y",
        help="period of a mesh in its units (default: its bounding box)",
    )
    group.add_argument(
        "--origin",
        type=numbers.reals(2),
        metavar="X,Y",
        help="corner of the cell, with --period (default: 0,0)",
    )
    group.add_argument("--up", choices=UPS, help="axis of a mesh that points out of the surface (default: z)")
    group.add_argument(
        "--metres-per-unit",
        type=numbers.real(0),
        metavar="M",
        help="size of a mesh unit in meters (default: 1; 0: unknown)",
    )


def given(args: argparse.Namespace, *names: str) -> dict:
    return {name: getattr(args, name) for name in names if getattr(args, name, None) is not None}


def add_to(scene: Scene, args: argparse.Namespace) -> dict:
    """Adds the subject to `scene`. Returns its placement as options of capture_job()."""
    if Path(args.subject).suffix.lower() in MESHES:
        return _add_mesh(scene, args)
    of_mesh = ("period", "origin", "metres_per_unit", "up", "base_color", "roughness", "metallic")
    for name in of_mesh:
        if getattr(args, name, None) is not None:
            raise refuse(
                f"--{name.replace('_', '-')} applies to meshes only; leave it out for the tile"
                f" {args.subject}."
            )
    with Tile.create(args.subject) as tile:
        mesh, materials = tile.add_to(scene)
        scene.add_instance(mesh, _UP["z"], materials)
        return {"origin": (0, 0), "period": tile.info()["period"]}


def _add_mesh(scene: Scene, args: argparse.Namespace) -> dict:
    mesh = scene.load_mesh(args.subject)
    material = scene.add_principled_material(**given(args, "base_color", "roughness", "metallic"))
    scene.add_instance(mesh, _UP[args.up or "z"], [material])
    if args.origin and not args.period:
        raise refuse("--origin needs --period; add it, or leave out both to use the mesh's bounding box.")
    return given(args, "period", "origin", "metres_per_unit")

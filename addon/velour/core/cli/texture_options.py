"""Options of every verb that takes a scene: the placement of a texture on the mesh."""

from __future__ import annotations

import argparse
import math

from ...native import Scene, library
from ...native.errors import refuse
from .. import placement
from . import numbers, output


def add_arguments(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("placement of tiled materials (BTFs)")
    group.add_argument(
        "--texture-scale", type=scale, metavar="S|SX,SY",
        help="tiles per unit of the mesh's texture coordinates (default: 1)",
    )  # fmt: skip
    group.add_argument(
        "--texture-rotation", type=numbers.real(), metavar="DEG",
        help="counterclockwise rotation of the tiles about the first one's lower left corner, or of an"
        " anisotropic BRDF (default: 0)",
    )  # fmt: skip
    group.add_argument(
        "--texture-offset", type=numbers.reals(2), metavar="U,V",
        help="texture coordinates of the first tile's lower left corner (default: 0,0)",
    )  # fmt: skip
    group.add_argument(
        "--shell-tile", type=numbers.real(0), metavar="METERS",
        help="tile width, which determines the height of the silhouette (default: from the texture"
        " coordinates)",
    )  # fmt: skip
    group.add_argument(
        "--shell-softness", type=numbers.real(0, 0.99), metavar="SHARE",
        help="fraction of a tile's width over which the edge of the silhouette fades out (0: hard edge)",
    )  # fmt: skip


def given_shell(args: argparse.Namespace) -> list[str]:
    """The options given that only apply to a model with a shell."""
    return [
        f"--{name.replace('_', '-')}"
        for name in ("shell_tile", "shell_softness")
        if getattr(args, name) is not None
    ]


def set_shell(scene: Scene, material: int, args: argparse.Namespace) -> None:
    if args.shell_tile is not None:
        scene.set_shell_tile(material, args.shell_tile)
    if args.shell_softness is not None:
        scene.set_shell_softness(material, args.shell_softness)


def scale(text: str) -> tuple[float, ...]:
    """One number for both axes, or two; 0 is refused."""
    values = numbers.reals(2 if "," in text else 1)(text)
    if 0 in values:
        raise argparse.ArgumentTypeError("the scale of a texture must not be 0")
    return values if len(values) == 2 else 2 * values


def placements(args: argparse.Namespace) -> list | None:
    """Placements of the one material, as Scene.add_instance() takes them; None: the mesh's own."""
    names = ("scale", "rotation", "offset")
    given = {name: v for name in names if (v := getattr(args, f"texture_{name}")) is not None}
    if not given:
        return None
    info = library.file_info(args.material)
    is_turned = given.keys() == {"rotation"} and not info.get("isotropic", True)
    if not is_turned and not {"texels", "shell"} & info.keys():
        flags = " and ".join(f"--texture-{name}" for name in given)
        raise refuse(f"{args.material} has no texture to place; leave out {flags}.")
    turn = math.radians(given.get("rotation", 0.0))
    return [placement.texture_map(given.get("scale", (1.0, 1.0)), turn, given.get("offset", (0.0, 0.0)))]


def warn_of_missing_coordinates(scene: Scene, mesh: str) -> None:
    """`scene`: committed, with one mesh."""
    if scene.info()["untextured"]:
        output.log.warning(
            "%s has no texture coordinates, so it shows the same point of the material everywhere."
            " Add texture coordinates to the mesh.",
            mesh,
        )

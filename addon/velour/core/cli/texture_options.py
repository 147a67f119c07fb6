"""Where a texture lies on a mesh: options of every verb that looks at a scene."""

from __future__ import annotations

import argparse
import math

from ...native import Scene, library
from ...native.errors import refuse
from .. import placement
from . import numbers, output


def add_arguments(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("materials with texture (BTFs)")
    group.add_argument(
        "--texture-scale", type=scale, metavar="S|SX,SY",
        help="tiles a unit of the mesh's texture coordinates (1)",
    )  # fmt: skip
    group.add_argument(
        "--texture-rotation", type=numbers.real(), metavar="DEG",
        help="turns the tiles counter-clockwise about the first one's corner, or an anisotropic BRDF (0)",
    )  # fmt: skip
    group.add_argument(
        "--texture-offset", type=numbers.reals(2), metavar="U,V",
        help="texture coordinates of the first tile's lower left corner (0,0)",
    )  # fmt: skip
    group.add_argument(
        "--shell-tile", type=numbers.real(0), metavar="METRES",
        help="width of a tile, which the height of its shell goes with (as the texture coordinates say)",
    )  # fmt: skip
    group.add_argument(
        "--shell-softness", type=numbers.real(0, 0.99), metavar="SHARE",
        help="of a tile's width, over which the edge of its shell fades out (0: hard)",
    )  # fmt: skip


def given_shell(args: argparse.Namespace) -> list[str]:
    """The options given that only a model with a shell has a use for."""
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
    """One number for both axes, or two; none is 0, which nothing could be seen of."""
    values = numbers.reals(2 if "," in text else 1)(text)
    if 0 in values:
        raise argparse.ArgumentTypeError("a texture cannot be scaled by 0")
    return values if len(values) == 2 else 2 * values


def placements(args: argparse.Namespace) -> list | None:
    """As Scene.add_instance() takes them, of the one material."""
    names = ("scale", "rotation", "offset")
    given = {name: v for name in names if (v := getattr(args, f"texture_{name}")) is not None}
    if not given:
        return None
    info = library.file_info(args.material)
    is_turned = given.keys() == {"rotation"} and not info.get("isotropic", True)
    if not is_turned and not {"texels", "shell"} & info.keys():
        flags = " and ".join(f"--texture-{name}" for name in given)
        raise refuse(f"{args.material} has no texture that could be placed; leave {flags} out.")
    turn = math.radians(given.get("rotation", 0.0))
    return [placement.texture_map(given.get("scale", (1.0, 1.0)), turn, given.get("offset", (0.0, 0.0)))]


def warn_of_missing_coordinates(scene: Scene, mesh: str) -> None:
    """Of a committed scene of one mesh."""
    if scene.info()["untextured"]:
        output.log.warning(
            "%s has no texture coordinates: one point of the material is shown all over it.", mesh
        )

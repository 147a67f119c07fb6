"""velour tile KIND -o MESH.obj"""

from __future__ import annotations

import argparse
from pathlib import Path

from ...native import Tile
from ..obj import write_obj
from . import numbers, output

_SHAPE = ("size", "count", "resolution", "thickness", "gap", "irregularity", "seed")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "kind",
        metavar="KIND",
        help="weave, twill, satin, knit, net, chainmail, gravel, corduroy, velvet, leather or denim",
    )
    parser.add_argument(
        "-o",
        "--output",
        metavar="MESH.obj",
        required=True,
        help="mesh file to write, with an .mtl file beside it",
    )
    add_shape_arguments(parser)


def add_shape_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--size", type=numbers.real(0), metavar="METERS", help="side of the tile")
    parser.add_argument(
        "--count", type=numbers.whole(1), metavar="N", help="number of pitches along each side"
    )
    parser.add_argument(
        "--resolution",
        type=numbers.whole(1),
        metavar="N",
        help="number of points around a yarn, wire, pebble or rib",
    )
    parser.add_argument("--thickness", type=numbers.real(0), metavar="T", help="thickness in pitches")
    parser.add_argument(
        "--gap", type=numbers.real(0), metavar="G", help="gap between yarns, cords or ribs in pitches"
    )
    parser.add_argument(
        "--irregularity",
        type=numbers.real(0, 1),
        metavar="I",
        help="irregularity of the shape, from 0 (regular) to 1",
    )
    parser.add_argument("--seed", type=numbers.seed, metavar="K", help="random seed")


def shape_of(args: argparse.Namespace) -> dict:
    """The shape options given, as keywords of Tile.create."""
    return {name: getattr(args, name) for name in _SHAPE if getattr(args, name) is not None}


def run(args: argparse.Namespace) -> dict:
    if Path(args.output).suffix != ".obj":  # such as .mtl, which is written beside it
        raise OSError(f"The output {args.output} can only be written as .obj; give it this extension.")
    output.check_writable(args.output)
    with Tile.create(args.kind, **shape_of(args)) as tile:
        info = tile.info()
        write_obj(args.output, tile.mesh(), info["materials"])
    return info

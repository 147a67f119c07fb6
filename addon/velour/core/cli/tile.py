"""velour tile KIND -o MESH.obj"""

from __future__ import annotations

import argparse

from ...native import Tile
from ..obj import write_obj
from . import numbers, output

_SHAPE = ("size", "count", "resolution", "thickness", "gap", "irregularity", "seed")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("kind", metavar="KIND", help="weave, twill, net, chainmail, gravel, corduroy")
    parser.add_argument("-o", "--output", metavar="MESH.obj", required=True, help="an MTL goes beside it")
    add_shape_arguments(parser)


def add_shape_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--size", type=numbers.real(0), metavar="METRES", help="side of the cell")
    parser.add_argument("--count", type=numbers.whole(1), metavar="N", help="pitches along it")
    parser.add_argument("--resolution", type=numbers.whole(1), metavar="N", help="points around a yarn")
    parser.add_argument("--thickness", type=numbers.real(0), metavar="T", help="in pitches")
    parser.add_argument("--gap", type=numbers.real(0), metavar="G", help="in pitches")
    parser.add_argument("--irregularity", type=numbers.real(0, 1), metavar="I", help="0: as drawn by rule")
    parser.add_argument("--seed", type=numbers.seed, metavar="K")


def shape_of(args: argparse.Namespace) -> dict:
    """What is said of the shape: keywords of Tile.create."""
    return {name: getattr(args, name) for name in _SHAPE if getattr(args, name) is not None}


def run(args: argparse.Namespace) -> dict:
    output.check_writable(args.output)
    with Tile.create(args.kind, **shape_of(args)) as tile:
        info = tile.info()
        write_obj(args.output, tile.mesh(), info["materials"])
    return info

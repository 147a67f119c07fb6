"""Options of every verb that reads a measured BTF: what its numbers mean."""

from __future__ import annotations

import argparse

from ... import native
from ...native import table
from ...native.errors import refuse
from . import numbers

_CURVES = {"srgb": 0.0, "linear": 1.0}


def gamma(text: str) -> float:
    """ "srgb", "linear" or an exponent."""
    return _CURVES[text] if text in _CURVES else numbers.real(0.1, 10)(text)


def tile_size(text: str) -> tuple[float, ...]:
    """X,Y in meters."""
    return numbers.reals(2, 1e-9, 1e9)(text)


def add_arguments(parser: argparse.ArgumentParser, layer_option: str = "--layer") -> None:
    group = parser.add_argument_group("measured BTFs")
    group.add_argument(
        "--values",
        choices=table.BTF_VALUES,
        help="meaning of the stored values (default: as the files state, else radiance; .btf: brdf)",
    )
    group.add_argument(
        "--gamma",
        type=gamma,
        metavar="srgb|linear|G",
        help="transfer curve of integer images (default: srgb)",
    )
    group.add_argument("--colors", choices=table.BTF_COLORS, help="color space of images (default: rec709)")
    group.add_argument(
        "--angles",
        choices=table.BTF_ANGLES,
        help="unit of angles in a CSV index (default: degrees, refused if they look like radians)",
    )
    group.add_argument(
        layer_option, dest="btf_layer", metavar="NAME", help="layer or channel of OpenEXR images"
    )
    group.add_argument(
        "--tile-size",
        type=tile_size,
        metavar="X,Y",
        help="size of the tile in meters (default: as the files state)",
    )


def given(args: argparse.Namespace) -> dict:
    """The options that the user gave, as keywords of Btf.load()."""
    names = {"values": args.values, "gamma": args.gamma, "colors": args.colors, "tile_metres": args.tile_size}
    names |= {"layer": args.btf_layer, "angles": args.angles}
    return {name: value for name, value in names.items() if value is not None}


def refuse_given(args: argparse.Namespace, path: str, layer_option: str = "--layer") -> None:
    """Refuses the options, by name, for `path`, which is not a BTF."""
    flags = {"tile_metres": "--tile-size", "layer": layer_option}
    named = [flags.get(name, f"--{name}") for name in given(args)]
    if named:
        raise refuse(f"{path} is not a BTF; leave out {' and '.join(named)}.")


def load(path: str, args: argparse.Namespace) -> native.Btf:
    return native.Btf.load(path, **given(args))

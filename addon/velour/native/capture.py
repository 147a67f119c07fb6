"""Captures of tiles: a virtual goniometer for mesostructure."""

from __future__ import annotations

import ctypes
import os
from ctypes import POINTER, byref, c_double, c_uint64

import numpy as np

from . import library, structs, table
from .handle import choice, path_bytes, set_fields, text_bytes
from .job import Job

_PAIRS = {"texels": ctypes.c_uint32 * 2, "origin": c_double * 2, "period": c_double * 2}


def directions(name: str) -> np.ndarray:
    """[n x 2] theta and phi of a set in degrees: "81" (Bonn's), "105" (Bonn's and a ring at 85 degrees), or
    another number of directions of equal solid angle."""
    lib, count = library.load(), c_uint64()
    lib.vlr_directions(text_bytes(name), None, byref(count))
    angles = np.empty((count.value, 2))
    lib.vlr_directions(text_bytes(name), _doubles(angles), byref(count))
    return angles


def capture_job(tile, path: str | os.PathLike, **options) -> Job:
    """Captures a committed Scene, repeated by its period, as a BTF in the folder `path`.

    Options: texels (one number or two), views and lights ([n x 2] degrees), held_out (number of held-out
    pairs, in place of both), samples, bounces, sides (table.SIDES), origin and period (pairs, the scene's
    units; default period: the bounding box), metres_per_unit (0: not known), reference_height (the scene's z;
    default: automatic), memory_limit (bytes of a view's images that are kept in memory), source (a name),
    seed, threads, resume, measure_ray_share.
    """
    raw = structs.CaptureOptions()
    library.load().vlr_capture_options_init(byref(raw))
    arrays = {name: _angles(options.pop(name)) for name in ("views", "lights") if name in options}
    for name, array in arrays.items():
        setattr(raw, name, _doubles(array))
        setattr(raw, f"{name[:-1]}_count", len(array))
    for name, kind in _PAIRS.items():
        if name in options:
            options[name] = kind(*np.broadcast_to(options[name], 2).tolist())
    if "sides" in options:
        options["sides"] = choice("sides", options["sides"], table.SIDES)
    if "source" in options:
        options["source"] = text_bytes(options["source"])
    set_fields(raw, options)
    return Job._create("vlr_capture_create_job", tile.pointer, byref(raw), path_bytes(path))


def votf_job(tile, model, **options) -> Job:
    """Adds to a copy of a Model the VOTF of a committed Scene, repeated by its period.

    Surfaces with the resulting Model show the silhouette and the holes of the scene.

    Options: texels (along x), origin and period (pairs, the scene's units; default period: the bounding box),
    metres_per_unit (0: not known), surface (the scene's z that lies on the surface with the material),
    reference_height (the scene's z; default: automatic), source (a name), check_views, seed, threads.
    """
    for name in ("origin", "period"):
        if name in options:
            options[name] = _PAIRS[name](*np.broadcast_to(options[name], 2).tolist())
    return Job._create("vlr_votf_create_job", tile.pointer, model.pointer, _votf_options(options))


def votf_data_job(btf, model, **options) -> Job:
    """Like votf_job(), from the views of a Btf: coverage and heights of a capture, or alpha.

    Options: texels (default: those of the data), surface (its height over the structure's lowest point, in
    meters, or in widths of the tile if its size is not known), source (a name), check_views (number of the
    data's own), threads.
    """
    return Job._create(
        "vlr_votf_data_create_job", btf.pointer, model.pointer, _votf_options({"texels": 0, **options})
    )


def _votf_options(options: dict):
    raw = structs.VotfOptions()
    library.load().vlr_votf_options_init(byref(raw))
    if "source" in options:
        options["source"] = text_bytes(options["source"])
    set_fields(raw, options)
    return byref(raw)


def _angles(angles) -> np.ndarray:
    return np.ascontiguousarray(angles, np.float64).reshape(-1, 2)


def _doubles(array: np.ndarray):
    return array.ctypes.data_as(POINTER(c_double))

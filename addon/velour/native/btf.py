"""A bidirectional texture function as it was measured or captured."""

from __future__ import annotations

import ctypes
import os
from typing import NamedTuple

import numpy as np

from . import library, structs, table
from .arrays import small
from .handle import Handle, choice, path_bytes, set_fields, text_bytes
from .job import Job
from .model import Model

_CHOICES = (("values", table.BTF_VALUES), ("colors", table.BTF_COLORS), ("angles", table.BTF_ANGLES))


class Btf(Handle):
    """Pictures for pairs of directions, read on demand. Immutable; threads may share it."""

    _free_name = "vlr_btf_free"

    @classmethod
    def load(cls, path: str | os.PathLike, **options) -> Btf:
        """Opens a folder written by Velour, a folder of pictures named after their angles (UBO2003), a CSV
        index of pictures, or a .btf file from Bonn (UBO2014). Options: values (table.BTF_VALUES), colors
        (table.BTF_COLORS), angles (table.BTF_ANGLES), gamma (0: the sRGB curve), tile_metres (x, y), layer
        (of OpenEXR pictures)."""
        raw = structs.BtfOptions()
        library.load().vlr_btf_options_init(ctypes.byref(raw))
        for name, names in _CHOICES:
            if name in options:
                options[name] = choice(name, options[name], names)
        if "layer" in options:
            options["layer"] = text_bytes(options["layer"])
        if "tile_metres" in options:
            options["tile_metres"] = small("tile_metres", options["tile_metres"], 2)
        set_fields(raw, options)
        return cls._create("vlr_btf_load", path_bytes(path), ctypes.byref(raw))

    def info(self) -> dict:
        """kind, format, name, path, sha256, bytes, raw_bytes, texels, views, lights, pairs, complete, ..."""
        return library.json_of(self._lib.vlr_btf_info_json, self.pointer)

    def angles(self) -> np.ndarray:
        """theta_l, phi_l, theta_v, phi_v of every pair in degrees: [pairs x 4]."""
        angles = np.empty((self.info()["pairs"], 4))
        buffer = angles.ctypes.data_as(ctypes.POINTER(ctypes.c_double))
        self._lib.vlr_btf_angles(self.pointer, buffer, angles.size)
        return angles

    def read(self, first: int = 0, pairs: int = 1) -> np.ndarray:
        """Apparent BRDFs (1/sr, without cosine, linear Rec. 709): [pairs x rows x columns x 3] float16, row 0
        at the bottom (y = 0)."""
        columns, rows = self.info()["texels"]
        halves = np.empty((pairs, rows, columns, 3), np.float16)
        buffer = halves.ctypes.data_as(ctypes.POINTER(ctypes.c_uint16))
        self._lib.vlr_btf_read(self.pointer, first, pairs, buffer, halves.size)
        return halves


def export_btf_job(btf: Btf, path: str | os.PathLike) -> Job:
    """Writes one OpenEXR picture per pair into the new folder `path`, named after its angles if all are whole
    degrees, otherwise listed in btf.csv."""
    return Job._create("vlr_btf_export_create_job", btf.pointer, path_bytes(path))


class CompressSize(NamedTuple):
    """Predicted memory and size of a fit of all sides of the BTF, in bytes."""

    memory: int  # peak without a limit, in addition to the process as it is
    least_memory: int  # the smallest `memory` option that the fit can keep to
    bytes: int  # upper bound for all coefficients


def compress_size(btf: Btf, **options) -> CompressSize:
    """Options as for compress_job(). Uses only the BTF's dimensions, without reading it."""
    numbers = [ctypes.c_uint64() for _ in CompressSize._fields]
    raw = ctypes.byref(_compress_options(options))
    library.load().vlr_compress_size(btf.pointer, raw, *map(ctypes.byref, numbers))
    return CompressSize(*(number.value for number in numbers))


def compress_job(btf: Btf, **options) -> Job:
    """Options: method (table.COMPRESS_METHODS), companding (table.COMPANDINGS), tolerance, bytes, seed,
    threads, memory, checkpoint (a file for finished stages; delete it once the model is saved) and resume,
    held_out (a Btf of held-out pairs); for_scene (an Observation) and full_model (a Model) make a scene model
    without details that the scenes do not resolve. Result: result_model()."""
    return Job._create("vlr_compress_create_job", btf.pointer, ctypes.byref(_compress_options(options)))


def _compress_options(options: dict) -> structs.CompressOptions:
    raw = structs.CompressOptions()
    library.load().vlr_compress_options_init(ctypes.byref(raw))
    for name, names in (("method", table.COMPRESS_METHODS), ("companding", table.COMPANDINGS)):
        if name in options:
            options[name] = choice(name, options[name], names)
    if "checkpoint" in options:
        options["checkpoint"] = path_bytes(options["checkpoint"])
    for name in {"held_out", "for_scene", "full_model"} & options.keys():
        options[name] = options[name].pointer
    set_fields(raw, options)
    return raw


def compare_btf_job(btf: Btf, judged: Model | Btf) -> Job:
    """Errors of a model, or of another BTF interpolated, at the pairs of `btf`."""
    create = "vlr_btf_compare_create_job" if isinstance(judged, Model) else "vlr_btf_compare_btf_create_job"
    return Job._create(create, btf.pointer, judged.pointer)

"""Optional passes of a render, and the labels of the scene that they show."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from . import library, structs, table
from .arrays import checked
from .errors import refuse
from .handle import set_fields

_CHANNELS = {
    "Combined": 4,
    "Depth": 1,
    "Normal": 3,
    "Sample Count": 1,
    "Position": 3,
    "UV": 3,
    "IndexOB": 1,
    "IndexMA": 1,
    "Mist": 1,
    "Albedo": 3,
    "Error": 3,
    "Denoising Albedo": 3,
    "Halves": 18,
    "Vector": 4,
    "Denoised": 4,
}
# Each is a sequence of passes with two ids each: CryptoObject00, CryptoObject01, ...
_CRYPTOMATTES = ("CryptoObject", "CryptoMaterial", "CryptoAsset")

INSTANCE_LABEL = np.dtype(structs.InstanceLabel)
MATERIAL_LABEL = np.dtype(structs.MaterialLabel)


@dataclass
class Passes:
    """vlr_pass_options."""

    asked: frozenset[str]  # names in table.PASSES
    cryptomatte_ranks: int = 6  # ids per pixel, two per pass; 2..16
    # Start: meters from the camera; depth: meters from there to full mist; exponent of the falloff.
    mist: tuple[float, float, float] = (5.0, 25.0, 2.0)
    # Indexed by the scene's instance and material numbers: INSTANCE_LABEL, MATERIAL_LABEL.
    instances: np.ndarray = field(default_factory=lambda: np.zeros(0, INSTANCE_LABEL))
    materials: np.ndarray = field(default_factory=lambda: np.zeros(0, MATERIAL_LABEL))

    def raw(self) -> structs.PassOptions:
        """The C struct, which borrows the labels."""
        raw = structs.PassOptions()
        library.load().vlr_pass_options_init(ctypes.byref(raw))
        start, depth, exponent = self.mist
        numbers = {
            "asked": sum(table.PASSES[name] for name in self.asked),
            "cryptomatte_ranks": self.cryptomatte_ranks,
            "mist_start": start,
            "mist_depth": depth,
            "mist_exponent": exponent,
        }
        set_fields(raw, numbers)
        for name, dtype in (("instances", INSTANCE_LABEL), ("materials", MATERIAL_LABEL)):
            labels = checked(name, getattr(self, name), (None,), dtype)
            setattr(raw, name, labels.ctypes.data)
            setattr(raw, f"{name[:-1]}_count", len(labels))
        return raw


def channels_of(name: str) -> int:
    """Raises VelourError if there is no pass of that name."""
    if name[:-2] in _CRYPTOMATTES and name[-2:].isdecimal():
        return 4
    if name not in _CHANNELS:
        known = ", ".join((*_CHANNELS, *(f"{each}00" for each in _CRYPTOMATTES)))
        raise refuse(f"There is no pass {name!r}; the passes are {known}.")
    return _CHANNELS[name]


_SUMS = 12  # floats per pixel of every film: light, alpha, normal, depth, halves, numbers of rays
_VALUES = {"position": 3, "uv": 3, "object_index": 1, "material_index": 1, "mist": 1, "albedo": 3, "error": 3}
_VALUES |= {"denoising_albedo": 3, "halves": 12, "vector": 5}
_SPARE_IDS = 2  # ids that are kept in addition to those shown


def sums_per_pixel(passes: Passes | None) -> int:
    """Floats per pixel of a film: Job.sums_per_pixel() before there is a job."""
    if passes is None:
        return _SUMS
    ids = 2 * (passes.cryptomatte_ranks + _SPARE_IDS)
    return _SUMS + sum(_VALUES.get(name, ids) for name in passes.asked)


class CryptomatteId(NamedTuple):
    hash: int  # MurmurHash3_x86_32 of the name
    value: float  # as stored in the passes

    @property
    def text(self) -> str:
        """The value as it is written in a manifest."""
        return f"{np.float32(self.value).view(np.uint32):08x}"


def cryptomatte_id(name: str) -> CryptomatteId:
    raw_hash, value = ctypes.c_uint32(), ctypes.c_float()
    lib = library.load()
    lib.vlr_cryptomatte_id(name.encode(), ctypes.byref(raw_hash), ctypes.byref(value))
    return CryptomatteId(raw_hash.value, value.value)

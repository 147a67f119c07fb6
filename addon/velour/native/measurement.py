"""A measured BRDF."""

from __future__ import annotations

import os

import numpy as np

from . import library
from .arrays import directions, pointer, small
from .handle import Handle, path_bytes


class Measurement(Handle):
    """Raw data with its provenance. Immutable; may be shared by threads once loaded."""

    _free_name = "vlr_measurement_free"

    @classmethod
    def load(cls, path: str | os.PathLike) -> Measurement:
        """Reads a measurement file; the format is recognized from its content."""
        return cls._create("vlr_measurement_load", path_bytes(path))

    def info(self) -> dict:
        """kind, format, name, path, sha256, bytes, isotropic, entries {...}, details {...}."""
        return library.json_of(self._lib.vlr_measurement_info_json, self.pointer)

    def eval(self, wv, wl: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """f [n x 3] in 1/sr, without cosine, linear Rec. 709, and valid [n] (the pair is covered).

        `wv` [3] towards the viewer, `wl` [n x 3] float32 towards the light: unit, local frame, +z normal.
        """
        wl = directions("wl", wl)
        f = np.empty_like(wl)
        valid = np.empty(len(wl), np.uint8)
        self._lib.vlr_measurement_eval(
            self.pointer, small("wv", wv, 3), len(wl), pointer(wl), pointer(f), pointer(valid)
        )
        return f, valid.astype(bool)

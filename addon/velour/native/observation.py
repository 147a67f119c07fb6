"""What scenes show of one material."""

from __future__ import annotations

import ctypes
import os

from . import library
from .handle import Handle, path_bytes


class Observation(Handle):
    """Views, lights and a sample of hits of some frames; a new one is of none. Merge from one thread."""

    _free_name = "vlr_observation_free"

    def __init__(self, lib=None, handle=None):
        if lib is None:
            lib = library.load()
            handle = ctypes.c_void_p()
            lib.vlr_observation_create(ctypes.byref(handle))
        super().__init__(lib, handle)

    @classmethod
    def load(cls, path: str | os.PathLike) -> Observation:
        return cls._create("vlr_observation_load", path_bytes(path))

    def save(self, path: str | os.PathLike) -> None:
        """Writes the old file or the new one, never a part."""
        self._lib.vlr_observation_save(self.pointer, path_bytes(path))

    def merge(self, other: Observation) -> None:
        """Adds what `other` saw; the order of frames does not matter but for the rounding of sums."""
        self._lib.vlr_observation_merge(self.pointer, other.pointer)

    def info(self) -> dict:
        """frames, camera_rays, hits, weight, share, views [from, to] degrees, light_density, hash."""
        return library.json_of(self._lib.vlr_observation_info_json, self.pointer)

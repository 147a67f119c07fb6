"""Scene usage: what scenes show of one material."""

from __future__ import annotations

import os

from . import library
from .handle import Handle, path_bytes


class Observation(Handle):
    """Weighted views and lights under which frames show a material; may be empty, and grows by merge()."""

    _free_name = "vlr_observation_free"

    @classmethod
    def of_nothing(cls) -> Observation:
        """An observation without frames, to merge others into."""
        return cls._create("vlr_observation_create")

    @classmethod
    def load(cls, path: str | os.PathLike) -> Observation:
        return cls._create("vlr_observation_load", path_bytes(path))

    def save(self, path: str | os.PathLike) -> None:
        """Atomic: the file is the old one or the new one, never a part."""
        self._lib.vlr_observation_save(self.pointer, path_bytes(path))

    def merge(self, other: Observation) -> None:
        """Adds the frames of `other`."""
        self._lib.vlr_observation_merge(self.pointer, other.pointer)

    def info(self) -> dict:
        """kind, frames, camera_rays, hits, weight, share, views (degrees), light_density (1/sr), hash."""
        return library.json_of(self._lib.vlr_observation_info_json, self.pointer)

"""A fitted model of a material."""

from __future__ import annotations

import ctypes
import os

import numpy as np

from . import library, structs, table
from .arrays import checked, directions, pointer, small
from .handle import Handle, path_bytes
from .observation import Observation


class Model(Handle):
    """Immutable. f in 1/sr without cosine, linear Rec. 709; unit directions, local frame, +z normal."""

    _free_name = "vlr_model_free"

    @classmethod
    def load(cls, path: str | os.PathLike) -> Model:
        return cls._create("vlr_model_load", path_bytes(path))

    @classmethod
    def from_bytes(cls, data: bytes, name: str) -> Model:
        """Loads a model from the content `data` of its file; `name` appears in error messages."""
        data = bytes(data)
        return cls._create("vlr_model_load_memory", data, len(data), os.fsencode(name))

    def bytes(self) -> bytes:
        """The content of the file that save() would write."""
        data, size = ctypes.c_void_p(), ctypes.c_uint64()
        self._lib.vlr_model_bytes(self.pointer, ctypes.byref(data), ctypes.byref(size))
        return ctypes.string_at(data, size.value)

    def save(self, path: str | os.PathLike) -> None:
        """Atomic: the file is the old one or the new one, never a part."""
        self._lib.vlr_model_save(self.pointer, path_bytes(path))

    def info(self) -> dict:
        """kind, model, kernel, lobes, bytes, relative_l2, by_view_angle, warnings, order, source, ..."""
        return library.json_of(self._lib.vlr_model_info_json, self.pointer)

    def roughened(self, roughness: float) -> Model:
        """The model of a rougher surface; `roughness`: 0 to 1. Not for models of BTFs."""
        return self._create("vlr_model_roughened", self.pointer, roughness)

    def closures(
        self, max_lobes: int = 0, tolerance: float = 0.0, masking: str = "separable", threads: int = 0
    ) -> dict:
        """Blender's closures fitted to the model: lobes, diffuse, views, relative_l2, albedo_excess, ...

        Curves have 65 samples over the view angle, 0 to 90 degrees. The keys are those of
        vlr_model_closures_json. `max_lobes`: 1 to 3 glossy closures; 0: automatic. `tolerance`: error with
        which no more are added, the mean of those of f cos and of its root; 0: automatic. `masking`:
        "separable" before Blender 3.5, "correlated" since. Not for models of BTFs.
        """
        if masking not in table.MASKINGS:
            raise ValueError(f"masking is {masking!r}, not one of {', '.join(table.MASKINGS)}")
        options = structs.ClosureOptions()
        self._lib.vlr_closure_options_init(ctypes.byref(options))
        options.max_lobes, options.tolerance, options.threads = max_lobes, tolerance, threads
        options.masking = table.MASKINGS.index(masking)
        return library.json_of(self._lib.vlr_model_closures_json, self.pointer, ctypes.byref(options))

    def out_of_domain(self, frame: Observation) -> float:
        """Share of the usage in `frame` that a scene model was not fitted for; 0 for other models."""
        share = ctypes.c_double()
        self._lib.vlr_model_out_of_domain(self.pointer, frame.pointer, ctypes.byref(share))
        return share.value

    def eval(self, wv, wl: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """f [n x 3] and the density pdf [n] of the model's own sampler, per solid angle, for `wl` [n x 3]."""
        wl = directions("wl", wl)
        f, pdf = np.empty_like(wl), np.empty(len(wl), np.float32)
        self._lib.vlr_model_eval(
            self.pointer, small("wv", wv, 3), len(wl), pointer(wl), pointer(f), pointer(pdf)
        )
        return f, pdf

    def sample(self, wv, u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Directions wl [n x 3] sampled for `wv` [3] from `u` [n x 2] in [0, 1), and their density pdf [n].

        A direction may lie below the horizon.
        """
        u = checked("u", u, (None, 2))
        wl, pdf = np.empty((len(u), 3), np.float32), np.empty(len(u), np.float32)
        self._lib.vlr_model_sample(
            self.pointer, small("wv", wv, 3), len(u), pointer(u), pointer(wl), pointer(pdf)
        )
        return wl, pdf

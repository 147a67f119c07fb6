"""A picture for somebody who watches it and keeps changing the scene."""

from __future__ import annotations

import ctypes
from typing import NamedTuple

import numpy as np

from . import structs
from .arrays import pointer
from .errors import refuse
from .job import Job, render_options


class Picture(NamedTuple):
    width: int  # 0: there is none yet
    height: int
    samples: int  # light directions that every pixel of full size has
    version: int  # grows with what there is to see


class ProgressiveJob(Job):
    """Coarse at once, then finer, then less noisy. Started again after a cancel, it goes on where it was."""

    @classmethod
    def of(cls, scene, **options) -> ProgressiveJob:
        """Options as of render_job, which see; noise and time_limit are not used."""
        raw = render_options(options)
        size = (raw.width, raw.height)
        return cls._create("vlr_progressive_create_job", scene.pointer, ctypes.byref(raw), size=size)

    def restart(self) -> None:
        """The next start begins anew, after Scene.commit() where the scene has changed. Not while it runs."""
        self._lib.vlr_progressive_restart(self.pointer)

    def stop(self) -> None:
        """Cancels and waits, at most 0.1 s."""
        self._stop()

    def picture(self) -> Picture:
        return self._read(None, 0)

    def read(self, out: np.ndarray) -> Picture:
        """Into the start of `out`, float32, which a picture of full size fits: [height x width x 4].

        RGBA, premultiplied, row 0 at the bottom.
        """
        if out.dtype != np.float32 or not out.flags.c_contiguous:
            raise refuse("The buffer for a picture must be contiguous float32.")
        return self._read(pointer(out), out.size)

    def _read(self, pixels, count: int) -> Picture:
        raw = structs.ProgressivePicture()
        raw.struct_size = ctypes.sizeof(raw)
        self._lib.vlr_progressive_read(self.pointer, pixels, count, ctypes.byref(raw))
        return Picture(raw.width, raw.height, raw.samples, raw.version)

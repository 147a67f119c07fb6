"""Progressive rendering for a viewer who keeps changing the scene."""

from __future__ import annotations

import ctypes
from typing import NamedTuple

import numpy as np

from . import structs
from .arrays import pointer
from .errors import refuse
from .job import Job, render_options


class Picture(NamedTuple):
    width: int  # 0: no picture yet
    height: int
    samples: int  # light directions of every pixel at full size
    version: int  # increases when the picture changes


class ProgressiveJob(Job):
    """Coarse at once, then finer, then less noisy. When started after a cancel, it continues where it was."""

    @classmethod
    def of(cls, scene, **options) -> ProgressiveJob:
        """Options as for render_job(); noise and time_limit are ignored."""
        raw = render_options(options)
        size = (raw.width, raw.height)
        return cls._create("vlr_progressive_create_job", scene.pointer, ctypes.byref(raw), size=size)

    def restart(self) -> None:
        """The next start begins from scratch; call Scene.commit() before if the scene has changed. Not while
        the job runs."""
        self._lib.vlr_progressive_restart(self.pointer)

    def stop(self) -> None:
        """Cancels the job and waits for it, at most 0.1 s."""
        self._stop()

    def picture(self) -> Picture:
        return self._read(None, 0)

    def read(self, out: np.ndarray) -> Picture:
        """Copies the picture to the start of `out`, float32, with room for full size: [height x width x 4].

        RGBA, premultiplied, row 0 at the bottom.
        """
        if out.dtype != np.float32 or not out.flags.c_contiguous:
            raise refuse("The buffer for an image must be a contiguous float32 array.")
        return self._read(pointer(out), out.size)

    def _read(self, pixels, count: int) -> Picture:
        raw = structs.ProgressivePicture()
        raw.struct_size = ctypes.sizeof(raw)
        self._lib.vlr_progressive_read(self.pointer, pixels, count, ctypes.byref(raw))
        return Picture(raw.width, raw.height, raw.samples, raw.version)

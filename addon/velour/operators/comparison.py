"""Renders of a measurement, its model and their difference on a ball."""

import contextlib
import functools

import numpy as np

from ..core.ball import ball_job, ball_scene, shown
from ..core.read_job import ReadJob
from ..export import ExportError
from ..export.files import StoredFile
from ..native import Btf, Measurement, VelourError, library
from ..native.plot import text_coverage

_BACKDROP = 0.05  # linear gray around the balls
_THUMBNAIL = 256  # pixels; previews are square
_CAPTION, _SMALLEST_EM = 26, 10  # height of a tile over that of a line of text, and its minimum in pixels
_CAPTION_GRAY = 0.6  # linear


class Comparison:
    """Jobs of a comparison, each to be run before requesting the next one, and the resulting images."""

    def __init__(self, node, owner, side, samples, threads):
        self._owner, self._side, self._samples, self._threads = owner, side, samples, threads
        if node.velour.measurement is None:
            raise ExportError(f"{owner}: there is no measurement to compare with; choose one.")
        self._model = StoredFile.of(node.image, owner)
        self._measurement = StoredFile.of(node.velour.measurement, owner)
        self._until_read = contextlib.ExitStack()
        self._path = self._until_read.enter_context(self._measurement.readable_path())
        self._balls = []  # measured, model: [side x side x 4], linear, premultiplied
        self._jobs = self._run()

    def next_job(self):
        """The next job; None after the last."""
        return next(self._jobs, None)

    def _run(self):
        with self._until_read:
            reading = ReadJob(self._model.model)
            yield reading
            model = reading.result()  # not closed here: after a cancel, a thread may still read it
            for add in (functools.partial(self._add_measured, model), _adding(model)):
                making = ReadJob(functools.partial(ball_scene, add))
                yield making
                with making.result() as scene, self._job(scene) as job:
                    yield job
                    self._balls.append(job.read_pass("Combined"))

    def _job(self, scene):
        return ball_job(scene, self._side, self._samples, self._threads)

    def _add_measured(self, model, scene):
        """Runs on the job's thread, since measurements may be large."""
        try:
            is_btf = library.file_info(self._path)["kind"] == "btf"
            with (Btf if is_btf else Measurement).load(self._path) as measured:
                self._measurement.refuse_other(measured.info()["sha256"])
                if is_btf:
                    return scene.add_btf_material(measured)
                return scene.add_measurement_material(measured, model)
        except VelourError as error:
            raise ExportError(f"{self._owner}: {error}") from error

    @property
    def relative_l2(self):
        """Relative L2 error over the pixels of the ball."""
        measured, model = (ball[..., :3] for ball in self._balls)
        return float(np.linalg.norm(model - measured) / max(np.linalg.norm(measured), 1e-30))

    def tiles(self, gain):
        """Measured, model and `gain` times the absolute difference, from left to right: linear, opaque."""
        measured, model = (_over_backdrop(ball) for ball in self._balls)
        difference = gain * np.abs(model - measured)
        for tile, caption in (
            (measured, "Measurement"),
            (model, "Model"),
            (difference, f"{gain:g} times the difference"),
        ):
            _write(tile, caption)
        tiles = np.concatenate((measured, model, difference), axis=1)
        return np.concatenate((tiles, np.ones_like(tiles[..., :1])), axis=2)

    def thumbnail(self, gain):
        """Square preview: measurement and model above the difference."""
        half = _THUMBNAIL // 2
        measured, model = (_resized(ball, half) for ball in self._balls)
        difference = gain * np.abs(model - measured)
        difference[..., 3] = np.maximum(measured[..., 3], model[..., 3])
        picture = np.zeros((_THUMBNAIL, _THUMBNAIL, 4), np.float32)
        picture[half:, :half], picture[half:, half:] = shown(measured), shown(model)
        picture[:half, half // 2 : half // 2 + half] = shown(difference)
        return picture


def _write(tile, caption):
    """Writes a caption into the lower left corner of a tile."""
    em = max(len(tile) / _CAPTION, _SMALLEST_EM)
    coverage = text_coverage(caption, em)[: len(tile), : tile.shape[1], None]
    height, width, _ = coverage.shape
    tile[:height, :width] += coverage * (_CAPTION_GRAY - tile[:height, :width])


def _adding(model):
    return lambda scene: scene.add_model_material(model)


def _over_backdrop(ball):
    return ball[..., :3] + (1 - ball[..., 3:]) * _BACKDROP


def _resized(pixels, side):
    """Nearest-neighbor resampling: a thumbnail may be noisy."""
    at = ((np.arange(side) + 0.5) * (len(pixels) / side)).astype(int)
    return pixels[at][:, at]

"""One plot in progress, made by jobs that the main thread only polls."""

import bpy

from ..export import ExportError
from ..operators.model_plots import PlotSource, PlotSteps

_source = (
    None,
    None,
)  # latest source, kept open for sliders: (identities, PlotSource)


class PlotWork:
    """`wanted`: see plot_preview. `model`, `measurement`: image names; the second may be None."""

    def __init__(self, wanted, model, measurement):
        self._wanted, self._names = wanted, (model, measurement)
        self._steps = self._job = None
        self.cancelled = False

    @property
    def missing(self):
        """Why an expected measurement is missing in the plot, or None."""
        return self._steps.source.missing

    @property
    def fraction(self):
        """Progress of the running job; None if there is none yet."""
        return None if self._job is None else self._job.poll().fraction

    def cancel(self):
        """Returns immediately; a later step ends the work, with an error or with the finished plot.

        Reading a measurement is not canceled, since the next plot needs it, too.
        """
        self.cancelled = True
        if self._job is not None and self._steps.source.reading is None:
            self._job.cancel()

    def step(self):
        """The pixels, or None until they are done. Raises ExportError or VelourError on failure."""
        if self._steps is None:
            self._steps = PlotSteps(self._opened(), self._wanted.kind, *self._wanted.angles)
            return self._begin_next()
        return self._begin_next() if self._job.wait(timeout=0.0) else None

    def _begin_next(self):
        self._job = self._steps.next_job()
        if self._job is not None:
            self._job.start()
            return None
        with self._steps.plot as plot:
            return plot.draw(**dict(self._wanted.style))

    def _opened(self):
        """The source that is already open, or a new one that replaces it."""
        global _source
        known = self._wanted.model, self._wanted.measurement
        if _source[0] != known:
            close_source()
            images, (model, measurement) = bpy.data.images, self._names
            if model not in images:
                raise ExportError("The model no longer exists.")
            measured = images.get(measurement) if measurement else None
            _source = known, PlotSource(images[model], measured, f"Model '{images[model].name}'")
        return _source[1]


def close_source():
    global _source
    if _source[1] is not None:
        _source[1].close()
    _source = (None, None)

"""One plot of a panel on its way, by jobs that the main thread only looks at."""

import bpy

from ..export import ExportError
from ..operators.model_plots import PlotSource, PlotSteps

_source = (
    None,
    None,
)  # what was asked for last, open: (identities, PlotSource); a slider asks for it many times


class PlotWork:
    """`wanted`: as plot_preview has it. `model`, `measurement`: names of images; the second may be None."""

    def __init__(self, wanted, model, measurement):
        self._wanted, self._names = wanted, (model, measurement)
        self._steps = self._job = None
        self.cancelled = False

    @property
    def missing(self):
        """Why the measurement is not in the plot although it should be, or None."""
        return self._steps.source.missing

    @property
    def fraction(self):
        """How far the job is that runs; None: there is none yet."""
        return None if self._job is None else self._job.poll().fraction

    def cancel(self):
        """Returns at once; a later step says that the work has ended: by an error, or by what is done.

        A measurement is read to its end: the next plot needs it, too.
        """
        self.cancelled = True
        if self._job is not None and self._steps.source.reading is None:
            self._job.cancel()

    def step(self):
        """The pixels, once they are there. Raises ExportError and VelourError where there will be none."""
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
        """The source that is open already, or another one in its place."""
        global _source
        known = self._wanted.model, self._wanted.measurement
        if _source[0] != known:
            close_source()
            images, (model, measurement) = bpy.data.images, self._names
            if model not in images:
                raise ExportError("The model is gone.")
            measured = images.get(measurement) if measurement else None
            _source = known, PlotSource(images[model], measured, f"Model '{images[model].name}'")
        return _source[1]


def close_source():
    global _source
    if _source[1] is not None:
        _source[1].close()
    _source = (None, None)

"""Plots of the model in an image datablock, computed by the library."""

from ..core.read_job import ReadJob
from ..export import ExportError
from ..export.files import MeasurementReading, StoredFile
from ..native import plot_job

_WITH_MEASUREMENT = ("LOBES", "ALBEDO")


def plot_name(kind):
    """The library's name of an item of PLOTS."""
    return kind.lower().replace("_", "-")


def measurement_for(kind, settings):
    """The image datablock of the measurement that this plot shows beside the model, or None."""
    return settings.measurement if kind in _WITH_MEASUREMENT else None


class PlotSource:
    """Sources of a material's plots: the model, and the measurement if there is one.

    `reading`: the job that must finish before plotting, or None. `missing`: why an expected measurement is
    missing, or None.
    """

    def __init__(self, image, measurement, owner):
        self.model = self.measurement = self.missing = self._of_measurement = None
        if measurement is not None:
            try:
                self._of_measurement = MeasurementReading(measurement, owner)
            except ExportError as error:
                self.missing = str(error)
        self.reading = ReadJob(StoredFile.of(image, owner).model)

    def take(self):
        """Takes the result of `reading`. Without a measurement, plots show the model only."""
        if self.model is None:
            self.model = self.reading.result()
            self.reading = self._of_measurement
            if "texels" in self.model.info():  # plots of BTFs never show the measurement
                self.reading = self.missing = None
            return
        try:
            with self.reading:
                self.measurement = self.reading.result()
        except ExportError as error:
            self.missing = str(error)
        self.reading = None

    def close(self):
        for handle in (self.reading, self._of_measurement, self.measurement, self.model):
            if handle is not None:
                handle.close()


class PlotSteps:
    """Jobs of one plot; each must be run before requesting the next one."""

    def __init__(self, source, kind, view, azimuth):
        """`kind`: an item of PLOTS; the angles in radians."""
        self.source, self.plot = source, None  # the Plot, available after the last job
        self._jobs = self._run(plot_name(kind), view, azimuth)

    def next_job(self):
        """The next job; None after the last. Raises VelourError if the model has no such plot."""
        return next(self._jobs, None)

    def _run(self, name, view, azimuth):
        source = self.source
        while source.reading is not None:
            yield source.reading
            source.take()
        with plot_job(source.model, name, source.measurement, view=view, azimuth=azimuth) as job:
            yield job
            self.plot = job.result_plot()

"""Plots of the model in an image datablock, from the library's numbers."""

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
    """What plots of a material are made from: the model, and the measurement where there is one.

    `reading`: the job that is to be done before there is a plot, or None. `missing`: why the measurement is
    not there although it should be, or None.
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
        """What its job has read. Without a measurement there are plots of the model alone."""
        if self.model is None:
            self.model = self.reading.result()
            self.reading = self._of_measurement
            if "texels" in self.model.info():  # BTFs have no plot with their measurement
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
    """The jobs of one plot; each is to be run before the next one is asked for."""

    def __init__(self, source, kind, view, azimuth):
        """`kind`: an item of PLOTS; the angles in radians."""
        self.source, self.plot = source, None  # the Plot is there after the last job
        self._jobs = self._run(plot_name(kind), view, azimuth)

    def next_job(self):
        """None after the last. VelourError where the model has no such plot."""
        return next(self._jobs, None)

    def _run(self, name, view, azimuth):
        source = self.source
        while source.reading is not None:
            yield source.reading
            source.take()
        with plot_job(source.model, name, source.measurement, view=view, azimuth=azimuth) as job:
            yield job
            self.plot = job.result_plot()

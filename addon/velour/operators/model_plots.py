"""Plots of the model in an image datablock, from the library's numbers."""

from ..export import ExportError
from ..export.files import MeasurementReading, read_model
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
        self.model, self.measurement = read_model(image, owner), None
        self.reading = self.missing = None
        if measurement is None or "texels" in self.model.info():  # BTFs have no plot with their measurement
            return
        try:
            self.reading = MeasurementReading(measurement, owner)
        except ExportError as error:
            self.missing = str(error)

    def take_measurement(self):
        """That its job has read. Without one there are plots of the model alone."""
        try:
            with self.reading:
                self.measurement = self.reading.result()
        except ExportError as error:
            self.missing = str(error)
        self.reading = None

    def close(self):
        for handle in (self.reading, self.measurement, self.model):
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
        if source.reading is not None:
            yield source.reading
            source.take_measurement()
        with plot_job(source.model, name, source.measurement, view=view, azimuth=azimuth) as job:
            yield job
            self.plot = job.result_plot()

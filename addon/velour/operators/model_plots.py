"""Plots of the model in an image datablock, from the library's numbers."""

from ..export import ExportError
from ..export.files import read_measurement, read_model
from ..native import Plot

_WITH_MEASUREMENT = ("LOBES", "ALBEDO")


def plot_name(kind):
    """The library's name of an item of PLOTS."""
    return kind.lower().replace("_", "-")


def measurement_for(kind, settings):
    """The image datablock of the measurement that this plot shows beside the model, or None."""
    return settings.measurement if kind in _WITH_MEASUREMENT else None


class PlotSource:
    """What plots of a material are made from; holds the model, and the measurement where there is one.

    `missing`: why the measurement is not there although it should be, or None.
    """

    def __init__(self, image, measurement, owner):
        self._model, self._measurement, self.missing = read_model(image, owner), None, None
        if measurement is None or "texels" in self._model.info():  # BTFs have no plot with their measurement
            return
        try:
            self._measurement = read_measurement(measurement, owner)
        except ExportError as error:
            self.missing = str(error)

    def plot(self, kind, view, azimuth):
        """VelourError where the model has no such plot. `kind` is an item of PLOTS."""
        return Plot.of(self._model, plot_name(kind), self._measurement, view, azimuth)

    def close(self):
        self._model.close()
        if self._measurement is not None:
            self._measurement.close()

    def __enter__(self):
        return self

    def __exit__(self, *_exception):
        self.close()

"""Measured materials in the library's scene."""

from typing import NamedTuple

from ..core.model_warnings import roughness_reason
from ..native import Model, VelourError
from . import files
from .notes import ExportError
from .visibility import hidden_backs


class Reduced(NamedTuple):
    """A material that may render with its scene model."""

    number: int  # material number in the library's scene
    name: str
    model: Model  # the scene model; the full one is in the library's scene
    neighbors: int
    has_full: bool  # False: the full model is missing, and the scene model replaces it
    image: str  # name of the image that holds the scene model


class _Known(NamedTuple):
    source: tuple  # _source() at the time of reading
    info: dict  # info of the model or measurement


class MeasuredMaterials:
    """Measured materials of one library scene. Files are read once: a tint changes many times a second."""

    def __init__(self, scene, notes):
        self._scene = scene
        self._notes = notes
        self._known = {}  # keys: pointers of original materials
        self.reduced = []

    def add(self, material, node):
        """Adds a material; returns its number and its model's or measurement's info.

        Raises ExportError or VelourError.
        """
        source = _source(node)
        number, info = self._read(material, node)
        self._adjust(material, node, number, info)
        self._known[material.original.as_pointer()] = _Known(source, info)
        return number, info

    def adjust(self, material, node, number):
        """Applies settings of an added material that need none of its files.

        Returns the info as add() does; None if its model or measurement has been replaced.
        """
        known = self._known.get(material.original.as_pointer())
        if known is None or known.source != _source(node):
            return None
        self._adjust(material, node, number, known.info)
        return known.info

    def forget(self, material):
        """Forgets a material whose number is reused."""
        self._known.pop(material.original.as_pointer(), None)

    def drop_reduced(self, number):
        for entry in self.reduced:
            if entry.number == number:
                entry.model.close()
        self.reduced = [entry for entry in self.reduced if entry.number != number]

    def renumber(self, before, now):
        self.reduced = [e._replace(number=now) if e.number == before else e for e in self.reduced]

    def _adjust(self, material, node, number, info):
        settings = node.velour
        self._scene.set_gain(number, gain(settings))
        self._scene.hide_backs(number, hidden_backs(material))
        if "shell" in info and not settings.use_reference:
            self._scene.set_shell_tile(number, settings.outline_width)
            self._scene.set_shell_softness(number, settings.outline_softness)

    def _read(self, material, node):
        settings, owner = node.velour, f"Material '{material.name}'"
        if settings.use_reference:
            self._note_roughness(settings, {}, owner)
            return self._add_reference(node, owner)
        if settings.use_scene_model and settings.scene_model is not None:
            return self._add_pair(material, node, owner)
        if node.image is None:
            raise ExportError(
                f"{owner}: node '{node.name}' has no model; press Fit, or choose a model as its image."
            )
        with self._read_model(node.image, settings, owner) as model:
            return self._scene.add_model_material(model, settings.neighbors), model.info()

    def _read_model(self, image, settings, owner):
        """The model with the roughness offset applied."""
        model = files.read_model(image, owner)
        if settings.roughness == 0 or self._note_roughness(settings, model.info(), owner):
            return model
        with model:
            return model.roughened(settings.roughness)

    def _note_roughness(self, settings, info, owner):
        """Whether the roughness offset is unsupported; adds a note if one is set."""
        reason = roughness_reason(info, settings.use_reference)
        if reason and settings.roughness > 0:
            self._notes.add(f"{owner}: {reason}")
        return reason is not None

    def _add_pair(self, material, node, owner):
        image = node.velour.scene_model
        reduced = self._read_model(image, node.velour, owner)
        has_full = files.is_there(node.image)
        model = self._read_model(node.image, node.velour, owner) if has_full else reduced
        number = self._scene.add_model_material(model, node.velour.neighbors)
        neighbors = node.velour.neighbors
        self.reduced.append(Reduced(number, material.name, reduced, neighbors, has_full, image.name))
        return number, model.info()

    def _add_reference(self, node, owner):
        if node.velour.measurement is None:
            raise ExportError(
                f"{owner}: 'Render from Measurement' is enabled, but no measurement is chosen; choose one."
            )
        if files.measurement_info(node.velour.measurement, owner)["kind"] == "btf":
            return self._add_btf(node.velour.measurement, owner)
        proposal = files.read_model(node.image, owner) if node.image else None
        with files.read_measurement(node.velour.measurement, owner) as measurement:
            number = self._scene.add_measurement_material(measurement, proposal, node.velour.neighbors)
            return number, measurement.info()

    def _add_btf(self, image, owner):
        try:
            with files.read_btf(image, owner) as btf:
                return self._scene.add_btf_material(btf), btf.info()
        except VelourError as error:
            raise ExportError(f"{owner}: {error}") from error


def _source(node):
    """Key of the files and settings of its reflectance: equal if and only if the reflectance is the same."""
    settings = node.velour
    other = settings.measurement if settings.use_reference else settings.scene_model
    is_other_used = settings.use_reference or settings.use_scene_model
    stamps = files.stamp_of(node.image), files.stamp_of(other if is_other_used else None)
    return settings.use_reference, settings.neighbors, settings.roughness, *stamps


def gain(settings):
    """Factor on a measured material's reflectance, from tint and exposure."""
    return tuple(channel * 2.0**settings.exposure for channel in settings.tint)

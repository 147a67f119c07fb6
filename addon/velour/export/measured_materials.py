"""Measured materials in the library's scene."""

import contextlib
from typing import Any, NamedTuple

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


class Reflectance(NamedTuple):
    """What a measured node reflects with, as read from its files."""

    kind: str  # "model", "measurement" or "btf"
    data: Any  # Model, Measurement or Btf
    info: dict
    neighbors: int = 0
    proposal: Model | None = None  # model that a measurement is sampled with

    def add_to(self, scene):
        """Adds it as a material; returns its number."""
        if self.kind == "model":
            return scene.add_model_material(self.data, self.neighbors)
        if self.kind == "measurement":
            return scene.add_measurement_material(self.data, self.proposal, self.neighbors)
        return scene.add_btf_material(self.data)

    def add_layer(self, shader, **values):
        """Adds it as a layer with weight 1. `values`: as for Shader.add_measured_layer."""
        given = {self.kind: self.data} | ({"model": self.proposal} if self.proposal else {})
        shader.add_measured_layer(**given, neighbors=self.neighbors, **values)

    def close(self):
        for handle in (self.data, self.proposal):
            if handle is not None:
                handle.close()


class _Known(NamedTuple):
    source: tuple  # _source() at the time of reading
    info: dict  # info of the model or measurement


class MeasuredMaterials:
    """Measured materials of one library scene. Files are read once: a tint changes many times a second.

    `unit`: length of Blender's unit in the scene.
    """

    def __init__(self, scene, notes, unit=1.0):
        self._scene = scene
        self._unit = unit
        self._notes = notes
        self._known = {}  # keys: pointers of original materials
        self._mixed = {}  # Reflectances of layers by _source()
        self.reduced = []

    def add(self, material, measured):
        """Adds a material that is one measured model; returns its number and its model's or measurement's
        info.

        Raises ExportError or VelourError.
        """
        source = _source(measured)
        if _uses_scene_model(measured.node):
            number, info = self._add_pair(material, measured)
        else:
            with contextlib.closing(self._read(material, measured)) as reflectance:
                number, info = reflectance.add_to(self._scene), reflectance.info
        self._adjust(material, measured, number, info)
        self._known[material.original.as_pointer()] = _Known(source, info)
        return number, info

    def adjust(self, material, measured, number):
        """Applies settings of an added material that need none of its files.

        Returns the info as add() does; None if its model or measurement has been replaced.
        """
        known = self._known.get(material.original.as_pointer())
        if known is None or known.source != _source(measured):
            return None
        self._adjust(material, measured, number, known.info)
        return known.info

    def of_layer(self, material, measured):
        """The Reflectance of a layer of a mixed material, which is kept open.

        Raises ExportError or VelourError.
        """
        if _uses_scene_model(measured.node):
            self._notes.add(
                f"Material '{material.name}': scene models of mixed materials are not supported; the full"
                " model is used."
            )
        source = _source(measured)
        if source not in self._mixed:
            self._mixed[source] = self._read(material, measured)
        return self._mixed[source]

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

    def set_shell(self, number, settings):
        """Places the VOTF of an added material. `settings`: VelourMaterialSettings."""
        self._scene.set_shell_tile(number, self._unit * settings.outline_width)
        self._scene.set_shell_softness(number, settings.outline_softness)

    def _adjust(self, material, measured, number, info):
        settings = measured.node.velour
        self._scene.set_gain(number, measured.look.gain)
        self._scene.hide_backs(number, hidden_backs(material))
        if "shell" in info and not settings.use_reference:
            self.set_shell(number, settings)

    def _read(self, material, measured):
        """The Reflectance of a measured node."""
        node, owner = measured.node, f"Material '{material.name}'"
        if node.velour.use_reference:
            self._note_roughness(measured, {}, owner)
            return self._read_reference(node, owner)
        if node.image is None:
            raise ExportError(
                f"{owner}: node '{node.name}' has no model; press Fit, or choose a Model File under Advanced."
            )
        model = self._read_model(node.image, measured, owner)
        return Reflectance("model", model, model.info(), node.neighbors)

    def _read_model(self, image, measured, owner):
        """The model with the roughness offset applied."""
        model, roughness = files.read_model(image, owner), measured.look.roughness
        if roughness == 0 or self._note_roughness(measured, model.info(), owner):
            return model
        with model:
            return model.roughened(min(max(roughness, 0.0), 1.0))

    def _note_roughness(self, measured, info, owner):
        """Whether the roughness offset is unsupported; adds a note if one is set."""
        reason = roughness_reason(info, measured.node.velour.use_reference)
        if reason and measured.look.roughness > 0:
            self._notes.add(f"{owner}: {reason}")
        return reason is not None

    def _add_pair(self, material, measured):
        node, owner = measured.node, f"Material '{material.name}'"
        image = node.velour.scene_model
        reduced = self._read_model(image, measured, owner)
        has_full = files.is_there(node.image)
        model = self._read_model(node.image, measured, owner) if has_full else reduced
        number = self._scene.add_model_material(model, node.neighbors)
        self.reduced.append(Reduced(number, material.name, reduced, node.neighbors, has_full, image.name))
        return number, model.info()

    def _read_reference(self, node, owner):
        image = node.velour.measurement
        if image is None:
            raise ExportError(
                f"{owner}: 'Render from Measurement' is enabled, but no measurement is chosen; choose one."
            )
        if files.measurement_info(image, owner)["kind"] == "btf":
            return self._read_btf(image, owner)
        proposal = files.read_model(node.image, owner) if node.image else None
        measurement = files.read_measurement(image, owner)
        return Reflectance("measurement", measurement, measurement.info(), node.neighbors, proposal)

    def _read_btf(self, image, owner):
        try:
            btf = files.read_btf(image, owner)
        except VelourError as error:
            raise ExportError(f"{owner}: {error}") from error
        return Reflectance("btf", btf, btf.info())


def _uses_scene_model(node):
    settings = node.velour
    return settings.use_scene_model and settings.scene_model is not None and not settings.use_reference


def _source(measured):
    """Key of the files and settings of its reflectance: equal if and only if the reflectance is the same."""
    node, settings = measured.node, measured.node.velour
    other = settings.measurement if settings.use_reference else settings.scene_model
    is_other_used = settings.use_reference or settings.use_scene_model
    stamps = files.stamp_of(node.image), files.stamp_of(other if is_other_used else None)
    return settings.use_reference, node.neighbors, measured.look.roughness, *stamps

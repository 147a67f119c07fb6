"""Parameters of a BTF fit: the BTF, the method and the size."""

import functools
import os
from typing import Any, NamedTuple

import bpy
from bpy.props import EnumProperty, FloatProperty, IntProperty, StringProperty

from ..export import ExportError
from ..export.files import StoredFile, absolute_path
from ..export.nodes import velour_node
from ..native import Btf
from ..properties.btf_fit_settings import METHODS, NAMES, SHAPE_OF
from . import measured
from .tiles import OfTile, capture_folder, find_tile


class Chosen(NamedTuple):
    """The BTF, and what it is fitted for: a tile, a material that has a measurement, or neither."""

    path: str
    settings: Any = None  # BtfFitSettings; None: use the operator's properties
    tile: Any = None  # TileSource
    material: bpy.types.Material | None = None

    def loading(self):
        """Function that loads the current BTF without accessing Blender's data."""
        if self.material is None:
            return functools.partial(Btf.load, self.path)
        measurement = velour_node(self.material).velour.measurement
        stored = StoredFile.of(measurement, f"Material '{self.material.name}'")
        return functools.partial(stored._replace(expected="").raw, Btf)


class AskedFit(OfTile):
    """Operator mixin with the parameters of a BTF fit."""

    _keeps = True  # stores given properties in the settings of the tile or the material

    filepath: StringProperty(
        name="BTF",
        subtype="FILE_PATH",
        description="Folder, CSV index or .btf file of a BTF. Empty: the captured BTF of the tile",
        options={"SKIP_SAVE"},
    )
    material: StringProperty(
        name="Material",
        description="Material whose BTF is fitted again. Empty: a new material from the file or the tile",
        options={"SKIP_SAVE"},
    )
    # If set, these replace the settings of the tile or the material.
    method: EnumProperty(name="Method", items=METHODS, default="SRBF", options={"SKIP_SAVE"})
    clusters: IntProperty(
        name="Clusters",
        description="Number of clusters (CTA, K-CTA). 0: automatic",
        min=0,
        max=256,
        options={"SKIP_SAVE"},
    )
    members: IntProperty(
        name="Clusters per Texel",
        description="Number of clusters per texel (K-CTA). 0: automatic",
        min=0,
        max=8,
        options={"SKIP_SAVE"},
    )
    tolerance: FloatProperty(
        name="Max Error",
        description="Maximum error of the model. The smallest model that meets it is chosen. 0: no limit",
        min=0.0,
        max=0.9,
        options={"SKIP_SAVE"},
    )
    megabytes: FloatProperty(
        name="Max Size (MB)",
        description="Maximum model size in MB. 0: automatic, or unlimited if Max Error is set",
        min=0.0,
        options={"SKIP_SAVE"},
    )

    def _chosen(self, context):
        if self.material:
            return self._of_material(measured.wanted_material(context, self.material))
        if self.filepath:
            return Chosen(_normal(self.filepath))
        tile = find_tile(context, self.collection)
        folder = capture_folder(tile.owner)
        if not os.path.exists(folder):
            raise ExportError(f"{tile.label} has not been captured: there is no {folder}; press Capture BTF.")
        return Chosen(folder, tile.owner.velour, tile)

    def _of_material(self, material):
        measured.refuse_linked(material)
        node = velour_node(material)
        if node is None or node.velour.measurement is None:
            raise ExportError(
                f"Material '{material.name}': no BTF is chosen; use File > Import > Measured Material."
            )
        measured.refuse_linked_group(material, node)
        path = _normal(absolute_path(node.velour.measurement))
        return Chosen(path, node.velour.btf, material=material)

    def _asked(self, settings):
        """Values by NAMES: properties that are set, or else the settings."""
        if settings is None:
            return {name: getattr(self, name) for name in NAMES}
        given = {name: getattr(self, name) for name in NAMES if self.properties.is_property_set(name)}
        if self._keeps:
            keep(given, settings)
        return {**{name: getattr(settings, name) for name in NAMES}, **given}


def keep(asked, settings):
    """Stores the parameters for the next fit."""
    for name, value in asked.items():
        setattr(settings, name, value)


def options_of(asked):
    """Options of compress_job(); clusters and members only if the method uses them."""
    return {
        "method": asked["method"].lower().replace("_", "-"),
        **{name: asked[name] for name in SHAPE_OF.get(asked["method"], ())},
        "tolerance": asked["tolerance"],
        "bytes": int(asked["megabytes"] * 1e6),
    }


def fitted_as(settings, *whose):
    """Key that changes with the parameters of a fit. Safe in draw()."""
    return repr((*whose, *(getattr(settings, name) for name in NAMES)))


def refitted_as(material):
    """fitted_as() for a material's BTF."""
    settings = velour_node(material).velour
    return fitted_as(settings.btf, material.name, absolute_path(settings.measurement))


def _normal(path):
    return os.path.normpath(bpy.path.abspath(path))

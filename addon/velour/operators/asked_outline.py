"""Parameters of a VOTF: the structure, the material and the resolution."""

from typing import NamedTuple

import bpy
from bpy.props import IntProperty, StringProperty

from ..export import ExportError
from ..export.tiles import TileSource, export_tile
from . import measured
from .tiles import OfTile, find_tile, tile_of


class Asked(NamedTuple):
    material: bpy.types.Material
    node: bpy.types.Node
    tile: TileSource
    texels: int


class AskedOutline(measured.OfMaterial, OfTile):
    """Operator mixin with the parameters of a VOTF."""

    _keeps = True  # stores given properties in the settings of the material

    structure: StringProperty(
        name="Structure",
        description="Object that is the tile. Empty: the structure that is set in the material",
        options={"SKIP_SAVE"},
    )
    texels: IntProperty(name="Texels", min=4, max=4096, default=128, options={"SKIP_SAVE"})

    def _asked(self, context):
        """Raises ExportError if there is no model or no structure."""
        material = measured.wanted_material(context, self.material)
        if self._keeps:
            measured.refuse_linked(material)
        owner = f"Material '{material.name}'"
        node = measured.modelled_node(material)
        tile, texels = self._tile(context, node.velour, owner), node.velour.outline_texels
        if self.properties.is_property_set("texels"):
            texels = self.texels
            if self._keeps:
                node.velour.outline_texels = texels
        return Asked(material, node, tile, texels)

    def _tile(self, context, settings, owner):
        if self.collection:
            return find_tile(context, self.collection)
        structure = settings.structure
        if self.structure:
            structure = bpy.data.objects.get(self.structure)
            if structure is None:
                raise ExportError(f"There is no object {self.structure!r} to use as a tile; check its name.")
            if self._keeps:
                settings.structure = structure
        if structure is None:
            raise ExportError(f"{owner}: no structure is chosen; choose the object that is the tile.")
        return tile_of(context, structure)


def export_structure(context, asked):
    """A committed library scene of the structure as it is now, options of votf_job(), and the notes."""
    scene, place, notes = export_tile(asked.tile, context.evaluated_depsgraph_get(), approximate=True)
    options = {
        "origin": place.origin,
        "period": place.period,
        "source": asked.tile.owner.name,
        "threads": context.scene.render.threads,
    }
    return scene, options, notes


def outlined_as(material, structure, texels):
    """Key that changes with the parameters of a material's VOTF. Safe in draw()."""
    return repr((material.name, structure and structure.name, texels))

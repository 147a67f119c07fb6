"""Give a material's model the outline and the holes of a tile: in the background of a window, or at once."""

import bpy
from bpy.props import IntProperty, StringProperty

from ..core.plain_words import plain
from ..core.read_job import ReadJob
from ..export import ExportError
from ..export.files import StoredFile
from ..export.tiles import export_tile
from ..native import votf_job
from . import measured
from .approximate import MakesModel
from .job_target import JobTarget
from .tiles import find_tile, tile_of


class VELOUR_OT_add_votf(MakesModel, bpy.types.Operator):
    bl_idname = "velour.add_votf"
    bl_label = "Add Outline"
    bl_description = (
        "Give the material's model the outline and the holes of the structure (VOTF). The model before it is"
        " not touched"
    )
    bl_options = {"UNDO"}

    material: StringProperty(name="Material", description="Empty: the active one", options={"SKIP_SAVE"})
    structure: StringProperty(
        name="Structure",
        description="The object that is the tile; empty: the one that the material names",
        options={"SKIP_SAVE"},
    )
    collection: StringProperty(
        name="Collection", description="The tile, in place of an object", options={"SKIP_SAVE"}
    )
    texels: IntProperty(name="Texels", min=4, max=4096, default=128, options={"SKIP_SAVE"})

    _what = "Adding the outline"

    def _begin(self, context):
        material = measured.wanted_material(context, self.material)
        owner = f"Material '{material.name}'"
        node = measured.modelled_node(material)
        self._target = JobTarget(material, node)
        self._subject = material.name
        tile = self._tile(context, node.velour, owner)
        if self.properties.is_property_set("texels"):
            node.velour.outline_texels = self.texels
        # The structure as it is now; the model is read when its turn has come.
        scene, place, self._notes = export_tile(tile, context.evaluated_depsgraph_get(), approximate=True)
        options = {
            "origin": place.origin,
            "period": place.period,
            "source": tile.owner.name,
            "texels": node.velour.outline_texels,
            "threads": context.scene.render.threads,
        }
        stored = StoredFile.of(node.image, owner)
        self._job = self._reading = ReadJob(lambda: _outline_job(scene, stored, options))

    def _finish(self):
        if self._reading is None:
            return super()._finish()
        self._next, self._reading = self._reading.result(), None
        return None

    def _tile(self, context, settings, owner):
        if self.collection:
            return find_tile(context, self.collection)
        if self.structure:
            settings.structure = bpy.data.objects.get(self.structure)
            if settings.structure is None:
                raise ExportError(f"There is no object {self.structure!r} to take as a tile.")
        if settings.structure is None:
            raise ExportError(f"{owner}: choose the object that is the structure.")
        return tile_of(context, settings.structure)

    def _put(self):
        report = self._report
        material, node = measured.put_model(self._data, self._target, self.report)
        if node is None:
            return {"FINISHED"}
        self._put_approximation(material)
        for sentence in (*self._notes, *map(plain, report["warnings"])):
            self.report({"WARNING"}, sentence)
        self.report(
            {"INFO"},
            f"'{material.name}' has the outline of '{report['source']}': {report['bytes'] / 1e6:.2f} MB,"
            f" {report['wrong']:.2%} of rays wrong.",
        )
        return {"FINISHED"}


def _outline_job(scene, stored, options):
    """Beside the window."""
    with scene, stored.model() as model:
        return votf_job(scene, model, **options)

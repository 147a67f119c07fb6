"""Adds one of the preset materials."""

import bpy
from bpy.props import BoolProperty, StringProperty

from ..core import presets
from ..core.files import read_bytes
from ..native import Model, VelourError
from . import measured
from .approximate import approximate_new
from .slots import PutsInSlot, SlotTarget

# Scripts may still use them.
_FORMER_NAMES = {"Brushed Aluminium": "Brushed Aluminum"}


class VELOUR_OT_add_preset(PutsInSlot, bpy.types.Operator):
    bl_idname = "velour.add_preset"
    bl_label = "Add Preset Material"
    bl_description = "Add a preset material and put it into the active slot"
    bl_options = {"REGISTER", "UNDO"}

    preset: StringProperty(name="Preset", description="Name of the preset material", options={"SKIP_SAVE"})
    directory: StringProperty(
        name="Folder",
        subtype="DIR_PATH",
        description="Folder of the presets. Empty: the folder of the add-on",
        options={"SKIP_SAVE"},
    )
    assign: BoolProperty(
        name="Assign", description="Put the material into a slot", default=True, options={"SKIP_SAVE"}
    )

    def execute(self, context):
        try:
            material, info = make(find(self.preset, self.directory), self.report)
        except (OSError, ValueError, VelourError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        target = SlotTarget.asked(context, self)
        if target is not None:
            target.put(material, self.report)
        else:
            material.use_fake_user = True
        approximate_new(context, material, info)
        return {"FINISHED"}


def find(name, directory=""):
    """The preset of this name in a folder, by default the add-on's; raises ValueError or OSError."""
    folder = bpy.path.abspath(directory) or presets.folder()
    listed = presets.listed(folder)
    if not listed:
        raise ValueError(f"{folder} has no {presets.INDEX_FILE}; reinstall Velour or choose another folder.")
    for preset in listed:
        if preset.name == name:
            return preset
    if name in _FORMER_NAMES:
        return find(_FORMER_NAMES[name], directory)
    raise ValueError(f"There is no preset {name!r}; there are {', '.join(p.name for p in listed)}.")


def make(preset, report):
    """A new material with the model of a preset, without its approximation, and the info of the model.

    Raises OSError or VelourError."""
    data = read_bytes(preset.model)
    with Model.load(preset.model) as model:
        info = model.info()
    material = measured.new_material(preset.name)
    image = measured.packed_model(data, preset.name)
    node = measured.set_model(material, measured.ensure_node(material), image, report, info=info)
    if preset.repeats:
        node.velour.placement.repeats = (preset.repeats,) * 2
    return material, info

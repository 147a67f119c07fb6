"""Asks which materials get another model if several share a node group."""

import bpy
from bpy.props import EnumProperty

from ..export.nodes import velour_node
from . import measured, measured_group


class ModelUsers:
    """Operator mixin: whether a new model of a shared node group is for all of its materials."""

    users: EnumProperty(
        name="Model For",
        description="Materials that get the model if several share the node group",
        items=(
            ("SINGLE", "This Material", "Give the material a copy of the node group", 0),
            ("ALL", "All Materials", "Change the node group that the materials share", 1),
        ),
        options={"SKIP_SAVE"},
    )


class AsksUsers(ModelUsers):
    """Mixin for an operator that replaces the model of the material that its property `material` names."""

    _asks_users = False

    def invoke(self, context, event):
        """Asks which materials get the model if several share the node group."""
        node = self._refitted(context)
        if node is None or not measured_group.is_shared(node) or self.properties.is_property_set("users"):
            return super().invoke(context, event)
        self._asks_users = True
        return context.window_manager.invoke_props_dialog(self)

    def draw(self, _context):
        self.layout.label(text="Several materials share this node group.")
        self.layout.prop(self, "users", expand=True)

    def execute(self, context):
        if not self._asks_users:
            return super().execute(context)
        # Blender ends the dialog's operator when this returns, so another one does the work.
        given = (p.identifier for p in self.properties.bl_rna.properties if p.identifier != "rna_type")
        chosen = {name: getattr(self, name) for name in given if self.properties.is_property_set(name)}
        operator = getattr(bpy.ops.velour, type(self).bl_idname.partition(".")[2])
        operator("INVOKE_DEFAULT", **{**chosen, "users": self.users})
        return {"CANCELLED"}  # no undo step: the other operator adds it

    def _refitted(self, context):
        """The MeasuredNode whose model is replaced, or None."""
        return velour_node(measured.find_material(context, self.material))

"""Material properties."""

import bpy

from ..core import verdict
from ..core.model_warnings import gain_warning, roughness_reason
from ..export.measured_look import INPUTS, constant_look
from ..export.newer import has_nodes
from ..export.nodes import active_output, former_node, velour_node
from ..export.notes import Notes
from ..export.objects import GEOMETRY
from ..export.shaders import surface_layers
from ..operators.accept_file import VELOUR_OT_accept_file
from ..operators.add_material import VELOUR_OT_add_material
from ..operators.approximation_group import is_editable
from ..operators.asked_fit import refitted_as
from ..operators.compress_btf import VELOUR_OT_compress_btf
from ..operators.convert import VELOUR_OT_convert_materials
from ..operators.fit import VELOUR_OT_fit
from ..operators.load_material import VELOUR_OT_load_material
from ..operators.measured import is_btf
from ..operators.open_file import VELOUR_OT_open_measurement
from ..operators.use_as_tile import VELOUR_OT_use_as_tile
from .draw_btf_fit import draw_btf_fit
from .preset_grid import draw_presets
from .progress import draw_progress
from .properties_panel import PropertiesPanel
from .summaries import is_changed, measurement_summary, model_summary
from .text import draw_sentence

_LOOK = ("Tint", "Exposure", "Roughness Offset", "Normal", "Scale")


class MaterialPanel(PropertiesPanel):
    bl_context = "material"

    @classmethod
    def poll(cls, context):
        is_there = context.object is not None or context.material is not None  # pinned ones have no object
        return super().poll(context) and is_there


class VELOUR_MATERIAL_PT_measured(MaterialPanel, bpy.types.Panel):
    bl_label = "Measured Material"

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        node = velour_node(context.material)
        if node is None:
            layout.operator(VELOUR_OT_add_material.bl_idname)
            if context.object is not None:  # the material goes into its slot
                layout.operator(VELOUR_OT_load_material.bl_idname, text="Import...")
                if context.object.type in GEOMETRY and not context.object.velour.is_shown():
                    layout.operator(VELOUR_OT_use_as_tile.bl_idname, icon="TEXTURE")
                if context.material is None:
                    draw_presets(context, layout)
            return
        if node.group is not None:
            layout.template_ID(node.group, "node_tree", text="Node Group")
        else:
            _draw_former(context, layout, context.material)
        found = model_summary(node.image) if node.image is not None else None
        info = found if isinstance(found, dict) else {}
        if isinstance(found, str):
            draw_refusal(context, layout, node.image, found)
        if node.group is not None:
            _draw_look(context, layout, node, info)
        _draw_verdict(context, layout, node, info)
        _draw_measurement(context, layout, node.velour)
        _draw_fit(context, layout, node, info)


def _draw_verdict(context, layout, node, info):
    """Draws one line on how the model looks, with a button that does what it advises."""
    if not info:
        return
    measurement = node.velour.measurement
    line = verdict.line_for(info, measurement.velour.sha256 if measurement is not None else None)
    if line is None:
        return
    draw_sentence(context, layout, line.text, icon="CHECKMARK" if line.is_good else "INFO")
    if line.remedy is not None and measurement is not None:
        fits, whose = (
            (VELOUR_OT_compress_btf, {"material": context.material.name})
            if "texels" in info
            else (VELOUR_OT_fit, {})
        )
        operator = layout.operator(fits.bl_idname, text=line.remedy.label, icon="FILE_REFRESH")
        for name, value in (line.remedy.settings | whose).items():
            setattr(operator, name, value)


def _draw_measurement(context, layout, settings):
    """Draws the measurement, and why it is refused if its file has changed or it is rendered."""
    layout.template_ID(settings, "measurement", open=VELOUR_OT_open_measurement.bl_idname, text="Measurement")
    image = settings.measurement
    if image is None or (not image.velour.sha256 and not settings.use_reference):
        return
    summary = measurement_summary(image)
    if isinstance(summary, str) and (is_changed(image) or settings.use_reference):
        draw_refusal(context, layout, image, summary)


def draw_refusal(context, layout, image, sentence):
    """Draws why a file is refused, and the button to accept it if that helps."""
    draw_sentence(context, layout, sentence, icon="ERROR")
    if is_changed(image):
        layout.operator(VELOUR_OT_accept_file.bl_idname)


def _draw_fit(context, layout, node, info):
    """Draws the button of the fit, its progress, and that it was canceled."""
    measurement = node.velour.measurement
    if measurement is not None and is_btf(measurement):
        key, name = refitted_as(context.material), context.material.name
        draw_btf_fit(context, layout, node.velour.btf, key, (VELOUR_OT_fit.bl_label, "PLAY"), material=name)
    elif "texels" not in info:  # otherwise there is no BTF to fit
        row = layout.row()
        row.enabled = measurement is not None
        row.operator(VELOUR_OT_fit.bl_idname, icon="PLAY")
    draw_progress(context, layout)
    state = context.window_manager.velour
    if state.canceled and state.canceled_subject == context.material.name:
        draw_sentence(context, layout, state.canceled, icon="CANCEL")


def _draw_former(context, layout, material):
    box = layout.box()
    sentence = (
        "This material is of the former layout. Convert it to edit its look and to mix it with shaders."
    )
    draw_sentence(context, box, sentence, icon="INFO")
    if is_editable(material):
        box.operator(VELOUR_OT_convert_materials.bl_idname, icon="NODETREE").material = material.name


def _draw_look(context, layout, node, info):
    """Draws the inputs of the node that are a measured material's look."""
    column, look = layout.column(align=True), constant_look(node)
    reason = roughness_reason(info, node.velour.use_reference)
    for name in _LOOK:
        socket = node.group.inputs.get(name)
        if socket is not None:
            row = column.row()
            row.active = reason is None or name != INPUTS["roughness"]
            draw_input(row, socket)
    if reason and look.roughness > 0:
        draw_sentence(context, layout, reason, icon="INFO")
    sentence = gain_warning(info.get("albedo_max"), look.gain)
    if sentence:
        draw_sentence(context, layout, sentence, icon="ERROR")


def draw_input(layout, socket):
    """Draws an input of a node: its value, or what is linked."""
    if socket.hide_value:
        layout.template_node_view(socket.id_data, socket.node, socket)
    elif socket.is_linked:
        layout.label(text=f"{socket.name}: linked")
    else:
        layout.prop(socket, "default_value", text=socket.name)


class VELOUR_MATERIAL_PT_surface(MaterialPanel, bpy.types.Panel):
    # Replaces Blender's panel, which would be above Velour's.

    bl_label = "Surface"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and context.material is not None

    def draw(self, context):
        layout, material = self.layout, context.material
        if former_node(material) is not None:
            layout.label(text="Approximation for Material Preview and other engines", icon="INFO")
        output = (
            active_output(material.node_tree, "ShaderNodeOutputMaterial") if has_nodes(material) else None
        )
        if output is None:
            layout.prop(material, "use_nodes", icon="NODETREE")
            return
        layout.use_property_split = True
        layout.template_node_view(material.node_tree, output, output.inputs["Surface"])


class VELOUR_MATERIAL_PT_notes(MaterialPanel, bpy.types.Panel):
    # Features of a material that Velour does not support, listed before the render.

    bl_label = "Unsupported Features"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and len(_notes(context.material)) > 0

    def draw(self, context):
        for note in _notes(context.material):
            draw_sentence(context, self.layout, note, icon="INFO")


def _notes(material):
    notes = Notes()
    if material is not None:
        surface_layers(material, notes)
    return notes

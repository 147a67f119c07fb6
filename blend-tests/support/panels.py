"""Panels of the Properties editor as it shows them: those that poll, below such that poll."""

import functools
import inspect
from types import SimpleNamespace

import bpy

# By tab, what Blender itself has to show where its settings are read.
STOCK = {
    "render": {"RENDER_PT_context", "RENDER_PT_color_management"},
    "output": {"RENDER_PT_format", "RENDER_PT_frame_range", "RENDER_PT_output", "RENDER_PT_post_processing"},
    "view_layer": {"VIEWLAYER_PT_layer"},
    "world": {"WORLD_PT_context_world", "EEVEE_WORLD_PT_surface"},
    "object": {"OBJECT_PT_transform", "OBJECT_PT_visibility", "OBJECT_PT_instancing", "OBJECT_PT_relations"},
    "light": {"DATA_PT_context_light"},
    "camera": {
        *("DATA_PT_context_camera", "DATA_PT_lens", "DATA_PT_camera"),
        *("DATA_PT_camera_dof", "DATA_PT_camera_dof_aperture"),
    },
    "mesh": {"DATA_PT_context_mesh", "DATA_PT_uv_texture", "DATA_PT_vertex_colors"},
    "material": {"EEVEE_MATERIAL_PT_context_material", "MATERIAL_PT_preview"},
}
# And Velour's own, in place of what Blender shows with other engines alone.
OURS = {
    "render": {"film", "sampling", "performance", "simplify", "motion_blur", "check"},
    "output": set(),
    "view_layer": {"filter", "override", "passes", "passes_data", "passes_cryptomatte"},
    "world": {"ray_visibility"},
    "object": {"ray_visibility"},
    "light": {"light"},
    "camera": set(),
    "mesh": set(),
    "material": {"settings"},
}
# Words in names of panels that may be there besides: of the interface, of files and of what comes before or
# after a render.
_BESIDES = (
    "animation", "audio", "color_management", "context", "lineart", "motion_paths", "preview",
    "viewport", "RENDER_PT_output", "RENDER_PT_stamp", "time_stretching", "delta_transform", "collections",
    "OBJECT_PT_display", "parent_inverse", "camera_background", "camera_display", "camera_safe_areas",
    "attributes", "customdata", "remesh", "shape_keys", "vertex_groups", "face_maps",
    "normals", "texture_space", "gltf",
)  # fmt: skip


class Layout:
    """A layout, and the panel or menu with it: remembers which settings, nodes and texts are put there, and
    their `order`."""

    def __init__(self, cls=None):
        self._cls, self.layout, self.props, self.operators, self.labels = cls, self, [], [], []
        self.order = []

    def __getattr__(self, name):
        if hasattr(self._cls, name):
            found = getattr(self._cls, name)
            is_method = inspect.isfunction(inspect.getattr_static(self._cls, name))
            return functools.partial(found, self) if is_method else found
        return lambda *_arguments, **_keywords: self

    def prop(self, _owner, name, text="", **_keywords):
        self.props.append(name)
        self.order.append(text or name)

    def template_ID(self, _owner, name, **_keywords):  # noqa: N802 - as in Blender
        self.order.append(name)

    def label(self, *, text="", **_keywords):
        self.labels.append(text)
        self.order.append(text)

    def operator(self, name, **_keywords):
        self.operators.append(SimpleNamespace(name=name))
        self.order.append(name)
        return self.operators[-1]


class Context:
    """A context with some members of its own: what is neither there nor in Blender's is None."""

    def __init__(self, **members):
        self.__dict__.update(members)

    def __getattr__(self, name):
        return getattr(bpy.context, name, None)


def shown(tab, context):
    """Names of the panels in a tab (of DATA by what it is the data of), in that context."""
    # Custom properties are nobody's, and ask for a real context.
    known = {panel.__name__: panel for panel in _of_the_editor() if "custom_props" not in panel.__name__}
    return {
        name
        for name, panel in known.items()
        if getattr(panel, "bl_context", "") == ("data" if tab in ("light", "camera", "mesh") else tab)
        and _is_shown(panel, known, context)
    }


def _of_the_editor():
    """All registered ones, those that inherit from others included."""
    waiting = list(bpy.types.Panel.__subclasses__())
    while waiting:
        panel = waiting.pop()
        waiting.extend(panel.__subclasses__())
        if getattr(panel, "bl_space_type", "") == "PROPERTIES" and panel.is_registered:
            yield panel


def _is_shown(panel, known, context):
    parent = getattr(panel, "bl_parent_id", "")
    if parent and (parent not in known or not _is_shown(known[parent], known, context)):
        return False
    return not hasattr(panel, "poll") or bool(panel.poll(context))


def wrong(tab, names):
    """What is missing in a tab, and what has no place there; two sorted lists."""
    ours = {name for name in names if name.startswith("VELOUR_")}
    missing = STOCK[tab] - names
    missing |= {word for word in OURS[tab] if not any(name.endswith(f"_PT_{word}") for name in ours)}
    others = {name for name in names - ours - STOCK[tab] if not any(word in name for word in _BESIDES)}
    return sorted(missing), sorted(others)

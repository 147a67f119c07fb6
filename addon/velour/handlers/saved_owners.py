"""Finds what has settings of Velour in a file."""

import bpy

_LISTS = ("scenes", "objects", "collections", "images", "node_groups")


def saved_owners():
    """Datablocks and nodes whose `velour` has settings. The `velour` of others is not even read."""
    for name in _LISTS:
        for datablock in getattr(bpy.data, name):
            if hasattr(type(datablock), "velour") and _has_settings(datablock):
                yield datablock
    for node in _nodes():
        if _has_settings(node):
            yield node


def _nodes():
    materials = (material.node_tree for material in bpy.data.materials)
    for tree in (*materials, *bpy.data.node_groups):
        for node in tree.nodes if tree else ():
            if node.bl_idname in ("ShaderNodeTexImage", "ShaderNodeGroup"):
                yield node


def _has_settings(owner):
    # Reading settings creates them; is_property_set() avoids that in the rest of the file.
    if owner.is_property_set("velour"):
        settings = owner.velour
        if any(
            settings.is_property_set(p.identifier)
            for p in settings.bl_rna.properties
            if p.identifier != "rna_type"
        ):
            return True
    return isinstance(owner, bpy.types.Scene) and owner.render.engine == "VELOUR"

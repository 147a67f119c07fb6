"""Ray visibility of objects."""

import bpy

from .notes import listed

# Looking up a missing attribute on every object is slow.
_LINKS_LIGHT = "light_linking" in bpy.types.Object.bl_rna.properties  # 4.0 and newer
_BOUNCES = {"visible_diffuse": "diffuse rays", "visible_glossy": "glossy rays"}


class Visibility:
    """Ray visibility of evaluated objects in a view layer."""

    def __init__(self, layer):
        self._layer = layer
        collections = list(_all_collections(layer.layer_collection))
        # Querying them per object would cost more than everything else here.
        self._some_indirect = any(each.indirect_only for each in collections)
        self._some_holdout = any(each.holdout for each in collections)

    def hidden(self, obj, notes):
        """The keyword `hidden` of Scene.add_instance; notes unsupported settings."""
        found = []
        if not obj.visible_camera or self._is_indirect(obj):
            found.append("camera")
        bounces = _hidden_bounces(obj)
        if len(bounces) == len(_BOUNCES):
            found.append("bounces")
        elif bounces:
            notes.add(f"Object '{obj.name}': hiding it from {bounces[0]} only is not supported; ignored.")
        if not obj.visible_shadow:
            found.append("shadows")
        if obj.is_holdout or self._is_holdout(obj):
            found.append("holdout")
        if obj.is_shadow_catcher:
            notes.add(f"Object '{obj.name}': Shadow Catcher is not supported; ignored.")
        _note_linking(obj, "Object", notes)
        return tuple(found)

    def _is_indirect(self, obj):
        return self._some_indirect and obj.original.indirect_only_get(view_layer=self._layer)

    def _is_holdout(self, obj):
        return self._some_holdout and obj.original.holdout_get(view_layer=self._layer)


def _all_collections(root):
    yield root
    for child in root.children:
        yield from _all_collections(child)


def hidden_backs(material):
    """Rays that pass through a material's back faces: the argument of Scene.hide_backs."""
    found = []
    if material and material.use_backface_culling:
        found += ["camera", "bounces"]
    if getattr(material, "use_backface_culling_shadow", False):  # 4.2 and newer
        found.append("shadows")
    return tuple(found)


def note_light_visibility(obj, notes):
    """Notes unsupported visibility settings of an evaluated light."""
    bounces = _hidden_bounces(obj)
    if bounces:
        notes.add(f"Light '{obj.name}': hiding it from {listed(bounces)} is not supported; ignored.")
    _note_linking(obj, "Light", notes)


def _note_linking(obj, kind, notes):
    linking = obj.light_linking if _LINKS_LIGHT else None
    if linking is not None and (linking.receiver_collection or linking.blocker_collection):
        notes.add(f"{kind} '{obj.name}': light linking is not supported; ignored.")


def _hidden_bounces(obj):
    if obj.visible_diffuse and obj.visible_glossy:
        return ()
    return [words for name, words in _BOUNCES.items() if not getattr(obj, name)]

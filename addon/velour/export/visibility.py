"""What objects are hidden from."""

import bpy

from .notes import listed

_GEOMETRY = ("MESH", "CURVE", "SURFACE", "FONT", "META")
# To ask each object for what it has not is slow.
_LINKS_LIGHT = "light_linking" in bpy.types.Object.bl_rna.properties  # 4.0 and newer
_BOUNCES = {"visible_diffuse": "diffuse rays", "visible_glossy": "glossy rays"}


class Visibility:
    """What evaluated objects are hidden from in a view layer."""

    def __init__(self, layer):
        self._layer = layer
        collections = list(_all_collections(layer.layer_collection))
        # Asked of each object they would cost more than all else here.
        self._some_indirect = any(each.indirect_only for each in collections)
        self._some_holdout = any(each.holdout for each in collections)

    def hidden(self, obj):
        """The keyword `hidden` of Scene.add_instance."""
        found = []
        if not obj.visible_camera or self._is_indirect(obj):
            found.append("camera")
        if len(_hidden_bounces(obj)) == len(_BOUNCES):
            found.append("bounces")
        if not obj.visible_shadow:
            found.append("shadows")
        if obj.is_holdout or self._is_holdout(obj):
            found.append("holdout")
        return tuple(found)

    def _is_indirect(self, obj):
        return self._some_indirect and obj.original.indirect_only_get(view_layer=self._layer)

    def _is_holdout(self, obj):
        return self._some_holdout and obj.original.holdout_get(view_layer=self._layer)


def _all_collections(root):
    yield root
    for child in root.children:
        yield from _all_collections(child)


def note_visibility(obj, notes):
    """Says what of an evaluated object's visibility is not rendered."""
    linking = obj.light_linking if _LINKS_LIGHT else None
    if linking is not None and (linking.receiver_collection or linking.blocker_collection):
        notes.add(f"{_owner(obj)}: light linking is not supported; ignored.")
    bounces = _hidden_bounces(obj)
    if obj.type == "LIGHT" and bounces:
        notes.add(f"{_owner(obj)}: that it is hidden from {listed(bounces)} is not supported; ignored.")
    if obj.type not in _GEOMETRY:
        return
    if len(bounces) == 1:
        notes.add(f"{_owner(obj)}: that it is hidden from {bounces[0]} alone is not supported; ignored.")
    if obj.is_shadow_catcher:
        notes.add(f"{_owner(obj)}: that it is a shadow catcher is not supported; ignored.")


def _owner(obj):
    return f"{'Light' if obj.type == 'LIGHT' else 'Object'} '{obj.name}'"


def _hidden_bounces(obj):
    if obj.visible_diffuse and obj.visible_glossy:
        return ()
    return [words for name, words in _BOUNCES.items() if not getattr(obj, name)]

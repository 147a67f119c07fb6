"""What objects are hidden from."""

from .notes import listed

_GEOMETRY = ("MESH", "CURVE", "SURFACE", "FONT", "META")
_BOUNCES = {"visible_diffuse": "diffuse rays", "visible_glossy": "glossy rays"}


def hidden_from(obj, layer):
    """The keyword `hidden` of Scene.add_instance for an evaluated object in a view layer."""
    original, hidden = obj.original, []
    if not getattr(obj, "visible_camera", True) or original.indirect_only_get(view_layer=layer):
        hidden.append("camera")
    if len(_hidden_bounces(obj)) == len(_BOUNCES):
        hidden.append("bounces")
    if not getattr(obj, "visible_shadow", True):
        hidden.append("shadows")
    if obj.is_holdout or original.holdout_get(view_layer=layer):
        hidden.append("holdout")
    return tuple(hidden)


def note_visibility(obj, notes):
    """Says what of an evaluated object's visibility is not rendered."""
    linking = getattr(obj, "light_linking", None)  # 4.0 and newer
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
    return [words for name, words in _BOUNCES.items() if not getattr(obj, name, True)]

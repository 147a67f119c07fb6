"""What objects are hidden from."""

from .notes import listed

_GEOMETRY = ("MESH", "CURVE", "SURFACE", "FONT", "META")
_BOUNCES = {"visible_diffuse": "diffuse rays", "visible_glossy": "glossy rays"}
_RAYS = {"visible_camera": "the camera", **_BOUNCES, "visible_shadow": "shadow rays"}


def note_visibility(obj, layer, notes):
    """Says what of an evaluated object's visibility in a view layer is not rendered."""
    linking = getattr(obj, "light_linking", None)  # 4.0 and newer
    if linking is not None and (linking.receiver_collection or linking.blocker_collection):
        notes.add(f"{_owner(obj)}: light linking is not supported; ignored.")
    if obj.type == "LIGHT":  # the camera never sees a lamp, and no shadow ray meets one
        _note(_owner(obj), "hidden from ", _hidden(obj, _BOUNCES), notes)
    elif obj.type in _GEOMETRY:
        _note(_owner(obj), "hidden from ", _hidden(obj, _RAYS), notes)
        _note(_owner(obj), "", _roles(obj, layer), notes)


def _owner(obj):
    return f"{'Light' if obj.type == 'LIGHT' else 'Object'} '{obj.name}'"


def _hidden(obj, rays):
    return [words for name, words in rays.items() if not getattr(obj, name, True)]


def _roles(obj, layer):
    roles = []
    if obj.is_holdout or obj.original.holdout_get(view_layer=layer):
        roles.append("a holdout")
    if obj.is_shadow_catcher:
        roles.append("a shadow catcher")
    if obj.original.indirect_only_get(view_layer=layer):
        roles.append("indirect only")
    return roles


def _note(owner, verb, what, notes):
    if what:
        notes.add(f"{owner}: that it is {verb}{listed(what)} is not supported; ignored.")

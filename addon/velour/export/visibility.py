"""Ray visibility of objects."""

from typing import NamedTuple

import bpy

from .lights import is_portal
from .notes import listed

# Looking up a missing attribute on every object is slow.
_LINKS_LIGHT = "light_linking" in bpy.types.Object.bl_rna.properties  # 4.0 and newer
# No property reveals it: since 4.4, lights follow the ray visibility of what instances them.
_INSTANCERS_HIDE_LIGHTS = bpy.app.version >= (4, 4)
_BOUNCES = {"visible_diffuse": "diffuse rays", "visible_glossy": "glossy rays"}
_RAYS = {"visible_camera": "camera", "visible_transmission": "transmission", "visible_shadow": "shadows"}


class Limits(NamedTuple):
    """Visibility settings of an evaluated object, which also apply to what it instances."""

    rays: tuple  # names of `hidden` in Scene.add_instance
    is_holdout: bool
    is_indirect: bool  # its collection is Indirect Only


class Visibility:
    """Ray visibility of evaluated objects in a view layer."""

    def __init__(self, layer, notes):
        self._layer = layer
        self._notes = notes
        collections = list(_all_collections(layer.layer_collection))
        # Querying them per object would cost more than everything else here.
        self._some_indirect = any(each.indirect_only for each in collections)
        self._some_holdout = any(each.holdout for each in collections)
        self._limits = {}  # of instancers

    def instancer_limits(self, instancer):
        """The Limits of an evaluated object that instances others."""
        key = instancer.original.as_pointer()
        if key not in self._limits:
            self._limits[key] = self.limits(instancer)
        return self._limits[key]

    def limits(self, obj):
        """The Limits of an object; notes unsupported settings."""
        if obj.is_shadow_catcher:
            self._notes.add(f"Object '{obj.name}': Shadow Catcher is not supported; ignored.")
        _note_linking(obj, "Object", self._notes)
        is_holdout = obj.is_holdout or self._is_in_holdout(obj)
        return Limits(self._hidden_rays(obj), is_holdout, not is_holdout and self._is_in_indirect(obj))

    def _hidden_rays(self, obj):
        found = [ray for name, ray in _RAYS.items() if not getattr(obj, name)]
        bounces = _hidden_bounces(obj)
        if len(bounces) == len(_BOUNCES):
            found.append("bounces")
        elif bounces:
            self._notes.add(
                f"Object '{obj.name}': hiding it from {bounces[0]} only is not supported; ignored."
            )
        return tuple(found)

    def _is_in_indirect(self, obj):
        return self._some_indirect and obj.original.indirect_only_get(view_layer=self._layer)

    def _is_in_holdout(self, obj):
        return self._some_holdout and obj.original.holdout_get(view_layer=self._layer)


def hidden(own, instancer=None):
    """The keyword `hidden` of Scene.add_instance, from Limits of an object and of what instances it.

    Like Cycles: rays must be allowed by both; only the instancer makes holdouts and Indirect Only.
    """
    layer = instancer or own
    found = {*own.rays, *layer.rays}
    if layer.is_indirect:
        found.add("camera")
    if layer.is_holdout:
        found.add("holdout")
    return tuple(sorted(found))


def _all_collections(root):
    yield root
    for child in root.children:
        yield from _all_collections(child)


def hidden_backs(material):
    """Rays that pass through back faces of a measured material: the argument of Scene.hide_backs.

    Cycles has no backface culling, and importers set it: other materials have two sides.
    """
    found = []
    if material and material.use_backface_culling:
        found += ["camera", "bounces", "transmission"]
    if getattr(material, "use_backface_culling_shadow", False):  # 4.2 and newer
        found.append("shadows")
    return tuple(found)


def hidden_light(obj, instancer, notes):
    """The keyword `hidden` of Scene.add_light for an evaluated light; notes unsupported visibility settings.

    instancer: the evaluated object that instances it, or None.
    """
    _note_linking(obj, "Light", notes)
    if is_portal(obj.data):
        return ()
    obeyed = [obj, instancer] if instancer and _INSTANCERS_HIDE_LIGHTS else [obj]
    bounces = list(dict.fromkeys(rays for each in obeyed for rays in _hidden_bounces(each)))
    if bounces:
        notes.add(f"Light '{obj.name}': hiding it from {listed(bounces)} is not supported; ignored.")
    if all(each.visible_camera for each in obeyed) and has_extent(obj.data):
        notes.add(
            f"Light '{obj.name}': showing it to the camera is not supported; left out of the image. Disable"
            " Camera in its Ray Visibility, or use an emissive mesh."
        )
    return () if all(each.visible_transmission for each in obeyed) else ("transmission",)


def has_extent(lamp):
    """Whether rays can hit a light in Cycles."""
    if is_portal(lamp) or not getattr(
        getattr(lamp, "cycles", None), "use_multiple_importance_sampling", True
    ):
        return False
    if lamp.type == "SUN":
        return lamp.angle > 0.0
    return lamp.type == "AREA" or getattr(lamp, "shadow_soft_size", 0.0) > 0.0


def _note_linking(obj, kind, notes):
    linking = obj.light_linking if _LINKS_LIGHT else None
    if linking is not None and (linking.receiver_collection or linking.blocker_collection):
        notes.add(f"{kind} '{obj.name}': light linking is not supported; ignored.")


def _hidden_bounces(obj):
    if obj.visible_diffuse and obj.visible_glossy:
        return ()
    return [words for name, words in _BOUNCES.items() if not getattr(obj, name)]

"""Visibility and lighting in a 3D viewport."""

from typing import NamedTuple

from .changes import may_be_shown
from .notes import ExportError
from .world import has_moving_picture, layer_world

_TYPE_SHOWN = "show_object_viewport_"


class StudioLight(NamedTuple):
    path: str
    strength: float
    turn: float  # rotation of directions about z, radians


class Look:
    """Visibility and lighting of the viewport being drawn."""

    def __init__(self, context, depsgraph):
        space = context.space_data
        shading = space.shading
        self._space = space
        self.has_lights = shading.use_scene_lights_render
        self.studio_light = None if shading.use_scene_world_render else _studio_light(shading)
        world = layer_world(depsgraph.scene, depsgraph.view_layer)
        frame = depsgraph.scene.frame_current if has_moving_picture(world) else None
        self._world = (world.as_pointer() if world else 0, depsgraph.view_layer.use_sky, frame)
        self._scene = scene_key(depsgraph)
        self._seen = self._all_seen(depsgraph)
        self._types = _shown_types(space)

    def key(self):
        """Keys of viewport state that affects the objects, the world and the scene, apart from datablocks."""
        return (self._seen, self._types, self.has_lights), (self.studio_light, *self._world), self._scene

    def shows(self, instance):
        """Whether an instance of the depsgraph is visible.

        Blender checks its own type, and its parent for local view and local collections.
        """
        if not instance.show_self:
            return False
        obj = instance.object
        return obj.visible_in_viewport_get(self._space) and (self.has_lights or obj.type != "LIGHT")

    def _all_seen(self, depsgraph):
        """Visible objects. Blender reports a change of visibility only as a change of the scene.

        Removing the last modifier of an unsupported type also removes the geometry that its nodes made.
        """
        layer, space = depsgraph.view_layer, self._space
        return frozenset(
            (
                obj.as_pointer(),
                may_be_shown(obj),
            )
            for obj in layer.objects
            if obj.visible_get(view_layer=layer, viewport=space)
        )


def _shown_types(space):
    """Object types that the viewport shows; nothing else reports a change of these for instances."""
    names = (setting.identifier for setting in space.bl_rna.properties)
    return frozenset(name for name in names if name.startswith(_TYPE_SHOWN) and getattr(space, name))


def _studio_light(shading):
    light = shading.selected_studio_light
    if light is None or not light.path:
        raise ExportError("The viewport's studio light has no image; choose another, or use Scene World.")
    return StudioLight(light.path, shading.studiolight_intensity, shading.studiolight_rotate_z)


def scene_key(depsgraph):
    """Scene settings that affect objects."""
    scene, layer = depsgraph.scene, depsgraph.view_layer
    override = layer.material_override
    units = scene.unit_settings
    return (
        scene.as_pointer(),
        layer.name,
        override.as_pointer() if override else 0,
        units.system,
        units.scale_length,
    )

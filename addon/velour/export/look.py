"""What a 3D viewport lets be seen of its scene: local view, and what lights it."""

from typing import NamedTuple

from .notes import ExportError
from .world import layer_world


class StudioLight(NamedTuple):
    path: str
    strength: float
    turn: float  # about z, radians


class Look:
    """Of the viewport that is drawn."""

    def __init__(self, context, depsgraph):
        space = context.space_data
        shading = space.shading
        self._space = space
        self._is_narrowed = space.local_view is not None or space.use_local_collections
        self.has_lights = shading.use_scene_lights_render
        self.studio_light = None if shading.use_scene_world_render else _studio_light(shading)
        world = layer_world(depsgraph.scene, depsgraph.view_layer)
        self._world = (world.as_pointer() if world else 0, depsgraph.view_layer.use_sky)
        self._scene = scene_key(depsgraph)
        self._seen = self._all_seen(depsgraph)

    def key(self):
        """Of the objects, the world and the scene: equal while no datablock of these changes."""
        return (self._seen, self.has_lights), (self.studio_light, *self._world), self._scene

    def shows(self, instance):
        """Whether an instance of the depsgraph is there."""
        obj = instance.parent if instance.is_instance else instance.object
        if not instance.show_self or (obj.type == "LIGHT" and not self.has_lights):
            return False
        return not self._is_narrowed or obj.visible_in_viewport_get(self._space)

    def _all_seen(self, depsgraph):
        """Blender tells of a change of visibility no more than that the scene changes."""
        layer, space = depsgraph.view_layer, self._space
        return frozenset(
            obj.as_pointer() for obj in layer.objects if obj.visible_get(view_layer=layer, viewport=space)
        )


def _studio_light(shading):
    light = shading.selected_studio_light
    if light is None or not light.path:
        raise ExportError("The viewport's studio light has no picture; choose another, or use Scene World.")
    return StudioLight(light.path, shading.studio_light_intensity, shading.studio_light_rotate_z)


def scene_key(depsgraph):
    """What of the scene changes objects, beside themselves."""
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

"""Refuses renders that can only be black, unless they may be intended."""

from .film import hides_world
from .layer_passes import shows_more_than_light
from .notes import ExportError
from .world import layer_world, shown_world

_NO_LIGHT = (
    "it has no light with power, no emissive material and a black world, so its image is black; add a light,"
    " or raise the strength of the world"
)
_NOTHING_SEEN = (
    "the camera sees no object with faces and a black world, so its image is black; enable objects or their"
    " collections for renders (the camera icon in the Outliner), or give the world a color"
)


def refuse_black(depsgraph, objects, materials, world_shines, notes):
    """Refuses or notes a black render. `objects`: ObjectExport, `materials`: MaterialTable of `depsgraph`."""
    scene = depsgraph.scene_eval
    if scene.render.film_transparent:
        return
    all_objects = depsgraph.scene.objects
    reason = None
    if not (objects.shines or materials.glows or world_shines):
        reason, changes = _NO_LIGHT, _light_may_change(depsgraph.scene, all_objects)
    elif not objects.is_seen and (not world_shines or hides_world(shown_world(depsgraph))):
        reason, changes = _NOTHING_SEEN, any(map(_faces_may_change, all_objects))
    if reason is None:
        return
    sentence = f"Scene '{scene.name}', view layer '{depsgraph.view_layer_eval.name}': {reason}."
    if not changes and not may_be_meant(depsgraph):
        raise ExportError(sentence)
    notes.add(sentence)


def may_be_meant(depsgraph):
    """Whether a black image may be intended: it is composited, or rendered for passes other than light."""
    scene = depsgraph.scene
    layers = [other for other in scene.view_layers if other.use]
    composited = scene.render.use_compositing and _compositor(scene)
    return len(layers) > 1 or composited or shows_more_than_light(depsgraph.view_layer_eval)


def _compositor(scene):
    if hasattr(scene, "compositing_node_group"):  # 5.0 and newer
        return scene.compositing_node_group is not None
    return getattr(scene, "use_nodes", False)


def is_animated(block):
    """Whether a datablock, its nodes or its shape keys are animated."""
    blocks = (block, getattr(block, "node_tree", None), getattr(block, "shape_keys", None))
    return any(_has_animation(each) for each in blocks if each is not None)


def _has_animation(block):
    data = getattr(block, "animation_data", None)
    return data is not None and bool(data.action or data.drivers or data.nla_tracks)


def _light_may_change(scene, objects):
    worlds = [scene.world, *(layer_world(scene, layer) for layer in scene.view_layers)]
    if any(world and is_animated(world) for world in worlds):
        return True
    return any(_may_shine_later(obj) for obj in objects)


def _may_shine_later(obj):
    blocks = [obj.data] if obj.type == "LIGHT" else [slot.material for slot in obj.material_slots]
    comes_and_goes = is_animated(obj) and (obj.type == "LIGHT" or obj.hide_render)
    return comes_and_goes or any(block and is_animated(block) for block in blocks)


def _faces_may_change(obj):
    """Whether the object may have faces in other frames; modifiers and particles may be empty in this one."""
    if obj.type in ("LIGHT", "CAMERA", "SPEAKER", "LIGHT_PROBE"):
        return False
    blocks = [block for block in (obj, obj.data) if block is not None]
    return bool(obj.modifiers or obj.particle_systems) or any(map(is_animated, blocks))


def refuse_dark_inside(depsgraph, pixels, surroundings):
    """Refuses a black image from inside an unlit object; frames of an animation may pass through one."""
    scene = depsgraph.scene
    is_part = scene.render.use_border or any(map(is_animated, scene.objects)) or may_be_meant(depsgraph)
    if surroundings and not is_part and not pixels[..., :3].any():
        raise ExportError(surroundings)

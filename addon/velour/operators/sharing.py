"""Finds scenes that share a material."""

import bpy


def other_scenes(material, scene):
    """Names of the scenes besides `scene` that reach `material`.

    Follows objects, collections and their instances, modifiers and node groups, particle systems, overrides
    of view layers, and background scenes; includes invisible objects that are only parents or targets.
    """
    users = bpy.data.user_map()
    reached, front = {material}, [material]
    while front:
        new = users.get(front.pop(), set()) - reached
        reached |= new
        front += [user for user in new if not isinstance(user, bpy.types.Scene)]
    scenes = {user for user in reached if isinstance(user, bpy.types.Scene)}
    while behind := {other for other in bpy.data.scenes if other.background_set in scenes} - scenes:
        scenes |= behind
    return sorted(other.name for other in scenes - {scene})

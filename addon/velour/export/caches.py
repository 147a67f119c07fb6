"""Where this Blender's add-on keeps what can always be made again."""

import bpy

from ..core.cache import user_cache_folder


def cache_folder():
    """An extension's own folder where there are extensions, else the user's cache."""
    package = __package__.rpartition(".")[0]
    try:
        return bpy.utils.extension_path_user(package, path="cache")
    except (AttributeError, ValueError):  # Blender before 4.2; installed as a plain add-on
        return user_cache_folder()

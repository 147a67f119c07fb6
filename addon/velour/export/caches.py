"""Folder for cached data that can always be recreated."""

import bpy

from ..core.cache import user_cache_folder


def cache_folder():
    """The extension's own folder if Blender supports extensions, otherwise the user's cache folder."""
    package = __package__.rpartition(".")[0]
    try:
        return bpy.utils.extension_path_user(package, path="cache")
    except (AttributeError, ValueError):  # Blender before 4.2, or installed as a legacy add-on
        return user_cache_folder()

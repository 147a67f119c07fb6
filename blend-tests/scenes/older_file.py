"""A file of Blender 3.4 without its spot, of the IOR that it had."""

QUANTITY = (
    "a file of Blender 3.4: paint, metal, coat, sheen, glow, texture, auto smooth, area and point lamps"
)
# Versions of the Principled BSDF, in which Velour follows Blender: coats keep their energy since 4.5.
MEANINGS = ("", "layered", "coats")


def meaning():
    import bpy

    from support import principled

    return "coats" if bpy.app.version >= (4, 5) else principled.meaning()


def build(_folder):
    from support import older_file

    older_file.open_with_old_index()

"""A file of Blender 3.4 without its spot, of the IOR that it had."""

QUANTITY = (
    "a file of Blender 3.4: paint, metal, coat, sheen, glow, texture, auto smooth, area and point lamps"
)
MEANINGS = ("", "layered")  # of the Principled BSDF, where Velour follows Blender


def meaning():
    from support import principled

    return principled.meaning()


def build(_folder):
    from support import older_file

    older_file.open_with_old_index()

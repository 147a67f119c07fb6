"""A file of Blender 3.4 without its spot, of the IOR that it had; the same picture in all Blenders."""

QUANTITY = (
    "a file of Blender 3.4: paint, metal, coat, sheen, glow, texture, auto smooth, area and point lamps"
)


def build(_folder):
    from support import older_file

    older_file.open_with_old_index()

"""A file that was saved in Blender 3.4, with its spot."""

QUANTITY = "the spot of a file of Blender 3.4, which means what it means in each Blender"
FRAMES = (2,)
MEANINGS = ("", "wide-spots")


def meaning():
    from support import lamps

    return lamps.spots()


def build(_folder):
    from support import older_file

    older_file.open_with_old_index()

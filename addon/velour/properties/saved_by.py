"""Version of Velour that last saved a datablock's settings."""

from bpy.props import IntProperty


def saved_by():
    """Version packed as in native.version: 100 is 0.1.0; 0: never saved. Overrides have their library's."""
    return IntProperty(options={"HIDDEN"}, min=0)

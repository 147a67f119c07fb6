"""Which Velour has saved a datablock's settings last."""

from bpy.props import IntProperty


def saved_by():
    """As native.version packs it: 100 is 0.1.0. 0: they were never saved. An override has its library's."""
    return IntProperty(options={"HIDDEN"}, min=0)

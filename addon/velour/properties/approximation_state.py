"""State of the nodes that approximate a measured material, in its node group."""

import bpy
from bpy.props import BoolProperty, FloatProperty, FloatVectorProperty, StringProperty

from .saved_by import saved_by

VIEW_ANGLES = ("5", "30", "60", "75", "85")  # degrees


class VelourApproximationState(bpy.types.PropertyGroup):
    """`node_tree.velour`. Errors below 0 are unknown."""

    saved_by: saved_by()
    is_approximation: BoolProperty()
    fitted: StringProperty()  # JSON from operators/approximation_look
    model: StringProperty()  # SHA-256 of the model's file; empty: no model yet
    # Matrix [3 x 3] by rows from linear Rec. 709 to the working space that colors of the nodes are in.
    to_working: FloatVectorProperty(size=9, default=(1, 0, 0, 0, 1, 0, 0, 0, 1))
    relative_l2: FloatProperty(default=-1.0)
    displaces: BoolProperty()  # the material's Displacement shows the relief, in place of the normal map
    reason: StringProperty()  # a sentence, if the error is large
    by_view_angle: FloatVectorProperty(size=len(VIEW_ANGLES), default=(-1.0,) * len(VIEW_ANGLES))

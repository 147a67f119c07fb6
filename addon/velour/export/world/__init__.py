"""The world: a color, an environment image, or nodes that are evaluated in each direction."""

from .environment import add_world, has_moving_picture, layer_world, shown_world
from .light import WorldLight

__all__ = ["WorldLight", "add_world", "has_moving_picture", "layer_world", "shown_world"]

"""Shaders of materials, as layers."""

from .layer import Layer, as_measured, as_principled, shines, sources_of, split, unlike_reflection
from .tree import surface_layers

__all__ = [
    "Layer",
    "as_measured",
    "as_principled",
    "shines",
    "sources_of",
    "split",
    "surface_layers",
    "unlike_reflection",
]

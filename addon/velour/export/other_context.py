"""Operators in a context that is not the one of what calls them."""

import contextlib

import bpy

from ..core import reading_gate


@contextlib.contextmanager
def other_context(**members):
    """bpy.context.temp_override(), which crashes beside threads in Python (core/reading_gate.py)."""
    with reading_gate.closed(), bpy.context.temp_override(**members):
        yield

"""Runs operators in another context than the caller's."""

import contextlib

import bpy

from ..core import reading_gate


@contextlib.contextmanager
def other_context(**members):
    """bpy.context.temp_override(), guarded: it crashes if other threads run Python (core/reading_gate.py)."""
    with reading_gate.closed(), bpy.context.temp_override(**members):
        yield

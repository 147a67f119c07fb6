"""Handlers that Blender calls by itself."""

from . import saved_files, solid_mode, temporary_captures

CLASSES = ()


def attach():
    saved_files.attach()
    solid_mode.attach()
    temporary_captures.attach()


def detach():
    temporary_captures.detach()
    solid_mode.detach()
    saved_files.detach()

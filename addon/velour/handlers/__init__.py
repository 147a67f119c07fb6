"""Handlers that Blender calls by itself."""

from . import saved_files, solid_mode

CLASSES = ()


def attach():
    saved_files.attach()
    solid_mode.attach()


def detach():
    solid_mode.detach()
    saved_files.detach()

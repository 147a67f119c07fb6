"""Handlers that Blender calls by itself."""

from . import saved_files

CLASSES = ()


def attach():
    saved_files.attach()


def detach():
    saved_files.detach()

"""Removes the captures of an unsaved file when another file is opened."""

import bpy
from bpy.app.handlers import persistent

from ..operators.tiles import remove_temporary


def attach():
    bpy.app.handlers.load_post.append(_opened)


def detach():
    bpy.app.handlers.load_post.remove(_opened)


@persistent
def _opened(*_):
    remove_temporary()

"""Registers everything in rank order, and unregisters it in exact reverse order."""

import bpy

from . import engine, handlers, operators, properties, ui
from .export.caches import cache_folder
from .native import library

# Each rank has CLASSES, and attach() / detach() for what is not a class: properties, menu entries, panels.
_RANKS = (properties, operators, handlers, engine, ui)
_cli_command = None


def register():
    for rank in _RANKS:
        for cls in rank.CLASSES:
            bpy.utils.register_class(cls)
        rank.attach()
    _register_cli_command()
    _say_what_is_wrong()


def unregister():
    _unregister_cli_command()
    for rank in reversed(_RANKS):
        rank.detach()
        for cls in reversed(rank.CLASSES):
            bpy.utils.unregister_class(cls)
    library.release()


def _say_what_is_wrong():
    """Prints one sentence if the library cannot be used; the preferences show the same sentence."""
    problem = ui.library_state.problem()
    if problem:
        print(f"Velour: {problem}", flush=True)


def _register_cli_command():
    """`blender --command velour VERB ...`, from Blender 4.2 on."""
    global _cli_command
    if hasattr(bpy.utils, "register_cli_command"):
        _cli_command = bpy.utils.register_cli_command("velour", _run_command)


def _run_command(arguments):
    from .core.cache import keep_in
    from .core.cli.in_blender import main

    keep_in(cache_folder())
    return main(arguments)


def _unregister_cli_command():
    global _cli_command
    if _cli_command is not None:
        bpy.utils.unregister_cli_command(_cli_command)
        _cli_command = None

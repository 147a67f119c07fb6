"""The release that saved a file's settings: stamped when Blender saves a file, checked when it opens one."""

import bpy
from bpy.app.handlers import persistent

from ..native.version import packed, version_text
from . import migrations
from .saved_owners import saved_owners


def attach():
    for handlers, function in _handlers():
        handlers.append(function)


def detach():
    for handlers, function in _handlers():
        handlers.remove(function)


def newer_sentence(saved_by):
    """Why a file may look different here; None unless a later release saved it, other than a patch."""
    if saved_by // 100 <= packed() // 100:
        return None
    return (
        f"Saved by Velour {version_text(saved_by)}, which is newer than this version ({version_text()})."
        " Settings of newer versions are ignored, but stay in the file; renders may differ. Update Velour."
    )


def _handlers():
    handlers = bpy.app.handlers
    yield handlers.save_pre, _stamp
    yield handlers.load_post, _open
    if hasattr(
        handlers, "blend_import_post"
    ):  # 4.3 and newer; in older versions, appended data wait for the next save
        yield handlers.blend_import_post, _open


@persistent
def _stamp(*_arguments):
    for owner in saved_owners():
        _bring_up_to_date(owner)
        # Keeps the number of a later release, which would otherwise take its own settings for ours.
        if owner.id_data.library is None and owner.velour.saved_by < packed():
            owner.velour.saved_by = packed()


@persistent
def _open(*_arguments):
    newest = 0
    for owner in saved_owners():
        _bring_up_to_date(owner)
        newest = max(newest, owner.velour.saved_by)
    sentence = newer_sentence(newest)
    if sentence:
        print(f"Velour: {bpy.data.filepath or 'this file'}: {sentence}", flush=True)


def _bring_up_to_date(owner):
    """Converts settings saved by an earlier release; those never saved are this release's."""
    saved_by = owner.velour.saved_by
    if not 0 < saved_by < packed():
        return
    for step in migrations.STEPS:
        if saved_by < packed(step.version) and isinstance(owner, step.owner):
            step.apply(owner)
    owner.velour.saved_by = packed()

"""Temporary files that Blender does not save while an operator is modal, as background jobs are."""

import os
import tempfile
import time
from pathlib import Path

import bpy

_QUIET_SECONDS = 3.0  # without an event from the user: nothing is being dragged


class Autosave:
    """Saves the file for *Recover > Auto Save*, as often as the preferences ask for it."""

    def __init__(self):
        self._saved = self._touched = time.monotonic()

    def notice(self, event):
        """Called for each event of the window."""
        if event.type not in ("TIMER", "NONE"):
            self._touched = time.monotonic()

    def step(self, context):
        """Called about ten times a second while a job runs."""
        asked, now = context.preferences.filepaths, time.monotonic()
        is_due = asked.use_auto_save_temporary_files and now - self._saved > 60 * asked.auto_save_time
        # Saving leaves the edit modes, and takes what is half dragged for done.
        if is_due and now - self._touched > _QUIET_SECONDS and context.mode == "OBJECT":
            self._saved = now
            try:
                save(asked.temporary_directory)
            except RuntimeError as error:  # a full disk, which must not end the job
                print(f"Velour: the temporary file could not be saved: {str(error).strip()}", flush=True)


def save(folder=""):
    """Writes the file that Blender itself would. The open file stays as it is."""
    was_dirty = bpy.data.is_dirty
    stem = Path(bpy.data.filepath).stem
    name = f"{stem}_{os.getpid()}_autosave.blend" if stem else f"{os.getpid()}_autosave.blend"
    path = os.path.join(folder or tempfile.gettempdir(), name)
    bpy.ops.wm.save_as_mainfile(filepath=path, copy=True, check_existing=False)
    if was_dirty and not bpy.data.is_dirty:  # copies count, and Blender would close without asking
        bpy.ops.ed.undo_push(message="Autosave")

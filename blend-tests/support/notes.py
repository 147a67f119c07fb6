"""What the export of a scene says of it."""

import bpy

from support import inputs, scenes
from support.blender import BlenderTest


class NotesTest(BlenderTest):
    """A scene with a camera and a world, to which tests add what they ask about."""

    def setUp(self):
        super().setUp()
        scenes.use_engine(samples=8, size=8)
        scenes.add_camera()
        scenes.set_world()

    def notes(self):
        export = inputs.module("export")
        camera = inputs.module("export.camera")
        notes = export.Notes()
        depsgraph = bpy.context.evaluated_depsgraph_get()
        view = camera.final_view(depsgraph)
        export.export_scene(depsgraph, view, notes)[0].close()
        return list(notes)

    def assert_said(self, *words):
        notes = self.notes()
        self.assertTrue(any(all(word in note for word in words) for note in notes), notes)

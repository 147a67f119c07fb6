"""What Check Scene has found. Never saved."""

import bpy
from bpy.props import BoolProperty, CollectionProperty, IntProperty, StringProperty


class VelourSentence(bpy.types.PropertyGroup):
    text: StringProperty(options={"SKIP_SAVE"})
    is_refusal: BoolProperty(options={"SKIP_SAVE"})


class VelourCheckState(bpy.types.PropertyGroup):
    """`window_manager.velour.checked`. A name, not a pointer: undo may replace the scene."""

    scene: StringProperty(options={"SKIP_SAVE"})  # empty: none was looked at
    frame: IntProperty(options={"SKIP_SAVE"})
    sentences: CollectionProperty(type=VelourSentence, options={"SKIP_SAVE"})

    def keep(self, scene, ignored, refused):
        self.scene, self.frame = scene.name, scene.frame_current
        self.sentences.clear()
        for sentences, is_refusal in ((refused, True), (ignored, False)):
            for text in sentences:
                item = self.sentences.add()
                item.text, item.is_refusal = text, is_refusal

"""Results of Check Scene. Never saved."""

import bpy
from bpy.props import BoolProperty, CollectionProperty, IntProperty, StringProperty


class VelourSentence(bpy.types.PropertyGroup):
    text: StringProperty(options={"SKIP_SAVE"})
    is_refusal: BoolProperty(options={"SKIP_SAVE"})


class VelourServedModel(bpy.types.PropertyGroup):
    """A scene model in one view layer. Stores names, like VelourCheckState."""

    material: StringProperty(options={"SKIP_SAVE"})
    model: StringProperty(options={"SKIP_SAVE"})  # name of the image that was checked
    text: StringProperty(options={"SKIP_SAVE"})
    is_inside: BoolProperty(options={"SKIP_SAVE"})  # within the scene usage that it was fitted to


class VelourCheckState(bpy.types.PropertyGroup):
    """`window_manager.velour.checked`. Stores a name, not a pointer, since undo may replace the scene."""

    scene: StringProperty(options={"SKIP_SAVE"})  # empty: none was checked
    frame: IntProperty(options={"SKIP_SAVE"})
    sentences: CollectionProperty(type=VelourSentence, options={"SKIP_SAVE"})
    models: CollectionProperty(type=VelourServedModel, options={"SKIP_SAVE"})

    def keep(self, scene, ignored, refused, served):
        """`served`: list of Served from export/scene_models.py."""
        self.scene, self.frame = scene.name, scene.frame_current
        self.sentences.clear()
        for sentences, is_refusal in ((refused, True), (ignored, False)):
            for text in sentences:
                item = self.sentences.add()
                item.text, item.is_refusal = text, is_refusal
        self.models.clear()
        for each in served:
            item = self.models.add()
            item.material, item.model = each.name, each.image
            item.text, item.is_inside = each.sentence, each.is_inside

    def of_model(self, scene, material, image):
        """Results for a material's scene model; empty if it was not checked."""
        if self.scene != scene.name:
            return []
        return [m for m in self.models if (m.material, m.model) == (material.name, image.name)]

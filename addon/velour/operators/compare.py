"""Compares a material's measurement and its model side by side in an image."""

import bpy
from bpy.props import FloatProperty, IntProperty

from ..export.color import rec709_pixels_to_working
from ..export.files import absolute_path, file_stamp
from . import measured
from .background_job import JobsInSteps
from .comparison import Comparison
from .shown_image import all_made, made_image, show


class VELOUR_OT_compare(measured.OfMaterial, JobsInSteps, bpy.types.Operator):
    bl_idname = "velour.compare"
    bl_label = "Compare with Measurement"
    bl_description = (
        "Show a ball with the measurement, with the model, and their difference in an Image Editor"
    )

    side: IntProperty(
        name="Size", description="Width and height of each image in pixels", default=512, min=64, max=4096
    )
    samples: IntProperty(
        name="Samples", description="Number of light directions per pixel", default=256, min=1, max=1 << 20
    )
    gain: FloatProperty(name="Gain", description="Factor on the difference", default=4.0, min=0.01)

    _what = "The comparison"

    def execute(self, context):
        """In a window it runs in the background, as from the button: a script does not block the window."""
        if bpy.app.background or context.window is None:
            return super().execute(context)
        return self.invoke(context, None)

    def _begin(self, context):
        material = measured.wanted_material(context, self.material)
        node = measured.modelled_node(material)
        self._subject, self._compared = material.name, _compared(node)
        threads = context.scene.render.threads
        self._steps = Comparison(node, f"Material '{material.name}'", self.side, self.samples, threads)
        self._advance()
        self._goes_on()

    def _finish(self):
        if self._advance():
            return None
        image = made_image(comparison_name(self._subject), 3 * self.side, self.side, float_buffer=True)
        image.velour.compared = self._compared
        image.use_view_as_render = True  # scene-linear, like a render: apply the scene's view transform
        image.pixels.foreach_set(rec709_pixels_to_working(self._steps.tiles(self.gain)).ravel())
        image.pack()  # otherwise Blender asks to save it on exit
        _set_preview(image, self._steps.thumbnail(self.gain))
        if not bpy.app.background:
            show(image)
        self.report(
            {"INFO"},
            f"'{self._subject}': measurement, model and {self.gain:g} times their difference; relative error"
            f" {self._steps.relative_l2:.2%} on the ball.",
        )
        return {"FINISHED"}


def comparison_name(material_name):
    """Name of the image."""
    return f"{material_name} compared"


def find_comparison(node):
    """The comparison of the node's model and measurement, possibly made for another material; or None."""
    wanted = _compared(node)
    return next((image for image in all_made() if image.velour.compared == wanted), None)


def _compared(node):
    """Key of the model and the measurement, from file hashes or stamps. Safe in draw()."""
    return " ".join(_content(image) for image in (node.image, node.velour.measurement) if image is not None)


def _content(image):
    packed = image.packed_file
    return image.velour.sha256 or repr(packed.size if packed else file_stamp(absolute_path(image)))


def _set_preview(image, pixels):
    preview = image.preview_ensure()
    preview.image_size = pixels.shape[1], pixels.shape[0]
    preview.image_pixels_float.foreach_set(pixels.ravel())

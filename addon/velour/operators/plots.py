"""Saves plots to files, and shows them enlarged in an Image Editor."""

import bpy
from bpy.props import IntProperty, StringProperty
from bpy_extras.io_utils import ExportHelper

from ..export import ExportError
from ..export.nodes import velour_node
from ..properties.plot_settings import plot_azimuth, plot_kind, plot_view
from . import measured
from .background_job import JobsInSteps
from .model_plots import PlotSource, PlotSteps, measurement_for, plot_name
from .plot_colors import theme_colors
from .shown_image import made_image, show

_KINDS_OF_FILES = (".png", ".svg", ".csv")


class _OfMaterial(measured.OfMaterial, JobsInSteps):
    """Operator mixin that makes a plot of a material. `_use(plot)` takes it."""

    kind: plot_kind()
    view: plot_view()
    azimuth: plot_azimuth()

    _what = "The plot"

    def _begin(self, context):
        material = measured.find_material(context, self.material)
        node = velour_node(material)
        if node is None or node.image is None:
            raise ExportError("There is no model to plot; fit or import one first.")
        self._subject = material.name
        source = PlotSource(
            node.image, measurement_for(self.kind, node.velour), f"Material '{material.name}'"
        )
        self._steps = PlotSteps(source, self.kind, self.view, self.azimuth)
        self._advance()
        self._goes_on()

    def _finish(self):
        if self._advance():
            return None
        if self._steps.source.missing:
            self.report({"WARNING"}, self._steps.source.missing)
        with self._steps.plot as plot:
            self._use(plot)
        self._steps.source.close()
        return {"FINISHED"}


class VELOUR_OT_save_plot(_OfMaterial, bpy.types.Operator, ExportHelper):
    bl_idname = "velour.save_plot"
    bl_label = "Save Plot"
    bl_description = "Save the plot as an image for print (.png, .svg), or its numbers (.csv)"

    filename_ext = ".png"
    check_extension = None  # the file's extension determines the format
    filter_glob: StringProperty(default="*.png;*.svg;*.csv", options={"HIDDEN"})
    side: IntProperty(
        name="Size", description="Width and height of an image in pixels", default=800, min=64, max=8192
    )

    _asks = False

    def invoke(self, context, event):
        """Opens a file browser unless the file is given."""
        if self.properties.is_property_set("filepath"):
            return JobsInSteps.invoke(self, context, event)
        material = measured.find_material(context, self.material)
        self.material = material.name if material else ""
        self._asks = True
        return ExportHelper.invoke(self, context, event)

    def execute(self, context):
        if not self._asks:
            return JobsInSteps.execute(self, context)
        # Blender ends the file browser's operator when this returns, so another one does the work.
        bpy.ops.velour.save_plot(
            "INVOKE_DEFAULT", **self.as_keywords(ignore=("check_existing", "filter_glob"))
        )
        return {"FINISHED"}

    def cancel(self, context):
        if not self._asks:
            JobsInSteps.cancel(self, context)

    def _use(self, plot):
        path = bpy.path.abspath(self.filepath)
        plot.save(
            path if path.lower().endswith(_KINDS_OF_FILES) else path + self.filename_ext, side=self.side
        )


class VELOUR_OT_enlarge_plot(_OfMaterial, bpy.types.Operator):
    bl_idname = "velour.enlarge_plot"
    bl_label = "Enlarge"
    bl_description = "Open the plot as an image in an Image Editor"

    side: IntProperty(name="Size", description="Width and height in pixels", default=1024, min=64, max=8192)

    def _use(self, plot):
        context = bpy.context
        pixels = plot.draw(side=self.side, **theme_colors(context.preferences))
        image = made_image(f"{self._subject} {plot_name(self.kind)}", self.side, self.side)
        image.pixels.foreach_set(pixels.ravel())
        image.pack()  # otherwise Blender asks to save it on exit
        if not bpy.app.background:
            show(image)

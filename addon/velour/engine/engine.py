"""The engine that is registered with Blender."""

import logging

import bpy

from ..export import ExportError, visitor
from ..native import VelourError
from . import viewport_clock
from .failed_frame import FailedFrame
from .final import RenderCancelledError, render_final
from .frame_parts import UnfinishedError
from .kept_scene import KeptScene
from .passes import register_passes
from .stamps import Stamps
from .viewport import Viewport

log = logging.getLogger(__package__)


class VelourRenderEngine(bpy.types.RenderEngine):
    bl_idname = "VELOUR"
    bl_label = "Velour"
    bl_use_preview = True
    bl_use_shading_nodes_custom = False  # keeps the shader editor of Cycles
    bl_use_eevee_viewport = True  # Material Preview shows the Principled approximation
    bl_use_spherical_stereo = False

    def __init__(self, *args, **kwargs):
        super().__init__(*args, **kwargs)  # Blender 4.4 and newer pass arguments and need this call
        self._viewport = None
        self.stamps = Stamps()
        self.failed_frame = FailedFrame()
        self.kept_scene = KeptScene()

    def __del__(self):
        # Plain attribute access raises if Blender has freed its half already, as it does on exit.
        own = object.__getattribute__(self, "__dict__")
        for name in ("_viewport", "kept_scene"):
            if own.get(name):
                own[name].close()
        parent = getattr(super(), "__del__", None)  # missing up to and including 5.2
        if parent:
            parent()

    def render(self, depsgraph):
        if self.failed_frame.is_current:
            return
        try:
            # Other threads may be rendering previews, which must not get the visitor.
            visit = None if self.is_preview else visitor.current()
            with viewport_clock.paused():
                (visit or render_final)(self, depsgraph)
        except RenderCancelledError:
            pass  # requested by Blender
        except (ExportError, UnfinishedError, VelourError) as error:
            self._fail(str(error), depsgraph)
        except KeyboardInterrupt:  # Blender as a module crashes on writing the file if this propagates
            self._fail("The render was interrupted.", depsgraph)
        except Exception as error:  # an exception alone would leave a black picture and exit status 0
            log.exception("render failed")
            self._fail(f"Velour failed unexpectedly: {type(error).__name__}: {error}", depsgraph)

    def view_update(self, context, depsgraph):
        if self._viewport is None:
            self._viewport = Viewport(self)
        self._viewport.update(context, depsgraph)

    def view_draw(self, context, depsgraph):
        if self._viewport is None:
            self.view_update(context, depsgraph)
        self._viewport.draw(context, depsgraph)

    def update_render_passes(self, scene=None, renderlayer=None):
        register_passes(self, scene, renderlayer)

    def _fail(self, sentence, depsgraph):
        if self.is_preview:
            self.error_set(sentence)  # nobody reads reports of a preview: show it in its corner
        else:
            self.report({"ERROR"}, sentence)
            self.failed_frame.note(depsgraph.scene)

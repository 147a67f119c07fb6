"""One 3D viewport in real time, drawn by the GPU at each redraw."""

from ..export.caches import cache_folder
from ..export.film import film_exposure, hides_world
from ..export.live import LiveExport
from ..export.look import Look
from ..export.viewport import viewport_frame
from ..export.world import layer_world
from ..realtime import Drawing, RealtimeScene, shaders
from . import viewport_clock
from .options import viewport_threads


class RealtimeViewport:
    """Raises UnshownError for what it cannot show; other errors propagate."""

    def __init__(self, engine_reference):
        shaders.check()
        self._engine = engine_reference
        self._live = None
        self._drawing = Drawing(cache_folder())
        self._key = None  # settings of the last drawing
        self._has_frame = False  # whether anything of it is visible

    def close(self):
        viewport_clock.forget(self)
        self.forget_scene()
        self._drawing.close()

    def forget_scene(self):
        """Keeps light, tables and the last picture: the next export tells which of them are still valid."""
        if self._live:
            self._live.close()
        self._live = None

    def update(self, context, depsgraph):
        self._drawing.restart()
        look = Look(context, depsgraph)
        if self._live is None:
            self._live = self._exported(depsgraph, look)
        else:
            self._live.scene.threads = viewport_threads(depsgraph.scene)
            changes = self._live.changes(depsgraph, look)
            if changes and not changes.everything:
                self._live.update(changes, depsgraph, look)
            if changes and (changes.everything or self._live.scene.is_stale):
                self.forget_scene()
                self._live = self._exported(depsgraph, look)
        self._live.scene.check()

    def _exported(self, depsgraph, look):
        scene = RealtimeScene(self._drawing.tables, viewport_threads(depsgraph.scene))
        return LiveExport(depsgraph, look, scene)

    def draw(self, context, depsgraph):
        """Returns a status line."""
        if self._live is None:
            self.update(context, depsgraph)
        frame = viewport_frame(context, depsgraph)
        self._has_frame = frame is not None
        if frame is None:
            self.pause()
            return ""
        scene = self._live.scene
        is_ready = self._drawing.is_ready(scene)
        if not viewport_clock.is_paused():
            self._drawing.jobs.go_on()
        viewport_clock.watch(self)
        if is_ready:
            self._draw(depsgraph, frame)
        self._show(depsgraph.scene_eval, frame.place)
        return self._line() if is_ready else "Preparing real time"

    def has_picture(self):
        """Whether draw() has shown any picture, even of the previous scene."""
        return self._drawing.last() is not None

    def turn(self):
        """Called between redraws. False: there is nothing to wait for."""
        engine = self._engine()
        if engine is None or self._live is None or not self._has_frame:
            return False
        if viewport_clock.is_paused():
            self.pause()
            return True
        if not self._drawing.is_waiting():
            return False  # a redraw would only request the next one
        engine.tag_redraw()
        return True

    def pause(self):
        """May be called from any thread; draw() continues later."""
        self._drawing.jobs.pause()

    def _draw(self, depsgraph, frame):
        scene = depsgraph.scene_eval
        world = layer_world(scene, depsgraph.view_layer_eval)
        shows_world = not scene.render.film_transparent and not hides_world(world)
        exposure = film_exposure(scene)
        key = frame.key(), exposure, shows_world
        if key != self._key:
            self._drawing.restart()
            self._key = key
        self._drawing.draw(self._live.scene, frame.view, exposure, shows_world)

    def _show(self, scene, place):
        """Shows the last drawing, which is that of the previous scene while this one is prepared."""
        import gpu
        from gpu_extras.presets import draw_texture_2d

        texture, engine = self._drawing.last(), self._engine()
        if texture is None:
            return
        gpu.state.blend_set("ALPHA_PREMULT")
        engine.bind_display_space_shader(scene)
        draw_texture_2d(texture, place[:2], place[2], place[3])
        engine.unbind_display_space_shader()
        gpu.state.blend_set("NONE")

    def _line(self):
        light = self._drawing.light_report
        said = ["Real time"]
        if light.get("relative_l2", 0.0) > 0.0:
            said.append(f"environment as {light['lobes']} lobes, error {100 * light['relative_l2']:.1f} %")
        simpler = sum(look.is_simpler for look in self._live.scene.looks)
        if simpler:
            said.append(f"{simpler} other materials simplified")
        if self._live.scene.simpler_lamps:
            said.append(f"{self._live.scene.simpler_lamps} lights simplified")
        return "; ".join(said)

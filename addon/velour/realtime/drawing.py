"""Draws a RealtimeScene into a texture. Runs on the main thread, while a viewport is drawn."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..native import light_map_job
from .errors import LOST, asking_for
from .job_line import JobLine
from .kept_tables import KeptTables
from .lamps import PIXELS
from .projection import jitter, view_projection
from .shaders import PICTURES, sky_shader
from .targets import Targets, full_screen
from .textures import texture

_WIDTH = 1020  # width of the texture of instances in pixels: a row holds whole instances
_FLOATS = 4
_NARROW, _MOST_NARROW = 60.0, 8  # least bandwidth of the environment's narrow lobes, and their maximum number


class _Draw(NamedTuple):
    """One material slot of a group's instances."""

    batch: object
    material: int
    in_shell: bool
    first: int
    count: int


class Drawing:
    """GPU resources of a scene."""

    def __init__(self, cache_folder):
        self._cache_folder = cache_folder
        self.jobs = JobLine()
        self.tables = KeptTables(self.jobs)  # tables of materials
        self._light = None  # light map texture
        self.light_report = {}  # report of the job that made the light map
        self._light_job = None
        self._light_key = None  # world key of the light map, or of its job
        self._has_tables = False
        self._targets = None
        self.count = 0  # number of images in the average
        self._lamps = None  # texture of lights
        self._instances = None  # the groups in the texture, and the texture

    def close(self):
        self._drop_light_job()
        self.tables.close()
        self._free_targets()
        self.__init__(self._cache_folder)

    def is_ready(self, scene):
        """Whether all tables that draw() needs exist; a changed environment is drawn as before until then.

        `jobs` make them once JobLine.go_on() is called.
        """
        import gpu

        self._follow_light(gpu, scene)
        self._has_tables = self.tables.has(gpu, _parts(scene), scene.to_working)
        return self._light is not None and self._has_tables

    def is_waiting(self):
        """Whether there is more to draw even if nothing changes."""
        return self._light_job is not None or not self._has_tables or self.count < PICTURES

    def _follow_light(self, gpu, scene):
        if self._light_key != scene.world_key:
            self._drop_light_job()
            self._light_job = self.jobs.add(light_map_job(scene, self._cache_folder, scene.threads))
            self._light_key = scene.world_key
        if self._light_job and self.jobs.has(self._light_job):
            self._light = texture(gpu, self._light_job.result_table())
            self.light_report = self._light_job.report()
            self._drop_light_job()
            self.restart()

    def _drop_light_job(self):
        if self._light_job:
            self.jobs.drop(self._light_job)
        self._light_job = None

    def restart(self):
        """Starts a new average, since the next image differs from the last."""
        self.count = 0

    def draw(self, scene, view, exposure, shows_world):
        """A texture of the view's size: scene-linear, premultiplied. Call only if is_ready().

        Images since restart() are averaged for antialiasing; after PICTURES the average remains.
        """
        import gpu

        size = (view.width, view.height)
        if self._targets is None or self._targets.size != size:
            self._free_targets()
            self._targets = Targets(gpu, size)
            self.count = 0
        if self.count < PICTURES:
            with asking_for(f"an image of {size[0]} x {size[1]} pixels", LOST):
                with self._targets.drawn.bind():
                    self._draw_scene(gpu, scene, view, exposure, shows_world)
                self._targets.average(gpu, 1 / (self.count + 1))
            self.count += 1
        return self._targets.mean()

    def last(self):
        """The last texture that draw() made, or None."""
        return self._targets.mean() if self._targets else None

    def _free_targets(self):
        if self._targets:
            self._targets.free()
        self._targets = None

    def _draw_scene(self, gpu, scene, view, exposure, shows_world):
        matrix, eye = view_projection(view, jitter(self.count))
        gpu.state.active_framebuffer_get().clear(color=(0.0, 0.0, 0.0, 0.0), depth=1.0)
        gpu.state.blend_set("NONE")
        gpu.state.depth_test_set("NONE")
        try:
            if shows_world:  # first, because the depth of distant surfaces rounds to that of a background
                self._draw_sky(gpu, matrix, exposure)
            gpu.state.depth_test_set("LESS_EQUAL")
            gpu.state.depth_mask_set(True)
            self._draw_surfaces(gpu, scene, matrix, eye, exposure)
        finally:  # on failure the ray tracer draws next
            gpu.state.depth_mask_set(False)
            gpu.state.depth_test_set("NONE")

    def _draw_surfaces(self, gpu, scene, matrix, eye, exposure):
        narrow = _narrow_lobes(self.light_report["mixture"])
        self._lamps = _lamps_texture(gpu, [*scene.lamps, *narrow])  # kept alive until everything is drawn
        for shader, draws in self._draws(gpu, scene).items():
            shader.bind()
            shader.uniform_float("view_projection", _columns(matrix))
            shader.uniform_float("eye", eye)
            shader.uniform_sampler("light_map", self._light)
            shader.uniform_sampler("instances", self._instances_texture(gpu, scene))
            shader.uniform_sampler("lamps", self._lamps)
            for draw in draws:
                tables = [self.tables[part.key] for part in scene.looks[draw.material].parts]
                for table in tables:
                    if draw.in_shell or not table.is_shell:
                        table.bind(shader)
                self._set_look(shader, scene, draw.material, exposure)
                layout = tables[0].layout(len(narrow))
                _draw_instances(shader, draw, layout, scene.looks[draw.material].hides_backs)

    def _draws(self, gpu, scene):
        """Lists of _Draw by shader."""
        draws, first = {}, 0
        for group in scene.groups:
            for slot, batch in enumerate(scene.meshes[group.mesh].batches(gpu)):
                material = group.materials[min(slot, len(group.materials) - 1)]
                if batch is None or material is None:
                    continue
                shader = self.tables[scene.looks[material].parts[0].key].shader(group.in_shell)
                draw = _Draw(batch, material, group.in_shell, first, len(group.rows))
                draws.setdefault(shader, []).append(draw)
            first += len(group.rows)
        return draws

    def _set_look(self, shader, scene, material, exposure):
        gain = [exposure * channel for channel in scene.gains[material]]
        shader.uniform_float("gain", (*gain, float(len(scene.lamps))))
        emission = [exposure * channel for channel in scene.looks[material].emission]
        shader.uniform_float("emission", (*emission, float(self.count)))

    def _instances_texture(self, gpu, scene):
        if self._instances is None or self._instances[0] is not scene.groups:
            rows = [group.rows.reshape(-1, _FLOATS) for group in scene.groups] or [np.zeros((5, _FLOATS))]
            pixels = np.concatenate(rows)
            table = np.zeros((-(-len(pixels) // _WIDTH), _WIDTH, _FLOATS), np.float32)
            table.reshape(-1, _FLOATS)[: len(pixels)] = pixels
            self._instances = scene.groups, texture(gpu, table)
        return self._instances[1]

    def _draw_sky(self, gpu, matrix, exposure):
        shader = sky_shader()
        shader.bind()
        shader.uniform_float("inverse_projection", _columns(np.linalg.inv(matrix)))
        shader.uniform_float("exposure", exposure)
        shader.uniform_sampler("light_map", self._light)
        full_screen(shader).draw(shader)


def _parts(scene):
    return [part for look in scene.looks for part in look.parts]


def _draw_instances(shader, draw, layout, hides_backs):
    many = getattr(draw.batch, "draw_instanced", None)  # 3.6 and newer
    if many:
        shader.uniform_int("layout_", (_first(draw.first, hides_backs), *layout))
        many(shader, instance_count=draw.count)
        return
    for i in range(draw.first, draw.first + draw.count):
        shader.uniform_int("layout_", (_first(i, hides_backs), *layout))
        draw.batch.draw(shader)


def _first(instance, hides_backs):
    """Encoded for surface.vert.glsl, since there is no room for another uniform."""
    return ~instance if hides_backs else instance


def _columns(matrix):
    """Matrix type for uniforms."""
    from mathutils import Matrix

    return Matrix(matrix.tolist())


def _lamps_texture(gpu, lamps):
    return texture(gpu, np.concatenate(lamps)[None] if lamps else np.zeros((1, PIXELS, _FLOATS), np.float32))


def _narrow_lobes(mixture):
    """The brightest lobes that are narrower than the light directions of BTFs, as pixels of lights."""
    lobes = np.array(mixture, float).reshape(-1, 7)
    lobes = lobes[lobes[:, 3] > _NARROW]
    whole = 2 * np.pi / lobes[:, 3]
    energy = lobes[:, 4:] * whole[:, None]
    pixels = np.zeros((len(lobes), PIXELS, _FLOATS), np.float32)
    pixels[:, 0, :3] = lobes[:, :3]
    pixels[:, 1, :3], pixels[:, 1, 3] = energy, lobes[:, 3]
    return list(pixels[np.argsort(-energy.sum(axis=1))[:_MOST_NARROW]])

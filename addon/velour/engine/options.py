"""A scene's settings as the options of a render job."""

from ..export.caches import cache_folder
from ..export.denoiser import missing
from ..export.film import hides_world
from ..export.world import layer_world

_MAX_SAMPLES = 1 << 20  # the maximum of scene.velour.samples
_WITHOUT_END = 1 << 24  # light directions per pixel, more than anybody waits for


def final_options(depsgraph, view, is_preview):
    scene, layer = depsgraph.scene_eval, depsgraph.view_layer_eval
    settings = scene.velour
    return {
        **_common(scene, layer, view),
        "spp": settings.preview_samples if is_preview else layer_samples(scene, layer),
        "threads": scene.render.threads,
        "denoise": int(settings.use_denoising and not is_preview),
        "noise": 0.0 if is_preview or not settings.use_noise_target else settings.noise_target,
        "time_limit": settings.time_limit,
    }


def layer_samples(scene, layer):
    """Light directions per pixel. The override of a view layer counts camera rays, as the panels do."""
    return min(layer.samples * scene.velour.split, _MAX_SAMPLES) or scene.velour.samples


def viewport_options(depsgraph, view):
    scene = depsgraph.scene_eval
    return {
        **_common(scene, depsgraph.view_layer_eval, view),
        "spp": scene.velour.viewport_samples or _WITHOUT_END,
        "denoise": int(scene.velour.use_viewport_denoising and not missing()),
        "threads": viewport_threads(scene),
    }


def samples_text(done, end, split):
    """How many of the camera rays per pixel are rendered, by light directions per pixel; `split`: per ray."""
    of_all = "" if end == _WITHOUT_END else f"/{-(-end // split)}"
    return f"Sample {-(-done // split)}{of_all}"


def viewport_threads(scene):
    """All but one, which is left to the interface."""
    return max(1, scene.render.threads - 1)


def _common(scene, layer, view):
    settings = scene.velour
    return {
        "width": view.width,
        "height": view.height,
        "split": settings.split,
        "bounces": settings.bounces,
        "strategy": settings.strategy.lower().replace("_", "-"),
        "seed": settings.seed,
        "clamp_direct": settings.clamp_direct,
        "clamp_indirect": settings.clamp_indirect,
        "filter_glossy": settings.filter_glossy,
        "reflective_caustics": int(settings.use_reflective_caustics),
        "share": settings.share,
        "heuristic": settings.heuristic.lower(),
        "sequence": settings.sequence.lower(),
        "cache_folder": cache_folder() if settings.use_cache else "",
        "transparent": int(scene.render.film_transparent),
        "hide_world": int(hides_world(layer_world(scene, layer))),
    }

"""Runs inside Blender: renders frames of a .blend with Velour, once for each seed, into EXR files.

The task: "blend", "scripts" (whether its own may run), "frames" (numbers, or [null] for the one that the file
was saved at), "seeds" (added to the file's), "samples" (null: the file's), "passes" (whether the files get
those that name causes, and the world gets files of its own), "folder" (of the pictures, FRAME-SEED.exr and
world-FRAME-SEED.exr, FRAME being "own" for null; of frames with depth of field or motion blur also
sharp-FRAME-SEED.exr, without it) and "report", which gets "layer" (of the passes, or null).
"""

from pathlib import Path

import bpy
import inside
import inside_world

_MIST_METERS = 1000.0  # distances beyond look alike
_LEAST_SAMPLES = 16  # of passes that are rendered by themselves, with a quarter of the picture's


def main(task):
    inside.open_file(task["blend"], task["scripts"])
    scene = bpy.context.scene
    inside.enable_velour(scene)
    inside.show_renders(scene)
    scene.render.engine = "VELOUR"
    _set_samples(scene, task["samples"])
    _stop_denoising(scene)
    ball = inside_world.MirrorBall(scene) if task["passes"] and scene.world else None
    layer = _show_passes(scene) if task["passes"] else None
    first = scene.velour.seed
    for frame in task["frames"]:
        if frame is not None:
            scene.frame_set(frame)
        for seed in task["seeds"]:
            scene.velour.seed = (first + seed) % (1 << 31)
            name = f"{'own' if frame is None else frame}-{seed}.exr"
            print(f"Rendering {name}", flush=True)
            inside.render(scene, Path(task["folder"]) / name)
            if task["passes"]:
                _render_sharp(scene, Path(task["folder"]) / f"sharp-{name}")
            if ball:
                ball.render(Path(task["folder"]) / f"world-{name}", scene.frame_current, scene.velour.seed)
    return {"layer": layer}


def _render_sharp(scene, path):
    """The passes without depth of field and motion blur, if any: they mix objects in every pixel."""
    lens = scene.camera.data.dof if scene.camera and scene.camera.type == "CAMERA" else None
    focused = lens is not None and lens.use_dof
    if not focused and not scene.render.use_motion_blur:
        return
    kept = [(scene.render, "use_motion_blur"), (scene.velour, "samples"), (scene.velour, "bounces")]
    kept += [(lens, "use_dof")] if focused else []
    kept += [(layer, "samples") for layer in scene.view_layers]
    before = [getattr(owner, name) for owner, name in kept]
    scene.render.use_motion_blur, scene.velour.bounces = False, 0
    scene.velour.samples = min(scene.velour.samples, max(scene.velour.samples // 4, _LEAST_SAMPLES))
    for layer in scene.view_layers:
        layer.samples = -(-layer.samples // 4)  # 0: no override
    if focused:
        lens.use_dof = False
    inside.render(scene, path)
    for (owner, name), value in zip(kept, before, strict=True):
        setattr(owner, name, value)


def _set_samples(scene, samples):
    """Sets the samples of all view layers. None leaves those of the file."""
    inside.stop_animation(scene, {"velour.seed"})
    if samples is None:
        return
    overrides = {f"{layer.path_from_id()}.samples" for layer in scene.view_layers}
    inside.stop_animation(scene, {"velour.samples", *overrides})
    scene.velour.samples = samples
    for layer in scene.view_layers:
        layer.samples = 0


def _stop_denoising(scene):
    """It blends pixels, whose errors are then neither independent nor those that several seeds show."""
    inside.stop_animation(scene, {"velour.use_denoising"})
    scene.velour.use_denoising = False


def _show_passes(scene):
    """Switches on the passes that tell geometry, materials and light apart; the name of their view layer.

    All are means over the camera rays of a pixel: depth and position are those of one ray, whose errors four
    seeds cannot tell. Mist takes the place of depth: the root of the distance, up to _MIST_METERS.
    """
    layer = next((each for each in scene.view_layers if each.use), scene.view_layers[0])
    layer.use_pass_normal = layer.use_pass_uv = layer.velour.use_pass_albedo = True
    layer.use_pass_cryptomatte_object = layer.use_pass_cryptomatte_material = True
    layer.pass_cryptomatte_depth = 2
    layer.use_pass_mist = True
    if scene.world is None:
        scene.world = bpy.data.worlds.new("None")
        scene.world.color = (0, 0, 0)
    mist = scene.world.mist_settings
    mist.start, mist.depth, mist.falloff = 0.0, _MIST_METERS, "INVERSE_QUADRATIC"
    settings = scene.render.image_settings
    if hasattr(settings, "media_type"):  # 5.0 and newer
        settings.media_type = "MULTI_LAYER_IMAGE"
    settings.file_format, settings.color_depth = "OPEN_EXR_MULTILAYER", "32"
    if hasattr(settings, "use_exr_interleave"):  # one part in place of one for each pass
        settings.use_exr_interleave = True
    return layer.name

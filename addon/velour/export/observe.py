"""Scene usage of a material in one frame."""

import zlib

from ..native import observe_job

_POLL_SECONDS = 0.05


def observe(native_scene, number, view, depsgraph, check_break=lambda: None):
    """The Observation of material `number` in a committed scene seen through `view`.

    Deterministic: the random seed depends only on the frame and the view layer.
    """
    scene = depsgraph.scene_eval
    job = observe_job(
        native_scene,
        number,
        width=view.width,
        height=view.height,
        bounces=scene.velour.bounces,
        threads=scene.render.threads,
        seed=zlib.crc32(f"{scene.frame_current} {depsgraph.view_layer_eval.name}".encode()),
    )
    with job:
        job.start()
        while not job.wait(timeout=_POLL_SECONDS):
            check_break()
        return job.result_observation()

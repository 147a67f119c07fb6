"""From the film's passes to Blender's render result."""

from ..native.job import PASS_CHANNELS

SAMPLE_COUNT = "Sample Count"


def register_passes(engine, scene, layer):
    """Tells the compositor which sockets to show."""
    engine.register_pass(scene, layer, "Combined", 4, "RGBA", "COLOR")
    if layer.use_pass_z:
        engine.register_pass(scene, layer, "Depth", 1, "Z", "VALUE")
    if layer.use_pass_normal:
        engine.register_pass(scene, layer, "Normal", 3, "XYZ", "VECTOR")
    if layer.velour.use_pass_sample_count:
        engine.register_pass(scene, layer, SAMPLE_COUNT, 1, "X", "VALUE")


def add_passes(engine, layer):
    """Passes that Blender does not make by itself; before begin_result."""
    if layer.velour.use_pass_sample_count:
        engine.add_pass(SAMPLE_COUNT, 1, "X", layer=layer.name)


def write_passes(job, result, exposure, names=None):
    """Copies the film into `result`: the passes in `names`, or all that both sides know.

    `exposure`: what light is multiplied by.
    """
    for target in result.layers[0].passes:
        if target.name in PASS_CHANNELS and (names is None or target.name in names):
            pixels = job.read_pass(target.name).reshape(-1, target.channels)
            if target.name == "Combined":
                pixels[:, :3] *= exposure
            _fill(target.rect, pixels)


def _fill(rect, pixels):
    """Blender 3.4 to 4.x take [pixels x channels], 5.x the same values flat; neither takes the other."""
    try:
        rect.foreach_set(pixels)
    except TypeError:
        rect.foreach_set(pixels.reshape(-1))

"""From the film's passes to Blender's render result."""

from ..export.camera import planar_depth

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


def write_passes(job, result, view, names=None):
    """Copies the film into `result`: the passes in `names`, or all that both sides know."""
    for target in result.layers[0].passes:
        reader = _READERS.get(target.name)
        if reader is None or (names and target.name not in names):
            continue
        pixels = reader(job, view)
        target.rect.foreach_set(pixels.reshape(-1, target.channels))


def _depth(job, view):
    return planar_depth(job.read_pass("Depth"), view)


_READERS = {
    "Combined": lambda job, _view: job.read_pass("Combined"),
    "Depth": _depth,
    "Normal": lambda job, _view: job.read_pass("Normal"),
    SAMPLE_COUNT: lambda job, _view: job.read_pass(SAMPLE_COUNT),
}

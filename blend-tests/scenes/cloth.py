"""A waving cloth."""

QUANTITY = (
    "a compressed BTF of a weave on a curved cloth: texture coordinates, tangents, mip levels, both lights"
)


def build(folder):
    from pathlib import Path

    from parity import stage
    from support import lamps, scenes

    scenes.use_picture(samples=256)
    weave = scenes.measured_material((Path(__file__).parent / "data/weave.velour").read_bytes(), "Weave")
    placement = scenes.velour_node(weave).velour.placement
    placement.mode, placement.repeats = "REPEATS", (12, 12)
    _cloth(stage, weave)
    stage.camera((0, -4.5, 2.2), (1.12, 0, 0), 50)
    watts = lamps.area_watts(250)
    stage.lamp("AREA", watts, (2, -1, 3), (0.1, 0.6, 0), shape="RECTANGLE", size=1, size_y=0.5)
    scenes.set_world((0.7, 0.8, 1.0), 0.4)


def _cloth(stage, material, count=40):
    import numpy as np

    s, t = (place.ravel() for place in np.meshgrid(*2 * [np.linspace(0, 1, count)]))
    x, y = 3 * s - 1.5, 3 * t - 1.5
    points = np.stack([x, y, 0.15 * np.sin(5 * x + y) + 0.1 * np.cos(4 * y)], axis=1)
    first = (np.arange(count - 1) + count * np.arange(count - 1)[:, None]).ravel()
    faces = np.stack([first, first + 1, first + count + 1, first + count], axis=1).tolist()
    obj = stage.mesh(points, faces, material, "Cloth", smooth=True)
    corners = np.array(faces).ravel()
    layer = obj.data.uv_layers.new()
    layer.data.foreach_set("uv", np.stack([s[corners], t[corners]], axis=1).astype(np.float32).ravel())

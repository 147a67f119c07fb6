"""A town under forty lamps."""

QUANTITY = (
    "forty lamps of every kind: points, spots, suns and area lights of four shapes, drawn by their power"
)
MEANINGS = ("", "wide-spots")


def meaning():
    from support import lamps

    return lamps.spots()


def build(folder):
    import numpy as np

    from parity import stage
    from support import lamps, scenes

    scenes.use_picture(samples=512)
    stage.town()
    stage.camera()
    random = np.random.default_rng(4)
    for number in range(38):
        place = (*random.uniform(-3, 3, 2), random.uniform(1.8, 3.0))
        _lamp(stage, lamps, number, place, random.uniform(2, 20)).data.color = tuple(
            random.uniform(0.3, 1, 3)
        )
    for tilt in (0.4, -0.6):
        stage.lamp("SUN", lamps.sun_strength(0.3, 0.2), rotation=(tilt, tilt, 0), angle=0.2)


def _lamp(stage, lamps, number, place, watts):
    shape = ("SQUARE", "RECTANGLE", "DISK", "ELLIPSE")[number // 3 % 4]
    if number % 3 == 0:
        return lamps.as_disk(stage.lamp("POINT", watts, place, shadow_soft_size=0.1))
    if number % 3 == 1:
        spread = {"spot_size": 1.2, "spot_blend": 0.3, "shadow_soft_size": 0.05}
        return lamps.as_disk(stage.lamp("SPOT", 2 * watts, place, (0.2, -0.3, 0), **spread))
    return stage.lamp(
        "AREA", lamps.area_watts(watts), place, (-0.3, 0.2, 0), shape=shape, size=0.5, size_y=0.2
    )

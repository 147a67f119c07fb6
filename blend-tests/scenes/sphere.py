"""One ball, one lamp."""

QUANTITY = "light of a disk on a smooth matt ball: interpolated normals, and a soft shadow on the ground"


def build(folder):
    from parity import stage
    from support import lamps, scenes

    scenes.use_picture(samples=64)
    stage.ground(20, 0.5)
    stage.sphere(albedo=0.7, segments=32, rings=16).location.z = 1
    stage.camera((0, -6, 2.6), (1.32, 0, 0), 45)
    stage.lamp("AREA", lamps.area_watts(400), (2, -2, 5), (0.41, 0.41, 0), shape="DISK", size=1.5)

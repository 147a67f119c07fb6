"""A box that turns while its lamp brightens."""

QUANTITY = "two frames: keyed rotation of a parent, a driven height, a keyed lamp and a keyed lens"
FRAMES = (3, 12)
MEANINGS = ("", "wide-spots")


def meaning():
    from support import lamps

    return lamps.spots()


def build(folder):
    import bpy

    from parity import stage
    from support import lamps, scenes

    scene = scenes.use_picture(samples=128)
    scene.frame_start, scene.frame_end = 1, 20
    stage.ground(20, 0.5)
    parent = stage.link(bpy.data.objects.new("Axis", None))
    box = stage.box((-0.5, -0.5, 0), (0.5, 0.5, 1), 0.7)
    box.parent, box.location.x = parent, 0.8
    spot = {"spot_size": 1.2, "shadow_soft_size": 0.3}
    lamp = lamps.as_disk(stage.lamp("SPOT", 200, (1, -2, 5), (0.4, 0.2, 0), **spot))
    camera = stage.camera((0, -8, 4), (1.15, 0, 0), 40)
    for frame, angle, watts, lens in ((1, 0, 200, 40), (20, 2.5, 800, 60)):
        parent.rotation_euler.z, lamp.data.energy, camera.data.lens = angle, watts, lens
        parent.keyframe_insert("rotation_euler", frame=frame)
        lamp.data.keyframe_insert("energy", frame=frame)
        camera.data.keyframe_insert("lens", frame=frame)
    box.driver_add("scale", 2).driver.expression = "1 + frame / 20"

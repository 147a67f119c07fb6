"""A row of boxes through an open lens."""

QUANTITY = "depth of field with blades, a shifted lens, oblong pixels and a cropped border"


def build(folder):
    from parity import stage
    from support import scenes

    scene = scenes.use_picture(samples=512, width=120, height=80)
    scene.render.pixel_aspect_x = 1.25
    scene.render.use_border = scene.render.use_crop_to_border = True
    scene.render.border_min_x, scene.render.border_max_x = 0.2, 0.9
    scene.render.border_min_y, scene.render.border_max_y = 0.1, 0.85
    stage.ground(40, 0.5)
    for number in range(7):
        x, y = 0.9 * number - 2.5, 1.6 * number - 3
        stage.box((x - 0.3, y - 0.3, 0), (x + 0.3, y + 0.3, 1 + 0.1 * number), 0.3 + 0.1 * (number % 5))
    lens = stage.camera((0, -8, 2.2), (1.4, 0, 0), 40).data
    lens.shift_x, lens.shift_y = 0.03, -0.05
    lens.dof.use_dof, lens.dof.focus_distance = True, 8.5
    lens.dof.aperture_fstop, lens.dof.aperture_blades, lens.dof.aperture_ratio = 0.05, 6, 1.3
    stage.lamp("SUN", 3, rotation=(0.6, 0.3, 0.2), angle=0.05)
    scenes.set_world((0.6, 0.8, 1.0), 0.4)

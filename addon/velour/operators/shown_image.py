"""Images that operators make and show in an Image Editor."""

import functools

import bpy

from ..export.other_context import other_context


def made_image(name, width, height, **options):
    """The image that an operator made under that name, resized, or a new one; `options`: as for
    bpy.data.images.new()."""
    image = find_made(name)
    if image is None:
        image = bpy.data.images.new(name, width, height, **options)
        image.velour.is_plot, image.velour.made_as = True, name
    elif tuple(image.size) != (width, height):
        image.scale(width, height)
    return image


def find_made(name):
    """The image that an operator made under that name, even if renamed; None if there is none."""
    for image in all_made():
        if (image.velour.made_as or image.name) == name:
            return image
    return None


def all_made():
    """The images of this file that operators made."""
    return [image for image in bpy.data.images if image.velour.is_plot and image.library is None]


def show(image):
    """Shows an image in an open Image Editor or a new window, after the operator has ended, because Blender
    loses count of modal operators that open windows."""
    bpy.app.timers.register(functools.partial(_show, image.name))


def _show(name):
    context, image = bpy.context, bpy.data.images.get(name)
    if image is None:
        return
    windows = context.window_manager.windows
    areas = [area for window in windows for area in window.screen.areas]
    area = next((area for area in areas if area.type == "IMAGE_EDITOR"), None)
    if area is None:
        with other_context(window=windows[0]):
            bpy.ops.wm.window_new()
        area = windows[-1].screen.areas[0]
        area.type = "IMAGE_EDITOR"
    area.spaces.active.image = image
    # The editor has its size only after it has been drawn.
    bpy.app.timers.register(functools.partial(_fit, image.name), first_interval=0.2)


def _fit(name):
    """Fits the whole image into the editors that show it."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type != "IMAGE_EDITOR" or getattr(area.spaces.active.image, "name", "") != name:
                continue
            region = next(region for region in area.regions if region.type == "WINDOW")
            with other_context(window=window, area=area, region=region):
                bpy.ops.image.view_all(fit_view=True)

"""A 3D viewport as a camera: the view, and the part of the region that is rendered."""

from typing import NamedTuple

from mathutils import Matrix, Vector

from .aperture import aperture
from .axes import unscaled
from .camera import View, inside, orthographic_window, perspective_window
from .notes import ExportError


class Frame(NamedTuple):
    view: View
    place: tuple  # x, y, width, height in the region, in pixels

    def key(self):
        """Key that is equal for equal images."""
        view = self.view
        size = (view.width, view.height)
        lens = tuple(sorted(view.lens.items()))
        return (
            view.kind,
            view.camera_to_world.tobytes(),
            view.window,
            view.clip_start,
            view.clip_end,
            size,
            lens,
        )


def viewport_frame(context, depsgraph):
    """Frame of the region being drawn; None if no part of it is rendered."""
    region, space, region_view = context.region, context.space_data, context.region_data
    if region.width < 1 or region.height < 1:
        return None
    camera = _camera(space, region_view, depsgraph)
    projection = region_view.window_matrix
    cut = _cut(region, space, region_view, camera, depsgraph.scene_eval.render)
    if cut is None:
        return None
    is_perspective = region_view.is_perspective
    window = (perspective_window if is_perspective else orthographic_window)(projection)
    window, size = inside(window, (region.width, region.height), *cut)
    matrix, clips = _placed(region_view, space, camera)
    pixel = pixel_size(context)
    view = View(
        "perspective" if is_perspective else "orthographic",
        unscaled(matrix),
        window,
        *clips,
        *(max(1, side // pixel) for side in size),
        aperture(camera, depsgraph) if camera else {},
    )
    return Frame(view, (cut[0], cut[1], *size))


def pixel_size(context):
    """Number of region pixels per rendered pixel, along a side."""
    asked = context.scene.render.preview_pixel_size
    if asked != "AUTO":
        return int(asked)
    return 2 if context.preferences.system.pixel_size >= 2 else 1


def _camera(space, region_view, depsgraph):
    """The evaluated camera that the viewport looks through; None if it uses its own view."""
    if region_view.view_perspective != "CAMERA":
        return None
    camera = space.camera if space.use_local_camera else depsgraph.scene.camera
    if camera is None or camera.type != "CAMERA":
        return None
    if camera.data.type == "PANO":
        raise ExportError(
            f"Camera '{camera.name}': panoramic cameras are not supported; choose Perspective or"
            " Orthographic."
        )
    return camera.evaluated_get(depsgraph)


def _placed(region_view, space, camera):
    """Matrix of the eye, and the clip range."""
    matrix = region_view.view_matrix.inverted()
    if camera:
        return matrix, (camera.data.clip_start, camera.data.clip_end)
    if region_view.is_perspective:
        return matrix, (space.clip_start, space.clip_end)
    # Blender's orthographic view reaches half of Clip End both ahead and behind.
    return matrix @ Matrix.Translation((0, 0, space.clip_end / 2)), (0.0, space.clip_end)


def _cut(region, space, region_view, camera, render):
    """x0, y0, x1, y1: the pixels of the region that are rendered; None if there are none."""
    size = (region.width, region.height)
    if camera:
        if not render.use_border:
            return 0, 0, *size
        low, high = _border_of_camera(camera, region_view.window_matrix, render, size)
    elif space.use_render_border:
        low = space.render_border_min_x * size[0], space.render_border_min_y * size[1]
        high = space.render_border_max_x * size[0], space.render_border_max_y * size[1]
    else:
        return 0, 0, *size
    x0, y0 = (min(max(round(a), 0), side) for a, side in zip(low, size, strict=True))
    x1, y1 = (min(max(round(a), 0), side) for a, side in zip(high, size, strict=True))
    return (x0, y0, x1, y1) if x1 > x0 and y1 > y0 else None


def _border_of_camera(camera, projection, render, size):
    """Two corners of the render border, in pixels of the region."""
    corners = camera.data.view_frame(scene=render.id_data)
    ends = (corners[2], corners[0])  # lower left, upper right
    points = [projection @ Vector((*corner, 1.0)) for corner in ends]
    (left, bottom), (right, top) = (
        ((p.x / p.w + 1) / 2 * size[0], (p.y / p.w + 1) / 2 * size[1]) for p in points
    )
    width, height = right - left, top - bottom
    return (
        (left + render.border_min_x * width, bottom + render.border_min_y * height),
        (left + render.border_max_x * width, bottom + render.border_max_y * height),
    )

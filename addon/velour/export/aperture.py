"""Depth of field: Blender's f-stop as a lens."""

_LEAST_STOP, _LEAST_FOCUS = 1e-5, 1e-5


def aperture(camera, depsgraph):
    """Aperture keywords of Scene.set_camera for an evaluated camera; empty without depth of field."""
    dof = camera.data.dof
    if not dof.use_dof:
        return {}
    # Orthographic cameras have no focal length; like Cycles, assume 1 m.
    focal_length = 1.0 if camera.data.type == "ORTHO" else camera.data.lens * 1e-3
    return {
        "aperture": focal_length / (2.0 * max(dof.aperture_fstop, _LEAST_STOP)),
        "focus": max(_focus(camera, dof, depsgraph), _LEAST_FOCUS),
        "blades": dof.aperture_blades,
        "blade_rotation": dof.aperture_rotation,
        "aperture_ratio": dof.aperture_ratio,
    }


def _focus(camera, dof, depsgraph):
    """Focus distance along the line of sight."""
    if dof.focus_object is None:
        return dof.focus_distance
    target = dof.focus_object.evaluated_get(depsgraph)
    matrix = target.matrix_world
    bone = target.pose.bones.get(dof.focus_subtarget) if target.type == "ARMATURE" and target.pose else None
    if bone is not None:
        matrix = matrix @ bone.matrix
    sight = camera.matrix_world.to_3x3().col[2].normalized()
    return abs(sight.dot(camera.matrix_world.translation - matrix.translation))

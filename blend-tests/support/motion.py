"""What moves over frames."""


def move(owner, path, values, first=0):
    """Keys of a property at successive frames from `first` on."""
    for frame, value in enumerate(values, first):
        setattr(owner, path, value)
        owner.keyframe_insert(path, frame=frame)


def blur(scene, shutter=1.0, position="CENTER", frame=1):
    """Motion blur in a frame, for Cycles and Velour."""
    scene.frame_set(frame)
    render = scene.render
    render.use_motion_blur, render.motion_blur_shutter = True, shutter
    owner = render if hasattr(render, "motion_blur_position") else scene.cycles
    owner.motion_blur_position = position

"""Files of image sequences by frame, numbered as in Blender."""

import os
import re


def sequence_number(user, frame):
    """The file number that an ImageUser shows in a frame of the scene."""
    place, count = frame - user.frame_start + 1, user.frame_duration
    if count and user.use_cyclic:
        place = (place - 1) % count + 1
    return min(max(place, 0), count) + user.frame_offset


def sequence_file(path, number):
    """File `number` of the sequence that contains `path`: replaces the last digits of its name."""
    folder, name = os.path.split(path)
    stem, extension = os.path.splitext(name)
    stem = re.sub(r"\d+(?=\D*$)", lambda digits: str(max(number, 0)).zfill(len(digits[0])), stem)
    return os.path.join(folder, stem + extension)

"""Velour beside Cycles, in the same Blender: the same scene, the same picture, judged by statistics."""

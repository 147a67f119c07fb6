"""Scenes beside references of their own: rendered anew with Velour, judged by statistics, shown on a page.

Nothing here but inside_build.py and inside_render.py needs Blender; those run inside it.
"""

"""Scenes beside references of their own: rendered anew with Velour, judged by statistics, shown on a page.

Nothing here but inside*.py needs Blender; those run inside it.
"""

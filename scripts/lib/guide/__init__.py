"""The user guide's pictures and numbers, taken while somebody goes through its steps in the real Blender.

`command`, `pages` and `pictures` run outside of Blender; the rest is run by `inside` in its window.
May not go in here: what the guide does not tell the reader to do.
"""

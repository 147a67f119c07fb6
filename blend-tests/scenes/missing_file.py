"""A model that is no longer where it was."""

QUANTITY = "a missing model file: no picture, exit status 1, a sentence with material, file and remedy"
REFUSAL = ("Material 'paint'", "paint.velour", "Find Missing Files")


def build(folder):
    from support import scenes

    scenes.worn_file(folder / "paint.velour")
    (folder / "paint.velour").unlink()

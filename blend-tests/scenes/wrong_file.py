"""A text that took the place of a model."""

QUANTITY = "a model file that is none: no picture, exit status 1, a sentence with material and file"
REFUSAL = ("Material 'paint'", "paint.velour", "Velour")


def build(folder):
    from support import scenes

    image = scenes.worn_file(folder / "paint.velour")
    (folder / "paint.velour").write_text("This is a shopping list.\n")
    image.velour.sha256 = ""  # as where the file was never looked at: else the change itself is refused

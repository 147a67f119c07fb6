"""Colors of Blender's theme for plots."""


def theme_colors(preferences):
    """Keywords of Plot.draw. The library mixes colors with too little contrast with the text color."""
    theme = preferences.themes[0]
    interface, editor = theme.user_interface, theme.properties.space
    colors = {
        "background": editor.back,
        "foreground": editor.text,
        "model": interface.wcol_regular.inner_sel,
        "measured": theme.view_3d.object_active,
        "red": interface.axis_x,
        "green": interface.axis_y,
        "blue": interface.axis_z,
    }
    return {name: tuple(color)[:3] for name, color in colors.items()}

"""Mouse and keyboard of an X display, through its XTEST extension. No Blender is needed to import this."""

import ctypes
import os

_X11, _XTST = "libX11.so.6", "libXtst.so.6"
_NAMES = {" ": "space", "/": "slash", ".": "period", "-": "minus", "_": "underscore", ":": "colon"}
_SHIFT = "Shift_L"
LEFT, WHEEL_UP, WHEEL_DOWN = 1, 4, 5  # buttons


def why_not():
    """Why there is no pointer here; empty: there is one."""
    for library in (_X11, _XTST):
        try:
            ctypes.CDLL(library)
        except OSError:
            return f"{library} is not installed"
    return ""


class Pointer:
    """Places are pixels from the upper left corner of the screen."""

    def __init__(self, display=None):
        self._x11, self._test = ctypes.CDLL(_X11), ctypes.CDLL(_XTST)
        self._x11.XOpenDisplay.restype = ctypes.c_void_p
        self._x11.XStringToKeysym.restype = ctypes.c_ulong
        self._x11.XKeysymToKeycode.restype = ctypes.c_ubyte
        self._x11.XkbKeycodeToKeysym.restype = ctypes.c_ulong
        name = display or os.environ["DISPLAY"]
        self._display = ctypes.c_void_p(self._x11.XOpenDisplay(name.encode()))
        if not self._display:
            raise RuntimeError(f"There is no X display {name}.")

    def close(self):
        self._x11.XCloseDisplay(self._display)

    def move(self, x, y):
        self._test.XTestFakeMotionEvent(self._display, -1, int(x), int(y), ctypes.c_ulong(0))
        self._flush()

    def press(self, button=LEFT):
        """And releases it."""
        for is_down in (1, 0):
            self._test.XTestFakeButtonEvent(self._display, button, is_down, ctypes.c_ulong(0))
        self._flush()

    def key(self, name, *held):
        """Presses a key by the name that X has for it, and releases it; other keys are held meanwhile."""
        codes = [self._code(key) for key in held]
        code = self._code(name)
        if self._needs_shift(name, code):
            codes.append(self._code(_SHIFT))
        for each, is_down in ((codes, 1), ((code,), 1), ((code,), 0), (codes[::-1], 0)):
            for key in each:
                self._test.XTestFakeKeyEvent(self._display, key, is_down, ctypes.c_ulong(0))
        self._flush()

    def type(self, text):
        for letter in text:
            self.key(_NAMES.get(letter, letter))

    def place(self):
        """Where the pointer is."""
        root, child = ctypes.c_ulong(), ctypes.c_ulong()
        numbers = [ctypes.c_int() for _ in range(4)]
        mask = ctypes.c_uint()
        window = self._x11.XDefaultRootWindow
        window.restype = ctypes.c_ulong
        asked = (root, child, *numbers, mask)
        references = [ctypes.byref(value) for value in asked]
        self._x11.XQueryPointer(self._display, ctypes.c_ulong(window(self._display)), *references)
        return numbers[0].value, numbers[1].value

    def _code(self, name):
        return self._x11.XKeysymToKeycode(self._display, ctypes.c_ulong(self._symbol(name)))

    def _symbol(self, name):
        symbol = self._x11.XStringToKeysym(name.encode())
        if not symbol:
            raise ValueError(f"No key is called {name!r}.")
        return symbol

    def _needs_shift(self, name, code):
        plain, shifted = (
            self._x11.XkbKeycodeToKeysym(self._display, ctypes.c_uint(code), 0, level) for level in (0, 1)
        )
        return self._symbol(name) == shifted != plain

    def _flush(self):
        self._x11.XSync(self._display, 0)

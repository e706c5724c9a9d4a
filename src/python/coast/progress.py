"""How long a job will take, told while it runs."""

import sys
import time


class Silent:
    """Tells nothing."""

    def stage(self, what, fraction):
        pass

    def say(self, line):
        pass

    def warn(self, line):
        pass


class Bar(Silent):
    """One line that is written again and again, in a terminal or a notebook: stage, share, seconds left."""

    WIDTH = 24

    def __init__(self, stream=None):
        self._stream = stream or sys.stderr
        self._what, self._since, self._length = "", 0.0, 0

    def stage(self, what, fraction):
        if what != self._what:
            self._what, self._since = what, time.monotonic()
        elapsed = time.monotonic() - self._since
        left = f", {elapsed * (1.0 - fraction) / fraction:.0f} s left" if fraction > 0.02 and elapsed > 1.0 else ""
        done = round(self.WIDTH * fraction)
        self._show(f"{'#' * done}{'.' * (self.WIDTH - done)} {what}{left}")

    def close(self):
        if self._length:
            self._show("")
            self._stream.write("\r")

    def _show(self, line):
        self._stream.write("\r" + line.ljust(self._length))
        self._stream.flush()
        self._length = len(line)


class _Function(Silent):
    def __init__(self, function):
        self._function = function

    def stage(self, what, fraction):
        self._function(what, fraction)


def listener(progress):
    """None: a bar where somebody looks at it; True, False; a function of (stage, fraction); or an object with stage, say, warn."""
    if progress is None:
        progress = sys.stderr.isatty() or "ipykernel" in sys.modules
    if progress is True:
        return Bar()
    if progress is False:
        return Silent()
    return progress if hasattr(progress, "stage") else _Function(progress)

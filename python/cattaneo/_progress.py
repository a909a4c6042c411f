"""What progress=True shows."""

import sys
import time


class Line:
    """A line on stderr that is overwritten, shown after the first second of work."""

    def __init__(self):
        self.shown = 0.0

    def __call__(self, progress):
        done = progress.share == 1
        if progress.seconds < 1 or (not done and time.monotonic() - self.shown < 0.5):
            return
        self.shown = time.monotonic()
        text = f"{progress.steps} steps, {progress.seconds:.0f} s"
        if progress.share == progress.share and progress.share > 0:  # known
            left = progress.seconds * (1 / progress.share - 1)
            text += f", {100 * progress.share:.0f} %" + ("" if done else f", {left:.0f} s left")
        sys.stderr.write(f"\rcattaneo: {text:<60}" + ("\n" if done else ""))
        sys.stderr.flush()

"""What a process takes, by /proc, and whether that grows."""

import pathlib
import statistics
import time


def field_kb(text, name):
    return next(int(line.split()[1]) for line in text.splitlines() if line.startswith(name + ":"))


class Sample:
    def __init__(self, pid):
        status = pathlib.Path(f"/proc/{pid}/status").read_text(encoding="ascii")
        self.at = time.monotonic()
        self.rss_kb = field_kb(status, "VmRSS")
        self.own_kb = field_kb(status, "RssAnon")
        self.threads = field_kb(status, "Threads")
        self.descriptors = len(list(pathlib.Path(f"/proc/{pid}/fd").iterdir()))


def slope_per_hour(samples, of):
    """The median of the slopes between all pairs (Theil and Sen): single peaks do not move it."""
    slopes = [(of(b) - of(a)) / (b.at - a.at) for i, a in enumerate(samples) for b in samples[i + 1:] if b.at > a.at]
    return 3600.0 * statistics.median(slopes) if slopes else 0.0


def growth(samples, of):
    """From the median of the first third to that of the last one."""
    third = max(1, len(samples) // 3)
    return statistics.median(map(of, samples[-third:])) - statistics.median(map(of, samples[:third]))


def row(name, samples, of, unit):
    values = [of(s) for s in samples]
    return (f"{name:<22} {values[0]:>9.0f} {statistics.median(values):>9.0f} {max(values):>9.0f} {values[-1]:>9.0f} "
            f"{growth(samples, of):>+9.0f} {slope_per_hour(samples, of):>+10.0f} {unit}")


HEAD = f"{'in quiet, warmed up':<22} {'first':>9} {'median':>9} {'largest':>9} {'last':>9} {'growth':>9} {'per hour':>10}"

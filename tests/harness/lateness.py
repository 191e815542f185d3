"""How late the control loop woke, from /metrics."""

import re


def buckets_of(metrics):
    """Upper bound in us → wake-ups of the loop that were at most so late. @param metrics text of /metrics"""
    found = re.findall(r'^\S*lateness\S*_bucket\{le="([^"]+)"\} (\d+)', metrics, re.M)
    if not found:
        raise ValueError("no histogram of the loop's lateness in /metrics")
    return {float(bound) * 1e6: int(count) for bound, count in found}


def percentile_us(before, after, share):
    """Where this share of the wake-ups lies; between a bucket's bounds by straight line."""
    counts = sorted((bound, after[bound] - before.get(bound, 0)) for bound in after)
    total = counts[-1][1]
    if total <= 100:
        raise ValueError(f"only {total} wake-ups")
    below, below_count = 0.0, 0
    for bound, count in counts:
        if count >= share * total:
            return below + (bound - below) * (share * total - below_count) / (count - below_count)
        below, below_count = bound, count
    return counts[-1][0]

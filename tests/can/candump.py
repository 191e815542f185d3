"""Reads a log of `candump -L` and says what the robot's bus carried; the judge of the CAN test.

    (1700000000.123456) vcan0 111#0096000000000000
"""

import re
import struct
from typing import NamedTuple

LINE = re.compile(r"^\((\d+\.\d+)\) (\S+) ([0-9A-F]{3})#((?:[0-9A-F]{2}){0,8})$")
# Extended ids, remote and FD frames: on the bus, but not what the robot and its base say.
OTHER = re.compile(r"^\(\d+\.\d+\) \S+ (?:[0-9A-F]{3}|[0-9A-F]{8})#(?:R\d?|#[0-9A-F]*|[0-9A-F]*)$")


class Frame(NamedTuple):
    time_s: float
    id: int
    data: bytes


def read(path):
    """Every whole line; the last one may still be in writing."""
    frames = []
    with open(path, encoding="ascii", errors="replace") as log:
        for number, line in enumerate(log, 1):
            if not line.endswith("\n"):
                break
            match = LINE.match(line.rstrip("\n"))
            if not match and OTHER.match(line.rstrip("\n")):
                continue
            if not match:
                raise ValueError(f"{path}:{number}: not a line of candump -L: {line!r}")
            frames.append(Frame(float(match[1]), int(match[3], 16), bytes.fromhex(match[4])))
    return frames


def only(frames, frame_id, begin_s=0.0, end_s=float("inf")):
    return [f for f in frames if f.id == frame_id and begin_s <= f.time_s <= end_s]


def motion(frame):
    """0x111 and 0x221: linear m/s, angular rad/s."""
    linear, angular = struct.unpack(">hh", frame.data[:4])
    return linear / 1000.0, angular / 1000.0


def moves(frame):
    return any(frame.data[:4])


def odometer_m(frame):
    """0x311: left and right track."""
    left, right = struct.unpack(">ii", frame.data)
    return left / 1000.0, right / 1000.0


def state(frame):
    """0x211: vehicle state, control mode, battery V, error code."""
    vehicle, mode, battery, errors = struct.unpack(">BBHH", frame.data[:6])
    return vehicle, mode, battery / 10.0, errors


def longest_gap_s(frames):
    return max((b.time_s - a.time_s for a, b in zip(frames, frames[1:])), default=float("inf"))

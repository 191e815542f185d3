#!/usr/bin/env python3
"""Sends depth images to roverd (docs/cloud-format.md): cloud_sender.py HOST PORT [IMAGES]

This one makes its images up: a wall 3 m ahead and a post 1.5 m ahead. Put your camera's in its place.
"""
import array
import socket
import struct
import sys
import time
import zlib

WIDTH, HEIGHT, FX, FY, CX, CY = 160, 120, 131.25, 131.25, 79.5, 59.5
DEPTH = 2  # 1 cloud, 2 depth image, 3 planar ranges


def image():
    """Row by row from the upper left, millimetres along the optical axis, 0: nothing seen."""
    return [1500 if 70 <= u < 90 else 3000 for _ in range(HEIGHT) for u in range(WIDTH)]


def frame(kind, body, sequence, flags=0, pose=(0.0,) * 6):
    head = struct.pack("<4sBBHqII6fI", b"RVSC", 1, kind, flags, time.monotonic_ns(), sequence,
                       len(body), *pose, zlib.crc32(body))
    return head + struct.pack("<I", zlib.crc32(head)) + body


with socket.create_connection((sys.argv[1], int(sys.argv[2]))) as roverd:
    for number in range(int(sys.argv[3]) if len(sys.argv) > 3 else 1 << 32):
        pixels = array.array("H", image())  # little endian on all that roverd runs on
        head = struct.pack("<HHfffff", WIDTH, HEIGHT, FX, FY, CX, CY, 0.001)
        roverd.sendall(frame(DEPTH, head + pixels.tobytes(), number))
        time.sleep(0.1)

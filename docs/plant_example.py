#!/usr/bin/env python3
"""A plant of somebody else for `roverd study --plant`: one JSON line in, one out, 100 Hz.

Tracks that lag and slide downhill to the south, a gyro with a bias, and an RTK receiver five times
a second. What is not told (here the compass) roverd makes of the true pose.
"""

import json
import math
import random
import sys

SLIDE = 0.03        # of the way, southwards
GYRO_BIAS = 0.004   # rad/s
LAG_S = 0.15


def main():
    hello = json.loads(sys.stdin.readline())
    noise = random.Random(hello["seed"])
    dt, width = hello["dt_s"], hello["track_width_m"]
    east = north = speed = turn = 0.0
    yaw = math.radians(90.0 - hello["heading_deg"])
    steps = 0

    def tell(**more):
        print(json.dumps({
            "east_m": east, "north_m": north, "heading_deg": math.degrees(math.pi / 2 - yaw) % 360.0,
            "speed_mps": speed, "yaw_rate_radps": turn,
            "left_mps": speed - turn * width / 2, "right_mps": speed + turn * width / 2,
            "gyro_radps": turn + GYRO_BIAS + noise.gauss(0.0, 0.002), **more}), flush=True)

    tell(own_gnss=True)
    for line in sys.stdin:
        order = json.loads(line)
        steps += 1
        wanted = (0.0, 0.0) if order["brake"] else (order["speed_mps"], order["yaw_rate_radps"])
        speed += (wanted[0] - speed) * dt / LAG_S
        turn += (wanted[1] - turn) * dt / LAG_S
        yaw = math.remainder(yaw + turn * dt, 2.0 * math.pi)
        east += speed * math.cos(yaw) * dt
        north += (speed * math.sin(yaw) - SLIDE * abs(speed)) * dt
        if steps % 20:
            tell()
            continue
        fix = {"fix": "rtk_fixed", "sigma_m": 0.014, "speed_mps": abs(speed),
               "east_m": east + noise.gauss(0.0, 0.01), "north_m": north + noise.gauss(0.0, 0.01)}
        if abs(speed) > 0.1:
            fix["course_deg"] = (math.degrees(math.pi / 2 - yaw) + (180.0 if speed < 0 else 0.0)) % 360.0
        tell(gnss=fix)


if __name__ == "__main__":
    main()

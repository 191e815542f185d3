#!/usr/bin/env python3
"""A plant of somebody else for `roverd study --plant`: one JSON line in, one out, 100 Hz.

Tracks that lag and slide downhill to the south, a gyro with a bias, and an RTK receiver five times
a second, whose positions come 0.12 s late, as roverd assumes (nav.estimate.gnss_latency_s). What is
not told (here the compass) roverd makes of the true pose.
"""

import json
import math
import random
import sys

SLIDE = 0.03        # of the way, southwards
GYRO_BIAS = 0.004   # rad/s
LAG_S = 0.15
EVERY, LATE = 20, 12  # steps of 10 ms


def main():
    hello = json.loads(sys.stdin.readline())
    noise = random.Random(hello["seed"])
    dt, width = hello["dt_s"], hello["track_width_m"]
    east = north = speed = turn = 0.0
    yaw = math.radians(90.0 - hello["heading_deg"])
    steps = 0
    fix = {}

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
        east_mps = speed * math.cos(yaw)
        north_mps = speed * math.sin(yaw) - SLIDE * abs(speed)
        east += east_mps * dt
        north += north_mps * dt
        if steps % EVERY == 0:
            over_ground = math.hypot(east_mps, north_mps)
            fix = {"fix": "rtk_fixed", "sigma_m": 0.014, "speed_mps": over_ground,
                   "east_m": east + noise.gauss(0.0, 0.01), "north_m": north + noise.gauss(0.0, 0.01)}
            if over_ground > 0.1:  # where it goes, not where it points
                fix["course_deg"] = math.degrees(math.atan2(east_mps, north_mps)) % 360.0
        if steps % EVERY == LATE and fix:
            tell(gnss=fix)
        else:
            tell()


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Recordings of real receivers, read by roverd and by gpsd's gpsdecode: the same track comes out,
within the digits of the format.

The recordings are not part of this repository: their folder is named by ROVERD_REAL_DATA. A missing
file is a skipped test, and with CI=true a failed one.
"""

import json
import os
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "harness"))
from station import BIN, check, run_cases  # noqa: E402

FOLDER = pathlib.Path(os.environ.get("ROVERD_REAL_DATA", ""))
# gpsdecode prints degrees with nine decimals, metres and metres a second with three or four.
DEGREES, METRES, SPEED = 0.51e-9, 0.51e-3, 0.51e-3


def lines_of(*command, file=None):
    with open(file or os.devnull, "rb") as stdin:
        done = subprocess.run(command, stdin=stdin, stdout=subprocess.PIPE,
                              stderr=subprocess.DEVNULL, timeout=120, check=True)
    return [json.loads(line) for line in done.stdout.splitlines() if line.startswith(b"{")]


def our_words(file):
    """What roverd reads: by time of day (ms) every position, height and speed it was told."""
    told = {}
    for kind in ("nmea", "ubx"):
        for word in lines_of(BIN / "roverd", "decode", kind, file):
            if word.get("sentence") in ("GGA", "RMC", "GNS") and word["time_s"] is not None:
                at = told.setdefault(round(word["time_s"] * 1000) % 86_400_000, {})
                at.setdefault("places", set()).add((word["lat"], word["lon"]))
                at.setdefault("heights", set()).add(word.get("alt_msl_m"))
                at.setdefault("speeds", set()).add(word.get("speed_mps"))
            elif word.get("message") == "NAV-PVT" and word.get("usable"):
                clock = word["hour"] * 3600 + word["min"] * 60 + word["sec"] + word["nano"] / 1e9
                at = told.setdefault(round(clock * 1000) % 86_400_000, {})
                at.setdefault("places", set()).add((word["lat"], word["lon"]))
                at.setdefault("heights", set()).add(word["hMSL"])
                at.setdefault("speeds", set()).add(word["gSpeed"])
    return told


def near(value, all_values, limit):
    return any(v is not None and abs(value - v) <= limit for v in all_values)


def compare(name, at_least):
    file = FOLDER / name
    told = our_words(file)
    compared = heights = speeds = 0
    for report in lines_of("gpsdecode", file=file):
        if report.get("class") != "TPV" or "lat" not in report or "time" not in report:
            continue
        h, m, s = report["time"][11:-1].split(":")
        clock_ms = round((int(h) * 3600 + int(m) * 60 + float(s)) * 1000) % 86_400_000
        at = told.get(clock_ms)
        check(at, f"{name}: gpsd tells of {report['time']}, roverd does not")
        check(any(lat is not None and abs(lat - report["lat"]) <= DEGREES
                  and abs(lon - report["lon"]) <= DEGREES for lat, lon in at["places"]),
              f"{name} at {report['time']}: gpsd says {report['lat']}, {report['lon']}; "
              f"roverd {sorted(at['places'], key=str)}")
        compared += 1
        # A sentence of the same epoch may tell it a moment later, or not at all.
        if "altMSL" in report and near(report["altMSL"], at["heights"], METRES):
            heights += 1
        if "speed" in report and near(report["speed"], at["speeds"], SPEED):
            speeds += 1
    check(compared >= at_least, f"{name}: only {compared} positions compared")
    check(heights >= 0.9 * compared, f"{name}: {heights} heights of {compared} agree")
    print(f"     {name}: {compared} positions, {heights} heights, {speeds} speeds agree")


def moving_receiver():
    """gnss-haicom-moving.log: roverd and gpsd read the same track"""
    compare("gnss-haicom-moving.log", 20)


def rtk_receiver():
    """gnss-nmea-rtk.log: roverd and gpsd read the same track"""
    compare("gnss-nmea-rtk.log", 100)


def mixed_receiver():
    """gnss-zed-f9p-ubx-nmea.log: roverd and gpsd read the same track"""
    compare("gnss-zed-f9p-ubx-nmea.log", 500)


CASES = {
    "gnss-haicom-moving.log": moving_receiver,
    "gnss-nmea-rtk.log": rtk_receiver,
    "gnss-zed-f9p-ubx-nmea.log": mixed_receiver,
}

if __name__ == "__main__":
    here = []
    for name, case in CASES.items():
        if (FOLDER / name).is_file():
            here.append(case)
        else:
            print(f"skip - {case.__doc__}: {FOLDER / name} is missing")
    sys.exit(run_cases(here))

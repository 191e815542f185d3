#!/usr/bin/env python3
"""roverd beside a real gpsd, which gpsfake feeds with a recording."""

import os
import pathlib
import signal
import socket
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "harness"))
from station import BIN, ROOT, Program, Rest, check, run_cases, until  # noqa: E402

START = (58.378, 26.728)


def sentence(body):
    total = 0
    for byte in body.encode():
        total ^= byte
    return f"${body}*{total:02X}\r\n"


def arc(degrees, width):
    return f"{int(degrees):0{width}d}{(degrees - int(degrees)) * 60:010.7f}"


def recording():
    """Ten minutes of an RTK receiver that goes north at 0.56 m/s, five epochs a second."""
    text = ""
    for i in range(3000):
        clock = f"12{i // 300 % 60:02d}{i / 5 % 60:05.2f}"
        place = f"{arc(START[0] + i * 1e-6, 2)},N,{arc(START[1], 3)},E"
        text += sentence(f"GNGGA,{clock},{place},4,12,0.7,62.500,M,18.400,M,1.0,0001")
        text += sentence(f"GNRMC,{clock},A,{place},1.080,0.00,180326,,,R")
        text += sentence(f"GNGST,{clock},0.02,0.02,0.01,0.0,0.015,0.012,0.03")
        if i % 5 == 0:
            text += sentence("GNGSA,A,3,05,12,,,,,,,,,,,1.2,0.7,1.0,1")
            text += sentence("GPGSV,1,1,03,05,45,120,41,12,30,200,38,20,10,300,,1")
    return text


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def used_satellites(rest):
    receivers = rest.get("/gnss/satellites")["receivers"]
    return {s["number"]: s["used"] for s in receivers[0]["satellites"]} if receivers else {}


def gpsd_is_a_receiver():
    """gpsd://127.0.0.1:PORT gives position, accuracy, fix class and satellites; and waits for gpsd"""
    port = free_port()
    with tempfile.TemporaryDirectory(prefix="roverd-gpsd.") as folder:
        log = pathlib.Path(folder) / "receiver.nmea"
        log.write_text(recording(), encoding="ascii")
        roverd = Program(BIN / "roverd", "--config", ROOT / "config/robot.toml", "--data", folder,
                         "--port", "0", "--set", "drivers.bunker.enabled=false",
                         "--set", "drivers.mti.enabled=false",
                         "--set", f"drivers.gnss.link=gpsd://127.0.0.1:{port}")
        gpsd = None
        try:
            rest = Rest(roverd.wait_line(r"^listening on (http://\S+)")[1])
            until("a gpsd that is not there is told", 20,
                  lambda: rest.get("/drivers/gnss")["state"] == "faulty")
            gpsd = subprocess.Popen(["gpsfake", "-q", "-c", "0.02", "-P", str(port), log],
                                    stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                    start_new_session=True)
            until("the receiver is up", 30, lambda: rest.get("/drivers/gnss")["state"] == "up")
            until("a fix", 20, lambda: rest.get("/vehicle")["gnss"]["fix"] == "rtk_fixed")
            gnss = rest.get("/vehicle")["gnss"]
            check(abs(gnss["lat"] - START[0]) < 0.004, f"lat {gnss['lat']}")
            check(abs(gnss["lon"] - START[1]) < 2e-8, f"lon {gnss['lon']}")
            until("an accuracy from GST", 10,
                  lambda: rest.get("/vehicle")["gnss"]["horizontal_accuracy_m"] == 0.015)
            # gpsd may tell the sky once before it has heard which satellites are used.
            until("a sky with the used satellites", 20, lambda: used_satellites(rest) == {
                5: True, 12: True, 20: False})
            driver = rest.get("/drivers/gnss")
            check(driver["refused"] == 0, f"refused: {driver['counts']}")
            check(driver["facts"]["gpsd"].startswith("3."), f"facts: {driver['facts']}")
            os.killpg(gpsd.pid, signal.SIGTERM)
            gpsd.wait(20)
            gpsd = None
            until("its end is told", 20, lambda: rest.get("/drivers/gnss")["state"] == "faulty")
        finally:
            if gpsd:
                os.killpg(gpsd.pid, signal.SIGKILL)
            roverd.stop(signal.SIGINT)


def a_wrong_address_is_named():
    """a gpsd address that is none refuses to start, naming the key"""
    done = subprocess.run([BIN / "roverd", "--config", ROOT / "config/robot.toml", "--data",
                           tempfile.gettempdir(), "--port", "0", "--set",
                           "drivers.bunker.enabled=false", "--set",
                           "drivers.gnss.link=gpsd://:x"], capture_output=True, text=True,
                          timeout=20, check=False)
    check(done.returncode == 2, f"exit code {done.returncode}")
    check("gpsd://HOST[:PORT][/DEVICE]" in done.stderr, done.stderr)


if __name__ == "__main__":
    sys.exit(run_cases([gpsd_is_a_receiver, a_wrong_address_is_named]))

"""A simulated robot with sensors that look around, in a world of its own, and roverd that hears their bytes."""

import json
import os
import pathlib
import shutil
import socket
import tempfile

from station import BIN, ROOT, Control, Program, Rest, until

TOP_AND_FRONT = """
[[sensor]]
kind = "vlp16"
name = "top"
z_m = 0.7
port = "udp:{port}"

[[sensor]]
kind = "lms"
name = "front"
x_m = 0.55
z_m = 0.3
rate_hz = 50
"""
# Beside it no sensor sees the ground: it may turn there slowly.
HEARS_TOP_AND_FRONT = """
[sense.protect]
creep_turn_radps = 0.3

[sensors.top]
kind = "velodyne"
link = "udp:{port}"
z_m = 0.7

[sensors.front]
kind = "sick"
link = "{front}"
x_m = 0.55
z_m = 0.3
rate_hz = 50
"""


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class SeeingRobot:
    """@param world of config/worlds' form. @param eyes of roverd-sim's configuration, with {port} for a free
    one. @param hears of roverd's, with {port}, {front} (the scanner's address; {at_front}, {at_eye}: without "tcp:") and {folder} (`scratch`).
    @param vehicle one of config/sim"""

    def __init__(self, world, eyes=TOP_AND_FRONT, hears=HEARS_TOP_AND_FRONT, sim=(), vehicle="bunker"):
        self.vehicle = vehicle
        self.scratch = pathlib.Path(tempfile.mkdtemp(prefix="roverd-seeing."))
        self.sim = self.roverd = self.control = None
        try:
            self.begin(world, eyes, hears, sim)
        except BaseException:
            self.close()
            raise

    def begin(self, world, eyes, hears, sim):
        port = free_port()
        (self.scratch / "world.json").write_text(json.dumps(world))
        (self.scratch / "sim.toml").write_text((ROOT / f"config/sim/{self.vehicle}.toml").read_text()
                                               + eyes.format(port=port))
        self.sim = Program(BIN / "roverd-sim", "--cansock", self.scratch / "can", "--gnss", "tcp:0",
                           "--control", "0", "--seed", "1", "--config", self.scratch / "sim.toml",
                           "--world", self.scratch / "world.json", *sim)
        try:  # devices are computers of their own: a busy machine must not make them silent
            os.setpriority(os.PRIO_PROCESS, self.sim.process.pid, -15)
        except PermissionError:
            pass
        at = dict(word.split("=", 1) for word in self.sim.wait_line(r"^ready (.*)$")[1].split())
        self.control = Control(at["control"])
        self.prepare()
        shutil.copytree(ROOT / "config/vehicles", self.scratch / "vehicles")
        config = self.scratch / "robot.toml"
        config.write_text((ROOT / "config/robot.toml").read_text()
                          + hears.format(port=port, front=at.get("front", ""), folder=self.scratch,
                                         at_front=at.get("front", "").removeprefix("tcp:"),
                                         at_eye=at.get("eye", "").removeprefix("tcp:")))
        links = [f"drivers.{'bunker' if name == 'can' else name}.link={link}" for name, link in at.items()
                 if name in ("can", "gnss", "mti", "ackermann")]
        self.roverd = Program(BIN / "roverd", "--config", config, "--data", self.scratch / "data",
                              "--port", "0", "--vehicle", self.vehicle,
                              *(word for link in links for word in ("--set", link)))
        self.rest = Rest(self.roverd.wait_line(r"^listening on (https?://\S+)")[1])

    def prepare(self):
        """What is to be so before roverd starts."""

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        if self.control:
            self.control.close()
        try:
            if self.roverd:
                self.roverd.stop()
        finally:
            if self.sim:
                self.sim.stop()
            shutil.rmtree(self.scratch, ignore_errors=True)

    def truth(self):
        return self.control.ask({"get": "truth"})

    def sees(self, *names):
        """Waits until all of its sensors, that are these, are good."""
        until("its sensors see", 20, lambda: sorted(
            (s["name"], s["health"]) for s in self.rest.get("/sensors")["items"])
            == [(name, "good") for name in sorted(names)], 0.2)

    def start(self, mission):
        """Loads, arms and starts it. @param mission as the API gave it back"""
        # Its map begins with the first position, and what was loaded for another one is refused.
        until("it is ready", 30, lambda: self.rest.get("/vehicle")["ready_to_arm"], 0.2)
        self.rest.do("POST", "/execution/load", {"mission_id": mission["id"]})
        self.rest.do("POST", "/vehicle/arm", {})
        self.rest.do("POST", "/execution/start",
                     {"mission_id": mission["id"], "revision": mission["revision"]})

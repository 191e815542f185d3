#!/usr/bin/env python3
"""Bad input where the robot sees: roverd hears sensors that send what no sensor should. Each is refused with
its reason and counted, nothing falls, and what is good is used."""

import math
import pathlib
import shutil
import socket
import struct
import sys
import tempfile
import threading
import time
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "harness"))
from station import BIN, ROOT, Program, Rest, check, run_cases, until  # noqa: E402


def free_port(kind=socket.SOCK_DGRAM):
    with socket.socket(socket.AF_INET, kind) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Robot:
    """roverd with the sensors of a text and no other device."""

    def __init__(self, sensors):
        self.scratch = pathlib.Path(tempfile.mkdtemp(prefix="roverd-bad-sight."))
        shutil.copytree(ROOT / "config/vehicles", self.scratch / "vehicles")
        config = self.scratch / "robot.toml"
        config.write_text((ROOT / "config/robot.toml").read_text() + sensors)
        off = [word for name in ("bunker", "gnss", "mti")
               for word in ("--set", f"drivers.{name}.enabled=false")]
        self.program = Program(BIN / "roverd", "--config", config, "--data", self.scratch / "data",
                               "--port", "0", *off)

    def __enter__(self):
        self.rest = Rest(self.program.wait_line(r"^listening on (https?://\S+)")[1])
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        self.program.stop()
        shutil.rmtree(self.scratch, ignore_errors=True)

    def sensor(self):
        items = self.rest.get("/sensors")["items"]
        return items[0] if items else {}

    def counts(self, name="eye"):
        return self.rest.get(f"/drivers/{name}")["counts"]

    def resident_kb(self):
        for line in pathlib.Path(f"/proc/{self.program.process.pid}/status").read_text().splitlines():
            if line.startswith("VmHWM:"):
                return int(line.split()[1])
        return 0


def told(robot, what, fits):
    """@return the sensor, once it is as that says"""
    return until(f"{what}: {robot.sensor()}", 10, lambda: (lambda s: s if s and fits(s) else None)(
        robot.sensor()), 0.1)


# ---- a lidar

class Lidar:
    """A head that turns ten times a second; things stand 5 m around it."""

    def __init__(self, port):
        self.to = ("127.0.0.1", port)
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.azimuth = 0.0
        self.us = 1_000_000.0

    def next(self, product=0x22, step=40):
        out = b""
        for block in range(12):
            azimuth = int(self.azimuth + block * step) % 36000
            out += struct.pack("<HH", 0xEEFF, azimuth) + struct.pack("<HB", 2500, 40) * 32
        out += struct.pack("<IBB", int(self.us) % 3_600_000_000, 0x37, product)
        self.azimuth = (self.azimuth + 12 * step) % 36000
        self.us += 1327.104
        return out

    def send(self, packet):
        self.socket.sendto(packet, self.to)

    def turn(self, turns=1.0):
        for _ in range(int(75 * turns)):
            self.send(self.next())
            time.sleep(0.0011)


LIDAR = """
[sensors.eye]
kind = "velodyne"
link = "udp:{port}:127.0.0.1:{peer}"
z_m = 0.6
"""


def packets_of_all_kinds():
    """cut, damaged, foreign, doubled, reordered and lost packets are counted, each as what it is"""
    port = free_port()
    with Robot(LIDAR.format(port=port, peer=(peer := free_port()))) as robot:
        head = Lidar(port)
        head.socket.bind(("127.0.0.1", peer))
        head.turn(4)
        before = told(robot, "it is seen", lambda s: s["points"] > 1000)
        check((before["malformed"], before["foreign"]) == (0, 0), f"nothing was wrong: {before}")
        packet = head.next()
        head.send(packet[:1205])
        head.send(packet + b"\0")
        head.send(packet[:300] + b"\xff\xdd" + packet[302:])
        head.send(head.next(product=0x28))
        head.send(b"")
        head.turn(0.2)
        twice, late = head.next(), head.next()
        head.send(twice)
        head.send(twice)
        head.send(head.next())
        head.send(late)
        for _ in range(7):
            head.next()  # lost
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as stranger:
            for _ in range(9):
                stranger.sendto(packet, head.to)
        head.turn(2)
        seen = told(robot, "all is counted", lambda s: s["foreign"] >= 9 and s["duplicates"] >= 1)
        check(4 <= seen["malformed"] <= 5, f"refused were four and an empty one: {seen}")
        check(seen["duplicates"] == 1, f"one came twice: {seen}")
        check(seen["lost"] - before["lost"] >= 7, f"seven were lost: {seen}")
        check(seen["malformed_last"] is not None, f"and why is told: {seen}")
        counts = robot.counts()
        for what in ("block 3 does not begin with FF EE", "a datagram that has not 1206 bytes",
                     "packets late", "from a foreign address"):
            check(counts.get(what, 0) > 0, f"{what}: {counts}")
        check(any("VLP-32C" in what for what in counts), f"the other lidar is named: {counts}")
        check(robot.sensor()["health"] != "silent", "what is good is used")


def the_sensors_clock_jumps():
    """a lidar whose clock is set, ahead or back, is heard on, and each jump is counted"""
    port = free_port()
    with Robot(LIDAR.format(port=port, peer=(peer := free_port()))) as robot:
        head = Lidar(port)
        head.socket.bind(("127.0.0.1", peer))
        head.turn(4)
        told(robot, "it is seen", lambda s: s["points"] > 1000)
        for by_us in (600e6, -1200e6, 3_599e6):
            head.us = (head.us + by_us) % 3_600e6
            head.turn(2)
        until(f"three jumps are counted: {robot.counts()}", 5,
              lambda: robot.counts().get("jumps of the sensor's clock") == 3)
        seen = robot.sensor()
        head.turn(1)
        check(seen["age_s"] < 1.0 and seen["points"] > 1000, f"it is seen as before: {seen}")


# ---- clouds

def frame(kind, sequence, body, stamp_ns=None, pose=None, crc=None, size=None):
    flags = 1 if pose else 0
    head = struct.pack("<4sBBHqII6f", b"RVSC", 1, kind, flags,
                       time.monotonic_ns() if stamp_ns is None else stamp_ns, sequence,
                       len(body) if size is None else size, *(pose or [0.0] * 6))
    head += struct.pack("<I", zlib.crc32(body) if crc is None else crc)
    return head + struct.pack("<I", zlib.crc32(head)) + body


def cloud(points, half_rad=0.005):
    return struct.pack("<If", len(points), half_rad) + b"".join(struct.pack("<3f", *p) for p in points)


def wall(n=400, at_m=3.0):
    return [(at_m, -2.0 + 4.0 * i / n, 0.1) for i in range(n)]


CLOUD = """
[sensors.eye]
kind = "cloud"
link = "listen:{port}"
z_m = 0.5
"""


class Camera:
    def __init__(self, robot, port):
        self.robot = robot
        until("its port listens", 10, lambda: self.connect(port))
        self.sequence = 0

    def connect(self, port):
        try:
            self.socket = socket.create_connection(("127.0.0.1", port), 5)
            return True
        except OSError:
            return False

    def send(self, kind=1, body=None, **more):
        self.sequence += 1
        self.socket.sendall(frame(kind, self.sequence, cloud(wall()) if body is None else body, **more))

    def good(self, n=4):
        for _ in range(n):
            self.send()
            time.sleep(0.05)


def clouds_that_are_none():
    """what is no number, no angle, no place for a camera, or damaged, is refused by its name"""
    port = free_port(socket.SOCK_STREAM)
    with Robot(CLOUD.format(port=port)) as robot:
        camera = Camera(robot, port)
        camera.good()
        told(robot, "it is seen", lambda s: s["points"] == 400)
        nan, inf = math.nan, math.inf
        # Of 400 points a quarter is none: they are unknown, the others are used.
        holes = [(nan, 0.0, 0.0), (inf, 1.0, 0.0), (0.0, 0.0, 0.0), (-inf, nan, 1e30)]
        camera.send(body=cloud(wall(300) + holes * 25))
        told(robot, "a cloud with holes is used", lambda s: s["points"] == 300)
        camera.send(3, struct.pack("<Iff", 4, -0.5, 0.3) + struct.pack("<4f", 0.0, nan, inf, -3.0))
        camera.send(body=cloud(wall(), half_rad=1e-9))
        camera.send(body=cloud(wall(), half_rad=nan))
        camera.send(body=cloud(wall()), pose=[0.1, 0.0, -0.8, 0.0, 0.0, 0.0])
        camera.send(crc=4711)
        camera.socket.sendall(b"GET / HTTP/1.1\r\n\r\n")
        camera.good(3)
        # Two half angles, a pose, a CRC; and bytes that belong to nothing.
        seen = told(robot, "it is seen on", lambda s: s["points"] == 400 and s["malformed"] >= 5)
        check(seen["malformed"] <= 6, f"bytes are not counted one by one: {seen}")
        counts = robot.counts()
        for what, n in (("half_step_rad of a cloud must be 0 or lie in 0.0001 .. 0.2", 2),
                        ("a pose that puts the camera into the ground", 1)):
            check(counts.get(what) == n, f"{what}: {counts}")
        check(any("CRC" in what for what in counts), f"the damaged body is told: {counts}")
        check(seen["malformed_last"] is not None and seen["malformed_age_s"] < 10, f"why: {seen}")


def stamps_that_jump():
    """a camera whose clock goes back or far ahead is heard on"""
    port = free_port(socket.SOCK_STREAM)
    with Robot(CLOUD.format(port=port)) as robot:
        camera = Camera(robot, port)
        camera.good()
        now = time.monotonic_ns()
        for off_s in (0, -3600, -3599.9, 86400 * 365, 0.1):
            camera.send(stamp_ns=max(0, int(now + off_s * 1e9)))
            time.sleep(0.05)
        camera.send(stamp_ns=2**62 + 10)
        camera.good()
        seen = told(robot, "it is seen", lambda s: s["points"] == 400 and s["malformed"] == 1)
        check(seen["malformed_last"] == "a stamp that is none", f"why: {seen}")
        check(robot.counts().get("stamps that go back", 0) >= 2, f"counted: {robot.counts()}")
        check(seen["age_s"] < 1.0, f"and as new as it is: {seen}")


def ten_million_points():
    """a cloud of ten million points is let by, not kept, and what comes after it is used"""
    port = free_port(socket.SOCK_STREAM)
    with Robot(CLOUD.format(port=port)) as robot:
        camera = Camera(robot, port)
        camera.good()
        told(robot, "it is seen", lambda s: s["points"] == 400)
        before_kb = robot.resident_kb()
        count = 10_000_000
        head = struct.pack("<If", count, 0.005)
        piece = struct.pack("<3f", 1.0, 0.0, 0.2) * 100_000
        body_crc = zlib.crc32(head)
        for _ in range(count // 100_000):
            body_crc = zlib.crc32(piece, body_crc)
        camera.sequence += 1
        camera.socket.sendall(frame(1, camera.sequence, b"", crc=body_crc, size=len(head) + 12 * count))
        camera.socket.sendall(head)
        for _ in range(count // 100_000):
            camera.socket.sendall(piece)
        camera.good()
        seen = told(robot, "what comes after it", lambda s: s["points"] == 400 and s["malformed"] == 1)
        check("1000000 points" in seen["malformed_last"] or "points" in seen["malformed_last"],
              f"why: {seen}")
        grown_kb = robot.resident_kb() - before_kb
        check(grown_kb < 40_000, f"it grew by {grown_kb} kB")


# ---- a scanner

class Scanner:
    """An LMS that speaks CoLa A; it says yes to all, and is turned by the test."""

    def __init__(self):
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        self.step_e4deg, self.count = 5000, 0
        self.special = {}
        self.hz = 25
        self.us = 5_000_000
        self.stopped = False
        self.thread = threading.Thread(target=self.serve, daemon=True)
        self.thread.start()

    def telegram(self):
        beams = 2_700_000 // self.step_e4deg + 1
        values = [self.special.get(i, 4000) for i in range(beams)]
        self.count += 1
        self.us += 1_000_000 // self.hz
        words = ["sSN LMDscandata 1 1 114097A 0 0"] + [f"{n:X}" for n in (self.count, self.count)]
        words += [f"{n:X}" for n in (self.us, self.us + 20_000)]
        words += ["0 0", "0 0", "0", f"{self.hz * 100:X}", "168", "0", "1", "DIST1", "3F800000", "00000000",
                  "FFF92230", f"{self.step_e4deg:X}", f"{beams:X}"]
        words += [f"{v:X}" for v in values]
        return (" ".join(words) + " 0 0 0 0 0 0").encode()

    def serve(self):
        client, _ = self.listener.accept()
        client.settimeout(0.02)
        try:
            self.speak(client)
        except OSError:
            pass  # it went

    def speak(self, client):
        subscribed, waiting, due = False, b"", time.monotonic()
        while not self.stopped:
            try:
                waiting += client.recv(4096)
            except TimeoutError:
                pass
            while b"\x03" in waiting:
                said, waiting = waiting.split(b"\x03", 1)
                said = said.lstrip(b"\x02")
                kind, name = said.split(b" ")[:2]
                if name == b"LMDscandata" and kind == b"sEN":
                    subscribed = True
                    answer = b"sEA LMDscandata 1"
                elif name == b"STlms":
                    answer = b"sRA STlms 7 0 8 00:00:00 8 01.01.1970 0 0 0"
                elif name == b"DeviceIdent":
                    answer = b"sRA DeviceIdent A LMS1xx_SIM 4 V1.0"
                else:
                    answer = {b"sRN": b"sRA ", b"sMN": b"sAN ", b"sWN": b"sWA "}[kind] + name + b" 1"
                client.sendall(b"\x02" + answer + b"\x03")
            if subscribed and time.monotonic() >= due:
                due += 1.0 / self.hz
                client.sendall(b"\x02" + self.telegram() + b"\x03")


SCANNER = """
[sensors.eye]
kind = "sick"
link = "tcp:127.0.0.1:{port}"
z_m = 0.3
rate_hz = 25
"""


def a_scanner_changes_while_it_runs():
    """another resolution while it scans is told and used; ranges that are none are unknown"""
    scanner = Scanner()
    with Robot(SCANNER.format(port=scanner.port)) as robot:
        told(robot, "it is seen", lambda s: s["points"] == 541)
        scanner.step_e4deg = 2500
        told(robot, "with twice as many beams", lambda s: s["points"] == 1081 and s["health"] == "good")
        scanner.step_e4deg = 5000
        told(robot, "and again with half of them", lambda s: s["points"] == 541)
        until("both changes are counted", 5,
              lambda: robot.counts().get("scan of another shape than before") == 2)
        # 0: nothing came back; 1 to 15 are reserved: dazzled and the like.
        scanner.special = {i: i % 16 for i in range(0, 541, 2)}
        seen = told(robot, "much is missing", lambda s: s["unknown_part"] > 0.3)
        check(seen["health"] in ("degraded", "blind") and seen["reason"], f"and that is told: {seen}")
        scanner.special = {}
        told(robot, "it sees again", lambda s: s["health"] == "good")
    scanner.stopped = True


# ---- what the configuration says

def refused_at_the_start():
    """two sensors on one port, and a mounting inside the ground, are refused with file and line"""
    two = LIDAR.format(port=2368, peer=1) + LIDAR.format(port=2368, peer=2).replace("eye", "other")
    deep = CLOUD.format(port=5000).replace("z_m = 0.5", "z_m = -0.3")
    for text, words in ((two, ("sensors.other.link", "UDP port 2368", "sensors.eye.link")),
                        (deep, ("robot.toml:", "sensors.eye.z_m must lie in 0.02 .. 5"))):
        robot = Robot(text)
        try:
            check(robot.program.wait_exit(20) == 2, f"it does not start: {robot.program.said()}")
            for word in words:
                check(word in robot.program.said(), f"{word} is not in: {robot.program.said()}")
        finally:
            robot.close()


if __name__ == "__main__":
    sys.exit(run_cases([packets_of_all_kinds, the_sensors_clock_jumps, clouds_that_are_none,
                        stamps_that_jump, ten_million_points, a_scanner_changes_while_it_runs,
                        refused_at_the_start]))

#!/usr/bin/env python3
"""The stop always gets in and stays: in a full house, without descriptors or memory, over a kill.

Nothing here is judged by the clock, but for being in time at all: a stop that comes late is no stop."""

import base64
import json
import os
import pathlib
import signal
import socket
import struct
import sys
import time
import urllib.parse

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "harness"))
from station import Program, Rest, Station, check, reset_stop, run_cases, until  # noqa: E402

SOON_S = 2.0  # the machine may be busy; without what is tested here it takes 12 s or never comes


class Crowd:
    """Sockets that a test holds open."""

    def __init__(self, address):
        parts = urllib.parse.urlparse(address)
        self.place = (parts.hostname, parts.port)
        self.open = []

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for one in self.open:
            one.close()

    def connect(self):
        one = socket.create_connection(self.place, 10)
        one.settimeout(10)
        self.open.append(one)
        return one

    def half_open(self, number):
        for _ in range(number):
            try:
                self.connect().sendall(b"GET /api/v1/vehicle HTTP/1.1\r\nHost: localhost\r\nX-Slow: ")
            except OSError:
                self.open.pop().close()

    def websocket(self):
        """@return the socket; None if it was refused"""
        one = self.connect()
        one.sendall(b"GET /api/v1/stream HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\n"
                    b"Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: "
                    + base64.b64encode(os.urandom(16)) + b"\r\n\r\n")
        try:
            return one if b" 101 " in one.recv(4096).split(b"\r\n", 1)[0] else None
        except OSError:
            return None

    def websockets(self, number):
        return [one for one in (self.websocket() for _ in range(number)) if one]


def text_frame(message):
    text = json.dumps(message).encode()
    check(len(text) < 126, "a short message only")
    return struct.pack("!BB4s", 0x81, 0x80 | len(text), b"\0\0\0\0") + text


def armed(rest):
    until("the robot is armed", 60,
          lambda: rest.call("POST", "/vehicle/arm", {"valid_for_s": 5})[0] == 200, 0.3)


def stop(address):
    """One POST on a connection of its own. @return status and how long it took"""
    place = urllib.parse.urlparse(address)
    begin = time.monotonic()
    try:
        with socket.create_connection((place.hostname, place.port), SOON_S) as one:
            one.settimeout(SOON_S)
            one.sendall(b"POST /api/v1/vehicle/estop HTTP/1.1\r\nHost: localhost\r\n"
                        b"Content-Length: 0\r\n\r\n")
            answer = one.recv(65536)
            return int(answer.split(b" ", 2)[1]) if answer else 0, time.monotonic() - begin
    except (OSError, ValueError, IndexError):
        return 0, time.monotonic() - begin


def stops(address, what):
    status, took_s = stop(address)
    print(f"    {what}: {status} after {1000 * took_s:.0f} ms")
    check(status == 200, f"{what}: the stop is answered {status} after {took_s:.2f} s")


def again(station, *before):
    """Starts roverd with the same arguments. @param before a command that starts it"""
    arguments = station.roverd.process.args
    arguments = arguments[arguments.index(next(a for a in arguments if a.endswith("/roverd"))):]
    station.roverd = Program(*before, *arguments)
    station.address = station.roverd.wait_line(r"^listening on (http://\S+)")[1]
    station.rest = Rest(station.address)
    until("the robot is there", 20, lambda: station.rest.call("GET", "/vehicle")[0] == 200, 0.1)


def reset(rest):
    reset_stop(rest, {"valid_for_s": 5})


def in_a_house_full_of_half_headers():
    """700 connections with half a header do not keep a stop out"""
    with Station() as station, Crowd(station.address) as crowd:
        armed(station.rest)
        crowd.half_open(700)
        stops(station.address, "700 half headers")
        check(station.rest.get("/vehicle")["estop"], "it is not latched")


def in_a_house_full_of_streams():
    """600 streams do not keep a stop out, neither as a request nor on a new stream or an old one"""
    with Station() as station, Crowd(station.address) as crowd:
        armed(station.rest)
        streams = crowd.websockets(600)
        check(len(streams) >= 400, f"only {len(streams)} streams")
        stops(station.address, f"{len(streams)} streams")

        late = crowd.websocket()
        check(late, "no new stream is let in to stop")
        late.sendall(text_frame({"estop": True}))
        said = b""
        end = time.monotonic() + SOON_S
        while b'"estop"' not in said and time.monotonic() < end:
            said += late.recv(65536)
        check(b'"topic":"estop"' in said, f"the stop on a new stream is not confirmed: {said[:200]}")


def without_descriptors():
    """with 48 descriptors, all taken, a stop still gets in"""
    with Station() as station:
        station.roverd.stop()
        again(station, "prlimit", "--nofile=48:48")
        for what in ("half headers", "streams"):
            with Crowd(station.address) as crowd:
                armed(station.rest)
                if what == "streams":
                    crowd.websockets(60)
                else:
                    crowd.half_open(100)
                for _ in range(3):
                    stops(station.address, f"48 descriptors, {what}")
            until("there is room again", 30, lambda: station.rest.call("GET", "/vehicle")[0] == 200, 0.3)
            check(station.rest.get("/vehicle")["estop"], "it is not latched")
            reset(station.rest)


def over_a_kill():
    """a confirmed stop is latched after SIGKILL, a confirmed reset is not; a damaged or missing file counts
    as latched, and is told"""
    with Station() as station:
        file = station.scratch / "data" / "estop"
        until("the control loop has started", 20, lambda: station.rest.call("GET", "/vehicle")[0] == 200, 0.05)
        check(not station.rest.get("/vehicle")["estop"], "a new robot begins with its stop latched")
        for _ in range(5):
            armed(station.rest)
            station.rest.do("POST", "/vehicle/estop")
            station.roverd.process.kill()
            station.roverd.process.wait()
            again(station)
            check(station.rest.get("/vehicle")["estop"], "the stop did not survive a SIGKILL")
            check(station.rest.call("POST", "/vehicle/arm", {"valid_for_s": 5})[0] == 409, "it arms")
            events = station.rest.get("/events?level=error&limit=200")["items"]
            check(any(e["kind"] == "estop" and "before the program started" in e["detail"]
                      for e in events), f"nobody is told: {events}")
            reset(station.rest)
        until("the reset is kept", 5, lambda: b"released" in file.read_bytes())
        station.roverd.process.kill()
        station.roverd.process.wait()
        again(station)
        check(not station.rest.get("/vehicle")["estop"], "a released stop is latched after a SIGKILL")
        for damage, word in ((lambda: file.write_bytes(file.read_bytes()[:20]), "damaged"),
                             (lambda: file.write_bytes(b"\0" * 39), "damaged"),
                             (lambda: file.write_bytes(b""), "damaged"),
                             (file.unlink, "missing")):
            station.roverd.stop()
            damage()
            again(station)
            check(station.rest.get("/vehicle")["estop"], f"a {word} file counts as released")
            events = station.rest.get("/events?level=error&limit=200")["items"]
            check(any(e["kind"] == "estop" and word in e["detail"] for e in events), f"{events}")
            reset(station.rest)
            until("the reset is kept", 5, lambda: b"released" in file.read_bytes())


def without_memory():
    """a request for which there is no memory is refused, and the robot stays in hand"""
    with Station() as station:
        station.roverd.stop()
        again(station, "prlimit", f"--as={900 << 20}")
        armed(station.rest)
        points = ",".join("[%.7f,%.7f]" % (11.0 + i * 1e-7, 48.0) for i in range(400_000))
        large = ('{"type":"Feature","properties":{},"geometry":{"type":"LineString","coordinates":['
                 + points + "]}}").encode()
        for _ in range(4):
            status, _, body = station.rest.call("POST", "/missions/import?format=geojson", large,
                                                {"Content-Type": "application/geo+json"}, 120)
            check(status in (201, 413, 422, 503), f"it answers {status}: {body}")
            print(f"    an import of {len(large) >> 20} MB: {status}")
        check(station.roverd.process.poll() is None, "the program has ended")
        check(station.rest.get("/vehicle")["armed"], "it is not armed any more")
        stops(station.address, "after all that")


sys.exit(run_cases([in_a_house_full_of_half_headers, in_a_house_full_of_streams, without_descriptors,
                    over_a_kill, without_memory]))

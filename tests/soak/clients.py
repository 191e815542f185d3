#!/usr/bin/env python3
"""One client of the soak, until it is killed: clients.py ADDRESS KIND SEED. None of them drives."""

import base64
import http.client
import json
import os
import pathlib
import random
import select
import socket
import struct
import sys
import time
import urllib.parse

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "harness"))
from station import Rest  # noqa: E402

FORMATS = ("json", "geojson", "gpx", "kml", "csv", "waypoints", "plan")
PATHS = ("/health", "/vehicle", "/vehicle/trail", "/vehicle/checks", "/vehicle/capabilities", "/missions?limit=50",
         "/execution", "/runs", "/parameters", "/events?limit=200", "/drivers", "/fences", "/fence", "/tags", "/teach",
         "/gnss/satellites", "/metrics", "/openapi.json", "/missions/none", "/no/such/thing")


def connect(address):
    parts = urllib.parse.urlparse(address)
    one = socket.create_connection((parts.hostname, parts.port), 10)
    one.settimeout(10)
    return one


def text_frame(message):
    text = json.dumps(message).encode()
    return struct.pack("!BB4s", 0x81, 0x80 | len(text), b"\0\0\0\0") + text  # short ones only


def websocket(address, rate_hz):
    """A stream of everything; None: there is no room."""
    one = connect(address)
    one.sendall(b"GET /api/v1/stream HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
                b"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: " + base64.b64encode(os.urandom(16)) + b"\r\n\r\n")
    if b" 101 " not in one.recv(4096).split(b"\r\n", 1)[0]:
        return None
    one.sendall(text_frame({"subscribe": {"vehicle": rate_hz, "events": 1, "missions": 1, "execution": 1}}))
    return one


def page(address, chance):
    """Watches like a page, and says that it is there."""
    stream = websocket(address, chance.choice((5, 10, 20)))
    said = time.monotonic()
    while stream and (select.select([stream], [], [], 1.0)[0] == [] or stream.recv(65536)):
        if time.monotonic() - said > 0.5:
            stream.sendall(text_frame({"ping": 1}))
            said = time.monotonic()


def deaf(address, _chance):
    """Asks for everything and never reads."""
    streams = [websocket(address, 50) for _ in range(5)]
    time.sleep(60)
    del streams


def half(address, chance):
    """Headers without an end, bodies without an end."""
    held = []
    for _ in range(chance.randint(5, 60)):
        held.append(connect(address))
        held[-1].sendall(chance.choice((b"GET /api/v1/vehicle HTTP/1.1\r\nHost: localhost\r\nX-Slow: ", b"",
                                        b"POST /api/v1/missions HTTP/1.1\r\nHost: localhost\r\nContent-Type: "
                                        b"application/json\r\nContent-Length: 90000\r\n\r\n{\"name\": \"")))
        time.sleep(0.02)
    time.sleep(60)


def rude(address, chance):
    """Noise, and connections that are torn."""
    while True:
        one = connect(address)
        one.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        one.sendall(chance.choice((os.urandom(200), b"GET / HTTP/1.1\r\n\r\n", b"GET /api/v1/vehicle/trail HTTP/1.1\r\n"
                                   b"Host: localhost\r\n\r\n", b"GET /" + b"x" * 20000)))
        time.sleep(chance.random() * 0.05)
        one.close()
        time.sleep(0.1)


def caller(address, chance):
    """Reads whatever there is, on a connection that is kept."""
    connection = http.client.HTTPConnection(urllib.parse.urlparse(address).netloc, timeout=10)
    while True:
        connection.request("GET", "/api/v1" + chance.choice(PATHS))
        connection.getresponse().read()
        time.sleep(chance.random() * 0.1)


def line_of(points, chance):
    lat, lon = 58.4 + chance.random() * 0.01, 26.8
    places = [[lon + 1e-5 * i, lat + 1e-6 * chance.randint(0, 20)] for i in range(points)]
    return json.dumps({"type": "Feature", "properties": {}, "geometry": {
        "type": "LineString", "coordinates": places}}).encode()


def files(address, chance):
    """Imports, changes, exports in every format and deletes."""
    rest = Rest(address)
    while True:
        status, _, made = rest.call("POST", "/missions/import?format=geojson",
                                    line_of(chance.choice((10, 300, 3000)), chance),
                                    {"Content-Type": "application/geo+json"})
        for mission in made.get("missions", [made]) if status == 201 else []:
            for _ in range(3):
                rest.call("GET", f"/missions/{mission['id']}/export?format={chance.choice(FORMATS)}")
            rest.call("POST", f"/missions/{mission['id']}/check")
            rest.call("DELETE", f"/missions/{mission['id']}", headers={"If-Match": f'"rev-{mission["revision"]}"'})
        time.sleep(0.3)


KINDS = {"page": page, "deaf": deaf, "half": half, "rude": rude, "caller": caller, "files": files}


def main():
    address, kind, seed = sys.argv[1:]
    chance = random.Random(int(seed))
    while True:  # whatever the house does with them, they come again
        try:
            KINDS[kind](address, chance)
        except (OSError, http.client.HTTPException, ValueError):
            pass
        time.sleep(0.2)


if __name__ == "__main__":
    main()

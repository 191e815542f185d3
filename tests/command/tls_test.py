#!/usr/bin/env python3
"""roverd --tls before other people's programs: openssl, curl, Python; half handshakes, a full house, files.

Nothing here is judged by the clock, but for a stop being in time at all."""

import base64
import contextlib
import json
import os
import pathlib
import re
import resource
import socket
import ssl
import struct
import subprocess
import sys
import tempfile
import time
import urllib.parse

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "harness"))
from station import BIN, ROOT, Program, Station, check, run_cases, until  # noqa: E402

SOON_S = 3.0  # the machine may be busy; a stop that is kept out never comes
CLIENT_HELLO = b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03"  # the begin of one


def place_of(station):
    parts = urllib.parse.urlparse(station.address)
    return parts.hostname, parts.port


def secret(station, seconds=10, session=None, trust=None):
    """@return a TLS connection whose certificate was checked"""
    trust = trust or ssl.create_default_context(cafile=station.authority)
    plain = socket.create_connection(place_of(station), seconds)
    return trust.wrap_socket(plain, server_hostname="localhost", session=session)


def ran(*command, stdin=b""):
    done = subprocess.run([str(c) for c in command], input=stdin, capture_output=True, timeout=60)
    return done.returncode, done.stdout.decode(errors="replace") + done.stderr.decode(errors="replace")


def s_client(station, *options, stdin=b"Q\n"):
    host, port = place_of(station)
    return ran("openssl", "s_client", "-connect", f"{host}:{port}", "-CAfile", station.authority,
               "-verify_return_error", "-verify_ip", host, *options, stdin=stdin)


def get(path, host="localhost", method="GET"):
    return f"{method} {path} HTTP/1.1\r\nHost: {host}\r\nContent-Length: 0\r\n\r\n".encode()


def answer_of(one):
    """@return status, head, body of the next answer, which is the last"""
    said = b""
    with contextlib.suppress(OSError):
        while b"\r\n\r\n" not in said:
            piece = one.recv(65536)
            if not piece:
                break
            said += piece
        length = re.search(rb"(?i)content-length: (\d+)", said)
        while length and len(said.split(b"\r\n\r\n", 1)[1]) < int(length[1]):
            said += one.recv(65536)
    head, _, body = said.partition(b"\r\n\r\n")
    return int(head.split(b" ", 2)[1]) if head else 0, head.decode(), body


def stops(station, what):
    """A stop over TLS, on a connection of its own."""
    begin = time.monotonic()
    status = 0
    with contextlib.suppress(OSError):
        with secret(station, SOON_S) as one:
            one.sendall(get("/api/v1/vehicle/estop", method="POST"))
            status = answer_of(one)[0]
    took_s = time.monotonic() - begin
    print(f"    {what}: {status} after {1000 * took_s:.0f} ms")
    check(status == 200, f"{what}: the stop is answered {status} after {took_s:.2f} s")


def stream(station, trust=None):
    """@return the WebSocket's connection; None if it was refused"""
    try:
        one = secret(station, trust=trust)
        one.sendall(b"GET /api/v1/stream HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\n"
                    b"Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: "
                    + base64.b64encode(os.urandom(16)) + b"\r\n\r\n")
        return one if b" 101 " in one.recv(4096).split(b"\r\n", 1)[0] else None
    except OSError:
        return None


def say(one, message):
    text = json.dumps(message).encode()
    check(len(text) < 126, "a short message only")
    one.sendall(struct.pack("!BB4s", 0x81, 0x80 | len(text), b"\0\0\0\0") + text)


def hears(one, word, seconds=SOON_S):
    said = b""
    one.settimeout(seconds)
    with contextlib.suppress(OSError):
        while word not in said:
            piece = one.recv(65536)
            if not piece:
                break
            said += piece
    return word in said


def station_with_tls(**more):
    return Station(arguments=("--tls", *more.pop("arguments", ())), **more)


def files_and_fingerprint():
    """the first start makes authority and certificate for the owner alone, and tells the fingerprint; the
    second start keeps them"""
    with station_with_tls() as station:
        told = station.roverd.wait_line(r"^fingerprint (\S+)$")[1]
        tls = station.authority.parent
        check(tls.stat().st_mode & 0o777 == 0o700, "the folder is open")
        for name in ("authority.pem", "server.pem"):
            check((tls / name).stat().st_mode & 0o777 == 0o600, f"{name} is open")
        _, seen = ran("openssl", "x509", "-in", station.authority, "-noout", "-fingerprint", "-sha256")
        check(told in seen, f"openssl has another fingerprint: {seen}")
        code, said = ran("openssl", "verify", "-x509_strict", "-purpose", "sslserver", "-CAfile",
                         station.authority, tls / "server.pem")
        check(code == 0, f"openssl does not verify it: {said}")
        before = station.authority.read_bytes(), (tls / "server.pem").read_bytes()
        station.roverd.stop()
        again = Program(*station.roverd.process.args)
        again.wait_line(r"^listening on https://")
        again.stop()
        check(before == (station.authority.read_bytes(), (tls / "server.pem").read_bytes()),
              "the second start made others")


def openssl_as_client():
    """openssl s_client: TLS 1.3 and 1.2, nothing older, ALPN, resumption, no renegotiation, no compression"""
    with station_with_tls() as station, tempfile.TemporaryDirectory() as scratch:
        for version in ("1_3", "1_2"):
            code, said = s_client(station, f"-tls{version}", "-alpn", "h2,http/1.1")
            check(code == 0 and "Verification: OK" in said, f"{version}: {said[-400:]}")
            check("ALPN protocol: http/1.1" in said, f"{version}: no ALPN")
            check("Compression: NONE" in said, f"{version}: compresses")
            kept = f"{scratch}/{version}"
            request = get("/api/v1/health").replace(b"Content-Length", b"Connection: close\r\nX")
            s_client(station, f"-tls{version}", "-sess_out", kept, "-ign_eof", stdin=request)
            _, said = s_client(station, f"-tls{version}", "-sess_in", kept)
            check("Reused, TLS" in said, f"{version} does not resume: {said[-400:]}")
        for version in ("1_1", "1"):
            code, said = s_client(station, f"-tls{version}", "-cipher", "ALL:@SECLEVEL=0")
            check(code != 0, f"TLS {version} is spoken")
        for weak in ("AES128-SHA", "ECDHE-ECDSA-AES128-SHA", "AES128-GCM-SHA256"):
            code, _ = s_client(station, "-tls1_2", "-cipher", f"{weak}:@SECLEVEL=0")
            check(code != 0, f"{weak} is spoken")
        code, said = s_client(station, "-tls1_2", stdin=b"R\n")
        check("no renegotiation" in said, f"it renegotiates: {said[-400:]}")
        check(s_client(station, "-alpn", "h2")[0] != 0, "h2 alone is agreed upon")
        code, _ = s_client(station, "-verify_hostname", "other.example")
        check(code != 0, "it has a name that nobody gave it")


def curl_and_python():
    """curl --cacert and Python's ssl take it, and neither without the authority; the stream works"""
    with station_with_tls() as station:
        health = f"{station.address}/api/v1/health"
        code, said = ran("curl", "-sS", "--cacert", station.authority, health)
        check(code == 0 and '"status"' in said, said)
        check(ran("curl", "-sS", health)[0] == 60, "curl takes it without the authority")
        try:
            secret(station, trust=ssl.create_default_context())
            check(False, "Python takes it without the authority")
        except ssl.SSLCertVerificationError:
            pass
        page = station.rest.call("GET", "/../../")[2]
        check(page is not None, "no page")
        with stream(station) as one:
            say(one, {"subscribe": {"vehicle": 10}})
            check(hears(one, b'"topic":"vehicle"', 10), "no vehicle on the stream")
            say(one, {"estop": True})
            check(hears(one, b'"topic":"estop"'), "the stop is not confirmed")
        origin = station.address
        for sent, wanted in ((origin, 200), (origin.replace("https", "http"), 403), ("https://evil.example", 403)):
            status = station.rest.call("POST", "/vehicle/estop", headers={"Origin": sent})[0]
            check(status == wanted, f"a page of {sent} is answered {status}")


def in_the_open():
    """unencrypted there are the pairing page, the certificate and the way to https, and nothing else"""
    with station_with_tls() as station:
        host, port = place_of(station)

        def ask(request):
            with socket.create_connection((host, port), 10) as one:
                one.sendall(request)
                return answer_of(one)

        status, _, page = ask(get("/pair"))
        told = station.roverd.wait_line(r"^fingerprint (\S+)$")[1]
        check(status == 200 and told.encode() in page and b"<script" not in page, f"/pair: {status}")
        status, head, body = ask(get("/ca.crt"))
        check(status == 200 and "application/x-x509-ca-cert" in head, f"/ca.crt: {head}")
        check(ssl.DER_cert_to_PEM_cert(body) in station.authority.read_text(), "another certificate")
        check(b"PRIVATE" not in ask(get("/ca.pem"))[2], "the key is served")
        status, head, body = ask(get("/ca.mobileconfig"))
        check(status == 200 and "application/x-apple-aspen-config" in head, head)
        import plistlib
        check(plistlib.loads(body)["PayloadContent"][0]["PayloadType"] == "com.apple.security.root", body)
        status, head, _ = ask(get("/api/v1/vehicle?a=1", f"localhost:{port}"))
        check(status == 307 and f"Location: https://localhost:{port}/api/v1/vehicle?a=1\r\n" in head, head)
        for request in (get("/api/v1/vehicle/estop", method="POST"), get("/", host="evil.example"),
                        get("/pair", host="evil.example"), get("http://evil.example/")):
            check(ask(request)[0] == 403, f"{request} is answered {ask(request)[0]}")
        check(not station.rest.get("/vehicle")["estop"], "a stop in the open was served")


def half_handshakes():
    """700 half handshakes and 700 silent connections do not keep out a stop"""
    with station_with_tls() as station, contextlib.ExitStack() as crowd:
        for i in range(1400):
            with contextlib.suppress(OSError):
                one = crowd.enter_context(socket.create_connection(place_of(station), 10))
                if i % 2:
                    one.sendall(CLIENT_HELLO)
        stops(station, "1400 half handshakes")
        check(station.rest.get("/vehicle")["estop"], "it is not latched")


def idle_connections():
    """2,000 idle TLS connections do not keep out a stop"""
    with station_with_tls() as station, contextlib.ExitStack() as crowd:
        trust = ssl.create_default_context(cafile=station.authority)
        shaken = 0
        for _ in range(2000):
            with contextlib.suppress(OSError):
                crowd.enter_context(secret(station, trust=trust))
                shaken += 1
        check(shaken >= 1900, f"only {shaken} handshakes")
        stops(station, f"{shaken} idle TLS connections")


def streams():
    """600 streams over TLS do not keep out a stop, neither as a request nor on a new stream or an old one"""
    with station_with_tls() as station, contextlib.ExitStack() as crowd:
        trust = ssl.create_default_context(cafile=station.authority)
        opened = [one for one in (stream(station, trust) for _ in range(600)) if one]
        for one in opened:
            crowd.enter_context(one)
        check(len(opened) >= 400, f"only {len(opened)} streams")
        stops(station, f"{len(opened)} TLS streams")
        for name, one in (("new", stream(station, trust)), ("old", opened[0])):
            check(one, "no new stream is let in to stop")
            say(one, {"estop": True})
            check(hears(one, b'"topic":"estop"'), f"the stop on a {name} stream is not confirmed")


def starts_with(scratch, *options):
    """@return exit code and words of a start that is refused"""
    program = Program(BIN / "roverd", "--config", ROOT / "config/robot.toml", "--data", scratch / "data",
                      "--port", "0", "--set", "drivers.bunker.enabled=false", "--set",
                      "drivers.gnss.enabled=false", *options)
    code = program.wait_exit(20)
    return code, " ".join(program.errors)


def given(folder, name):
    """A chain and key of other people's making."""
    code, said = ran("openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "30", "-subj",
                     f"/CN={name}", "-addext", f"subjectAltName=DNS:{name},DNS:localhost,IP:127.0.0.1",
                     "-keyout", folder / "key.new", "-out", folder / "chain.new")
    check(code == 0, said)
    (folder / "key.new").chmod(0o600)
    (folder / "key.new").rename(folder / "key.pem")
    (folder / "chain.new").rename(folder / "chain.pem")


def refusals():
    """a start is refused with one clear sentence: open keys, wrong pairs"""
    with tempfile.TemporaryDirectory() as name:
        scratch = pathlib.Path(name)
        given(scratch, "one")
        pair = ("--tls", "--set", f"server.tls_certificate={scratch / 'chain.pem'}", "--set",
                f"server.tls_key={scratch / 'key.pem'}")
        (scratch / "key.pem").chmod(0o644)
        code, said = starts_with(scratch, *pair)
        check(code == 2 and "can be read or changed by others" in said, said)
        (scratch / "key.pem").chmod(0o600)
        (scratch / "chain.pem").write_text("nothing")
        code, said = starts_with(scratch, *pair)
        check(code == 2 and "there is no whole certificate in it" in said, said)
        code, said = starts_with(scratch, *pair[:3])
        check(code == 2 and "needs the other one" in said, said)
        (scratch / "data" / "tls").mkdir(parents=True, exist_ok=True)
        (scratch / "data" / "tls").chmod(0o755)
        code, said = starts_with(scratch, "--tls")
        check(code == 2 and "can be read or changed by others" in said, said)


def a_given_certificate():
    """a given certificate is shown, and its successor without a restart; who is connected stays so"""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        given(folder, "one")
        with Station(arguments=("--tls", "--set", f"server.tls_certificate={folder / 'chain.pem'}", "--set",
                                f"server.tls_key={folder / 'key.pem'}"),
                     authority=folder / "chain.pem") as station:
            with secret(station) as old:
                given(folder, "two")

                def shown():
                    try:
                        secret(station).close()
                        return True
                    except ssl.SSLError:
                        return False
                until("the next certificate is shown", 60, shown, 1)
                old.sendall(get("/api/v1/health"))
                check(answer_of(old)[0] in (0, 200), "the old connection is broken")


soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
resource.setrlimit(resource.RLIMIT_NOFILE, (min(hard, 8192), hard))
sys.exit(run_cases([files_and_fingerprint, openssl_as_client, curl_and_python, in_the_open, half_handshakes,
                    idle_connections, streams, refusals, a_given_certificate]))

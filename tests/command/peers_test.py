#!/usr/bin/env python3
"""Other people's programs as judges: openssl, sslscan, curl, Python's requests and websockets, with a token.

What tests/command/tls_test.py asks of openssl (versions, resumption, renegotiation) is not asked again."""

import asyncio
import contextlib
import json
import os
import pathlib
import re
import socket
import subprocess
import sys
import xml.etree.ElementTree

SYSTEM = "/usr/bin/python3"
try:
    import requests
    import websockets
except ModuleNotFoundError:  # another Python goes first in PATH; Debian's packages belong to the system's
    if os.path.realpath(sys.executable) == os.path.realpath(SYSTEM):
        raise
    os.execv(SYSTEM, [SYSTEM, *sys.argv])

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "harness"))
from field import Field  # noqa: E402
from station import check, run_cases  # noqa: E402

SUITES_12 = {"ECDHE-ECDSA-AES128-GCM-SHA256", "ECDHE-ECDSA-AES256-GCM-SHA384", "ECDHE-ECDSA-CHACHA20-POLY1305"}
SUITES_13 = {"TLS_AES_128_GCM_SHA256", "TLS_AES_256_GCM_SHA384", "TLS_CHACHA20_POLY1305_SHA256"}
SSL3_HELLO = bytes.fromhex("1603000030010000" "2c0300") + bytes(32) + bytes.fromhex("000006002f0035000a0100")


def ran(*command, stdin=""):
    done = subprocess.run([str(c) for c in command], input=stdin, capture_output=True, text=True, timeout=120,
                          check=False, errors="replace")
    return done.returncode, done.stdout + done.stderr


def place():
    return f"{field.nobody.place[0]}:{field.nobody.place[1]}"


def s_client(*options):
    return ran("openssl", "s_client", "-connect", place(), "-CAfile", field.station.authority,
               "-verify_return_error", *options, stdin="Q\n")


def bearer(role):
    return f"Authorization: Bearer {field.tokens[role]}"


def openssl_names():
    """openssl: the chain leads to the robot's authority, for its names and addresses and no others"""
    for option, name, good in (("-verify_hostname", "localhost", True), ("-verify_ip", "127.0.0.1", True),
                               ("-verify_ip", "::1", True), ("-verify_hostname", "evil.example", False),
                               ("-verify_ip", "192.0.2.1", False), ("-verify_hostname", "x.localhost", False)):
        code, said = s_client(option, name)
        check((code == 0) == good, f"{name}: {said[-300:]}")
    check(ran("openssl", "s_client", "-connect", place(), "-verify_return_error", stdin="Q\n")[0] != 0,
          "it is taken without the authority")


def openssl_suites():
    """openssl: of all its cipher suites only three are spoken in TLS 1.2, by forward secrecy and with AEAD"""
    _, all_suites = ran("openssl", "ciphers", "ALL:COMPLEMENTOFALL:@SECLEVEL=0")
    offered = [name for name in all_suites.strip().split(":") if not name.startswith("TLS_")]
    check(len(offered) > 60, f"openssl knows only {len(offered)}")
    spoken = {name for name in offered if s_client("-tls1_2", "-cipher", f"{name}:@SECLEVEL=0")[0] == 0}
    check(spoken == SUITES_12, f"{spoken} are spoken")


def ssl3():
    """SSL 3.0 is not answered by a hello"""
    with socket.create_connection(field.nobody.place, 10) as one:
        one.sendall(SSL3_HELLO)
        one.settimeout(5)
        with contextlib.suppress(ConnectionResetError):
            said = one.recv(4096)
            check(said[:1] in (b"", b"\x15"), f"it is answered: {said[:20]}")


def sslscan():
    """sslscan: TLS 1.2 and 1.3 alone, no weak suite or group, no compression, no renegotiation, no Heartbleed"""
    code, said = ran("sslscan", "--no-colour", "--show-certificate", "--xml=-", place())
    check(code == 0, said[-300:])
    test = xml.etree.ElementTree.fromstring(said[said.index("<?xml"):]).find("ssltest")
    versions = {f"{p.get('type')}{p.get('version')}": p.get("enabled") for p in test.iter("protocol")}
    check(versions == {"ssl2": "0", "ssl3": "0", "tls1.0": "0", "tls1.1": "0", "tls1.2": "1", "tls1.3": "1"}, versions)
    suites = {c.get("cipher") for c in test.iter("cipher")}
    check(suites == SUITES_12 | SUITES_13, f"{suites}")
    check({c.get("strength") for c in test.iter("cipher")} <= {"strong", "acceptable"}, "a weak suite")
    check({g.get("name").split(" ")[0] for g in test.iter("group")} == {"x25519", "secp256r1"}, "other groups")
    for weakness in ("compression", "renegotiation"):  # without the first where OpenSSL has none
        check(all(w.get("supported") == "0" for w in test.iter(weakness)), weakness)
    check(all(h.get("vulnerable") == "0" for h in test.iter("heartbleed")), "Heartbleed")
    certificate = next(test.iter("certificate"))
    check("ecdsa-with-SHA256" in certificate.findtext("signature-algorithm"), "how is it signed?")
    check(all(c.findtext("expired") in (None, "false") for c in test.iter("certificate")), "it is over")


def curl():
    """curl --cacert with a token: reads, saves, is refused by role, and is led from http to https"""
    base = field.station.address + "/api/v1"
    ask = ("curl", "-sS", "--cacert", field.station.authority)
    code, said = ran(*ask, "-H", bearer("viewer"), base + "/vehicle")
    check(code == 0 and json.loads(said)["name"] == "bunker", said[:200])
    code, said = ran(*ask, "-w", "%{http_code}", "-o", "/dev/null", base + "/vehicle")
    check(said == "401", f"without a token: {said}")
    body = '{"name": "by curl", "items": [{"type": "waypoint", "lat": 58.37812, "lon": 26.72905}]}'
    save = ("-H", "Content-Type: application/json", "-d", body, base + "/missions")
    check(ran(*ask, "-w", "%{http_code}", "-o", "/dev/null", "-H", bearer("viewer"), *save)[1] == "403", "a viewer saves")
    code, said = ran(*ask, "-i", "-H", bearer("operator"), *save)
    check(re.match(r"HTTP/1\.1 201 ", said) and "ETag: \"rev-1\"" in said, said[:300])
    check(ran(*ask, "-X", "POST", "-w", "%{http_code}", "-o", "/dev/null", base + "/vehicle/estop")[1] == "200",
          "nobody may stop")
    plain = base.replace("https:", "http:")
    check(ran(*ask, "-w", "%{http_code}", "-o", "/dev/null", plain + "/vehicle")[1] == "307", "no way to https")
    code, said = ran(*ask, "--location-trusted", "-H", bearer("viewer"), plain + "/vehicle")
    check(code == 0 and '"mode"' in said, f"it is not led on: {said[:200]}")
    for option in ("--tlsv1.1", "--tlsv1.0"):
        code, _ = ran(*ask, option, "--tls-max", option[-3:], base + "/health")
        check(code == 35, f"{option} is spoken")


def python_requests():
    """requests: one session with a token; log-in with a cookie, which changes nothing without Origin"""
    base = field.station.address + "/api/v1"
    with requests.Session() as script:
        script.trust_env = False  # an authority that the machine names there would go first
        script.verify = str(field.station.authority)
        script.headers["Authorization"] = f"Bearer {field.tokens['operator']}"
        check(script.get(base + "/vehicle").json()["name"] == "bunker", "no vehicle")
        made = script.post(base + "/missions", json={"name": "by requests", "items": [
            {"type": "waypoint", "lat": 58.37812, "lon": 26.72905}]})
        check(made.status_code == 201 and made.headers["Location"].startswith("/api/v1/missions/"), made.text)
        file = script.get(field.station.address + made.headers["Location"] + "/export?format=gpx")
        check(file.ok and "<gpx" in file.text, file.text[:200])
        check(script.delete(field.station.address + made.headers["Location"],
                            headers={"If-Match": made.headers["ETag"]}).status_code == 204, "it is not deleted")
        check(script.get(base + "/audit").status_code == 403, "an operator reads the audit")
    with requests.Session() as browser:
        browser.trust_env = False
        browser.verify = str(field.station.authority)
        check(browser.post(base + "/session", json={"user": "anna", "password": "wrong horse"}).status_code == 401, "")
        browser.cookies.set(*field.cookie.split("=", 1))
        check(browser.get(base + "/vehicle").status_code == 200, "the cookie opens nothing")
        check(browser.post(base + "/tokens", json={"name": "x", "role": "viewer"}).status_code == 403,
              "a cookie without Origin changes something")
    with contextlib.suppress(requests.exceptions.SSLError):
        requests.get(base + "/health", timeout=10)
        check(False, "requests takes it without the authority")


def python_websockets():
    """websockets: vehicle and pongs on the stream, compression is offered in vain, a stop, the end with the token"""
    asyncio.run(on_the_stream())


async def on_the_stream():
    trust = field.nobody.trust
    url = field.station.address.replace("https:", "wss:") + "/api/v1/stream"
    try:
        async with websockets.connect(url, ssl=trust):
            check(False, "the stream is open")
    except websockets.exceptions.InvalidStatusCode as refused:
        check(refused.status_code == 401, f"it answers {refused.status_code}")
    made = field.anna.do("POST", "/tokens", {"name": "listener", "role": "viewer"}, 201)
    shown = {"Authorization": f"Bearer {made['token']}"}
    async with websockets.connect(url, ssl=trust, extra_headers=shown, compression="deflate") as stream:
        check(not stream.extensions, f"{stream.extensions} was agreed upon")

        async def hears(topic):
            while True:
                message = json.loads(await asyncio.wait_for(stream.recv(), 10))
                if message["topic"] == topic:
                    return message
        await hears("hello")
        await stream.send(json.dumps({"subscribe": {"vehicle": 10}}))
        first, second = await hears("vehicle"), await hears("vehicle")
        check(second["seq"] > first["seq"], "the numbers stand still")
        await asyncio.wait_for(await stream.ping(), 10)
        await stream.send(json.dumps({"drive": {"speed_mps": 1, "yaw_rate_dps": 0, "deadman": True}}))
        check((await hears("error"))["data"]["status"] == 403, "a viewer drives")
        await stream.send(json.dumps({"estop": True}))
        await hears("estop")
        field.anna.do("DELETE", f"/tokens/{made['id']}", status=204)
        try:
            while True:
                await asyncio.wait_for(stream.recv(), 10)
        except websockets.exceptions.ConnectionClosed as closed:
            check(closed.rcvd and closed.rcvd.code == 4401, f"it is closed with {closed.rcvd}")


if __name__ == "__main__":
    with Field() as field:
        sys.exit(run_cases([openssl_names, openssl_suites, ssl3, sslscan, curl, python_requests, python_websockets]))

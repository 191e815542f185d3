#!/usr/bin/env python3
"""The robot under attack: it drives, somebody attacks, others go on, and a stop stops it.

The attacker (tests/harness/attacks.py) comes from other addresses than the one who stops. How long a stop
takes and how late the loop is meanwhile is printed, not judged: tests/bench/run does that."""

import base64
import contextlib
import pathlib
import re
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "harness"))
import attacks  # noqa: E402
import lateness  # noqa: E402
from field import PASSWORD, Caller, Field  # noqa: E402
from station import check, run_cases, until  # noqa: E402

FOE = "127.0.0.2"
MEMORY_MB = 400  # whatever is thrown at it; at rest it takes about 40
ROWS = 100  # of the audit, for 100,000 log-ins
HASHED = 200  # of 100,000 guesses: as many passwords were compared


def withstands(attack, role=None, until_done=None):
    """@return what the attacker was given"""
    field.drive()
    before = field.lateness()
    with field.under(attack, role) as attacker:
        for _ in range(5):
            field.viewer.do("GET", "/vehicle")
        if until_done:
            until_done(attacker)
        near, far = field.stop(), Caller(field.station, source=FOE)
        check(far.call("POST", "/vehicle/estop")[0] == 200, "the attacker's neighbour cannot stop")
        for _ in range(5):
            field.viewer.do("GET", "/vehicle")
        used_mb = field.resident_mb()
    late = field.lateness()
    ticks = max(late.values()) - max(before.values())
    late_ms = lateness.percentile_us(before, late, 0.99) / 1000 if ticks > 100 else float("nan")
    print(f"    {attack}: stop answered after {near:.0f} ms, loop late by {late_ms:.2f} ms (p99 of {ticks}), "
          f"{used_mb:.0f} MB; given {attacker.given}")
    check(used_mb < MEMORY_MB, f"{used_mb:.0f} MB are used")
    return attacker.given


def idle():
    """2,000 idle connections of one address: it has its share, the others have theirs"""
    given = withstands("idle")
    check(given["opened"] >= 1000, f"only {given}")
    check(given["still open"] <= 64 + 8, f"{given['still open']} of one address stay open")


def slow():
    """slow heads, bodies and handshakes of one address keep nobody else out"""
    given = withstands("slow")
    check(given["body opened"] >= 64, f"no slow bodies: {given}")


def handshakes():
    """handshake after handshake"""
    check(withstands("handshakes", until_done=pause)["handshakes"] > 20, "no flood")


def renegotiation():
    """renegotiation is refused, and the connection ended"""
    import subprocess
    place = f"{field.nobody.place[0]}:{field.nobody.place[1]}"
    done = subprocess.run(["openssl", "s_client", "-connect", place, "-tls1_2", "-CAfile", field.station.authority],
                          input=b"R\n" * 20, capture_output=True, timeout=60, check=False)
    check(b"no renegotiation" in done.stdout + done.stderr, f"it renegotiates: {done.stderr[-300:]}")


def pause(_):
    time.sleep(1)


def streams():
    """streams flooded with messages, nonsense, pings, frames of 4 EB, endless and unmasked ones"""
    for attack in ("messages", "nonsense", "pings", "huge", "pieces", "unmasked"):
        # Whoever is told goodbye and does not hear it has two seconds.
        given = withstands(attack, "viewer", (lambda _: time.sleep(3)) if attack == "nonsense" else pause)
        check(given["streams"] > 0 and given["deflate agreed"] == 0, f"{attack}: {given}")
        if attack not in ("messages", "pings"):
            check(given.get("closed", 0) > 0, f"{attack} is not ended: {given}")


def bombs():
    """what is small until it is unpacked: a KMZ of 200 MB is refused, gzip is never unpacked"""
    given = withstands("bombs", "operator", pause)
    for kind in given:
        check(re.fullmatch(r"kmz 413|kmz 429|gzip (400|415|422)", kind), f"{given}")
    check("kmz 413" in given and any(kind.startswith("gzip") for kind in given), f"{given}")


def bodies_at_once():
    """50 MB for the import from four addresses at once, again and again"""
    withstands("bodies", "operator", pause)


def guesses():
    """100,000 log-ins: few passwords are compared, anna still logs in, and the audit has few rows"""
    before = len(audit_rows())
    begin = time.monotonic()
    log_ins = []

    def anna_logs_in(attacker):
        def tries():
            status, _, _ = field.nobody.call("POST", "/session", {"user": "anna", "password": PASSWORD})
            log_ins.append(status)
            return status == 200
        # Her name waits up to 30 s behind the last guess that was compared.
        until("anna logs in", 80, tries, 0.3)
        attacker.wait_line("^done$", 90)
    given = withstands("guess", until_done=anna_logs_in)
    rows = len(audit_rows()) - before
    asked = sum(count for word, count in given.items() if word.isdigit())
    print(f"    {asked} log-ins in {given['milliseconds'] / 1000:.1f} s: {given.get('401', 0)} passwords compared, "
          f"{given.get('429', 0)} told to wait; anna: {log_ins}; {rows} rows in {time.monotonic() - begin:.0f} s")
    check(asked >= attacks.GUESSES * 0.99, f"only {given}")
    check("200" not in given and set(given) <= {"401", "429", "closed", "milliseconds"}, f"{given}")
    check(given.get("401", 0) <= HASHED, f"{given['401']} guesses were compared")
    check(0 < rows <= ROWS, f"{rows} rows")


def audit_rows():
    return field.admin.do("GET", "/audit?limit=1000")["items"]


def a_stolen_cookie():
    """after the log-out the cookie opens nothing, and its stream is closed"""
    answers = []

    def let_in():
        answers.append(field.nobody.call("POST", "/session", {"user": "anna", "password": PASSWORD}))
        return answers[-1][0] == 200
    until("anna logs in", 40, let_in, 0.5)
    headers = answers[-1][1]
    cookie = {"Cookie": headers["Set-Cookie"].split(";")[0], "Origin": field.station.address}
    owner, thief = Caller(field.station, cookie), Caller(field.station, cookie, FOE)
    thief.do("GET", "/vehicle")
    with contextlib.closing(stream_with(cookie)) as stolen:
        owner.do("DELETE", "/session", status=204)
        thief.do("GET", "/vehicle", status=401)
        thief.do("POST", "/vehicle/arm", {}, status=401)
        said = b""
        with contextlib.suppress(OSError):
            while piece := stolen.recv(65536):
                said += piece
        check((4401).to_bytes(2, "big") in said, f"the stream is not closed with 4401: {said[-60:]}")


def target():
    return attacks.Target(*field.nobody.place, field.station.authority)


def stream_with(headers):
    one = target().secret(FOE)
    lines = [f"{name}: {value}" for name, value in headers.items()]
    one.sendall(("\r\n".join([
        "GET /api/v1/stream HTTP/1.1", f"Host: {field.nobody.place[0]}:{field.nobody.place[1]}", *lines,
        "Connection: Upgrade", "Upgrade: websocket", "Sec-WebSocket-Version: 13",
        "Sec-WebSocket-Key: " + base64.b64encode(bytes(16)).decode()]) + "\r\n\r\n").encode())
    check(b" 101 " in one.recv(4096), "no stream")
    return one


# Files and maps may be as large as that, and a stop is carried out whatever comes with it.
SO_LARGE_OR_NEVER_REFUSED = ("/vehicle/estop", "/missions/import", "/maps")


def large_bodies():
    """50 MB for every operation: refused by its limit, before it is held"""
    kinds, most_mb = {}, field.resident_mb()
    document = field.viewer.do("GET", "/openapi.json")
    for path, operations in document["paths"].items():
        for method in operations:
            if method not in ("post", "put", "patch", "delete"):
                continue
            for who in ("", field.tokens["admin"]):
                for coding in ("Content-Length: 50000000", "Transfer-Encoding: chunked"):
                    at = re.sub(r"\{(\w+)\}", "1", path)
                    status, sent = give(method.upper(), at, who, coding)
                    kinds.setdefault(status, []).append(f"{method.upper()} {path}")
                    check(status in (413, 503) or path in SO_LARGE_OR_NEVER_REFUSED,
                          f"{method.upper()} {path} with {coding}: {status} after {sent} bytes")
            most_mb = max(most_mb, field.resident_mb())
    print(f"    {({status: len(calls) for status, calls in kinds.items()})}, {most_mb:.0f} MB at most")
    check(most_mb < MEMORY_MB, f"{most_mb:.0f} MB are used")
    check(not 500 <= max(kinds) < 503, f"{kinds}")


def give(method, path, token, coding):
    """@return status and how many bytes were taken of 50 MB"""
    one = target()
    one.token = token
    chunked = "chunked" in coding
    piece = b" " * 65536
    piece = b"10000\r\n" + piece + b"\r\n" if chunked else piece
    sent = 0
    with contextlib.closing(one.secret()) as line:
        with contextlib.suppress(OSError):
            line.sendall(one.head(method, path, coding, "Content-Type: application/json"))
            line.settimeout(0.01)
            while sent < 50_000_000:
                with contextlib.suppress(TimeoutError):
                    if answer := line.recv(65536):
                        return int(answer.split(b" ", 2)[1]), sent
                line.settimeout(5)
                for _ in range(16):
                    line.sendall(piece)
                sent += 1 << 20
                line.settimeout(0.01)
            if chunked:
                line.sendall(b"0\r\n\r\n")
        line.settimeout(20)
        answer = line.recv(65536)
        return int(answer.split(b" ", 2)[1]) if answer else 0, sent


ODD_PATHS = ["/../../etc/passwd", "/%2e%2e/%2e%2e/%2e%2e/etc/passwd", "/..%2f..%2f..%2fetc%2fpasswd", "//etc/passwd",
             "/assets/../../../../etc/passwd", "/assets/..%5c..%5cetc%5cpasswd", "/%00", "/index.html%00.js",
             "/api/v1/tiles/../../../../etc/passwd/1/1/1", "/api/v1/tiles/..%2f..%2fetc%2fpasswd/1/1/1",
             "/api/v1/missions/..%2f..%2froverd.db", "/api/v1/missions/%2e%2e", "/api/v1/runs/1%20OR%201=1",
             "/api/v1/missions?cursor='%3B%20DROP%20TABLE%20missions%3B--", "/api/v1/events?since='%20OR%20'1'='1",
             "/api/v1/events?level=%27)%3BDELETE%20FROM%20events--", "/api/v1/users/anna'--", "/%c0%ae%c0%ae/etc/passwd",
             "/api/v1/../../data/tls/authority.pem", "/data/roverd.db", "/tls/authority.pem", "/.git/config",
             "/api/v1/vehicle%0d%0aSet-Cookie:%20a=b", "/api/v1/%ff%fe", "/api/v1/vehicle;/../users", "*", "/" + "a" * 8000]
SMUGGLED = [
    "POST /api/v1/vehicle/move HTTP/1.1\r\nHost: {h}\r\nContent-Length: 6\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\nG",
    "POST /api/v1/session HTTP/1.1\r\nHost: {h}\r\nContent-Length: 5\r\nContent-Length: 50\r\n\r\nabcde",
    "POST /api/v1/session HTTP/1.1\r\nHost: {h}\r\nTransfer-Encoding: xchunked\r\n\r\n0\r\n\r\n",
    "POST /api/v1/session HTTP/1.1\r\nHost: {h}\r\nTransfer-Encoding: chunked, identity\r\n\r\n0\r\n\r\n",
    "POST /api/v1/session HTTP/1.1\r\nHost: {h}\r\nTransfer-Encoding : chunked\r\n\r\n0\r\n\r\n",
    "POST /api/v1/session HTTP/1.1\r\nHost: {h}\r\nTransfer-Encoding: chunked\r\n\r\nfffffffffffffffff\r\nab",
    "POST /api/v1/session HTTP/1.1\r\nHost: {h}\r\nContent-Length: +5\r\n\r\nabcde",
    "POST /api/v1/session HTTP/1.1\r\nHost: {h}\r\nContent-Length: -1\r\n\r\n",
    "POST /api/v1/session HTTP/1.0\r\nHost: {h}\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n",
    "GET /api/v1/health HTTP/1.1\r\nHost: {h}\r\nHost: evil.example\r\n\r\n",
    "GET /api/v1/health HTTP/1.1\r\n\r\n",
    "GET /api/v1/health HTTP/1.1\nHost: {h}\n\nGET /x HTTP/1.1\r\n\r\n",
    "GET http://evil.example/api/v1/vehicle HTTP/1.1\r\nHost: evil.example\r\n\r\n",
    "GET /api/v1/vehicle HTTP/1.1\r\nHost: {h}\r\nX: a\0b\r\n\r\n",
    "GET /api/v1/vehicle HTTP/1.1\r\nHost: {h}\r\nA: b\r\n GET: x\r\n\r\n",
    "GET /api/v1/vehicle HTTP/9.9\r\nHost: {h}\r\n\r\n",
    "CONNECT 127.0.0.1:22 HTTP/1.1\r\nHost: {h}\r\n\r\n",
    "TRACE / HTTP/1.1\r\nHost: {h}\r\n\r\n"]


def raw(request):
    """@return all that is answered until it ends, or for a moment"""
    said = b""
    with contextlib.closing(target().secret()) as one, contextlib.suppress(OSError):
        one.sendall(request)
        one.settimeout(0.4)
        while piece := one.recv(65536):
            said += piece
    return said


def shapes():
    """odd paths lead nowhere, odd framing gets one refusal, and names stay text"""
    host = f"{field.nobody.place[0]}:{field.nobody.place[1]}"
    shown = f"Authorization: Bearer {field.tokens['admin']}\r\n"
    for path in ODD_PATHS:
        said = raw(f"GET {path} HTTP/1.1\r\nHost: {host}\r\n{shown}Connection: close\r\n\r\n".encode())
        status = int(said.split(b" ", 2)[1]) if said else 0
        check(status in (200, 400, 404, 405, 422), f"{path[:60]} answers {said[:200]}")
        for word in (b"root:", b"PRIVATE KEY", b"SQLite format", b"[core]", b"\r\nSet-Cookie: a=b"):
            check(word not in said, f"{path} shows {word}")
    for request in SMUGGLED:
        said = raw(request.format(h=host).encode())
        statuses = re.findall(rb"HTTP/1\.[01] (\d{3}) ", said)
        check(len(statuses) == 1 and 400 <= int(statuses[0]) < 506 and statuses[0] != b"500",
              f"{request!r} answers {statuses}: {said[:200]}")
    names = ['"; filename="evil.exe', "../../../etc/cron.d/x", "a\r\nSet-Cookie: b=c", "<script>alert(1)</script>",
             "'; DROP TABLE missions;--", "\u202egnp.exe", "$(reboot)", "%n%n%n%s"]
    for name in names:
        status, _, made = field.operator.call("POST", "/missions", {"name": name, "items": [
            {"type": "waypoint", "lat": 58.37, "lon": 26.72}]})
        check(status in (201, 422), f"{name!r} answers {status}: {made}")
        if status == 201:
            check(made["name"] == name, f"{name!r} became {made['name']!r}")
            _, headers, _ = field.viewer.call("GET", f"/missions/{made['id']}/export?format=csv")
            offered = headers["Content-Disposition"]
            check(re.fullmatch(r'attachment; filename="[^"\\/\r\n]+"(; filename\*=[A-Za-z0-9\'%._~!#$&+^`|-]+)?', offered),
                  f"{name!r} is offered as {offered!r}")
            check("Set-Cookie" not in headers, "a header was injected")
    check(len(field.viewer.do("GET", "/missions")["items"]) >= 3, "the missions are gone")


def at_the_end():
    """nothing of all that was noted as a fault, and the robot still drives"""
    check(field.metric("roverd_loop_faults_total") == 0, "the loop had faults")
    said = "\n".join(field.station.roverd.errors + field.station.roverd.lines)
    for word in ("undocumented status", "a handler failed"):
        check(word not in said, f"the log has: {[line for line in said.splitlines() if word in line][:3]}")
    field.drive()
    field.stop()


if __name__ == "__main__":
    with Field() as field:
        sys.exit(run_cases([idle, slow, handshakes, renegotiation, streams, bombs, bodies_at_once, guesses,
                            a_stolen_cookie, large_bodies, shapes, at_the_end]))

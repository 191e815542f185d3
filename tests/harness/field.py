"""A robot with TLS and access control in a field that is open to everybody: who may do what there, and who
attacks it (attacks.py)."""

import contextlib
import http.client
import json
import pathlib
import ssl
import sys
import time
import urllib.parse

import lateness
from station import Program, Station, check, reset_stop, until

PASSWORD = "four tractors in a barn"
ATTACKS = pathlib.Path(__file__).with_name("attacks.py")


class Caller:
    """Somebody with a token or a cookie, or nobody, at an address of this computer."""

    def __init__(self, station, headers=(), source="127.0.0.1"):
        parts = urllib.parse.urlsplit(station.address)
        self.place, self.source = (parts.hostname, parts.port), source
        self.trust = ssl.create_default_context(cafile=station.authority)
        self.headers = dict(headers)

    def call(self, method, path, body=None, headers=(), seconds=30):
        """On a connection of its own. @return status, headers, body (JSON decoded where it is that)"""
        line = http.client.HTTPSConnection(*self.place, timeout=seconds, context=self.trust,
                                           source_address=(self.source, 0))
        with contextlib.closing(line):
            sent = {**self.headers, **dict(headers)}
            if body is not None and not isinstance(body, bytes):
                body = json.dumps(body)
                sent["Content-Type"] = "application/json"
            line.request(method, path if path.startswith("/api/") else "/api/v1" + path, body, sent)
            answer = line.getresponse()
            text = answer.read()
            kind = answer.getheader("Content-Type", "")
            return answer.status, answer.headers, json.loads(text) if kind.split(";")[0].endswith("json") else text

    def do(self, method, path, body=None, status=200, headers=()):
        got, _, answer = self.call(method, path, body, headers)
        check(got == status, f"{method} {path} answers {got}, not {status}: {str(answer)[:300]}")
        return answer


class Field:
    """One station, its admin anna, and a token of each role."""

    def __init__(self, *arguments, **more):
        self.station = Station(arguments=("--tls", "--set", "server.access=true", "--set",
                                          "server.control_grace_s=120", *arguments), **more)
        try:
            self.settle()
        except BaseException:
            self.station.close()
            raise

    def settle(self):
        self.code = self.station.roverd.wait_line(r" with the code (\S+)$")[1]
        self.nobody = Caller(self.station)
        status, headers, answer = self.nobody.call(
            "POST", "/setup", {"code": self.code, "user": "anna", "password": PASSWORD, "device": "laptop"})
        check(status == 200, f"the first admin is refused: {answer}")
        self.cookie = headers["Set-Cookie"].split(";")[0]
        self.anna = Caller(self.station, {"Cookie": self.cookie, "Origin": self.station.address})
        self.tokens = {role: self.anna.do("POST", "/tokens", {"name": role, "role": role}, 201)["token"]
                       for role in ("viewer", "operator", "admin")}
        self.viewer, self.operator, self.admin = [
            Caller(self.station, {"Authorization": f"Bearer {token}"}) for token in self.tokens.values()]
        self.operator.do("POST", "/control/take", {})

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.station.close()

    def truth(self):
        return self.station.control.ask({"get": "truth"})

    def drive(self):
        """Drives off, in front of it as far as it takes."""
        soon = {"valid_for_s": 5}
        reset_stop(self.operator, soon)
        until("it is armed", 60, lambda: self.operator.call("POST", "/vehicle/arm", soon)[0] == 200, 0.2)
        at = self.truth()["driven_m"]
        self.operator.do("POST", "/vehicle/move", {"forward_m": 100, **soon}, 202)
        until("it moves", 20, lambda: self.truth()["driven_m"] > at + 0.1, 0.02)

    def stop(self, source="127.0.0.1"):
        """By nobody in particular. @return ms until the answer; afterwards it stands"""
        begin = time.monotonic()
        Caller(self.station, source=source).do("POST", "/vehicle/estop")
        took_ms = 1000 * (time.monotonic() - begin)
        check(self.viewer.do("GET", "/vehicle")["estop"] is True, "the stop is not latched")
        until("it stands", 5, self.stands, 0.05)
        return took_ms

    def stands(self):
        before = self.truth()["driven_m"]
        time.sleep(0.1)
        return self.truth()["driven_m"] == before

    def lateness(self):
        return lateness.buckets_of(self.viewer.do("GET", "/metrics").decode())

    def metric(self, name):
        text = self.viewer.do("GET", "/metrics").decode()
        return next(float(line.split()[1]) for line in text.splitlines() if line.startswith(name + " "))

    def resident_mb(self):
        status = pathlib.Path(f"/proc/{self.station.roverd.process.pid}/status").read_text()
        return int(next(line.split()[1] for line in status.splitlines() if line.startswith("VmRSS:"))) / 1000

    @contextlib.contextmanager
    def under(self, attack, role=None, seconds=60):
        """@return the attacker; what it was given is there afterwards, as `given`"""
        place = self.nobody.place
        program = Program(sys.executable, ATTACKS, attack, *place, self.station.authority,
                          *((self.tokens[role],) if role else ()))
        try:
            program.wait_line("^ready$", seconds)
            yield program
        finally:
            program.stop(seconds=20)
        program.given = json.loads(program.lines[-1])

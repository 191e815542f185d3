#!/usr/bin/env python3
"""roverd --lan: who can reach it, under which names, and what they get before and after a log-in.

First on this computer, where 127.0.0.2 and ::1 stand in for others; then in network namespaces, where
another computer at the end of a wire is one, and where addresses come while roverd runs. Where the system
permits no namespaces these cases are listed as not run, and with CI=true they fail."""

import base64
import contextlib
import http.client
import json
import os
import pathlib
import re
import socket
import ssl
import subprocess
import sys
import tempfile
import urllib.parse

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "harness"))
from station import BIN, ROOT, Program, Station, check, run_cases, until  # noqa: E402

PASSWORD = "four tractors in a barn"
OPENING = {"Connection": "Upgrade", "Upgrade": "websocket", "Sec-WebSocket-Version": "13",
           "Sec-WebSocket-Key": base64.b64encode(bytes(16)).decode()}
INSIDE = ["unshare", "--user", "--map-root-user", "--net"]


def port_of(station):
    return urllib.parse.urlparse(station.address).port


def ask(station, address, path, host=None, method="GET", secret=True, headers=(), body=None):
    """@param secret through TLS, whose certificate must be right for the address; None: whatever it is.
    @return status, headers, body"""
    port = port_of(station)
    if secret is False:
        line = http.client.HTTPConnection(address, port, timeout=20)
    else:
        trust = ssl.create_default_context(cafile=station.authority)
        if secret is None:
            trust.check_hostname = False
        line = http.client.HTTPSConnection(address, port, timeout=20, context=trust)
    with contextlib.closing(line):
        line.putrequest(method, path, skip_host=True, skip_accept_encoding=True)
        line.putheader("Host", host or (f"[{address}]:{port}" if ":" in address else f"{address}:{port}"))
        data = b"" if body is None else json.dumps(body).encode()
        if method != "GET":
            line.putheader("Content-Length", str(len(data)))
        if data:
            line.putheader("Content-Type", "application/json")
        for name, value in dict(headers).items():
            line.putheader(name, value)
        line.endheaders(data)
        answer = line.getresponse()
        return answer.status, answer.headers, b"" if answer.status == 101 else answer.read()


def status(*arguments, **more):
    return ask(*arguments, **more)[0]


def station_in_the_lan(*arguments, **more):
    return Station(arguments=("--lan", *arguments), **more)


def refused(*arguments, config=None):
    """@return what a start that is refused says"""
    with tempfile.TemporaryDirectory() as scratch:
        program = Program(BIN / "roverd", "--config", config or ROOT / "config/robot.toml", "--data", scratch,
                          "--port", "0", "--set", "drivers.bunker.enabled=false", "--set",
                          "drivers.gnss.enabled=false", *arguments)
        code = program.wait_exit(20)
        said = " ".join(program.errors)
        check(code == 2, f"{arguments}: exit code {code}: {said}")
        return said


def the_first_admin():
    """--lan prints address, pairing page, fingerprint and code; with it the first admin comes in, nobody
    without, and anyone may stop"""
    with station_in_the_lan() as station:
        check(station.address.startswith("https://"), station.address)
        for pattern in (r"^pair at http://\S+/pair$", r"^fingerprint (\w\w:){31}\w\w$"):
            station.roverd.wait_line(pattern)
        where, code = station.roverd.wait_line(r"first admin at (\S+) with the code (\S{4}-\S{4})$").groups()
        check(where == station.address, f"the code is for {where}, not for {station.address}")
        there = "127.0.0.2"
        origin = f"https://{there}:{port_of(station)}"

        def call(method, path, body=None, headers=()):
            return ask(station, there, "/api/v1" + path, method=method, secret=None, body=body,
                       headers={"Origin": origin, **dict(headers)})
        check(call("GET", "/vehicle")[0] == 401, "the state is open")
        check(call("POST", "/vehicle/arm", {})[0] == 401, "anybody may arm")
        check(call("POST", "/vehicle/estop")[0] == 200, "not everybody may stop")
        check(ask(station, there, "/", secret=None)[0] == 200, "there is no page to log in on")
        answer, headers, body = call("POST", "/setup", {"code": code, "user": "anna", "password": PASSWORD})
        check(answer == 200, f"setup answers {answer}: {body}")
        cookie = headers["Set-Cookie"]
        for word in ("Secure", "HttpOnly", "SameSite=Strict"):
            check(word in cookie, f"{word} is missing: {cookie}")
        check(cookie.startswith("__Host-roverd_session=") and "Domain" not in cookie, f"a wider cookie: {cookie}")
        known = {"Cookie": cookie.split(";")[0]}
        check(call("GET", "/vehicle", headers=known)[0] == 200, "the cookie is not taken")
        upgrade = {**OPENING, **known}
        check(call("GET", "/stream", headers=OPENING)[0] == 401, "the stream is open")
        check(call("GET", "/stream", headers=upgrade)[0] == 101, "the stream is closed")
        _, _, sessions = call("GET", "/sessions", headers=known)
        seen = json.loads(sessions)["items"][0]["address"]
        check(seen == "127.0.0.1", f"the session came from {seen}")


def foreign_names():
    """a foreign name that is pointed here gets nothing, neither pages nor calls nor the stream, in the open
    nor through TLS; own names and addresses do"""
    with station_in_the_lan("--set", "server.names=rover.farm.example") as station:
        port = port_of(station)
        own = [socket.gethostname(), "localhost", f"localhost:{port}", "127.0.0.1", f"127.0.0.2:{port}", "[::1]",
               "rover.farm.example", f"Rover.Farm.Example:{port}", urllib.parse.urlparse(station.address).netloc]
        foreign = ["evil.example", f"evil.example:{port}", "127.0.0.1.evil.example", "127.0.0.3", "192.0.2.99",
                   "farm.example", "x.rover.farm.example", "localhost.evil.example", "localhost:x", ""]
        for hosts, good in ((own, True), (foreign, False)):
            for host in hosts:
                for path, headers, right in (("/", {}, 200), ("/api/v1/health", {}, 200), ("/pair", {}, 200),
                                             ("/api/v1/stream", OPENING, 401)):
                    got = status(station, "127.0.0.2", path, host=host or " ", secret=None, headers=headers)
                    check(got == (right if good else 403), f"{path} of host {host!r}: {got}")
                for path, right in (("/pair", 200), ("/", 307), ("/api/v1/health", 307)):
                    got = status(station, "127.0.0.2", path, host=host or " ", secret=False)
                    check(got == (right if good else 403), f"{path} of host {host!r} in the open: {got}")
        check(status(station, "::1", "/api/v1/health") == 200, "the certificate is not for ::1")
        check(status(station, "127.0.0.1", "/api/v1/health") == 200, "the certificate is not for 127.0.0.1")


def foreign_pages():
    """a page of another site may neither command nor open the stream, with a good cookie or without"""
    with station_in_the_lan() as station:
        code = station.roverd.wait_line(r"with the code (\S+)$")[1]
        own = f"https://127.0.0.1:{port_of(station)}"
        _, headers, _ = ask(station, "127.0.0.1", "/api/v1/setup", method="POST", headers={"Origin": own},
                            body={"code": code, "user": "anna", "password": PASSWORD})
        cookie = {"Cookie": headers["Set-Cookie"].split(";")[0]}
        for known in ({}, cookie):
            for origin in ("https://evil.example", own.replace("https", "http"), "null", own + "0"):
                there = {"Origin": origin, **known}
                got = status(station, "127.0.0.1", "/api/v1/vehicle/estop", method="POST", headers=there)
                check(got == 403, f"{origin} may stop: {got}")
                got = status(station, "127.0.0.1", "/api/v1/stream", headers={**OPENING, **there})
                check(got == 403, f"{origin} gets the stream: {got}")
        got = status(station, "127.0.0.1", "/api/v1/stream", headers={**OPENING, **cookie, "Origin": own})
        check(got == 101, f"the own page gets no stream: {got}")
        got = status(station, "127.0.0.1", "/api/v1/missions", method="POST", headers=cookie, body={})
        check(got == 403, f"a cookie without an Origin changes something: {got}")


def in_the_open():
    """unencrypted there is the pairing page and the way to https, for whoever asks; no call is taken"""
    with station_in_the_lan() as station:
        for address in ("127.0.0.2", "::1"):
            answer, headers, _ = ask(station, address, "/?a=1", secret=False)
            shown = f"[{address}]" if ":" in address else address
            check(answer == 307 and headers["Location"] == f"https://{shown}:{port_of(station)}/?a=1",
                  f"{answer} {headers['Location']}")
            answer, _, page = ask(station, address, "/pair", secret=False)
            check(answer == 200 and f"https://{shown}:{port_of(station)}/".encode() in page,
                  "the pairing page leads elsewhere")
            for method, path in (("POST", "/api/v1/vehicle/estop"), ("POST", "/api/v1/session"),
                                 ("PUT", "/api/v1/fence")):
                check(status(station, address, path, method=method, secret=False, body={}) == 403, path)
        check(status(station, "127.0.0.2", "/api/v1/stream", secret=False, headers=OPENING) == 307, "the stream")


def refusals():
    """the network without TLS or without a log-in is refused, with file, line and key"""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "vehicles").symlink_to(ROOT / "config/vehicles")
        config = folder / "robot.toml"
        shipped = (ROOT / "config/robot.toml").read_text(encoding="utf-8")
        for key in ("tls", "access"):
            config.write_text(shipped.replace("[server]\n", f"[server]\n{key} = false\n", 1), encoding="utf-8")
            line = 1 + config.read_text(encoding="utf-8").split("\n").index(f"{key} = false")
            said = refused("--lan", config=config)
            check(f"robot.toml:{line}: server.{key} must not be false: server.listen" in said, said)
            said = refused("--set", "server.listen=0.0.0.0", "--set", f"server.{key}=false")
            check(f"--set server.{key}=false must not be false: server.listen" in said, said)
        said = refused("--set", "server.listen=world")
        check("server.listen=world must be loopback, lan or addresses" in said, said)
        for also in ((), ("--tls",), ("--set", "server.access=true")):
            said = refused("--set", "server.bind=0.0.0.0", *also)
            check("server.bind=0.0.0.0 must be a loopback address" in said, said)


def listed_addresses():
    """a list of addresses: of loopback alone as ever; one of a network, there or not yet, turns TLS and log-in on"""
    with Station(arguments=("--set", "server.listen=127.0.0.2 ::1")) as station:
        check(station.address.startswith("http://127.0.0.2:"), station.address)
        for address in ("127.0.0.2", "::1"):
            check(status(station, address, "/api/v1/vehicle", secret=False) == 200, f"{address} is closed")
        with contextlib.suppress(ConnectionRefusedError):
            ask(station, "127.0.0.1", "/", secret=False)
            check(False, "it listens on 127.0.0.1, too")
    with Station(arguments=("--set", "server.listen=127.0.0.2 198.51.100.7")) as station:
        check(status(station, "127.0.0.2", "/api/v1/vehicle", secret=None) == 401, "the state is open")
        log = (station.scratch / "data/roverd.log").read_text(encoding="utf-8")
        check("no interface has the address 198.51.100.7 now" in log, "nobody is told of the missing address")


class Other:
    """Another computer at the end of a wire: a network namespace of its own. Only inside of one."""

    def __init__(self):
        self.holder = subprocess.Popen(["unshare", "--net", "sleep", "600"])
        self.enter = ["nsenter", "--net", "--target", str(self.holder.pid)]
        ours = os.readlink("/proc/self/ns/net")
        until("the other computer is there", 10,
              lambda: os.readlink(f"/proc/{self.holder.pid}/ns/net") != ours)
        run("ip", "link", "add", "name", "wire", "type", "veth", "peer", "name", "far")
        run("ip", "link", "set", "far", "netns", str(self.holder.pid))
        run("ip", "link", "set", "wire", "up")
        self.run("ip", "link", "set", "far", "up")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        run("ip", "link", "delete", "wire")
        self.holder.kill()
        self.holder.wait()

    def network(self, number):
        """A network between the two: .1 is the robot, .2 the other. @return the robot's addresses"""
        for device, enter, last in (("wire", [], 1), ("far", self.enter, 2)):
            run(*enter, "ip", "address", "add", f"10.77.{number}.{last}/24", "dev", device)
            run(*enter, "ip", "-6", "address", "add", f"fd77:{number}::{last}/64", "dev", device, "nodad")
        return f"10.77.{number}.1", f"[fd77:{number}::1]"

    def run(self, *command):
        return run(*self.enter, *command)

    def curl(self, station, host, path, *options, scheme="https", trust=True):
        """@return status and body; status 0: curl's own complaint"""
        port = port_of(station)
        trust = ("--cacert", station.authority) if trust else ("--insecure",)
        done = subprocess.run([*self.enter, "curl", "--silent", "--show-error", "--max-time", "10", "--noproxy", "*",
                               "--write-out", "\n%{http_code}", *map(str, trust), *options,
                               f"{scheme}://{host}:{port}{path}"], capture_output=True, text=True, timeout=30)
        body, _, code = done.stdout.rpartition("\n")
        return int(code or 0), body + done.stderr


def run(*command):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, timeout=30)
    check(done.returncode == 0, f"{' '.join(map(str, command))}: {done.stderr}")
    return done.stdout


def another_computer():
    """another computer pairs, logs in and reads, over IPv4 and IPv6; what it is called there decides, and a
    name that was pointed here gets nothing"""
    with Other() as other:
        addresses = other.network(1)
        with station_in_the_lan() as station, tempfile.TemporaryDirectory() as scratch:
            check(station.address == f"https://10.77.1.1:{port_of(station)}", station.address)
            station.roverd.wait_line(rf"^also at https://\[fd77:1::1\]:{port_of(station)}$")
            code = station.roverd.wait_line(r"with the code (\S+)$")[1]
            got, page = other.curl(station, addresses[0], "/pair", scheme="http")
            check(got == 200 and station.address in page, f"/pair: {got} {page}")
            got, authority = other.curl(station, addresses[0], "/ca.pem", scheme="http")
            check(got == 200 and authority.strip() in station.authority.read_text(), "another authority")
            for host in addresses:
                got, body = other.curl(station, host, "/api/v1/health")
                check(got == 200, f"{host}: {got} {body}")
                check(other.curl(station, host, "/api/v1/vehicle")[0] == 401, f"{host} is open")
                got, _ = other.curl(station, host, "/api/v1/vehicle/estop", "--request", "POST")
                check(got == 200, f"{host} cannot stop: {got}")
            jar = f"{scratch}/jar"
            origin = ("--header", f"Origin: {station.address}", "--header", "Content-Type: application/json")
            draft = json.dumps({"code": code, "user": "anna", "password": PASSWORD})
            got, body = other.curl(station, addresses[0], "/api/v1/setup", *origin, "--data", draft, "--cookie-jar", jar)
            check(got == 200, f"setup: {got} {body}")
            got, body = other.curl(station, addresses[0], "/api/v1/sessions", "--cookie", jar)
            check(got == 200 and json.loads(body)["items"][0]["address"] == "10.77.1.2", f"{got} {body}")
            for scheme in ("http", "https"):
                for path in ("/", "/pair", "/api/v1/health"):
                    pointed = ("--resolve", f"evil.example:{port_of(station)}:10.77.1.1", "--cookie", jar)
                    got, body = other.curl(station, "evil.example", path, *pointed, scheme=scheme, trust=False)
                    check(got == 403, f"{scheme}://evil.example{path}: {got} {body}")


def an_address_that_comes():
    """a robot that had no network at its start is reached at an address that comes later, and at the next; each
    time with a certificate for it, and who is connected stays so"""
    with Other() as other, station_in_the_lan() as station:
        check(station.address.startswith("https://127.0.0.1:"), station.address)
        kept = http.client.HTTPSConnection("127.0.0.1", port_of(station), timeout=20,
                                           context=ssl.create_default_context(cafile=station.authority))
        with contextlib.closing(kept):
            for number in (1, 2):
                addresses = other.network(number)
                # At once, for whoever looks away.
                got, body = other.curl(station, addresses[0], "/api/v1/health", trust=False)
                check(got == 200, f"{addresses[0]}: {got} {body}")
                for host in addresses:
                    until(f"{host} has a certificate", 60,
                          lambda host=host: other.curl(station, host, "/api/v1/health")[0] == 200, 0.5)
                kept.request("GET", "/api/v1/health")
                check(kept.getresponse().read(), "the old connection is broken")
            station.roverd.wait_line(rf"^now at https://10\.77\.1\.1:{port_of(station)}$")
            log = station.scratch / "data/roverd.log"
            until("the log tells of the certificate", 30, lambda: re.search(
                r"a server certificate was made: .*10\.77\.2\.1", log.read_text(encoding="utf-8")))


def a_listed_address_that_comes():
    """a listed address is heard as soon as an interface has it, and no other"""
    with Other() as other, Station(arguments=("--set", "server.listen=10.77.2.1")) as station:
        other.network(1)
        other.network(2)
        until("the listed address answers with its certificate", 60,
              lambda: other.curl(station, "10.77.2.1", "/api/v1/health")[0] == 200, 0.5)
        check(other.curl(station, "10.77.1.1", "/api/v1/health")[0] == 0, "another address answers, too")


CASES = [the_first_admin, foreign_names, foreign_pages, in_the_open, refusals, listed_addresses]
IN_NAMESPACES = [another_computer, an_address_that_comes, a_listed_address_that_comes]


def in_namespaces():
    """The rest, in a network of its own. @return the exit code"""
    probe = subprocess.run([*INSIDE, "sh", "-c", "ip link add name a0 type veth peer name b0 && unshare --net true"],
                           capture_output=True, text=True)
    if probe.returncode == 0:
        return subprocess.run([*INSIDE, sys.executable, __file__, "inside"]).returncode
    why = "this system permits no network namespaces: " + " ".join(probe.stderr.split())
    for case in IN_NAMESPACES:
        word = "not ok" if os.environ.get("CI") == "true" else "skip"
        print(f"{word} - {' '.join(case.__doc__.split())}: {why}", flush=True)
    return 1 if os.environ.get("CI") == "true" else 0


if sys.argv[1:] == ["inside"]:
    run("ip", "link", "set", "lo", "up")
    sys.exit(run_cases(IN_NAMESPACES))
sys.exit(max(run_cases(CASES), in_namespaces()))

#!/usr/bin/env python3
"""Corrections from a real caster (rtklib's str2str on loopback) and from one that we play (version 2,
chunks, TLS), through the running roverd to the receiver's port."""

import base64
import hashlib
import json
import os
import pathlib
import re
import shutil
import socket
import ssl
import subprocess
import sys
import tempfile
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "harness"))
from station import BIN, ROOT, Failed, Program, Rest, check, run_cases, until  # noqa: E402

F1005 = bytes.fromhex("d300133ed7d30382980edeef34b4bd62ac0941986f3305ab51")
F1006 = bytes.fromhex("d300153ee04d0386ba9305d2030cd236880cd60114443a9801144b")
SECRET = "s3cret-pw"
LOGIN = base64.b64encode(f"rover:{SECRET}".encode()).decode()
TABLE = "Town;RTCM 3.2;1005(1);2;GPS+GLO;NET;FIN;60.17;24.94;1;0;gen;none;B;N;9600;"

scratch = pathlib.Path(tempfile.mkdtemp(prefix="roverd-ntrip."))


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


def gga():
    """A fix of this very moment: a clock that stands would be refused."""
    now = time.time()
    clock = time.strftime("%H%M%S", time.gmtime(now)) + f".{int(now * 10) % 10}0"
    body = f"GPGGA,{clock},6010.02000,N,02456.11000,E,1,12,0.9,25.4,M,17.9,M,,"
    total = 0
    for c in body.encode():
        total ^= c
    return f"${body}*{total:02X}\r\n".encode()


class Receiver:
    """The receiver's port: says where it is, and keeps what it is told."""

    def __init__(self):
        self.heard = b""
        self.server = socket.create_server(("127.0.0.1", 0))
        self.port = self.server.getsockname()[1]
        threading.Thread(target=self._serve, daemon=True).start()

    def _serve(self):
        while True:
            try:
                client, _ = self.server.accept()
            except OSError:
                return
            threading.Thread(target=self._listen, args=(client,), daemon=True).start()
            try:
                while True:
                    client.sendall(gga())
                    time.sleep(0.1)
            except OSError:
                pass

    def _listen(self, client):
        try:
            while data := client.recv(4096):
                self.heard += data
        except OSError:
            pass

    def close(self):
        self.server.close()


class Caster:
    """A caster of our own. @param answer what it says after the request, piece by piece."""

    def __init__(self, answer, context=None):
        self.answer, self.context = answer, context
        self.requests = []
        self.refusal = None  # what a request without a Digest is answered with
        self.told = b""
        self.server = socket.create_server(("127.0.0.1", 0))
        self.port = self.server.getsockname()[1]
        threading.Thread(target=self._serve, daemon=True).start()

    def _serve(self):
        while True:
            try:
                client, _ = self.server.accept()
                if self.context:
                    client = self.context.wrap_socket(client, server_side=True)
            except ssl.SSLError:
                continue
            except OSError:
                return
            threading.Thread(target=self._speak, args=(client,), daemon=True).start()

    def _speak(self, client):
        try:
            request = b""
            while b"\r\n\r\n" not in request:
                piece = client.recv(4096)
                if not piece:
                    return
                request += piece
            self.requests.append(request.decode())
            if self.refusal and b"Authorization: Digest" not in request:
                client.sendall(self.refusal)
                return
            for piece in self.answer:
                client.sendall(piece)
            while data := client.recv(4096):
                self.told += data
        except OSError:
            pass

    def close(self):
        self.server.close()


class House:
    """roverd with a receiver and casters, without a vehicle."""

    def __init__(self, casters, env=None, record=False):
        self.receiver = Receiver()
        self.folder = pathlib.Path(tempfile.mkdtemp(dir=scratch))
        (self.folder / "vehicles").symlink_to(ROOT / "config/vehicles")
        config = self.folder / "robot.toml"
        config.write_text(f"""
[server]
log_level = "debug"
[drivers.bunker]
enabled = false
[drivers.gnss]
enabled = true
link = "tcp:127.0.0.1:{self.receiver.port}"
[drivers.ntrip]
enabled = true
link = "{casters}"
gga_period_s = 1
[recording]
enabled = {str(record).lower()}
""")
        config.chmod(0o600)
        self.program = Program(BIN / "roverd", "--config", config, "--data", self.folder / "data",
                               "--port", "0", env=env, cwd=self.folder)
        base = self.program.wait_line(r"listening on (http://\S+)")[1]
        self.rest = Rest(base)

    def ntrip(self):
        return self.rest.call("GET", "/drivers/ntrip")[2]

    def until_state(self, state, seconds=20):
        return until(f"ntrip is {state}: {self.ntrip()}", seconds,
                     lambda: self.ntrip() if self.ntrip().get("state") == state else None)

    def until_reason(self, part, seconds=20):
        try:
            until(f"the reason says '{part}'", seconds,
                  lambda: part in str(self.ntrip().get("reason")))
        except Failed as error:
            raise Failed(f"{error}; it says: {self.ntrip()}") from None

    def everything_said(self):
        logs = "".join(p.read_text(errors="replace") for p in self.folder.glob("data/**/*.log"))
        api = "".join(str(self.rest.call("GET", path)[2]) for path in
                      ("/drivers", "/drivers/ntrip", "/events", "/vehicle", "/vehicle/capabilities"))
        return logs + api + " ".join(self.program.lines + self.program.errors)

    def keeps_its_secret(self):
        said = self.everything_said()
        check("ntrip" in said, "nothing was said at all")
        check(SECRET not in said and LOGIN not in said, "the login was told")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.program.stop()
        self.receiver.close()


class Str2str:
    """rtklib's caster, fed with two frames again and again."""

    def __init__(self):
        self.port = free_port()
        self.process = subprocess.Popen(
            ["str2str", "-in", "", "-out", f"ntripc://rover:{SECRET}@:{self.port}/TEST0:{TABLE}"],
            stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            cwd=scratch)
        self.going = True
        threading.Thread(target=self._feed, daemon=True).start()
        until("str2str listens", 10, self._listens)

    def _listens(self):
        try:
            socket.create_connection(("127.0.0.1", self.port), 1).close()
            return True
        except OSError:
            return False

    def _feed(self):
        try:
            while self.going:
                self.process.stdin.write(F1005 + F1006)
                self.process.stdin.flush()
                time.sleep(0.2)
        except OSError:
            pass

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.going = False
        self.process.terminate()
        try:
            self.process.wait(3)
        except subprocess.TimeoutExpired:  # it sometimes hangs in its own end
            self.process.kill()
            self.process.wait()


def frames_arrive(house, frame):
    until("the receiver hears the frame", 20, lambda: frame in house.receiver.heard)


def a_real_caster():
    """str2str: corrections reach the receiver's port unchanged and are counted"""
    with Str2str() as caster:
        url = f"ntrip://rover:{SECRET}@127.0.0.1:{caster.port}/TEST0"
        with House(url) as house:
            frames_arrive(house, F1005 + F1006)
            state = house.until_state("up")
            check(state["counts"].get("RTCM3 1005", 0) > 0, f"not counted: {state}")
            check(state["facts"]["protocol"] == "NTRIP 1", f"which protocol: {state}")
            until("the receiver's driver counts what it hands on", 10, lambda: house.rest.get(
                "/drivers/gnss")["counts"].get("correction frame for the receiver", 0))
            house.keeps_its_secret()


def corrections_are_recorded():
    """--record keeps the corrections' frames, with times and without the login; replay counts them"""
    with Str2str() as caster:
        url = f"ntrip://rover:{SECRET}@127.0.0.1:{caster.port}/TEST0"
        with House(url, record=True) as house:
            frames_arrive(house, F1005 + F1006)
            house.until_state("up")
            check(house.ntrip()["recording"] == "on", str(house.ntrip()))
            time.sleep(1)  # a second of it
            house.program.stop()
            tapes = {name: next(house.folder.glob(f"data/recordings/*-{name}.raw")) for name in ("gnss", "ntrip")}
            kept = tapes["ntrip"].read_bytes()
            check(F1005 in kept and F1006 in kept, "a frame is missing")
            check(re.match(rb"roverd-bytes 1 ntrip\n\(\d{10}\.\d{6}\) R 25\n", kept), str(kept[:80]))
            for tape in tapes.values():
                check(SECRET.encode() not in tape.read_bytes() and LOGIN.encode() not in tape.read_bytes(),
                      f"{tape.name} holds the login")
            said = subprocess.run([BIN / "roverd", "replay", *tapes.values(), "--report", "--config",
                                   house.folder / "robot.toml"], capture_output=True, text=True, check=False)
            check(said.returncode == 0, said.stderr)
            check("RTCM3 1005" in said.stdout, said.stdout[-600:])


def the_table():
    """roverd ntrip table lists what a caster offers, as text and as JSON"""
    with Str2str() as caster:
        run = [BIN / "roverd", "ntrip", "table", f"127.0.0.1:{caster.port}"]
        text = subprocess.run(run, capture_output=True, text=True, check=False)
        check(text.returncode == 0, text.stderr)
        check("TEST0" in text.stdout and "RTCM 3.2" in text.stdout and "60.17" in text.stdout, text.stdout)
        table = json.loads(subprocess.run([*run, "--json"], capture_output=True, check=True).stdout)
        check(table[0]["mountpoint"] == "TEST0" and table[0]["country"] == "FIN", str(table))
        check(table[0]["lat"] == 60.17 and table[0]["wants_gga"] and table[0]["login"] == "basic", str(table))
    away = subprocess.run([BIN / "roverd", "ntrip", "table", f"ntrip://a:{SECRET}@127.0.0.1:{free_port()}"],
                          capture_output=True, text=True, check=False)
    check(away.returncode == 1 and SECRET not in away.stderr, away.stderr)
    check(subprocess.run([BIN / "roverd", "ntrip"], capture_output=True, check=False).returncode == 2, "usage")


def by_digest():
    """a caster that wants the login as a Digest gets a right one"""
    caster = Caster([b"HTTP/1.1 200 OK\r\nContent-Type: gnss/data\r\n\r\n" + F1005])
    caster.refusal = (b'HTTP/1.1 401 Unauthorized\r\nWWW-Authenticate: Digest realm="net", qop="auth", '
                      b'nonce="n0nce"\r\nConnection: close\r\n\r\n')
    with House(f"ntrip://rover:{SECRET}@127.0.0.1:{caster.port}/VRS") as house:
        frames_arrive(house, F1005)
        house.keeps_its_secret()
        said = dict(re.findall(r'(\w+)="?([^",\r]+)"?', caster.requests[-1].split("Digest ")[1].split("\r")[0]))
        md5 = lambda text: hashlib.md5(text.encode()).hexdigest()  # noqa: E731
        wanted = md5(f"{md5(f'rover:net:{SECRET}')}:n0nce:00000001:{said['cnonce']}:auth:{md5('GET:/VRS')}")
        check(said["response"] == wanted, f"{said} instead of {wanted}")
    caster.close()


def a_wrong_login():
    """str2str: a refused login is said, not tried again soon, and nowhere told"""
    with Str2str() as caster:
        with House(f"ntrip://rover:wrong-{SECRET}@127.0.0.1:{caster.port}/TEST0") as house:
            house.until_reason("does not accept the login")
            house.keeps_its_secret()


def no_such_mountpoint():
    """str2str: an unknown mountpoint is answered with the ones there are"""
    with Str2str() as caster:
        with House(f"ntrip://rover:{SECRET}@127.0.0.1:{caster.port}/NOWHERE") as house:
            house.until_reason("no mountpoint NOWHERE; it has: TEST0 (RTCM 3.2)")


def the_next_caster():
    """a caster that is not there is passed, the next in the list serves"""
    with Str2str() as caster:
        login = f"rover:{SECRET}@127.0.0.1"
        with House(f"ntrip://{login}:{free_port()}/A ntrip://{login}:{caster.port}/TEST0") as house:
            house.until_state("up")
            check(house.ntrip()["link"]["address"].endswith("/TEST0"), str(house.ntrip()))


def second_version():
    """version 2: chunks are undone, and the caster is told where we are"""
    chunk = F1005[:7]
    rest = F1005[7:] + F1006
    caster = Caster([b"HTTP/1.1 200 OK\r\nNtrip-Version: Ntrip/2.0\r\nContent-Type: gnss/data\r\n"
                     b"Transfer-Encoding: chunked\r\n\r\n",
                     b"%x\r\n%b\r\n" % (len(chunk), chunk), b"%x\r\n%b\r\n" % (len(rest), rest)])
    with House(f"ntrip://rover:{SECRET}@127.0.0.1:{caster.port}/VRS") as house:
        frames_arrive(house, F1005 + F1006)
        check(house.until_state("up")["facts"]["protocol"] == "NTRIP 2", str(house.ntrip()))
        until("the caster hears a position", 20, lambda: b"$GPGGA," in caster.told)
        line = caster.told.split(b"\r\n")[0]
        check(b",6010.02000,N,02456.11000,E,1,12," in line, f"another position: {line}")
        check(caster.requests[0].startswith("GET /VRS HTTP/1.1\r\n"), caster.requests[0])
        house.keeps_its_secret()
    caster.close()


def through_tls():
    """TLS: a caster whose certificate is trusted serves, one whose is not is refused"""
    key, cert = scratch / "key.pem", scratch / "cert.pem"
    subprocess.run(["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2",
                    "-subj", "/CN=localhost", "-addext", "subjectAltName=DNS:localhost",
                    "-keyout", key, "-out", cert], check=True, capture_output=True)
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(cert, key)
    caster = Caster([b"HTTP/1.1 200 OK\r\nContent-Type: gnss/data\r\n\r\n" + F1005], context)
    url = f"ntrips://rover:{SECRET}@localhost:{caster.port}/VRS"
    with House(url, env={**os.environ, "SSL_CERT_FILE": str(cert)}) as house:
        frames_arrive(house, F1005)
        check(house.until_state("up")["link"]["address"].startswith("ntrips://localhost:"), "which link")
        house.keeps_its_secret()
    asked = len(caster.requests)
    with House(url) as house:
        house.until_reason("TLS: certificate verify failed")
        check(len(caster.requests) == asked, "the login was sent to a stranger")
    caster.close()


try:
    code = run_cases([a_real_caster, corrections_are_recorded, the_table, by_digest, a_wrong_login,
                      no_such_mountpoint, the_next_caster, second_version, through_tls])
finally:
    shutil.rmtree(scratch, ignore_errors=True)
sys.exit(code)

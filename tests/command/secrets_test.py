#!/usr/bin/env python3
"""Where secrets may be and where not: passwords, PINs, cookies, tokens, codes, a caster's login.

A run of the real programs uses them all. Afterwards everything that was written and answered is searched."""

import base64
import contextlib
import pathlib
import socket
import subprocess
import sys
import tempfile
import threading

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "harness"))
from field import PASSWORD, Caller, Field  # noqa: E402
from station import BIN, ROOT, Program, Station, check, run_cases, until  # noqa: E402

LOGIN = "rover:a caster%27s secret"
CASTER = "a caster's secret"
TYPED = {"second": "seven geese on a roof", "third": "nine pigs in the rain", "wrong": "eleven goats at sea",
         "in the field of the name": "twelve owls after dark"}


class Caster:
    """Refuses every login."""

    def __enter__(self):
        self.server = socket.create_server(("127.0.0.1", 0))
        self.asked = []
        threading.Thread(target=self.serve, daemon=True).start()
        return self

    def serve(self):
        with contextlib.suppress(OSError):
            while True:
                one, _ = self.server.accept()
                with one, contextlib.suppress(OSError):
                    self.asked.append(one.recv(4096))
                    one.sendall(b"HTTP/1.1 401 Unauthorized\r\nWWW-Authenticate: Basic realm=\"x\"\r\n"
                                b"Content-Length: 0\r\nConnection: close\r\n\r\n")

    def __exit__(self, *_):
        self.server.close()


def configured(folder, link, mode=0o600):
    """A configuration beside the profiles, with a caster's login."""
    for name in ("vehicles", "sim"):
        if not (folder / name).exists():
            (folder / name).symlink_to(ROOT / "config" / name)
    file = folder / "robot.toml"
    file.write_text((ROOT / "config/robot.toml").read_text()
                    + f'\n[drivers.ntrip]\nenabled = true\nlink = "{link}"\n')
    file.chmod(mode)
    return file


def starts(folder, *options):
    """@return exit code and words of a start that is refused"""
    program = Program(BIN / "roverd", "--config", folder / "robot.toml", "--data", folder / "data", "--port", "0",
                      "--set", "drivers.bunker.enabled=false", "--set", "drivers.gnss.enabled=false", *options)
    code = program.wait_exit(20)
    return code, " ".join(program.lines + program.errors)


def open_files():
    """a configuration with a login that others can read is refused, with its name, line and mode, and without the
    login"""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for mode in (0o644, 0o640, 0o604, 0o620):
            file = configured(folder, f"ntrip://{LOGIN.replace(' ', '%20')}@127.0.0.1:9/A", mode)
            code, said = starts(folder)
            check(code == 2, f"{mode:o}: exit code {code}: {said}")
            for word in (str(file), "drivers.ntrip.link has a login", f"(mode {mode:04o})", f"chmod go= {file}"):
                check(word in said, f"{word} is missing: {said}")
            check("secret" not in said, f"the login is told: {said}")
        configured(folder, "ntrip://127.0.0.1:9/A", 0o644)
        check("can be read" not in starts(folder, "--set", "nobody=1")[1], "a file without a login is refused")


def wrong_settings():
    """what is wrong with a setting that holds a login is told without it"""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        wrong = "ntrip://" + LOGIN.replace(" ", "%20") + "@127.0.0.1:9x/A"
        configured(folder, wrong)
        for options in ((), ("--set", f"drivers.ntrip.link={wrong}"), ("--set", f"drivers.ntrip.lonk={wrong}")):
            code, said = starts(folder, *options)
            check(code == 2 and "drivers.ntrip.l" in said and "secret" not in said, f"{code}: {said}")


def use_everything(field):
    """@return the secrets that were used"""
    used = {"password": PASSWORD, "code": field.code, "cookie": field.cookie.split("=", 1)[1], **TYPED,
            **{f"token of {role}": token for role, token in field.tokens.items()}}
    nobody, anna = field.nobody, field.anna

    def log_in(user, password):
        return nobody.call("POST", "/session", {"user": user, "password": password, "device": "tablet"})
    check(log_in("anna", TYPED["wrong"])[0] == 401, "a wrong password is taken")
    check(log_in(TYPED["in the field of the name"], "x")[0] == 401, "somebody is let in")
    check(nobody.call("POST", "/session", b'{"user":"anna","password":"' + TYPED["wrong"].encode())[0] in (400, 415),
          "half a body is taken")
    nobody.call("GET", f"/vehicle?password={TYPED['wrong'].replace(' ', '%20')}")
    anna.do("POST", "/users", {"name": "bert", "role": "operator", "password": TYPED["second"]}, 201)
    status, headers, answer = log_in("bert", TYPED["second"])
    check(status == 200, f"bert is not let in: {answer}")
    used["bert's cookie"] = headers["Set-Cookie"].split(";")[0].split("=", 1)[1]
    bert = Caller(field.station, {"Cookie": headers["Set-Cookie"].split(";")[0], "Origin": field.station.address})
    bert.do("GET", "/vehicle")
    anna.do("PATCH", "/users/bert", {"password": TYPED["third"]}, 200)
    check(bert.call("GET", "/vehicle")[0] == 401, "bert is still in")
    key = {"Idempotency-Key": "once"}
    for _ in range(2):
        made = anna.do("POST", "/tokens", {"name": "again", "role": "viewer"}, 201, key)
    used["token made twice"] = made["token"]
    Caller(field.station, {"Authorization": "Bearer " + made["token"] + "x"}).do("GET", "/vehicle", status=401)
    anna.do("DELETE", f"/tokens/{made['id']}", status=204)
    return used


def use_devices(field):
    """Pairs a browser and a phone. @return the secrets that were used"""
    used = {"PIN": "40719358", "wrong PIN": "82640917", "phone's PIN": "95283074"}
    browser = {"Origin": field.station.address}

    def kept(headers, name):
        cookies = dict(one.split(";")[0].split("=", 1) for one in headers.get_all("Set-Cookie"))
        device, secret = next(one for one in cookies.items() if one[0].endswith("roverd_device"))
        used[f"{name}'s cookies"] = secret
        return {**browser, "Cookie": f"{device}={secret}"}
    _, headers, _ = field.anna.call("POST", "/devices", {"name": "tractor", "pin": used["PIN"]})
    tractor = Caller(field.station, kept(headers, "tractor"))
    check(tractor.call("POST", "/session", {"pin": used["wrong PIN"]})[0] == 401, "a wrong PIN is taken")
    status, headers, answer = tractor.call("POST", "/session", {"pin": used["PIN"]})
    check(status == 200, f"the PIN is not taken: {answer}")
    used["cookie by PIN"] = headers["Set-Cookie"].split(";")[0].split("=", 1)[1]
    used["invitation"] = field.anna.do("POST", "/invitations", {}, 201)["code"]
    phone = {"code": used["invitation"], "name": "phone", "pin": used["phone's PIN"]}
    wrong = Caller(field.station, browser).call("POST", "/invitations/accept", {**phone, "code": "ZZZZ-ZZZZ"})
    check(wrong[0] == 401, f"a wrong code: {wrong[0]}")
    status, headers, answer = Caller(field.station, browser).call("POST", "/invitations/accept", phone)
    check(status == 200, f"the phone is not paired: {answer}")
    kept(headers, "phone")
    return used


def answers(field):
    """Of everything that can be read, by the highest role. @return address → bytes"""
    out = {}
    for path, operations in field.admin.do("GET", "/openapi.json")["paths"].items():
        if "get" not in operations or "{" in path or path == "/stream":
            continue
        out[path] = repr(field.admin.call("GET", path)[1:]).encode()
    for path in ("/audit/export?format=jsonl", "/audit/export?format=csv", "/events?limit=1000", "/drivers/ntrip"):
        status, _, answer = field.admin.call("GET", path)
        check(status == 200, f"{path} answers {status}")
        out[path] = repr(answer).encode()
    return out


def written(field):
    """Every file of the data folder, and what was printed; keys of TLS stay where they are."""
    data = field.station.scratch / "data"
    out = {str(file.relative_to(data)): file.read_bytes() for file in data.rglob("*")
           if file.is_file() and file.parent.name != "tls"}
    check("roverd.db" in out and "roverd.log" in out, f"only {list(out)} was written")
    out["stderr"] = "\n".join(field.station.roverd.errors).encode()
    out["stdout"] = "\n".join(field.station.roverd.lines).encode()
    return out


def secrets():
    """a run that uses them all: no secret is in a file, in a log, in an answer or in what is printed"""
    with tempfile.TemporaryDirectory() as name, Caster() as caster:
        port = caster.server.getsockname()[1]
        config = configured(pathlib.Path(name), f"ntrip://{LOGIN.replace(' ', '%20')}@127.0.0.1:{port}/A")
        with Field("--set", "server.log_level=debug", config=config) as field:
            used = {**use_everything(field), **use_devices(field)}
            basic = base64.b64encode(f"rover:{CASTER}".encode())
            until("the caster is asked", 20, lambda: any(basic in one for one in caster.asked))
            until("its refusal is told", 20, lambda: field.admin.do("GET", "/drivers/ntrip")["state"] != "up")
            used.update({"caster": CASTER, "caster's login": basic.decode(), "caster as written": LOGIN})
            told = answers(field)
            copy = subprocess.run([BIN / "roverd", "backup", "--data", field.station.scratch / "data"],
                                  capture_output=True, text=True, timeout=60, check=False)
            check(copy.returncode == 0, copy.stderr)
            field.station.roverd.stop()
            told.update(written(field))
            check(any("backups" in where for where in told), f"there is no backup: {list(told)}")
            private(field.station.scratch / "data")
    code = used.pop("code")
    lines = [line for line in told["stdout"].decode().splitlines() if code in line]
    check(len(lines) == 1 and "first admin" in lines[0], f"the code is printed so: {lines}")
    for where, content in told.items():
        check(code.encode() not in content or where == "stdout", f"the code is in {where}")
        for kind, secret in used.items():
            check(secret.encode() not in content, f"the secret '{kind}' is in {where}")
    print(f"    {len(used) + 1} secrets, {len(told)} files and answers, {sum(map(len, told.values())) // 1000} kB")


def private(data):
    """Nothing of it can others read."""
    for file in data.rglob("*"):
        check(file.stat().st_mode & 0o077 == 0, f"{file} is open: {file.stat().st_mode & 0o777:o}")


def older_files():
    """a database that an older version let others read is closed to them"""
    with tempfile.TemporaryDirectory() as name:
        data = pathlib.Path(name) / "data"
        with Field(data=data):
            pass
        (data / "roverd.db").chmod(0o644)
        with Station(data=data):
            check((data / "roverd.db").stat().st_mode & 0o777 == 0o600, "the database stays open")


if __name__ == "__main__":
    sys.exit(run_cases([open_files, wrong_settings, secrets, older_files]))

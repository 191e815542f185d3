"""Violations that the doors must find, each as somebody once hid one, and what must pass."""

import pathlib
import subprocess
import tempfile

import objects
from sources import House
from table import Table

# file -> (content, part of the finding)
CPP = {
    "server/base/a.cpp": ('#include "mission/plan.hpp"\n', "no door to mission"),
    "server/base/b.cpp": ("#include <thread>\n", "does not use <thread>"),
    "server/base/c.cpp": ("#include <sys/socket.h>\n", "does not use <sys/socket.h>"),
    "server/mission/a.cpp": ("auto t = base::steady_now();\n", "reads a clock"),
    "server/mission/b.cpp": ("#include <SQLiteCpp/Database.h>\n", "does not use <SQLiteCpp"),
    "server/mission/json/a.cpp": ('#include "mission/survey/cells.hpp"\n', "no door to mission/survey"),
    "server/nav/track/a.cpp": ("#include <mutex>\n", "does not use <mutex>"),
    "server/nav/track/b.cpp": ('#include "nav/estimate/ekf.hpp"\n', "no door to nav/estimate"),
    "server/nav/b.cpp": ("#include <nlohmann/json.hpp>\n", "does not use <nlohmann"),
    "server/nav/c.cpp": ("auto t = std::chrono::steady_clock::now();\n", "reads a clock"),
    "server/nav/d.cpp": ('#include "pose.hpp"\n', "an include names its room"),
    "server/robot/a.cpp": ('#include "link/link.hpp"\n', "no door to link"),
    "server/store/a.cpp": ('#include "robot/robot.hpp"\n', "no door to robot"),
    "server/api/a.cpp": ("#include <boost/asio.hpp>\n", "does not use <boost/asio.hpp>"),
    "server/api/b.cpp": ('#include "nav/track/track.hpp"\n', "no door to nav/track"),
    "server/net/a.cpp": ("// the mission goes out here\n", "net knows no robot word"),
    "server/misc/a.cpp": ("\n", "is no room of this house"),
    "server/loose.cpp": ('#include "sim/motion.hpp"\n', "is no room of this house"),
    "server/app/a.cpp": ('#include "sim/motion.hpp"\n', "no door to sim"),
    "drivers/link/a.cpp": ('#include "bunker/codec.hpp"\n', "no door to bunker"),
    "drivers/bunker/codec.cpp": ('#include "link/link.hpp"\n', "no door to link"),
    "drivers/bunker/own.cpp": ('#include "bunker/driver.hpp"\n', "no door to a driver"),
    "drivers/bunker/driver.cpp": ('#include "gnss/nmea.hpp"\n', "no door to gnss"),
    "drivers/gnss/nmea.cpp": ("#include <fstream>\n", "does not use <fstream>"),
    "drivers/sim/a.cpp": ('#include "nav/track/track.hpp"\n', "no door to nav/track"),
    "drivers/sim/b.cpp": ('#include "bunker/driver.hpp"\n', "no door to a driver"),
    "drivers/loose.cpp": ("\n", "is no room of this house"),
    # written so that it is not seen
    "server/nav/e01.cpp": ('#include "../store/store.hpp"\n', "not the way to it"),
    "server/nav/e02.cpp": ('#include "base/../store/store.hpp"\n', "not the way to it"),
    "server/nav/e03.cpp": ('#include "./store/store.hpp"\n', "not the way to it"),
    "server/nav/e04.cpp": ('#include "mutex"\n', 'there is no "mutex"'),
    "server/nav/e05.cpp": ("#include <store/store.hpp>\n", "no door to store"),
    "server/nav/e06.cpp": ('#define HEADER "store/store.hpp"\n#include HEADER\n', "names its header"),
    "server/nav/e07.cpp": ('#include_next <mutex>\n', "#include_next is not used"),
    "server/nav/e08.cpp": ("#if __has_include(<sys/socket.h>)\n#endif\n", "does not use <sys/socket.h>"),
    "server/nav/e09.cpp": ("#inc\\\nlude <mu\\\ntex>\n", "does not use <mutex>"),
    "server/nav/e10.cpp": ("#/* here */ include /* there */ <mutex>\n", "does not use <mutex>"),
    "server/nav/e11.cpp": ("/* a comment\n*/ # /* over\n lines */ include <mutex>\n", "does not use <mutex>"),
    "server/nav/e12.cpp": ('const char* a = R"x(\n"/*)x";\n#include <mutex>\n// */\n', "does not use <mutex>"),
    "server/nav/e13.cpp": ("%:include <mutex>\n", "does not use <mutex>"),
    "server/nav/e14.cpp": ("const int a = 1'000;\n#include <mutex>\nconst int b = 1'000;\n", "does not use <mutex>"),
    "server/nav/e15.cpp": ('const char a = \'"\';\n#include <mutex>\nconst char b = \'"\';\n', "does not use <mutex>"),
    "server/nav/e16.cpp": ('auto a = "/*";\n#include <mutex>\nauto b = "*/";\n', "does not use <mutex>"),
    "server/nav/e17.cpp": ("// no more \\\n*/\n#include <mutex>\n", "does not use <mutex>"),
    "server/nav/e18.cpp": ("#if 0\n#include <mutex>\n#endif\n", "does not use <mutex>"),
    "server/nav/e19.cpp": ("import <mutex>;\n", "a module"),
    "server/nav/e20.cpp": ("#import <mutex>\n", "#import is not used"),
    "server/nav/e21.cpp": ('extern "C" int clock_gettime(int, void*);\n', 'extern "C"'),
    "server/nav/e22.cpp": ('asm(".incbin \\"x\\"");\n', "assembler"),
    "server/nav/e23.cpp": ("auto t = std::chrono::steady_clock\n  :: /* now */ now();\n", "reads a clock"),
    "server/nav/e24.cpp": ("auto t = steady\\\n_now();\n", "reads a clock"),
    "server/nav/e25.cpp": ("#include <execution>\n", "does not use <execution>"),
    "server/nav/e26.cpp": ('#include "nav/track/a.cpp"\n', "what is included is a header"),
    "server/nav/e27.cpp": ('#include "/usr/include/pthread.h"\n', "not the way to it"),
    "server/nav/e28.cpp": ('\ufeff#include <mutex>\n', "does not use <mutex>"),
    "server/nav/e29.cpp": ("int a;\r\n#include <mutex>\r\n", "does not use <mutex>"),
    "server/nav/e30.cpp": ('#  include"store/store.hpp"\n', "no door to store"),
    "server/nav/e31.cpp": ("??=include <mutex>\n", "a trigraph"),
    "server/nav/e32.cpp": ('auto a = u8R"(\\\n)"; /*\n*/\n#include <mutex>\n', "does not use <mutex>"),
    "server/nav/f.h": ("#include <mutex>\n", "does not use <mutex>"),
    "server/nav/g.cc": ('#include "store/store.hpp"\n', "no door to store"),
    "server/nav/h.ipp": ("\n", "sources here end in .cpp"),
    "server/nav/i.hpp": ("#include <iostream>\n", "does not use <iostream>"),
    "server/api/routes/a.cpp": ('auto q = "SELECT id "\n"FROM missions";\n', "no SQL, not in pieces"),
    "server/api/c.cpp": ("boost::asio::ip::tcp /**/ ::\nsocket s;\n", "has no sockets"),
    "tests/unit/nav/a_test.cpp": ('#include "net/server.hpp"\n', "does not see server/net"),
    "tests/unit/nav/b_test.cpp": ('#include "../../../server/net/server.hpp"\n', "not the way to it"),
    "tests/unit/nav/c_test.cpp": ('#define X "net/server.hpp"\n#include X\n', "names its header"),
    "server/store/b.cpp": ("// TO" "DO later\n", "unfinished"),
    "server/store/c.cpp": ("\n" * 601, "601 lines"),
}
WEB = {
    "web/src/model/a.ts": ('import { Map } from "ol";\n', "does not import 'ol'"),
    "web/src/model/b.ts": ("export const w = document.body;\n", "'document'"),
    "web/src/model/c.ts": ("const { fetch: get } = globalThis;\nexport { get };\n", "'fetch'"),
    "web/src/model/d.ts": ("export const w = globalThis['local' + 'Storage'];\n", "'[…]'"),
    "web/src/model/e.ts": ('import "../ui/a";\n', "no door to web/src/ui"),
    "web/src/model/f.ts": ('export type A = import("../ui/a").A;\n', "no door to web/src/ui"),
    "web/src/model/g.ts": ('/// <reference path="../ui/a.ts" />\nexport {};\n', "no door to web/src/ui"),
    "web/src/map/a.ts": ('import { rest } from "../link/rest";\n', "no door to web/src/link"),
    "web/src/map/b.ts": ('export * from "../link/rest";\n', "no door to web/src/link"),
    "web/src/map/c.ts": ('import type { Rest } from "../link/rest";\nexport type R = Rest;\n', "no door to web/src/link"),
    "web/src/map/d.ts": ('export const a = import(\n  /* there */ `../link/rest`\n);\n', "no door to web/src/link"),
    "web/src/map/e.ts": ('import { rest } from "@page/link/rest";\nexport { rest };\n', "no door to web/src/link"),
    "web/src/map/f.ts": ('const n = "../link/rest";\nexport const a = import(n);\n', "name is computed"),
    "web/src/map/g.ts": ("export const a = import.meta.glob('../link/*.ts');\n", "name is computed"),
    "web/src/map/h.ts": ("export const a = new URL('../link/rest.ts', import.meta.url);\n", "no door to web/src/link"),
    "web/src/map/i.ts": ("export const a = window.fetch('/');\n", "'fetch'"),
    "web/src/map/j.ts": ("export const a = new (globalThis as never as { X: 1 } & typeof globalThis).WebSocket('/');\n",
                         "'WebSocket'"),
    "web/src/map/k.ts": ("export const a = self['fetch'];\n", "'fetch'"),
    "web/src/map/l.ts": ("export const a = new Function('return fetch')();\n", "runs text"),
    "web/src/map/m.ts": ("import '../nowhere';\n", "leads nowhere"),
    "web/src/map/n.js": ("export * from '../link/rest';\n", "no door to web/src/link"),
    "web/src/ui/Panel.svelte": ('<script>import M from "ol/Map";</script>\n', "does not import 'ol/Map'"),
    "web/src/ui/B.svelte": ('<script module lang="ts">\nimport { rest } from "../link/rest";\n</script>\n<p></p>\n',
                            "no door to web/src/link"),
    "web/src/ui/C.svelte": ("{#await import('../link/rest')}<p></p>{/await}\n", "no door to web/src/link"),
    "web/src/ui/D.svelte": ("<button onclick={() => fetch('/')}>x</button>\n", "'fetch'"),
    "web/src/ui/E.svelte": ("<p></p>\n<style>@import '../link/x.css';</style>\n", "no door to web/src/link"),
    "web/src/ui/F.svelte": ("<script>const a = 1; const send = (x) => navigator.sendBeacon(x);</script>\n", "'sendBeacon'"),
    "web/src/ui/x.css": ("@import url(../link/x.css);\n", "no door to web/src/link"),
    "web/src/ui/y.css": ("p { background: url(https://example.org/x.png); }\n", "comes from elsewhere"),
    "web/src/link/a.ts": ('export const x = await import("../map/b");\n', "no door to web/src/map"),
    "web/src/main.ts": ('import "./model/ok";\nimport "./other/a";\n', "lies outside every room"),
    "web/src/other/a.ts": ("export {};\n", "web/src/other is no room"),
    "tests/page/a.spec.ts": ('import { plan } from "../../web/src/model/ok";\nexport { plan };\n', "no door to web/src/model"),
}
CLEAN = {
    "server/base/ok.cpp": '#include "base/geo.hpp"\n#include <GeographicLib/Geodesic.hpp>\n',
    "server/nav/ok.cpp": '#include <Eigen/Dense>\n#include "mission/plan.hpp"\n// never steady_now\n'
                         'auto a = "#include <mutex>"; /*\n#include <mutex>\n*/ auto b = R"(\n#include <thread>\n)";\n'
                         "const int c = 1'000; const char d = '\\'';\n",
    "server/mission/plan.hpp": "#pragma once\n",
    "server/mission/survey/cells.hpp": "#pragma once\n",
    "server/base/geo.hpp": "#pragma once\n",
    "server/base/bytes.hpp": "#pragma once\n",
    "server/nav/estimate/ekf.hpp": "#pragma once\n",
    "server/nav/track/track.hpp": "#pragma once\n",
    "server/store/store.hpp": "#pragma once\n",
    "server/robot/robot.hpp": "#pragma once\n",
    "server/net/server.hpp": "#pragma once\n",
    "server/net/ok.cpp": "#include <boost/beast/http.hpp>\n// permission, transmission\n",
    "server/api/api.hpp": '#pragma once\n#include "store/store.hpp"\n',
    "server/app/main.cpp": '#include "api/api.hpp"\n#include "bunker/driver.hpp"\n#include "app/version.hpp"\n',
    "drivers/link/link.hpp": "#pragma once\n",
    "drivers/link/ok.cpp": "#include <net/if.h>\n",
    "drivers/sim/motion.hpp": "#pragma once\n",
    "drivers/gnss/nmea.hpp": "#pragma once\n",
    "drivers/gate/gate.cpp": '#include <mutex>\n#include "base/bytes.hpp"\n',
    "drivers/bunker/codec.hpp": "#pragma once\n",
    "drivers/bunker/driver.hpp": '#pragma once\n#include "link/link.hpp"\n',
    "drivers/bunker/ok_driver.cpp": '#include "bunker/codec.hpp"\n#include "link/link.hpp"\n',
    "tests/unit/nav/ok_test.cpp": '#include "nav/track/track.hpp"\n#include "base/geo.hpp"\n#include <thread>\n',
    "tests/loop/ok_test.cpp": '#include "net/server.hpp"\n',
    "web/src/ui/a.ts": "export type A = 1;\nexport const f = async (x: { fetch: (y: null) => void }) => x.fetch(null);\n",
    "web/src/ui/Ok.svelte": "<script lang=\"ts\">\n  let { fetched }: { fetched: string } = $props();\n</script>\n"
                            "<!-- import('../link/rest') --><p>fetch {fetched}</p>\n",
    "web/src/link/rest.ts": "export interface Rest { a: 1 }\nexport const rest = () => fetch('/');\n",
    "web/src/link/x.css": "p { color: red; }\n",
    "web/src/map/ok.ts": 'import Map from "ol/Map";\nimport { plan } from "../model/ok";\nexport const a = [Map, plan];\n',
    "web/src/model/ok.ts": "export const plan = 1; // document.body\nexport const t = 'fetch(';\n",
    "web/tests/ok.test.ts": 'import { test } from "vitest";\nimport { plan } from "../src/model/ok";\ntest("", () => plan);\n',
}
TSCONFIG = ('{"compilerOptions": {"target": "ES2022", "module": "ESNext", "moduleResolution": "bundler",'
            ' "lib": ["ES2023", "DOM"], "baseUrl": ".", "paths": {"@page/*": ["src/*"]}}}')

# library -> (C++ of its only object, part of the finding or "" for none)
OBJECTS = {
    "nav": ('extern "C" int clock_gettime(int, void*);\nint a() { return clock_gettime(0, nullptr); }',
            "server/nav uses clock: clock_gettime"),
    "robot": ('namespace roverd::store { int put(int); }\nint b() { return roverd::store::put(1); }',
              "server/robot has no door to server/store: roverd::store::put"),
    "store": ('namespace roverd::store { int put(int a) { return a; } }\nextern "C" int sqlite3_open();\n'
              "int c() { return sqlite3_open(); }", ""),
    "mission": ('extern "C" int socket(int, int, int);\nusing F = int (*)(int, int, int);\nF d() { return &socket; }',
                "server/mission uses socket: socket"),
    "api": ('extern "C" int sqlite3_exec();\nint e() { return sqlite3_exec(); }', "server/api uses sqlite: sqlite3_exec"),
    "gate": ('extern "C" double atan2(double, double);\nextern "C" int pthread_mutex_lock(void*);\n'
             "double f(double a) { return pthread_mutex_lock(nullptr) + atan2(a, 2); }", ""),
    "rtcm": ('namespace roverd::base { long steady_now(int); }\nlong g() { return roverd::base::steady_now(1); }',
             "drivers/rtcm uses clock: roverd::base::steady_now"),
    "pwm": ('extern "C" int open_the_pod_bay_doors();\nint h() { return open_the_pod_bay_doors(); }',
            "what no group of the table knows: open_the_pod_bay_doors"),
    "ubx": ('extern "C" __attribute__((weak)) void* dlsym(void*, const char*);\n'
            'void* i() { return dlsym(nullptr, "x"); }', "drivers/ubx uses process: dlsym"),
    "twist": ('namespace spdlog { void info(int); }\nvoid j() { spdlog::info(1); }', "drivers/twist uses spdlog: spdlog::info"),
    "stowaway": ("int k() { return 1; }", "libstowaway.a belongs to no room"),
}
DEPS = """server/nav/CMakeFiles/nav.dir/Unity/unity_0_cxx.cxx.o: #deps 3, deps mtime 1 (VALID)
    ROOT/server/nav/track/track.hpp
    ROOT/server/store/store.hpp
    /usr/include/SQLiteCpp/Database.h
    /usr/include/c++/12/vector

server/api/CMakeFiles/api.dir/api.cpp.o: #deps 2, deps mtime 1 (VALID)
    ROOT/server/nav/track/track.hpp
    /usr/include/SQLiteCpp/Database.h

"""
PAST = ["server/nav: an object saw server/store/store.hpp", "server/nav: an object saw <SQLiteCpp/Database.h>"]


class Judge:
    def __init__(self):
        self.failed = 0

    def wants(self, holds, claim):
        self.failed += not holds
        print(f"{'ok' if holds else 'not ok'} - doors {claim}")


def grow(root, files):
    for name, text in files.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text, encoding="utf-8", newline="")


def judge_sources(judge, root, repository):
    files = {name: text for name, (text, _) in (CPP | WEB).items()} | CLEAN
    grow(root, files | {"web/tsconfig.json": TSCONFIG})
    (root / "web/node_modules").symlink_to(repository / "web/node_modules")
    (root / "server/nav/linked.cpp").symlink_to(root / "server/net/ok.cpp")
    findings = House(root, Table(), repository).check(sorted(files) + ["server/nav/linked.cpp"])
    for name, (_, cause) in (CPP | WEB).items():
        found = any(f.startswith(name + ":") and cause in f for f in findings)
        judge.wants(found, f"finds a planted \"{cause}\" in {name}")
    judge.wants(any("no symbolic links" in f for f in findings), "finds a symbolic link")
    for name in CLEAN:
        false_alarm = [f for f in findings if f.startswith(name + ":")]
        judge.wants(not false_alarm, f"lets {name} pass {' '.join(false_alarm)}".rstrip())


def judge_objects(judge, build, root):
    build.mkdir()
    for name, (text, _) in OBJECTS.items():
        source, made = build / f"{name}.cpp", build / f"{name}.o"
        source.write_text(text)
        subprocess.run(["g++", "-std=c++20", "-O1", "-c", source, "-o", made], check=True)
        subprocess.run(["ar", "qc", build / f"lib{name}.a", made], check=True)
    table = Table()
    findings = objects.symbols(table, build) + objects.archives(table, build)[1]
    for name, (_, cause) in OBJECTS.items():
        if cause:
            judge.wants(any(cause in f for f in findings), f"finds in lib{name}.a: {cause}")
        else:
            wrong = [f for f in findings if f.startswith(f"lib{name}.a:")]
            judge.wants(not wrong, f"lets lib{name}.a pass {' '.join(wrong)}".rstrip())
    seen = objects.headers(table, DEPS.replace("ROOT", str(root)), build, root)
    for past in PAST:
        judge.wants(any(past in f for f in seen), f"tells: {past}")
    judge.wants(len(seen) == len(PAST), f"tells nothing else of what objects saw: {seen}")


def self_test(repository):
    judge = Judge()
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder).resolve() / "tree"
        root.mkdir()
        judge_sources(judge, root, repository)
        judge_objects(judge, root / "build", root)
    return 1 if judge.failed else 0

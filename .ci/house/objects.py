"""Checks what the compiler made: the headers that each object saw, and the names that it needs.

A header says what a file means to use; the object says what it uses, whatever macro, alias or template
brought it in. Read from a build folder, after the build.
"""

import pathlib
import re
import subprocess

DEFINED = set("ABCDGRSTVWiu")
NEEDED = set("Uwv")  # weak or not: what is there is taken


# These include one another; who may name them, the sources tell.
BROAD = {"asio", "beast", "messages", "openssl", "digest"}


def archives(table, build):
    """(room, archive) of every library that the table names as a target, and those that are missing."""
    plan = build / "build.ninja"  # knows what is left over from an older one
    planned = plan.read_text(encoding="utf-8") if plan.exists() else None
    built = {p.name[3:-2]: p for p in build.rglob("lib*.a")
             if "tests" not in p.relative_to(build).parts and (planned is None or f"{p.relative_to(build)}:" in planned)}
    found, missing = [], []
    for room in table.rooms.values():
        around = table.rooms.get(room.name.rpartition("/")[0])
        inside = around is not None and room.row.get("targets") == around.row.get("targets")  # in its archives
        if not room.name.startswith(("server/", "drivers/")) or inside:
            continue
        for target in room.row.get("targets", [room.short]):
            if target in built:
                found.append((room, built.pop(target)))
            elif room.name != "server/app":
                missing.append(f"{room.name}: lib{target}.a is not built")
    missing += [f"lib{name}.a belongs to no room of the table" for name in sorted(built)]
    return found, missing


def names_of(archive):
    """(needed, defined): demangled names, of the whole archive."""
    told = subprocess.run(["nm", "-C", archive], capture_output=True, text=True, check=True).stdout
    needed, defined = set(), set()
    for line in told.splitlines():
        found = re.match(r"[0-9a-f ]{16} ([A-Za-z]) (.+)", line)
        if not found:
            continue
        kind, name = found.groups()
        if kind in NEEDED:
            needed.add(name)
        elif kind in DEFINED:
            defined.add(name)
    return needed - defined, defined


def short(symbol):
    return symbol if len(symbol) < 90 else symbol[:87] + "…"


def symbols(table, build):
    """Findings: what a room's objects need and its row does not grant."""
    found, findings = archives(table, build)[0], []
    known = [(room, archive.name, *names_of(archive)) for room, archive in found]
    home = {}
    for room, _, _, defined in known:
        for name in defined:
            home.setdefault(name, set()).add(room.name)
    for room, archive, needed, _ in known:
        granted = set(room.rights.uses) | set(room.rights.libraries)
        doors = set(room.rights.doors)
        if room.driver:
            granted |= room.driver.uses | set(room.driver.libraries)
            doors |= room.driver.doors
        for name in sorted(needed):
            owners = home.get(name, set())
            groups = table.groups_of(name)
            if room.name in owners or groups & granted:
                continue
            if groups:
                findings.append(f"{archive}: {room.name} uses {' or '.join(sorted(groups))}: {short(name)}")
            elif owners:
                if not any(enters(table, doors, owner) for owner in owners):
                    findings.append(f"{archive}: {room.name} has no door to {sorted(owners)[0]}: {short(name)}")
            elif "roverd::" not in name:
                findings.append(f"{archive}: {room.name} uses what no group of the table knows: {short(name)}")
    return findings


def enters(table, doors, owner):
    return any(d.split(":")[0] == owner or d.split(":")[0].startswith(owner + "/") for d in doors)


def closure(table, room):
    """Every room that may be seen through its doors, and through theirs."""
    seen, todo = set(), [n for n in table.names if (n + "/").startswith(room.name + "/")]
    while todo:
        name = todo.pop()
        if name in seen:
            continue
        seen.add(name)
        inner = table.rooms[name]
        for rights in filter(None, (inner.rights, inner.driver)):
            for door in rights.doors:
                door = door.split(":")[0]
                todo += [n for n in table.names if n == door or n.startswith(door + "/")]
    return seen


def granted_to(table, room):
    """(rooms in sight, libraries that any of them has)."""
    rooms, libraries = closure(table, room), set()
    for name in rooms:
        inner = table.rooms[name]
        libraries |= set(inner.rights.libraries) | set(inner.driver.libraries if inner.driver else ())
    return rooms, libraries


def seen_headers(build):
    """What the compiler wrote down of each object, as ninja keeps it."""
    return subprocess.run(["ninja", "-C", build, "-t", "deps"], capture_output=True, text=True,
                          check=True).stdout


def headers(table, told, build, root):
    """Findings: headers of ours, or of others, that reached an object past every door."""
    findings, seen_by = set(), {}
    for block in told.split("\n\n"):
        lines = block.splitlines()
        if not lines or "#deps" not in lines[0]:
            continue
        owner = re.match(r"((?:server|drivers)/.*?)/CMakeFiles/", lines[0])
        room = owner and table.room_of(owner[1] + "/x")
        if not room:
            continue
        if room.name not in seen_by:
            seen_by[room.name] = granted_to(table, room)
        for line in lines[1:]:
            cause = past_the_doors(table, seen_by[room.name], pathlib.Path(build, line.strip()), (build, root))
            if cause:
                findings.add(f"{room.name}: an object saw {cause}")
    return sorted(findings)


def past_the_doors(table, sight, path, folders):
    """What is wrong with a header that an object saw, or None."""
    rooms, granted = sight
    build, root = folders
    if path.is_relative_to("/usr/include"):
        header = str(path.relative_to("/usr/include"))
        owners = table.library_of(header) - BROAD
        return f"<{header}>, which no room in its sight uses" if owners and not owners & granted else None
    path = path.resolve()
    if path.is_relative_to(build) or not path.is_relative_to(root):
        return None
    other = table.room_of(path.relative_to(root))
    if other and other.name in rooms:
        return None
    return f"{path.relative_to(root)}, past every door to {other.name if other else 'it'}"

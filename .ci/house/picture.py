"""Writes what people see of the table: the README's rooms, docs/house.md and docs/house.svg.

compare() says whether the files are what the table gives; ./test readme calls it.
"""

from html import escape

BEGIN = "<!-- rooms: written by .ci/doors --write -->"
END = "<!-- end of rooms -->"


def parent_of(room, table):
    name = room.name.rsplit("/", 1)[0]
    return table.rooms.get(name) if not room.name.startswith("web/") else None


def doors_of(row):
    """Words of a row's doors; the rooms inside it go without saying."""
    inside = row["name"].split("/", 1)[-1] + "/"
    doors = [d for d in row.get("doors", []) if not d.startswith(inside)]
    words = ["every room" if d == "*" else "every driver" if d == "drivers/*" else "every room of the page" if d == "web/src/*" else d.removeprefix("web/src/")
             for d in doors]
    text = ", ".join(w for w in words)
    if row.get("but"):
        text += " but " + ", ".join(row["but"])
    return text or "nothing"


def device_doors(room):
    extra = room.row["device"].get("doors", [])
    return "codec: " + ", ".join(["base", *extra]) + "; driver also link, gate"


def besides(room):
    row = room.row
    return ", ".join(row["packages"] if "packages" in row else row.get("libraries", [])).replace("*", "every package")


def shown(table):
    """The rooms that people want to know of: no tests."""
    return [r for r in table.rooms.values() if r.is_what]


def readme_rows(table):
    rooms = shown(table)
    rows, devices = [], {}
    for room in rooms:
        if "device" in room.row:
            devices.setdefault(device_doors(room), []).append(room)
        elif not parent_of(room, table):
            inside = [r.name.rsplit("/", 1)[1] for r in rooms if r.name.startswith(room.name + "/")
                      and not r.name.startswith("web/")]
            what = room.is_what + (f" ({', '.join(inside)})" if inside else "")
            rows.append(f"| `{room.name}` | {what} | {doors_of(room.row)} | {besides(room)} |")
    at = next(i for i, row in enumerate(rows) if row.startswith("| `web/"))
    for doors, same in devices.items():
        names = ", ".join(f"`{r.name}`" for r in same)
        what = same[0].is_what if len(same) == 1 else "devices, each codec and driver"
        libraries = ", ".join(lib for r in same for lib in r.row["device"].get("libraries", []))
        rows.insert(at, f"| {names} | {what} | {doors} | {libraries} |")
        at += 1
    return rows


def readme_table(table):
    head = ["| room | what it is | may include | libraries |", "|---|---|---|---|"]
    return "\n".join([BEGIN, "", *head, *readme_rows(table), "", END])


def page(table):
    """docs/house.md: every room, those inside others too."""
    lines = ["# The rooms of the house", "",
             "Written by `.ci/doors --write` from `.ci/house/rooms.toml`; `.ci/doors` holds every source, import and",
             "compiled object against it. \"uses\": what its objects may call of the system.", "",
             "![The rooms and their doors](house.svg)", "",
             "| room | what it is | may include | libraries | uses | never |", "|---|---|---|---|---|---|"]
    for room in shown(table):
        row = room.row
        doors = device_doors(room) if "device" in row else doors_of(row)
        libraries = row["packages"] if "packages" in row else row.get("libraries", [])
        uses = ["atomics, locks"] if "device" in row else row.get("uses", [])
        lines.append(f"| `{room.name}` | {room.is_what} | {doors} | {', '.join(libraries)} | {', '.join(uses)} | "
                     f"{', '.join(row.get('never', []))} |")
    return "\n".join(lines) + "\n"


# ---- the picture

WIDE, HIGH, THIN, GAP_X, GAP_Y, EDGE = 176, 60, 26, 20, 44, 20


def nodes_and_arrows(table):
    """Top rooms of robot and drivers; the devices are one box."""
    def node(name):
        top = "/".join(name.split(":")[0].split("/")[:2])
        return "drivers/…" if "device" in table.rooms[top].row else top

    nodes, arrows = {}, {}
    for room in shown(table):
        if room.name.startswith("web/"):
            continue
        here = node(room.name)
        if room.name == room.top:
            nodes.setdefault(here, room.is_what)
        for rights in filter(None, (room.rights, room.driver)):
            for door in rights.doors:
                if not door.startswith("web/") and node(door) != here:
                    arrows.setdefault(here, set()).add(node(door))
    nodes["drivers/…"] = "codec and driver each: " + ", ".join(r.short for r in shown(table) if r.driver)
    return nodes, arrows


def reduced(arrows):
    """Without the arrows that a longer way says already."""
    def reach(name, seen):
        for other in arrows.get(name, ()):
            if other not in seen:
                seen.add(other)
                reach(other, seen)
        return seen

    return {name: sorted(o for o in others if not any(o in reach(p, set()) for p in others if p != o))
            for name, others in arrows.items()}


def laid_out(nodes, arrows):
    """(rows from the bottom up, ways): a way is a list of boxes and of thin places it passes between."""
    depth = {}

    def of(name):
        if name not in depth:
            depth[name] = 1 + max((of(o) for o in arrows.get(name, ())), default=-1)
        return depth[name]

    rows = [[] for _ in range(1 + max(map(of, nodes)))]
    for name in nodes:
        rows[of(name)].append(name)
    ways = []
    for name, others in sorted(reduced(arrows).items()):
        for other in others:
            between = [(name, other, level) for level in range(of(other) + 1, of(name))]
            for place in between:
                rows[place[2]].append(place)
            ways.append([other, *between, name])
    ordered(rows, ways)
    return rows, ways


def ordered(rows, ways):
    """Sorts each row by where its neighbours stand, to and fro, so that few ways cross."""
    beside = {}
    for way in ways:
        for a, b in zip(way, way[1:]):
            beside.setdefault(a, []).append(b)
            beside.setdefault(b, []).append(a)
    for sweep in range(12):
        for row in rows if sweep % 2 else reversed(rows):
            at = {}
            for other in rows:
                if other is not row:
                    at |= {name: (i + 0.5) / len(other) for i, name in enumerate(other)}
            mean = {n: sum(at[o] for o in beside[n]) / len(beside[n]) for n in row if n in beside}
            row.sort(key=lambda n: (mean.get(n, 0.5), str(n)))


def width_of(name):
    return WIDE if isinstance(name, str) else THIN


def wrapped(text, width=28):
    lines = [""]
    for word in text.replace("`", "").split():
        if len(lines[-1]) + len(word) + 1 > width and lines[-1]:
            lines.append("")
        lines[-1] = f"{lines[-1]} {word}".strip()
    if len(lines) < 3:
        return lines
    second = lines[1] if len(lines[1]) < width - 1 else lines[1].rsplit(" ", 1)[0]
    return [lines[0], second.rstrip(",:;") + " …"]


def box(x, y, title, what, tone):
    middle = f"{x + WIDE / 2:.0f}"
    out = [f'<rect x="{x:.0f}" y="{y}" width="{WIDE}" height="{HIGH}" rx="6" class="{tone}"/>',
           f'<text x="{middle}" y="{y + 19}" class="name">{escape(title)}</text>']
    return out + [f'<text x="{middle}" y="{y + 36 + 14 * at}">{escape(line)}</text>'
                  for at, line in enumerate(wrapped(what))]


def row_of_boxes(row, middle):
    """Where each of a row stands: name → x of its left side."""
    x = middle - (sum(map(width_of, row)) + GAP_X * (len(row) - 1)) / 2
    places = {}
    for name in row:
        places[name] = x
        x += width_of(name) + GAP_X
    return places


def curve(way, places):
    """From the upper box down to the lower one, through the thin places."""
    way = way[::-1]
    middle = {n: places[n][0] + width_of(n) / 2 for n in way}
    out = f"M{middle[way[0]]:.0f} {places[way[0]][1] + HIGH}"
    for upper, lower in zip(way, way[1:]):
        begin, end = places[upper][1] + HIGH, places[lower][1]
        out += f"C{middle[upper]:.0f} {begin + 22} {middle[lower]:.0f} {end - 22} {middle[lower]:.0f} {end}"
        if lower is not way[-1]:
            out += f"V{end + HIGH}"
    return f'<path d="{out}" marker-end="url(#tip)"/>'


STYLE = ("rect{stroke:#456;fill:#eef3f7}.drivers{fill:#f7f0e4}.page{fill:#eaf5ea}text{font-size:11px;fill:#333;"
         "text-anchor:middle}.name{font-size:13px;font-weight:bold;fill:#000}path{stroke:#789;fill:none}")
TIP = ('<defs><marker id="tip" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="8" markerHeight="8" orient="auto">'
       '<path d="M0 0 8 4 0 8z" style="fill:#789"/></marker></defs>')


def drawing(table):
    nodes, arrows = nodes_and_arrows(table)
    rows, ways = laid_out(nodes, arrows)
    page_rooms = [r for r in shown(table) if r.name.startswith("web/")]
    widest = max([*(sum(map(width_of, r)) + GAP_X * (len(r) - 1) for r in rows),
                  len(page_rooms) * (WIDE + GAP_X) - GAP_X])
    width, places = widest + 2 * EDGE, {}
    for level, row in enumerate(reversed(rows)):
        y = EDGE + level * (HIGH + GAP_Y)
        places |= {name: (x, y) for name, x in row_of_boxes(row, width / 2).items()}
    bottom = EDGE + len(rows) * (HIGH + GAP_Y) + 10
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {bottom + HIGH + EDGE}" '
           'font-family="sans-serif">',
           "<title>The rooms; an arrow leads to what a room may include (what a longer way says is left out)</title>",
           f"<style>{STYLE}</style>", TIP, '<rect width="100%" height="100%" style="fill:#fff;stroke:none"/>']
    out += [curve(way, places) for way in ways]
    for name, what in nodes.items():
        out += box(*places[name], name, what, name.split("/")[0])
    out.append(f'<text x="{width / 2:.0f}" y="{bottom - 12}">the page, which net serves: link, map and ui look at '
               "model; main.ts wires them</text>")
    titles = [r.name + ("/main.ts" if r.name == "web/src" else "") for r in page_rooms]
    for room, (title, x) in zip(page_rooms, row_of_boxes(titles, width / 2).items()):
        out += box(x, bottom, title, room.is_what, "page")
    return "\n".join([*out, "</svg>"]) + "\n"


# ---- files

def files(root, table):
    """path → what it should hold."""
    readme = (root / "README.md").read_text(encoding="utf-8")
    if BEGIN not in readme or END not in readme:
        raise SystemExit(f"README.md has no place for the rooms: {BEGIN} … {END}")
    before, rest = readme.split(BEGIN, 1)
    after = rest.split(END, 1)[1]
    return {root / "README.md": before + readme_table(table) + after,
            root / "docs/house.md": page(table),
            root / "docs/house.svg": drawing(table)}


def write(root, table):
    for path, text in files(root, table).items():
        path.parent.mkdir(exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return 0


def compare(root, table):
    """The files that are not what the table gives."""
    return [str(path.relative_to(root)) for path, text in files(root, table).items()
            if not path.exists() or path.read_text(encoding="utf-8") != text]

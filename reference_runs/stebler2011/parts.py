"""What the sections of the page are made of: results of `coast`, panels taken out of its pages, new curves and tables.

A page and its packed curves are described by docs/schema/page.schema.json.
"""

import base64
import json
import math
import os
import struct
import sys
import zlib


def load(*path):
    name = os.path.join(*path)
    try:
        with open(name, encoding="utf-8") as file:
            return json.load(file)
    except OSError as error:
        sys.exit(f"{name}: {error.strerror}; did the job that writes it run?")


def panel_of(folder, panel_id):
    """A panel of the page that a job left in `folder`, by its id."""
    page = load(folder, "report.json")
    panels = [panel for section in page.get("sections", []) for panel in section.get("panels", [])]
    for panel in panels:
        if panel["id"] == panel_id:
            return panel
    sys.exit(f"{folder}/report.json: no panel {panel_id!r} among {[panel['id'] for panel in panels]}")


def named(items, what, **keys):
    """The one of `items` whose members are `keys`."""
    for item in items:
        if all(item.get(key) == value for key, value in keys.items()):
            return item
    sys.exit(f"{what}: none with {keys}")


def curve_of(plot, label, kind="lines"):
    """x and y of a curve of a plot, by its label."""
    series = named(plot.get(kind, []), f"plot {plot.get('title', '')!r}", label=label)["series"]
    return unpack(series["x"]), unpack(series["y"])


def pieces_of(plot, label):
    """The pieces of an interrupted curve, each x and y."""
    series = named(plot["lines"], f"plot {plot.get('title', '')!r}", label=label)["series"]
    x, y = unpack(series["x"]), unpack(series["y"])
    bounds = [0, *series.get("breaks", []), len(x)]
    return [(x[a:b], y[a:b]) for a, b in zip(bounds, bounds[1:])]


def unpack(packed):
    n = packed["n"]
    data = zlib.decompress(base64.b64decode(packed["z"]))
    words = [data[i] | data[n + i] << 8 | data[2 * n + i] << 16 | data[3 * n + i] << 24 for i in range(n)]
    if "q" not in packed:
        return list(struct.unpack(f"<{n}f", struct.pack(f"<{n}I", *words)))
    values, count = [], 0
    for word in words:
        count = (count + word) & 0xFFFFFFFF
        values.append(packed["x0"] + packed["q"] * count)
    return values


def pack(values):
    data = struct.pack(f"<{len(values)}f", *values)
    ranked = b"".join(data[rank::4] for rank in range(4))
    return {"n": len(values), "z": base64.b64encode(zlib.compress(ranked)).decode()}


def line(label, x, y, tone="auto", **more):
    return {"label": label, "series": {"x": pack(x), "y": pack(y)}, "tone": tone, **more}


def distribution(label, values, tone, **more):
    """Share of the values below x, in per cent."""
    ordered = sorted(values)
    return line(label, ordered, [100.0 * (i + 1) / len(ordered) for i in range(len(ordered))], tone, width_px=1.8, **more)


def axis(label, unit="", scale="linear", limits=None, ticks=None):
    node = {"label": label, "unit": unit, "scale": scale}
    if limits:
        node["range"] = list(limits)
    if ticks:
        node["ticks"] = ticks
    return node


def panel(panel_id, title, caption, plots, columns=1):
    return {"id": panel_id, "title": title, "caption": caption, "columns": columns, "plots": plots}


def table(table_id, title, caption, columns, rows):
    """Columns are names; a name that ends in # is of numbers."""
    heads = [{"label": name.rstrip("#"), "numeric": name.endswith("#")} for name in columns]
    return {"id": table_id, "title": title, "caption": caption, "columns": heads, "rows": rows}


def section(section_id, title, lead, tables, panels):
    return {"id": section_id, "title": title, "lead": lead, "tables": tables, "panels": panels}


def sig(value, digits=3):
    """Significant digits, without an exponent between 1e-3 and 1e5."""
    if value == 0.0 or not math.isfinite(value):
        return f"{value:g}"
    if not 1e-3 <= abs(value) < 1e5:
        return f"{value:.{digits - 1}e}".replace("e-0", "e-").replace("e+0", "e")
    return f"{value:.{max(digits - 1 - math.floor(math.log10(abs(value))), 0)}f}"


def percent(share):
    return f"{100.0 * share:.0f} %"


def quantile(values, p):
    ordered = sorted(values)
    at = p * (len(ordered) - 1)
    low = math.floor(at)
    high = min(low + 1, len(ordered) - 1)
    return ordered[low] + (at - low) * (ordered[high] - ordered[low])

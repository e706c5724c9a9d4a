#!/usr/bin/env python3
"""coast ppk and rnx2rtkp on the same files: numbers.json, and a table for people in table.md.

compare.py COAST OUT      finds the recordings through COAST_DATA
"""

import gzip
import json
import math
import os
import subprocess
import sys
import time

DATA = os.environ["COAST_DATA"]
WRONG = 0.1  # m

GSI = {
    "name": "gsi",
    "rover": "rinex-gsi-2005-092/07590920.05o",
    "base": "rinex-gsi-2005-092/30400920.05o",
    "nav": ["rinex-gsi-2005-092/30400920.05n"],
    "base_ecef": (-3978242.4348, 3382841.1715, 3649902.7667),
    "epochs": 120,
    "air": True,
    "truth": (-3976219.664, 3382372.541, 3652513.055),
}
CAR = {
    "name": "car",
    "rover": "rinex-kinematic-2021-265/SEPT265G.21O.gz",
    "base": "rinex-kinematic-2021-265/3034265G.21O.gz",
    "nav": ["rinex-kinematic-2021-265/SEPT2650.21P.gz"],
    "base_ecef": (-3959400.631, 3385704.533, 3667523.111),
    "epochs": 360,
    "air": True,
    "truth": None,  # none while it moves: forward and backward against each other
}
SPIRENT = {
    "base": "spirent-rtk-none/Base-static_MO_Spirent.obs.gz",
    "nav": ["spirent-rtk-none/RINEX_GN_Spirent.23N", "spirent-rtk-none/RINEX_EN_Spirent.23L"],
    "base_ecef": (4157177.06580187, 671230.476590636, 4774767.03105544),
    "epochs": 601,
    "air": False,
}
STATIC = dict(SPIRENT, name="spirent-static", rover="spirent-rtk-none/Rover-static-2km-east_MO_Spirent.obs.gz",
              truth=(4156857.1195929, 673209.028774142, 4774767.03105544))
ROSE = dict(SPIRENT, name="spirent-moving", rover="spirent-rtk-none/Rover-dynamic_MO_Spirent.obs.gz",
            truth="spirent-rtk-none/Rover-dynamic_PVA_Spirent.csv.gz")

# Of an independent simulator: streets with reflections, bridges and slips; a long baseline. The peer gets its best settings: fix and
# hold, and over the long baseline the states for the atmosphere that coast sets by itself.
STREETS = {
    "name": "streets",
    "rover": "sim-urban/rover.obs.gz",
    "base": "sim-urban/base.obs.gz",
    "nav": ["sim-urban/nav.rnx.gz"],
    "base_ecef": (-4645941.0040, 2552098.6412, -3535492.9766),
    "epochs": 2868,  # recorded: none under the bridges
    "air": True,
    "hold": True,
    "truth": "sim-urban/truth_antenna.csv.gz",
}
LONG = dict(STREETS, name="25 km", rover="sim-long/rover.obs.gz", base="sim-long/base.obs.gz", nav=["sim-long/nav.rnx.gz"],
            base_ecef=(4140845.3583, 687756.1171, 4786475.9655), epochs=2997, estimate_air=True,
            truth="sim-long/truth_antenna.csv.gz")

CASES = [(GSI, 15, "forward"), (GSI, 10, "forward"), (GSI, 15, "combined"), (STATIC, 10, "forward"), (ROSE, 10, "forward")]
CASES += [(CAR, mask, order) for mask in (10, 15, 20) for order in ("forward", "combined")]
CASES += [(case, 10, "combined") for case in (STREETS, LONG)]


def ecef(lat, lon, h):
    a, e2 = 6378137.0, 6.69437999014e-3
    lat, lon = math.radians(lat), math.radians(lon)
    n = a / math.sqrt(1 - e2 * math.sin(lat) ** 2)
    return ((n + h) * math.cos(lat) * math.cos(lon), (n + h) * math.cos(lat) * math.sin(lon), (n * (1 - e2) + h) * math.sin(lat))


def in_neu(v, lat, lon):
    lat, lon = math.radians(lat), math.radians(lon)
    s, c, sl, cl = math.sin(lat), math.cos(lat), math.sin(lon), math.cos(lon)
    x, y, z = v
    return (-s * cl * x - s * sl * y + c * z, -sl * x + cl * y, c * cl * x + c * sl * y + s * z)


def read_pos(path):
    """Epochs of a .pos file by second of day: quality, position, sigmas N E U."""
    epochs = {}
    with open(path, encoding="utf-8") as file:
        for line in file:
            if line.startswith("%"):
                continue
            f = line.split()
            h, m, s = f[1].split(":")
            t = 3600 * int(h) + 60 * int(m) + float(s)
            lat, lon, height = float(f[2]), float(f[3]), float(f[4])
            epochs[round(t, 1)] = {"t": t, "q": int(f[5]), "lat": lat, "lon": lon, "r": ecef(lat, lon, height),
                                "sd": [float(x) for x in f[7:10]]}
    return epochs


def unpacked(name, out):
    """rnx2rtkp reads no gzip."""
    source = os.path.join(DATA, name)
    if not name.endswith(".gz"):
        return source
    target = os.path.join(out, name.replace("/", "-")[:-3])
    if not os.path.exists(target):
        with gzip.open(source, "rb") as packed, open(target, "wb") as plain:
            plain.write(packed.read())
    return target


def run(command, quiet=True):
    begin = time.perf_counter()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL if quiet else None)
    return time.perf_counter() - begin


def run_coast(coast, case, mask, order, out):
    folder = os.path.join(out, f"coast-{case['name']}-{mask}-{order}")
    config = {"schema": "coast.ppk/1", "rover": os.path.join(DATA, case["rover"]), "base": os.path.join(DATA, case["base"]),
              "nav": [os.path.join(DATA, n) for n in case["nav"]], "base_position": {"ecef_m": list(case["base_ecef"])},
              "elevation_mask_deg": mask, "solution": order}
    if not case["air"]:
        config |= {"troposphere": "none", "ionosphere": "none"}
    os.makedirs(folder, exist_ok=True)
    path = os.path.join(folder, "ppk.yaml")
    with open(path, "w", encoding="utf-8") as file:
        json.dump(config, file)  # JSON is YAML
    seconds = run([coast, "ppk", path, "--out", folder, "--quiet"], quiet=False)
    return read_pos(os.path.join(folder, "ppk.pos")), seconds


def run_rtklib(case, mask, order, out):
    stem = os.path.join(out, f"rtklib-{case['name']}-{mask}-{order}")
    x, y, z = case["base_ecef"]
    with open(stem + ".conf", "w", encoding="utf-8") as file:
        file.write(f"""pos1-posmode=kinematic
pos1-frequency=l1+l2+l5
pos1-soltype={order}
pos1-elmask={mask}
pos1-ionoopt={'est-stec' if case.get('estimate_air') else 'brdc' if case['air'] else 'off'}
pos1-tropopt={'est-ztd' if case.get('estimate_air') else 'saas' if case['air'] else 'off'}
pos1-navsys=25
pos2-armode={'fix-and-hold' if case.get('hold') else 'continuous'}
pos2-arthres=3
out-solformat=llh
out-timesys=gpst
out-timeform=hms
ant2-postype=xyz
ant2-pos1={x}
ant2-pos2={y}
ant2-pos3={z}
""")
    files = [unpacked(name, out) for name in (case["rover"], case["base"], *case["nav"])]
    seconds = run(["rnx2rtkp", "-k", stem + ".conf", "-o", stem + ".pos", *files])
    return read_pos(stem + ".pos"), seconds


class Truth:
    """Where the rover was at a second of the day."""

    def __init__(self, truth):
        self.rows = None
        self.point = truth
        self.epochs = None
        if isinstance(truth, str) and "antenna" in truth:  # week, second of week, ECEF, at the rover's own epochs
            with gzip.open(os.path.join(DATA, truth), "rt", encoding="utf-8") as file:
                next(file)
                rows = [[float(x) for x in line.split(",")] for line in file]
            self.epochs = {round(row[1] % 86400.0, 1): tuple(row[2:5]) for row in rows}
            return
        if isinstance(truth, str):
            with gzip.open(os.path.join(DATA, truth), "rt", encoding="utf-8") as file:
                next(file)
                self.rows = [[float(x) for x in line.split(",")] for line in file]

    def at(self, t):
        if self.epochs is not None:
            return self.epochs[round(t, 1)]
        if self.rows is None:
            return self.point
        first = self.rows[0][3] % 86400.0
        i = max(0, min(len(self.rows) - 2, int((t - first) / 0.1)))
        a, b = self.rows[i], self.rows[i + 1]
        h = b[3] - a[3]
        u = (t - first - (a[3] - self.rows[0][3])) / h
        return tuple((1 + 2 * u) * (1 - u) ** 2 * a[4 + k] + u * (1 - u) ** 2 * h * a[7 + k] + u * u * (3 - 2 * u) * b[4 + k]
                     + u * u * (u - 1) * h * b[7 + k] for k in range(3))


def quantile(values, p):
    values = sorted(values)
    return values[min(len(values) - 1, int(p * len(values)))] if values else None


def statistics(epochs, expected, errors, exact):
    """Errors: NEU by epoch, for epochs that can be judged; exact: of every epoch."""
    fixed = [t for t, e in epochs.items() if e["q"] == 1]
    judged = [t for t in fixed if t in errors]
    sizes = [math.dist(errors[t], (0, 0, 0)) for t in judged]
    ratios = [(x / s) ** 2 for t in judged for x, s in zip(errors[t], epochs[t]["sd"]) if s > 0]
    result = {"fix_rate": len(fixed) / expected, "wrong_share": sum(s > WRONG for s in sizes) / max(1, len(sizes)),
              "p50_m": quantile(sizes, 0.5), "p95_m": quantile(sizes, 0.95), "max_m": max(sizes, default=None),
              "error_over_sigma": math.sqrt(sum(ratios) / len(ratios)) if ratios else None}
    if exact:
        everywhere = [math.dist(e, (0, 0, 0)) for e in errors.values()]
        result |= {"all_p95_m": quantile(everywhere, 0.95), "all_max_m": max(everywhere, default=None)}
    return {key: value for key, value in result.items() if value is not None}


def against_truth(epochs, case):
    truth = Truth(case["truth"])
    errors = {}
    for t, e in epochs.items():
        errors[t] = in_neu([a - b for a, b in zip(e["r"], truth.at(e["t"]))], e["lat"], e["lon"])
    return errors


def against_each_other(epochs, others):
    """Separation of two ways through the recording, where both are fixed."""
    errors = {}
    for t, e in epochs.items():
        o = others.get(t)
        if o and e["q"] == 1 and o["q"] == 1:
            errors[t] = in_neu([a - b for a, b in zip(e["r"], o["r"])], e["lat"], e["lon"])
    return errors


def main(coast, out):
    os.makedirs(out, exist_ok=True)
    version = subprocess.run(["dpkg-query", "-W", "-f=${Version}", "rtklib"], capture_output=True, text=True, check=False).stdout
    numbers, lines = {}, []
    backward, solved = {}, {}
    for case, mask, order in CASES:
        for program in ("coast", "rtklib"):
            solve = (lambda o: run_coast(coast, case, mask, o, out)) if program == "coast" else (lambda o: run_rtklib(case, mask, o, out))
            epochs, seconds = solve(order)
            if case["truth"]:
                errors = against_truth(epochs, case)
            else:
                if (program, mask) not in backward:
                    backward[program, mask] = solve("backward")[0]
                errors = against_each_other(epochs, backward[program, mask])
            result = statistics(epochs, case["epochs"], errors, bool(case["truth"]))
            numbers.setdefault(f"{case['name']} {mask} deg {order}", {})[program] = result
            solved[case["name"], mask, order, program] = epochs
            lines.append((f"{case['name']}, {mask} deg, {order}", program, result, 1000 * seconds / case["epochs"]))
    for mask in (10, 15):  # the car's low satellites are bad: without them is nearest to a truth
        for order in ("forward", "combined"):
            errors = against_each_other(solved["car", mask, order, "coast"], solved["car", 20, "combined", "coast"])
            numbers[f"car {mask} deg {order}"]["coast"]["from_20_deg_p50_m"] = quantile([math.hypot(*e) for e in errors.values()], 0.5)
    with open(os.path.join(out, "numbers.json"), "w", encoding="utf-8") as file:
        json.dump(numbers, file, indent=2)
        file.write("\n")
    with open(os.path.join(out, "table.md"), "w", encoding="utf-8") as file:
        file.write("| case | program | fixed % | wrong % | p50 mm | p95 mm | largest mm | of all: p95 mm | largest mm | error / sigma | ms an epoch |\n")
        file.write("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n")
        for name, program, r, ms in lines:
            mm = lambda key: f"{1000 * r[key]:.1f}" if key in r else "-"
            sigma = f"{r['error_over_sigma']:.2f}" if "error_over_sigma" in r else "-"
            file.write(f"| {name} | {program} | {100 * r['fix_rate']:.1f} | {100 * r['wrong_share']:.1f} | {mm('p50_m')} | "
                       f"{mm('p95_m')} | {mm('max_m')} | {mm('all_p95_m')} | {mm('all_max_m')} | {sigma} | {ms:.2f} |\n")
    print(f"rtklib {version}")
    with open(os.path.join(out, "table.md"), encoding="utf-8") as file:
        print(file.read())


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])

#!/usr/bin/env python3
"""Runs coast fleet over drawn fleets and counts.

study.py COAST WORK_FOLDER CLEAN DEFECTS: so many clean fleets of each kind (draw.py), and so many with defects; prints numbers.json.
"""

import concurrent.futures
import datetime
import json
import math
import pathlib
import subprocess
import sys

import draw

BEGIN = datetime.date(2023, 1, 1)
DAYS = 365.25
SIMULATIONS = 299
FIRST_SEED = 5001  # those below served to find what was wrong with the tails of departures


def processed(coast, folder, kind, seed):
    name = folder / f"{kind}-{seed}"
    truth = draw.draw(seed, kind, f"{name}.csv")
    pathlib.Path(f"{name}.yaml").write_text(f"schema: coast.fleet/1\nestimates: {name.name}.csv\nsimulations: {SIMULATIONS}\n")
    subprocess.run([coast, "fleet", f"{name}.yaml", "--out", f"{name}.out", "--quiet", "--threads", "1"], check=True)
    result = json.loads((name.with_suffix(".out") / "fleet.json").read_text())
    for file in name.with_suffix(".out").iterdir():
        file.unlink()
    name.with_suffix(".out").rmdir()
    pathlib.Path(f"{name}.csv").unlink()
    pathlib.Path(f"{name}.yaml").unlink()
    return truth, result


def share(hits, of):
    """With Wilson's 95 % interval."""
    z = 1.959964
    middle = (hits + z * z / 2) / (of + z * z)
    half = z / (of + z * z) * math.sqrt(hits * (of - hits) / of + z * z / 4)
    return {"share": hits / of, "share_95": [max(0.0, middle - half), min(1.0, middle + half)]}


def day(t):
    return BEGIN + datetime.timedelta(days=DAYS * t)


def parts(result, kind, quantity):
    for finding in result["findings"]:
        for part in finding["parts"]:
            if part["kind"] == kind and part["quantity"] == quantity:
                yield part


class Tally:
    def __init__(self):
        self.found, self.days, self.inside, self.deviations, self.extra = 0, [], 0, [], 0

    def date(self, part, t):
        self.days.append((datetime.date.fromisoformat(part["date"]) - day(t)).days)
        low, high = map(datetime.date.fromisoformat, part["date_95"])
        self.inside += low <= day(t) <= high

    def numbers(self, of):
        numbers = {"found": share(self.found, of), "size_deviation_rms_sigma": math.sqrt(sum(d * d for d in self.deviations) / max(len(self.deviations), 1))}
        if self.days:
            numbers["date_error_median_days"] = sorted(map(abs, self.days))[len(self.days) // 2]
            numbers["date_inside_95"] = share(self.inside, len(self.days))
        return numbers


def judge(truth, result, tallies):
    """What was put in, and what is told besides."""
    ages, moved, firmware = truth["ages"], truth["moved"], truth["firmware"]
    own = 0
    for part in parts(result, "drift", "accel_bias"):
        if [u["unit"] for u in part["units"]] == [ages["unit"]]:
            tallies["ages"].found += 1
            tallies["ages"].deviations.append((part["size"] - ages["per_year"]) / part["size_sd"])
    hits = [p for p in parts(result, "step", "lever_arm") if [u["unit"] for u in p["units"]] == [moved["unit"]]]
    if hits:
        tallies["moved"].found += 1
        tallies["moved"].date(hits[0], moved["t"])
        for part in hits:
            tallies["moved"].deviations.append((part["size"] - moved["size"]["xyz".index(part["axis"])]) / part["size_sd"])
    shared = [p for p in parts(result, "step", "gyro_bias") if len(p["units"]) >= 3]
    if shared:
        part = max(shared, key=lambda p: len(p["units"]))
        named = {u["unit"] for u in part["units"]}
        tallies["firmware"].found += 1
        tallies["firmware"].date(part, firmware["t"])
        tallies["firmware"].deviations.append((part["size"] - firmware["size"]) / part["size_sd"])
        tallies["named"].found += len(named & set(firmware["units"]))
        tallies["named"].extra += len(named - set(firmware["units"]))
    tallies["named"].days.append(len(firmware["units"]))
    expected = {ages["unit"], moved["unit"], *firmware["units"]}
    own = sum(not set(f["units"]) <= expected for f in result["findings"])
    tallies["other"].found += own > 0 or bool(result["departures"])


def main():
    coast, folder, clean, defects = sys.argv[1], pathlib.Path(sys.argv[2]), int(sys.argv[3]), int(sys.argv[4])
    folder.mkdir(parents=True, exist_ok=True)
    numbers = {"clean": {}, "defects": {}}
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        for kind in ("clean", "t5", "uneven"):
            runs = list(pool.map(lambda seed, kind=kind: processed(coast, folder, kind, seed)[1], range(FIRST_SEED, FIRST_SEED + clean)))
            changes = [bool(r["findings"]) for r in runs]
            outliers = [bool(r["departures"]) for r in runs]
            numbers["clean"][kind] = {"stated": 0.05, "any": share(sum(c or o for c, o in zip(changes, outliers)), clean),
                                      "changes": share(sum(changes), clean), "departures": share(sum(outliers), clean)}
        tallies = {name: Tally() for name in ("ages", "moved", "firmware", "named", "other")}
        for truth, result in pool.map(lambda seed: processed(coast, folder, "defects", seed), range(FIRST_SEED, FIRST_SEED + defects)):
            judge(truth, result, tallies)
    for name in ("ages", "moved", "firmware"):
        numbers["defects"][name] = tallies[name].numbers(defects)
    numbers["defects"]["firmware"]["units_named"] = tallies["named"].found / sum(tallies["named"].days)
    numbers["defects"]["firmware"]["units_named_wrongly"] = tallies["named"].extra / defects
    numbers["defects"]["fleets_with_anything_else"] = share(tallies["other"].found, defects)
    json.dump(numbers, sys.stdout, indent=1)
    print()


if __name__ == "__main__":
    main()

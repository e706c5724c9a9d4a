#!/usr/bin/env python3
"""score.py FOLDER: numbers.json of estimates.csv and fleet.json against truth.json of missions.py.

The chi-square of an axis is the mean over missions of ((estimate - truth) / stated sigma)^2, beside the bounds between which it lies in 99.9 % of such fleets.
"""

import csv
import datetime
import json
import math
import pathlib
import sys


def bounds(n):
    """99.9 % of chi2(n)/n, by Wilson and Hilferty."""
    return [(1.0 - 2.0 / (9.0 * n) + z * math.sqrt(2.0 / (9.0 * n))) ** 3 for z in (-3.290527, 3.290527)]


def chi_squares(folder, missions):
    squares = {}
    with open(folder / "campaign/estimates.csv") as file:
        for row in csv.DictReader(file):
            name = row["mission"].split("/")[-1]
            if row["quantity"] not in missions[name]:
                continue
            truth = missions[name][row["quantity"]]
            truth = truth["xyz".index(row["axis"])] if row["axis"] else truth
            squares.setdefault(f"{row['quantity']} {row['axis']}".strip(), []).append(((float(row["value"]) - truth) / float(row["sigma"])) ** 2)
    return {figure: {"missions": len(s), "mean_square": sum(s) / len(s), "bounds_99_9": bounds(len(s)), "largest_sigmas": math.sqrt(max(s))}
            for figure, s in squares.items()}


def found(result, truth, kind, named, size_of, day):
    """What is told of the units that changed, and of nobody else, in the quantity that changed."""
    parts = [p for f in result["findings"] for p in f["parts"]
             if p["kind"] == kind and p["quantity"] == truth["quantity"] and [u["unit"] for u in p["units"]] == named]
    numbers = {"told": int(bool(parts))}
    for part in parts:
        own = numbers[f"{part['quantity']} {part['axis']}".strip()] = {"size": part["size"], "size_sd": part["size_sd"], "true": size_of(part["axis"])}
        if kind == "step":
            low, high = part["date_95"]
            own["date_error_days"] = (datetime.date.fromisoformat(part["date"]) - day(truth["t"])).days
            own["date_inside_95"] = int(low <= day(truth["t"]).isoformat() <= high)
    return numbers


def main():
    folder = pathlib.Path(sys.argv[1])
    truth = json.loads((folder / "truth.json").read_text())
    result = json.loads((folder / "fleet/fleet.json").read_text())
    group = json.loads((folder / "campaign/campaign.json").read_text())["groups"][0]
    day = lambda t: datetime.date.fromisoformat(truth["begin"]) + datetime.timedelta(days=365.25 * t)  # noqa: E731
    ages, moved, firmware = truth["ages"], truth["moved"], truth["firmware"]
    told = {"ages": found(result, ages, "drift", [ages["unit"]], lambda axis: ages["per_year"] if axis == ages["axis"] else 0.0, day),
            "moved": found(result, moved, "step", [moved["unit"]], lambda axis: moved["size"]["xyz".index(axis)], day),
            "firmware": found(result, firmware, "step", firmware["units"], lambda axis: firmware["size"], day)}
    numbers = {"missions": group["units"], "done": group["done"], "verdicts": group["verdicts"], "chi_square": chi_squares(folder, truth["missions"]),
               "told": told, "findings": len(result["findings"]), "departures": len(result["departures"])}
    json.dump(numbers, sys.stdout, indent=1)
    print()


if __name__ == "__main__":
    main()

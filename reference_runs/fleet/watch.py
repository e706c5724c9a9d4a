#!/usr/bin/env python3
"""How often a clean fleet that is looked at every month is told of in two years.

watch.py COAST WORK_FOLDER FLEETS: clean fleets (draw.py), from the third month on looked at as far as they have come; prints JSON. A fleet is told of at a
smaller false_alarm_probability where what was told at 5 % has a p that is as much smaller: one look serves for all.
"""

import csv
import json
import pathlib
import subprocess
import sys

import draw
from study import share

FIRST_SEED = 8001
MONTHS = range(3, 25)
LEVELS = (0.05, 0.02, 0.01)
SIMULATIONS = 299


def look(coast, folder, rows, fields):
    with open(folder / "seen.csv", "w") as file:
        table = csv.DictWriter(file, fields)
        table.writeheader()
        table.writerows(rows)
    (folder / "seen.yaml").write_text(f"schema: coast.fleet/1\nestimates: seen.csv\nsimulations: {SIMULATIONS}\n")
    subprocess.run([coast, "fleet", folder / "seen.yaml", "--out", folder / "seen.out", "--quiet", "--threads", "1"], check=True)
    result = json.loads((folder / "seen.out/fleet.json").read_text())
    changes = [2.0 * f["p"] for f in result["findings"]]
    single = [2.0 * d["p"] * len(rows) for d in result["departures"]]
    return min(changes, default=1.0), min(single, default=1.0)


def main():
    coast, folder, fleets = sys.argv[1], pathlib.Path(sys.argv[2]), int(sys.argv[3])
    folder.mkdir(parents=True, exist_ok=True)
    told, single_looks = {level: 0 for level in LEVELS}, {level: 0 for level in LEVELS}
    for seed in range(FIRST_SEED, FIRST_SEED + fleets):
        draw.draw(seed, "clean", folder / "all.csv")
        with open(folder / "all.csv") as file:
            rows = list(csv.DictReader(file))
        fields = list(rows[0])
        looks = []
        for month in MONTHS:
            end = f"{2023 + month // 12}-{month % 12 + 1:02d}-01"
            seen = [row for row in rows if row["start"] < end]
            looks.append(min(look(coast, folder, seen, fields)))
        for level in LEVELS:
            told[level] += min(looks) <= level
            single_looks[level] += sum(p <= level for p in looks)
        print(seed, [round(p, 4) for p in looks if p <= 0.05], file=sys.stderr, flush=True)
    json.dump({"fleets": fleets, "looks": len(MONTHS),
               "levels": {f"{level:g}": {"told_in_two_years": share(told[level], fleets), "share_of_looks": single_looks[level] / fleets / len(MONTHS)}
                          for level in LEVELS}}, sys.stdout, indent=1)
    print()


if __name__ == "__main__":
    main()

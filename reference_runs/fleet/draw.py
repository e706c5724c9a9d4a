#!/usr/bin/env python3
"""Draws fleets at the level of estimates.

draw.py SEED KIND FILE: 200 missions of 8 to 20 units in two years, three axes of the lever arm, one gyro and one accelerometer bias, with unequal
sigmas, temperatures of the season, slopes against temperature, and scatter between missions. KIND: clean (normal scatter, equal numbers of missions),
t5 (heavy tails), uneven (3 to 40 missions a unit), firmware (clean, with a column of groups), or defects: one unit ages, one antenna is moved, one
firmware is wrong in several units from a date on. Prints what was done as JSON.
"""

import datetime
import json
import math
import random
import sys

FIGURES = [  # quantity, axis, unit, size of the units' values, typical sigma, scatter between missions, slope per kelvin
    ("lever_arm", "x", "m", 0.3, 0.008, 0.006, 0.0),
    ("lever_arm", "y", "m", 0.3, 0.008, 0.006, 0.0),
    ("lever_arm", "z", "m", 0.3, 0.015, 0.010, 0.0),
    ("gyro_bias", "z", "rad/s", 2e-3, 1e-5, 4e-5, 4e-6),
    ("accel_bias", "x", "m/s^2", 0.03, 1e-3, 2e-3, 1e-4),
]
YEARS = 2.0


def t_draw(random_, nu):
    """With the variance of the standard normal distribution."""
    if not nu:
        return random_.gauss(0.0, 1.0)
    return random_.gauss(0.0, 1.0) / math.sqrt(random_.gammavariate(nu / 2.0, 2.0 / nu)) * math.sqrt((nu - 2.0) / nu)


def schedule(random_, kind):
    units = random_.randint(8, 20)
    shares = [random_.uniform(0.15, 2.0) if kind == "uneven" else 1.0 for _ in range(units)]
    counts = [max(3, round(200 * share / sum(shares))) for share in shares]
    return [sorted(random_.uniform(0.0, YEARS) for _ in range(count)) for count in counts]


def draw(seed, kind, file):
    random_ = random.Random(seed)
    dates = schedule(random_, kind)
    nu = 5 if kind == "t5" else None
    ages, moved = random_.sample(range(len(dates)), 2)
    truth = {"units": len(dates), "missions": sum(map(len, dates))}
    if kind == "defects":
        others = [u for u in range(len(dates)) if u not in (ages, moved)]
        # Steps lie inside the missions of the unit: three on either side at least.
        truth["ages"] = {"unit": f"u{ages:02d}", "quantity": "accel_bias", "axis": "x", "per_year": random_.choice((-1, 1)) * 0.008}
        middle = dates[moved][3:-3]
        at = random_.uniform(middle[0], middle[-1]) if len(middle) > 1 else middle[0] + 1e-3
        truth["moved"] = {"unit": f"u{moved:02d}", "quantity": "lever_arm", "t": at, "size": [random_.choice((-1, 1)) * 0.04, 0.0, random_.choice((-1, 1)) * 0.06]}
        several = random_.sample(others, max(4, len(others) // 3))
        truth["firmware"] = {"units": sorted(f"u{u:02d}" for u in several), "quantity": "gyro_bias", "axis": "z",
                             "t": random_.uniform(0.3 * YEARS, 0.7 * YEARS), "size": random_.choice((-1, 1)) * 2e-4}
    begin = datetime.datetime(2023, 1, 1)
    with open(file, "w") as out:
        out.write("mission,unit,start,quantity,axis,value,sigma,unit_of_value,temperature_degC" + (",firmware" if kind == "firmware" else "") + "\n")
        for u, times in enumerate(dates):
            name = f"u{u:02d}"
            values = [random_.gauss(0.0, f[3]) for f in FIGURES]
            slopes = [random_.gauss(0.0, f[6]) for f in FIGURES]
            for m, t in enumerate(times):
                temperature = 12.0 - 10.0 * math.cos(2.0 * math.pi * t) + random_.gauss(0.0, 4.0)
                quality = math.exp(random_.gauss(0.0, 0.4))
                start = (begin + datetime.timedelta(days=365.25 * t)).strftime("%Y-%m-%dT%H:%M:%S")
                level = random_.choice("ab") if t > 1.0 else "a"
                for i, (quantity, axis, unit, _, sigma, tau, _) in enumerate(FIGURES):
                    stated = sigma * quality * math.exp(random_.gauss(0.0, 0.2))
                    value = values[i] + slopes[i] * (temperature - 12.0) + tau * t_draw(random_, nu) + random_.gauss(0.0, stated)
                    if kind == "defects":
                        if name == truth["ages"]["unit"] and quantity == "accel_bias":
                            value += truth["ages"]["per_year"] * t
                        if name == truth["moved"]["unit"] and quantity == "lever_arm" and t > truth["moved"]["t"]:
                            value += truth["moved"]["size"]["xyz".index(axis)]
                        if name in truth["firmware"]["units"] and quantity == "gyro_bias" and t > truth["firmware"]["t"]:
                            value += truth["firmware"]["size"]
                    row = [f"{name}-{m:03d}", name, start, quantity, axis, f"{value:.9g}", f"{stated:.6g}", unit, f"{temperature:.1f}"]
                    out.write(",".join(row + ([level] if kind == "firmware" else [])) + "\n")
    return truth


if __name__ == "__main__":
    print(json.dumps(draw(int(sys.argv[1]), sys.argv[2], sys.argv[3])))

"""spoil.py SEED FIRST_S LASTING_S IN.pos OUT.pos: makes 2 % of the fixes from FIRST_S seconds on wrong.

Each wrong stretch lasts LASTING_S seconds (one fix where that is shorter than the interval), and is off by 0.2 to 2 m (uniform) in a
direction at random. The sigmas that the fixes state stay as they are.
"""

import math
import random
import sys

SHARE = 0.02
METRES_PER_DEGREE = 111_320.0


def moved(line, north, east, up):
    words = line.split()
    latitude, longitude, height = (float(w) for w in words[2:5])
    latitude += north / METRES_PER_DEGREE
    longitude += east / (METRES_PER_DEGREE * math.cos(math.radians(latitude)))
    words[2:5] = [f"{latitude:.9f}", f"{longitude:.9f}", f"{height + up:.4f}"]
    return " ".join(words) + "\n"


def direction(draw):
    while True:
        v = [draw.gauss(0.0, 1.0) for _ in range(3)]
        length = math.hypot(*v)
        if length > 1e-6:
            return [c / length for c in v]


def main():
    seed, first, lasting = int(sys.argv[1]), float(sys.argv[2]), float(sys.argv[3])
    draw = random.Random(seed)
    with open(sys.argv[4], encoding="ascii") as file:
        lines = file.readlines()
    fixes = [i for i, line in enumerate(lines) if not line.startswith("%")]
    length = max(1, round(lasting))  # one fix a second
    good = list(range(int(first), len(fixes) - length))
    wrong = 0
    while wrong < SHARE * len(fixes):
        begin = draw.choice(good)
        good = [i for i in good if abs(i - begin) > 2 * length]
        size, towards = draw.uniform(0.2, 2.0), direction(draw)
        for i in range(begin, begin + length):
            lines[fixes[i]] = moved(lines[fixes[i]], *(size * c for c in towards))
            wrong += 1
    with open(sys.argv[5], "w", encoding="ascii") as file:
        file.writelines(lines)


main()

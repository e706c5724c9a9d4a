"""The smallest sizes of effects that a mission shows, by `coast process` alone: the innovations with an effect and without it."""

import csv
import math
import os
import random
import shutil
import subprocess

from . import mission

DETECTABLE = math.sqrt(17.07)  # sigmas: alpha 0.1 %, power 80 % (Baarda)
COMPONENTS = 6
LENGTHS = (1, 4, 16, 64, 256)  # innovations


def innovations(folder):
    """(innovation, its sigma) of every component, by kind and time."""
    coast = os.environ.get("COAST", "build/release/bin/coast")
    run = os.path.join(folder, "probe.yaml")
    with open(os.path.join(folder, "run.yaml"), encoding="ascii") as file:
        text = file.read()
    with open(run, "w", encoding="ascii") as file:
        file.write(text + "smoother: none\nfilter: {gate_probability: 0}\naccept: true\n")
    subprocess.run([coast, "process", run, "--out", os.path.join(folder, "probe"), "--quiet", "--threads", "1"], check=True)
    with open(os.path.join(folder, "probe", "innovations.csv"), encoding="ascii") as file:
        return {(r["kind"], float(r["sow_s"])): [(float(r[f"nu_{i}"]), float(r[f"sd_{i}"])) for i in (1, 2, 3)]
                for r in csv.DictReader(file)}


def in_sigmas(without, with_it):
    """What an effect adds to the innovations: a series in time of each component."""
    series = [[] for _ in range(COMPONENTS)]
    for (kind, t), before in sorted(without.items(), key=lambda item: item[0][1]):
        if (kind, t) not in with_it:
            continue
        first = 0 if "position" in kind else 3
        for i, (b, a) in enumerate(zip(with_it[kind, t], before)):
            series[first + i].append((b[0] - a[0]) / a[1])
    return series


class Mission:
    """One of which innovations are asked again and again; its sensors' noise is the same each time."""

    def __init__(self, folder, case, truth):
        self.folder, self.case, self.truth = os.path.join(folder, "probe"), case, truth
        self.without = self.innovations([])

    def innovations(self, concealed, realisation=0):
        mission.write(self.folder, self.case, self.truth, concealed, realisation)
        result = innovations(self.folder)
        shutil.rmtree(self.folder)
        return result

    def difference(self, effect, axis, size, onset, realisation=0):
        return in_sigmas(self.without, self.innovations([(effect, axis, size, onset)], realisation))

    def largest_rate(self, axis):
        return max(abs(state[4][axis]) for state in self.truth.states)


def norm(series):
    return math.sqrt(sum(x * x for component in series for x in component))


def of_linear_effect(seen, effect, axis, onset):
    found = norm(seen.difference(effect, axis, effect.probe, onset))
    return DETECTABLE * effect.probe / found if found > 0.0 else math.inf


def of_clipping(seen, effect, axis, times):
    """The limit at which what is cut off moves the innovations by so many times the smallest detectable."""
    low, high = 0.0, seen.largest_rate(axis)
    for _ in range(12):
        limit = 0.5 * (low + high)
        if norm(seen.difference(effect, axis, limit, -1.0)) > times * DETECTABLE:
            low = limit
        else:
            high = limit
    return low


def tests(noise, difference):
    """Of every test (count, sum of w^2, of w d, of d^2), w and d what a stretch has of white noise and of the effect, both over the
    root of its length: components one by one and all together, stretches of every length."""
    result = []
    for length in LENGTHS:
        together = [0.0] * 4
        for w, d in zip(noise, difference):
            of = [0.0] * 4
            for i in range(0, len(d) - length + 1, length):
                a, b = sum(w[i:i + length]), sum(d[i:i + length])
                of = [of[0] + 1.0, of[1] + a * a / length, of[2] + a * b / length, of[3] + b * b / length]
            result.append(of)
            together = [x + y for x, y in zip(together, of)]
        result.append(together)
    return [of for of in result if of[0] > 0.0]


def differs(of_recording, factor):
    """Whether one of the tests says that w + factor d is more than white noise. Of 35, 3e-5 by chance each, 0.1 % together: 4.02
    sigmas of chi-square's cube root (Wilson and Hilferty 1931)."""
    for count, ww, wd, dd in of_recording:
        ratio = (ww + 2.0 * factor * wd + factor * factor * dd) / count
        if (ratio ** (1.0 / 3.0) - 1.0 + 2.0 / (9.0 * count)) / math.sqrt(2.0 / (9.0 * count)) > 4.02:
            return True
    return False


def factor_that_is_seen(seen, differences):
    """By what the differences have to be multiplied for 80 % of fifty recordings to differ from clean ones, whose innovations
    are white."""
    draw = random.Random(f"white {seen.case.seed}")
    recordings = []
    for i in range(50):
        difference = differences[i % len(differences)]
        recordings.append(tests([[draw.gauss(0.0, 1.0) for _ in d] for d in difference], difference))
    low, high = -3.0, 3.0  # decades
    for _ in range(12):
        middle = 0.5 * (low + high)
        seen_in = sum(differs(of, 10.0 ** middle) for of in recordings)
        low, high = (low, middle) if seen_in >= 0.8 * len(recordings) else (middle, high)
    return 10.0 ** high


def realisations(seen, effect, axis, size):
    """Ten of the effect; one of what chance has no part in: rounding."""
    differences = [seen.difference(effect, axis, size, -1.0, realisation) for realisation in (1, 2)]
    if differences[0] == differences[1]:
        return differences[:1]
    return differences + [seen.difference(effect, axis, size, -1.0, realisation) for realisation in range(3, 11)]


def of_noise(seen, effect, axis, size):
    """Realisations of the effect, fifty recordings of noise beside them; again at the size found, until it stays. Where sizes on either
    side are known, the next one is between them: what rounding does is not in proportion to its step."""
    low, high = 0.0, math.inf
    for _ in range(12):
        factor = factor_that_is_seen(seen, realisations(seen, effect, axis, size))
        if abs(math.log(factor)) < 0.15 or high < 1.1 * low:
            break
        low, high = (size, high) if factor > 1.0 else (low, size)
        size *= factor
        if not low < size < high:
            size = math.sqrt(low * high)
    return size

"""An effect in the IMU data of a recording that is there: what was measured stands for the truth."""

import gzip
import math
import random
import re
import tempfile

from . import mission, sizes


def opened(path, how):
    return gzip.open(path, how + "t", encoding="ascii") if path.endswith(".gz") else open(path, how, encoding="ascii")


def places(text, header):
    """"time=1,accel=2:3:4,gyro=5:6:7": columns by number from 1 or by name."""
    result = {}
    for item in text.split(","):
        key, names = item.split("=")
        result[key] = [int(n) - 1 if n.isdigit() else header.index(n) for n in names.split(":")]
    return result


def needs_more(effect, axis, size):
    """What an effect needs that rates and forces of a recording do not tell: motion, temperature, vibration. Nothing: None."""
    s = mission.Sample()
    s.t, s.dt, s.draw = 0.01, 0.01, random.Random("recorded")
    s.w, s.f, s.alpha, s.out_w, s.out_f = ([0.0] * 3 for _ in range(5))
    try:
        for act in (effect.sample, effect.last):
            if act:
                act(s, axis, size)
    except AttributeError as error:
        return error.name.replace("_", " ")
    return None


def rows(source, columns, gyro_unit):
    """(the line, its cells, places, rates, forces); of a header the line alone. Columns by name are those of the first line."""
    place = None
    with opened(source, "r") as lines:
        for line in lines:
            cells = line.rstrip("\n").split(",")
            place = place or places(columns, cells)
            try:
                float(cells[place["time"][0]])
            except ValueError:
                yield line, None, place, None, None
                continue
            yield line, cells, place, [float(cells[i]) * gyro_unit for i in place["gyro"]], [float(cells[i]) for i in place["accel"]]


def conceal(source, target, columns, effect, axis, size, onset, gyro_unit=1.0):
    """Writes the recording with the effect from `onset` s after its start on. A shift of time moves the IMU's tags."""
    s = mission.Sample()
    s.draw = random.Random("recorded")
    start, before, before_w = None, None, None
    with opened(target, "w") as out:
        for line, cells, place, s.w, s.f in rows(source, columns, gyro_unit):
            if cells is None:
                out.write(line)
                continue
            tag = float(cells[place["time"][0]])
            start = tag if start is None else start
            s.t, s.dt = tag - start, (tag - before if before is not None else 0.01)
            s.alpha = [0.0] * 3 if before_w is None or s.dt <= 0.0 else [(a - b) / s.dt for a, b in zip(s.w, before_w)]
            before, before_w = tag, s.w
            s.out_w, s.out_f = list(s.w), list(s.f)
            if s.t >= onset:
                for act in (effect.sample, effect.last):
                    if act:
                        act(s, axis, size)
                if effect.name == "gnss_time_offset":
                    tag -= size
            cells[place["time"][0]] = "%.6f" % tag
            for i, value in zip(place["gyro"] + place["accel"], [w / gyro_unit for w in s.out_w] + s.out_f):
                cells[i] = "%.10g" % value
            out.write(",".join(cells) + "\n")


class Recording:
    """One of which innovations are asked again and again, as sizes.Mission: `run` is the text of its run.yaml, which names `source`
    as the file of the IMU. Noise that is estimated is so once, without an effect."""

    def __init__(self, run, source, columns, gyro_unit):
        self.source, self.columns, self.gyro_unit = source, columns, gyro_unit
        self.folder = tempfile.TemporaryDirectory()
        self.run = self.stated(run)
        self.without = self.innovations(self.run)

    def innovations(self, run):
        with open(f"{self.folder.name}/run.yaml", "w", encoding="ascii") as file:
            file.write(run)
        return sizes.innovations(self.folder.name)

    def stated(self, run):
        """With the noise that `coast process` fits in place of `estimated`."""
        self.innovations(run)
        with open(f"{self.folder.name}/probe/run.resolved.yaml", encoding="ascii") as file:
            fitted = re.findall(r"# (noise: \{.*\})  # estimated", file.read())
        if len(fitted) != run.count("noise: estimated"):
            raise SystemExit("of what noise is estimated in the run, run.resolved.yaml does not tell all values")
        for noise in fitted:
            run = run.replace("noise: estimated", noise, 1)
        return run

    def difference(self, effect, axis, size, onset):
        target = f"{self.folder.name}/imu.csv.gz"
        conceal(self.source, target, self.columns, effect, axis, size, onset, self.gyro_unit)
        return sizes.in_sigmas(self.without, self.innovations(self.run.replace(self.source, target)))

    def shown(self, effect, axis, onset, probe):
        """The smallest size that would be seen of an effect that is linear about the size of `probe`, and what the recording shows of it as
        it is: least squares of its innovations upon what the effect adds to them."""
        added = self.difference(effect, axis, probe, onset)
        as_is = sizes.in_sigmas({key: [(0.0, sd) for _, sd in values] for key, values in self.without.items()}, self.without)
        squares = sizes.norm(added) ** 2
        both = sum(a * b for x, y in zip(added, as_is) for a, b in zip(x, y))
        return probe * sizes.DETECTABLE / math.sqrt(squares), probe * both / squares

    def span(self):
        """First and last tag."""
        tags = [float(cells[place["time"][0]]) for _, cells, place, _, _ in rows(self.source, self.columns, self.gyro_unit) if cells]
        return tags[0], tags[-1]

    def largest_rate(self, axis):
        return max(abs(w[axis]) for _, cells, _, w, _ in rows(self.source, self.columns, self.gyro_unit) if cells)

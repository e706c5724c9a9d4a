"""An effect in the IMU data of a recording that is there: what was measured stands for the truth."""

import gzip
import random

from . import mission


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


def conceal(source, target, columns, effect, axis, size, onset, gyro_unit=1.0):
    """Writes the recording with the effect from `onset` s after its start on. A shift of time moves the IMU's tags."""
    s = mission.Sample()
    s.draw = random.Random("recorded")
    start, before, before_w = None, None, None
    with opened(source, "r") as lines, opened(target, "w") as out:
        place = None
        for line in lines:
            cells = line.rstrip("\n").split(",")
            if place is None:
                place = places(columns, cells)
            try:
                tag = float(cells[place["time"][0]])
            except ValueError:
                out.write(line)
                continue
            start = tag if start is None else start
            s.w = [float(cells[i]) * gyro_unit for i in place["gyro"]]
            s.f = [float(cells[i]) for i in place["accel"]]
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

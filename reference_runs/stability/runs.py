"""runs.py COAST OUT [SHARD OF]: `coast diagnose` on real recordings as they are, with a minute less at either end, with every second fix, and with another IMU of
the same vehicle; what each is told goes to OUT/numbers.json. A run that is there already is not made again."""

import gzip
import json
import os
import re
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../tools/lib"))

from concealment import configured, diagnosed  # noqa: E402

MINUTE = 60.0  # s
BEGIN_AT_SOME_TIME = ("bias_step", "antenna_mount_slip", "imu_mount_rotation", "gnss_wrong_fix")
TEXT = {"car": "car-drive-0708", **{f"rover-{run}": "rc-rover-mimu" for run in "hk"}, "cpet": "rover-cpet-run3"}
# As inspected from the recordings, s; the published synchronisation of the rover's runs was made by hand.
OFFSETS = {"h": 0.203, "k": 0.063}
IMUS = {"h": (1, 2, 3, 4, 5), "k": (1, 2, 3)}


def base(recording):
    if not recording.startswith("rover-"):
        return configured.run(TEXT[recording])
    run = recording[-1]
    return configured.run("rc-rover-mimu", [("h_imu", f"{run}_imu"), ("h_rtk", f"{run}_rtk"), ("time_offset_s: 0.2", f"time_offset_s: {OFFSETS[run]}")])


def seconds(line):
    """The time of a row: of day where it is a calendar's."""
    if calendar := re.match(r"\d{4}/\d\d/\d\d (\d\d):(\d\d):(\S+)", line):
        hours, minutes, rest = calendar.groups()
        return 3600.0 * int(hours) + 60.0 * int(minutes) + float(rest)
    return float(re.split(r"[,\s]+", line, maxsplit=1)[0])


def rewritten(source, target, wanted):
    """A copy of the rows for which wanted(s since the first row, s before the last, number) holds."""
    with (gzip.open if source.endswith(".gz") else open)(source, "rt") as file:
        lines = file.readlines()
    is_row = [line[:1].isdigit() for line in lines]
    rows = [line for line, row in zip(lines, is_row) if row]
    first, last = seconds(rows[0]), seconds(rows[-1])
    number = -1
    with open(target, "w") as file:
        for line, row in zip(lines, is_row):
            number += row
            if not row or wanted(seconds(line) - first, last - seconds(line), number):
                file.write(line)


def cut(text, folder, wanted_imu, wanted_gnss):
    paths = re.findall(r"\n  file: (\S+)", text)
    for path, wanted, name in zip(paths, (wanted_imu, wanted_gnss), ("imu", "gnss")):
        source = os.path.expandvars(path)
        target = f"{folder}/{name}{os.path.splitext(source.removesuffix('.gz'))[1]}"
        rewritten(source, target, wanted)
        text = text.replace(path, target)
    return text


def another_imu(number):
    return lambda text, folder: text.replace("imu1_", f"imu{number}_")


def variants(recording):
    everything = lambda since, before, number: True  # noqa: E731
    later = lambda since, before, number: since >= MINUTE  # noqa: E731
    earlier = lambda since, before, number: before >= MINUTE  # noqa: E731
    second = lambda since, before, number: number % 2 == 0  # noqa: E731
    yield "as it is", lambda text, folder: text
    if recording != "cpet":  # its start is stated
        yield "first minute less", lambda text, folder: cut(text, folder, later, later)
    yield "last minute less", lambda text, folder: cut(text, folder, earlier, earlier)
    yield "every second fix", lambda text, folder: cut(text, folder, everything, second)
    if recording.startswith("rover-"):
        for number in IMUS[recording[-1]][1:]:
            yield f"IMU {number}", another_imu(number)


def times(effect):
    """At which it is, where it begins at some time."""
    if several := effect.get("times"):
        return {"times_s": [t["t_start_s"] for t in several]}
    return {"times_s": [effect["t_start_s"]]} if effect["name"] in BEGIN_AT_SOME_TIME else {}


def one(name, text, out):
    d = diagnosed.diagnosis(COAST, f"{out}/{name.replace(' ', '-')}", text)
    return {"told": diagnosed.effects(d, times), "outage_rms_m": d["verification"]["outage_rms_m"], "nis": d["verification"]["nis"]}


COAST, OUT = sys.argv[1:3]
SHARD, OF = (int(a) for a in sys.argv[3:5]) if len(sys.argv) > 4 else (0, 1)
numbers = {}
cases = [(recording, name, make) for recording in TEXT for name, make in variants(recording)]
for i, (recording, name, make) in enumerate(cases):
    if i % OF == SHARD:
        numbers[f"{recording}/{name}"] = one(f"{recording}/{name}", lambda folder: make(base(recording), folder), OUT)
        print(recording, name, *numbers[f"{recording}/{name}"]["told"], sep="; ", flush=True)
if OF == 1:
    with open(f"{OUT}/numbers.json", "w") as file:
        json.dump(numbers, file, indent=1)
        file.write("\n")

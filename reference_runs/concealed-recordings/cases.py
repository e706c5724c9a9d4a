"""cases.py COAST OUT [--shard I N]: effects in the IMU data of real recordings, and configurations falsified, by chance; recording and
key of every case. What is there already is not made again, so an interrupted run goes on; shards share the cases out."""

import functools
import json
import math
import os
import random
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../tools/lib"))

from concealment import configured, effects, recorded, sizes, study  # noqa: E402

DATA = os.environ["COAST_DATA"]
# What the recordings show of antenna and clock, as they are (missing-physics-recordings), is told; nothing of it is estimated on the way.
CAR = {"config": "car-drive-0708", "changes": [("time_offset_s: -0.1", "time_offset_s: -0.128")], "file": "car-drive-0708/imu_gpst.csv.gz",
       "columns": "time=1,accel=2:3:4,gyro=5:6:7", "gyro_unit": 1.0, "lever_arm": (0.0, -0.05, 0.0), "offset": -0.128, "clock": 0.0}


def rover(run, lever_arm, offset):
    arm = "lever_arm_m: [%g, %g, %g]" % lever_arm
    return {"config": "rc-rover-mimu", "file": f"rc-rover-mimu/{run}_imu.csv.gz",
            "changes": [("h_imu", f"{run}_imu"), ("h_rtk", f"{run}_rtk"), ("lever_arm_m: [0, 0, 0]", arm), ("time_offset_s: 0.2", f"time_offset_s: {offset:g}")],
            "columns": "time=time_s,accel=imu1_ax:imu1_ay:imu1_az,gyro=imu1_gx:imu1_gy:imu1_gz", "gyro_unit": math.pi / 180.0,
            "lever_arm": lever_arm, "offset": offset, "clock": 1000.0}


RECORDINGS = {"car": CAR, "rover-h": rover("h", (-0.125, -0.136, -0.112), 0.203), "rover-k": rover("k", (-0.124, -0.129, -0.118), 0.063)}
STRENGTHS = (1.0, 2.0, 4.0, 10.0)
PLAUSIBLE = {"gyro_scale_factor": 0.1, "accel_scale_factor": 0.1, "gyro_g_sensitivity": 0.02}
PROBES = {"gnss_time_offset": 0.02}  # where it is plausible: over a millisecond what the vehicle shakes outweighs its speed
CONCEALED = [("gyro_scale_factor", "gyro"), ("accel_scale_factor", "accel"), ("gyro_g_sensitivity", "gyro"), ("gnss_time_offset", "clock"),
             ("saturation", "gyro"), ("bias_step", "gyro"), ("bias_step", "accel")]
# 0 to 99: the car; from 100 on: the RC car's runs, whose error model has all scale factors as states (112 to 119 conceal none); from 200 on:
# falsified configurations, from 210 on of the RC car. 900 and on: the recordings as they are.
CASES = [900, 901, 902, *range(28), *range(100, 112), *range(120, 128), *range(200, 220)]


def recording_of(case):
    if case >= 900:
        return list(RECORDINGS)[case - 900]
    if 100 <= case < 200 or case >= 210:
        return ("rover-h", "rover-k")[(case + case // 4) % 2]
    return "car"


def run_of(recording):
    return configured.run(recording["config"], [("${COAST_DATA}", DATA), *recording["changes"]], ("lever_arm_sd_m", "time_offset_sd_s"))


@functools.cache
def seen_in(recording):
    r = RECORDINGS[recording]
    return recorded.Recording(run_of(r), f"{DATA}/{r['file']}", r["columns"], r["gyro_unit"])


def falsified(run, recording, draw, case):
    """A lever arm that is 0.1 to 0.5 m off along an axis, or an offset by 20 to 100 ms: of what is found, true minus configured."""
    sign = draw.choice((-1.0, 1.0))
    if case % 2 == 0:
        axis, size = draw.randrange(3), sign * draw.uniform(0.1, 0.5)
        arm = list(recording["lever_arm"])
        old = "lever_arm_m: [%g, %g, %g]" % tuple(arm)
        arm[axis] -= size
        return run.replace(old, "lever_arm_m: [%.3f, %.3f, %.3f]" % tuple(arm)), {"name": "lever_arm_error", "sensor": "antenna", "axis": "xyz"[axis],
                                                                                  "value": size}
    size = sign * draw.uniform(0.02, 0.1)
    return (run.replace(f"time_offset_s: {recording['offset']:g}", f"time_offset_s: {recording['offset'] - size:.4f}"),
            {"name": "gnss_time_offset", "sensor": "clock", "axis": "", "value": size})


def size_of(effect, seen, draw, strength, onset):
    """Axis and size of an effect; no larger than plausible, or weaker than asked for."""
    first = draw.choice(effect.axes)
    for axis in (first, *(a for a in effect.axes if a != first)):
        if effect.name == "saturation":
            return {"axis": effects.label(axis), "strength": strength, "value": sizes.of_clipping(seen, effect, axis, strength)}, axis
        smallest, as_is = seen.shown(effect, axis, onset, PROBES.get(effect.name, effect.probe))
        possible = [s for s in STRENGTHS if s <= strength and s * smallest <= PLAUSIBLE.get(effect.name, math.inf)]
        if possible:  # else it is another axis: this one has a state of its own that explains all of it
            return {"axis": effects.label(axis), "strength": possible[-1], "value": draw.choice((-1.0, 1.0)) * possible[-1] * smallest,
                    "smallest_detectable": smallest, "as_is": as_is}, axis
    sys.exit(f"{effect.name}: no axis shows it at a plausible size")


def concealed(run, seen, clock, draw, case, folder):
    """Effect, axis, sign and onset by chance, at so many times the smallest size that `coast process` shows of it in this recording."""
    name, sensor = CONCEALED[case // 4 % len(CONCEALED)]
    effect = next(e for e in effects.EFFECTS + effects.NOISE if (e.name, e.sensor) == (name, sensor))
    first, last = seen.span()
    onset = draw.uniform(0.3, 0.7) * (last - first) if effect.onset else 0.0
    size, axis = size_of(effect, seen, draw, STRENGTHS[case % 4], onset)
    key = {"name": name, "sensor": sensor, **size, **({"t_start_s": first + onset + clock} if effect.onset else {})}
    target = f"{folder}/imu.csv.gz"
    recorded.conceal(seen.source, target, seen.columns, effect, axis, key["value"], onset, seen.gyro_unit)
    return run.replace(seen.source, target), key


def make(case, folder):
    recording, draw = RECORDINGS[recording_of(case)], random.Random(f"effect {case}")
    run, key = run_of(recording), None
    if 200 <= case < 900:
        run, key = falsified(run, recording, draw, case)
    elif case < 200:
        run, key = concealed(run, seen_in(recording_of(case)), recording["clock"], draw, case, folder)
    with open(f"{folder}/run.yaml", "w") as file:
        file.write(run)
    with open(f"{folder}/key.json", "w") as file:  # is written last
        json.dump({"recording": recording_of(case), "effect": key}, file)


study.work_through(CASES, make, study.arguments())

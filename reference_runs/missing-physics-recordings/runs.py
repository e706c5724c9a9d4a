"""runs.py COAST CONCEAL OUT [SHARD OF]: `coast diagnose` on real recordings as they are, with a configuration that was falsified, and with an effect put
into the recording's own IMU data; what each finds goes to OUT/numbers.json. A run that is there already is not made again."""

import json
import os
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../tools/lib"))

from concealment import configured, diagnosed  # noqa: E402

DATA = os.environ["COAST_DATA"]
NUMBERED = "time=1,accel=2:3:4,gyro=5:6:7"
CAR_IMU = f"{DATA}/car-drive-0708/imu_gpst.csv.gz"
FREE = ("lever_arm_sd_m", "time_offset_sd_s")  # what is to be found is not to be estimated on the way
CAR = "car-drive-0708"


def car(*changes):
    return lambda out: configured.run(CAR, changes, FREE)


def car_with(effect, axis, size, onset=0.0):
    def make(out):
        target = f"{out}/imu.csv.gz"
        subprocess.run([sys.executable, CONCEAL, "--into", CAR_IMU, "--columns", NUMBERED, "--effect", effect, "--axis", axis, "--size", str(size),
                        "--onset", str(onset), "--out", target], check=True)
        return configured.run(CAR, [("${COAST_DATA}/car-drive-0708/imu_gpst.csv.gz", target)], FREE)
    return make


def rolling(mounting):
    """The car is told that it neither slides nor lifts, and where it rolls to. The published mounting is the opposite rotation."""
    wheels = "vehicle: {kind: car, mounting_pitch_deg: %g, mounting_yaw_deg: %g, mounting_sd_deg: 0}\n" % mounting
    return lambda out: configured.run(CAR, [("outages:", wheels + "outages:")], FREE)


def rover(run):
    return lambda out: configured.run("rc-rover-mimu", [("h_imu", f"{run}_imu"), ("h_rtk", f"{run}_rtk"), ("time_offset_s: 0.2", "time_offset_s: 0")], FREE)


RUNS = {
    "as-is/car-drive-0708": car(), "as-is/rc-rover-mimu": lambda out: configured.run("rc-rover-mimu"),
    "as-is/quadrotor-mimu": lambda out: configured.run("quadrotor-mimu"),
    "falsified/lever-arm-0.3": car(("lever_arm_m: [0, -0.05, 0]", "lever_arm_m: [0.3, -0.05, 0]")),
    "falsified/mounting-zero": rolling((0.0, 0.0)), "as-is/car-drive-0708-mounting": rolling((6.79, -5.35)),
    "falsified/time-offset-0.05": car(("time_offset_s: -0.1", "time_offset_s: -0.05")),
    "concealed/accel-scale-x-5-percent": car_with("accel_scale_factor", "x", 0.05),
    "concealed/gyro-step-z": car_with("bias_step", "z", 0.01, 250.0),
    "concealed/clipped-gyro-z": car_with("saturation", "z", 0.25),
    "falsified/noise-3": car(("  noise: estimated\ngnss:", "  noise: {gyro_factor: 66, accel_factor: 63}\ngnss:")),
    "concealed/time-shift-0.08": car_with("gnss_time_offset", "", 0.08),
    "rover-offset/h": rover("h"), "rover-offset/k": rover("k"),
    "concealed/g-sensitivity-yx": car_with("gyro_g_sensitivity", "yx", 2e-3),
    # At two and four times the smallest size that the recording as it is would show.
    "twice/accel-scale-y": car_with("accel_scale_factor", "y", 0.0158), "four-times/accel-scale-y": car_with("accel_scale_factor", "y", 0.0316),
    "twice/gyro-step-z": car_with("bias_step", "z", 0.002, 250.0), "four-times/gyro-step-z": car_with("bias_step", "z", 0.004, 250.0),
    "four-times/g-sensitivity-zx": car_with("gyro_g_sensitivity", "zx", 3.3e-3),
}


def one(name, make, out):
    d = diagnosed.diagnosis(COAST, f"{out}/{name}", make)
    effects = diagnosed.effects(d, lambda e: {"held_out": e.get("held_out_gain")})
    v = d["verification"]
    return {"effects": effects, "nis": v["nis"], "log_likelihood_per_epoch": v["log_likelihood_per_epoch"], "outage_rms_m": v["outage_rms_m"],
            "rejected": [r["effect"] for r in v["rejected"]]}


COAST, CONCEAL, OUT = sys.argv[1:4]
SHARD, OF = (int(a) for a in sys.argv[4:6]) if len(sys.argv) > 5 else (0, 1)
numbers = {}
for i, (name, make) in enumerate(RUNS.items()):
    if i % OF != SHARD:
        continue
    numbers[name] = one(name, make, OUT)
    print(name, list(numbers[name]["effects"]), flush=True)
if OF == 1:
    with open(f"{OUT}/numbers.json", "w") as file:
        json.dump(numbers, file, indent=1)

# %% [markdown]
# # Find the missing physics
#
# A gyro that responds to acceleration, and an error model that does not know it. `coast process` calls the run good; the trajectory is worse than it
# could be. [`coast diagnose`](../jobs/diagnose.md) finds the effect, its axis and its size from the recording alone. A longer story, with every figure of
# the page: [Missing physics](../missing-physics.md).

# %%
import pathlib
import tempfile

import coast
import numpy as np
from matplotlib import pyplot

work = tempfile.TemporaryDirectory()                        # removed at the end
folder = pathlib.Path(work.name)
drive = coast.simulate({
    "schema": "coast.scenario/1",
    "trajectory": {"kind": "city", "duration_s": 360, "static_s": 30, "origin_deg_m": [46.52, 6.57, 400]},
    "imu": {"rate_hz": 100, "error_model": "configs/imu/adis16465.yaml", "lever_arm_m": [0.3, -0.2, -1.1]},
    "gnss": {"rate_hz": 2, "sd_m": [0.01, 0.01, 0.02], "velocity_sd_mps": [0.02, 0.02, 0.03]},
    "start_gps": {"week": 2300, "sow": 200000},
    "seed": 11,
}, out=folder / "drive", progress=False)

# %% [markdown]
# ## The concealed effect
#
# The pitch gyro (y) reads 1.5e-4 rad/s too much for each m/s^2 along x, forward. Nothing below is told of it.

# %%
CONCEALED = 1.5e-4
imu = np.genfromtxt(folder / "drive/imu.csv", delimiter=",", names=True)
log = {name: imu[name].copy() for name in imu.dtype.names}
log["gyro_y_radps"] += CONCEALED * log["accel_x_mps2"]

run = {
    "schema": "coast.run/1",
    "imu": {"file": coast.Table(log, "log"), "gps_week": 2300, "error_model": "configs/imu/adis16465.yaml", "lever_arm_m": [0.3, -0.2, -1.1]},
    "gnss": {"file": str(folder / "drive/gnss.pos")},
    "reference": {"file": str(folder / "drive/truth.nav")},     # the truth, to judge the results with
    "outages": {"every_s": 60, "durations_s": [20]},
}
before = coast.process(run, progress=False)
before

# %% [markdown]
# Good, with a NIS a little above what is expected. Many a run looks like this.
#
# ## Diagnosis
#
# Every effect of the [catalogue](../effects.md) is tried. What is accepted is estimated from half of the drive and tested on the other half. Twins, which are simulations
# of the same motion with the model as configured, say which figures are unusual. Four are enough here; the default is 20.

# %%
diagnosis = coast.diagnose(run, twins=4, progress=False)
diagnosis

# %%
effect = diagnosis.summary["effects"][0]
size = effect["parameters"][0]
print(f"{effect['name']} {effect['axis']}: {size['value']:.3g} +- {size['std']:.1g} {size['unit']}")
print(f"log-likelihood of the blocks that it was not estimated from: + {effect['held_out_gain']:.0f}")
print("what else it could be:", effect["confounded_with"] or "nothing")

assert [(e["name"], e["axis"]) for e in diagnosis.summary["effects"]] == [("gyro_g_sensitivity", "yx")]
assert abs(size["value"] - CONCEALED) < 3 * size["std"]

# %% [markdown]
# ## With the effect in the model
#
# `run.diagnosed.yaml` has it as [`effects:`](../effects.md#in-runyaml); here it goes into the dict. `coast process` subtracts it from the recording.

# %%
run["effects"] = [{"name": effect["name"], "sensor": effect["sensor"], "axis": effect["axis"], "value": size["value"]}]
after = coast.process(run, progress=False)


def nis_of_positions(result):
    nis = result.innovations["nis"]
    return nis[result.innovations["kind"].values == "gnss_position"]


def figures(result):
    position = result.summary["reference"]["smoothed"]["position_rms_m"]
    attitude = result.summary["reference"]["smoothed"]["attitude_rms_deg"]
    drift = [outage["forward"]["horizontal_max_m"] for outage in result.outages]
    return {"NIS of positions, 3 expected": float(nis_of_positions(result).mean()), "position, mm": 1000 * float(np.hypot(*position[:2])),
            "pitch, deg": attitude[1], "drift in 20 s, median, m": float(np.median(drift))}


was, now = figures(before), figures(after)
print(f"{'':30}   before    after")
for name in was:
    print(f"{name:30} {was[name]:8.3f} {now[name]:8.3f}")
assert now["position, mm"] < 0.2 * was["position, mm"] and now["pitch, deg"] < was["pitch, deg"] and now["drift in 20 s, median, m"] < 0.6 * was["drift in 20 s, median, m"]

# %%
fig, axis = pyplot.subplots()
for result, name in ((before, "as configured"), (after, "with the effect")):
    nis = nis_of_positions(result).rolling(time=20, center=True).mean()
    axis.plot((nis["time"] - nis["time"][0]) / np.timedelta64(1, "s"), nis, label=name)
axis.axhline(3, color="black", linewidth=0.8)
axis.set(xlabel="s since the start", ylabel="NIS of positions, mean of 20")
axis.legend()

# %% [markdown]
# A second diagnosis of the corrected recording is not needed: the search goes on until nothing else is found, and [the page](../report.md) says which size of every
# other effect this drive would have shown.

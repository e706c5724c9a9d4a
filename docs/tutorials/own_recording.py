# %% [markdown]
# # Your own recording, from Python
#
# You have an IMU log and a table of GNSS positions, in their own columns, units and axes. The result is a trajectory, a verdict, and the
# page that shows both. The recording is simulated here, so that the trajectory can be compared with the truth.
#
# `PYTHONPATH=build/release/python python3 docs/tutorials/own_recording.py` runs this page, from the folder of a clone.

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
    "trajectory": {"kind": "city", "duration_s": 400, "static_s": 30, "origin_deg_m": [46.52, 6.57, 400]},
    "imu": {"rate_hz": 100, "error_model": "configs/imu/adis16465.yaml", "lever_arm_m": [0.3, -0.2, -1.1]},
    "gnss": {"rate_hz": 5, "sd_m": [0.01, 0.01, 0.02]},
    "start_gps": {"week": 2300, "sow": 200000},
    "seed": 5,
}, out=folder / "drive", progress=False)

# %% [markdown]
# ## The log as it is
#
# The data logger of this example has the usual peculiarities: axes forward, left and up; deg/s and g; time in seconds since 1970, which is UTC.
# The receiver writes a CSV file with GPS seconds of week.

# %%
imu = np.genfromtxt(folder / "drive/imu.csv", delimiter=",", names=True)
gps_to_unix = 315964800 + 2300 * 604800 - 18                # 18 leap seconds since 1980
flu = np.array([1, -1, -1])
log = {"stamp": imu["time_s"] + gps_to_unix}
for n, axis in enumerate("xyz"):
    log["w" + axis] = np.degrees(imu[f"gyro_{axis}_radps"]) * flu[n]
    log["f" + axis] = imu[f"accel_{axis}_mps2"] / 9.80665 * flu[n]

positions = [line.split() for line in open(folder / "drive/gnss.pos") if not line.startswith("%")]
with open(folder / "receiver.csv", "w") as file:
    print("sow,lat,lon,h", file=file)
    for n, row in enumerate(positions):
        print(f"{200000 + 0.2 * n:.1f},{row[2]},{row[3]},{row[4]}", file=file)

print("".join(open(folder / "receiver.csv").readlines()[:3]))
print({name: round(float(column[0]), 6) for name, column in log.items()})

# %% [markdown]
# ## The configuration
#
# A dict has the keys of a [run file](../reference/run.md). Columns are named, each with its unit; `axes` says which sensor axes point forward,
# right and down. A `coast.Table` stands where a file would; the receiver's file is named as it is. Suppose that you did not know the axes and left them out.

# %%
run = {
    "schema": "coast.run/1",
    "imu": {"file": coast.Table(log, "log"), "time": {"kind": "unix"},
            "columns": {"time": "stamp", "gyro": ["wx", "wy", "wz"], "accel": ["fx", "fy", "fz"]},
            "units": {"gyro": "deg/s", "accel": "g"},
            "error_model": "configs/imu/adis16465.yaml", "lever_arm_m": [0.3, -0.2, -1.1]},
    "gnss": {"file": str(folder / "receiver.csv"), "gps_week": 2300,
             "columns": {"time": "sow", "position": ["lat", "lon", "h"]}, "sd_m": [0.01, 0.01, 0.02]},
}
try:
    coast.process(run, progress=False)
except coast.CoastError as error:
    refused = error
print(refused)

# %% [markdown]
# Gravity and the direction of travel contradict these axes, so nothing is computed; the message says what to write. With it the job runs.

# %%
assert "[x, -y, -z]" in str(refused)
run["imu"]["axes"] = ["x", "-y", "-z"]
run["outages"] = {"every_s": 60, "durations_s": [30]}       # also: how far does it drift without GNSS?
result = coast.process(run, out=folder / "results", progress=False)
result

# %% [markdown]
# ## Checks
#
# First what was understood: rate, span, gaps, gravity at rest, axes, time. If one of these lines surprises you, the run file is wrong.

# %%
print(*result.inspection, sep="\n")
assert not result.warnings

# %% [markdown]
# Then the [verdict](../first-recording.md#the-verdict), and the normalised innovations: with the right sigmas their mean is the number of components, 3.

# %%
checks = result.summary["verdict"]["checks"]
for check in checks:
    print(f"{check['name']:36} {check['value']:8.3f}")
print("nis", round(float(result.innovations["nis"].mean()), 2))
assert result.verdict == "good"

# %% [markdown]
# ## The trajectory
#
# `result.trajectory` is an xarray.Dataset; `result.forward` that of the forward filter. Here the truth is known: are the stated sigmas honest?

# %%
truth = np.loadtxt(folder / "drive/truth.nav")
smoothed = result.trajectory
seconds = (smoothed["time"].values - smoothed["time"].values[0]) / np.timedelta64(1, "s")
at = np.searchsorted(truth[:, 1], 200000.01 + seconds - 0.002)
north = np.radians(smoothed["latitude"] - truth[at, 2]) * 6.37e6
error = np.asarray(north)
sd = np.asarray(smoothed["position_sd"].sel(axis="north"))
inside = float(np.mean(np.abs(error) < 1.96 * sd))

fig, axes = pyplot.subplots(1, 2, width_ratios=[1, 1.6])
axes[0].plot(smoothed["longitude"], smoothed["latitude"])
axes[0].set(xlabel="longitude, deg", ylabel="latitude, deg")
axes[0].ticklabel_format(useOffset=False)
axes[0].tick_params(axis="x", rotation=30)
axes[1].plot(seconds, 1000 * error, label="north, smoothed minus truth")
axes[1].fill_between(seconds, -1960 * sd, 1960 * sd, alpha=0.2, label="95 % by the stated sigma")
axes[1].set(xlabel="s since the start", ylabel="mm")
axes[1].legend(loc="lower left")

print(f"rms error north {1000 * np.sqrt(np.mean(error**2)):.1f} mm, stated {1000 * np.sqrt(np.mean(sd**2)):.1f} mm, inside 95 %: {inside:.2f}")
assert inside > 0.85 and np.sqrt(np.mean(error**2)) < 0.01

# %% [markdown]
# ## Without GNSS
#
# `outages` has withheld 30 s of fixes every 60 s, each time alone, and compared the solution with the one that has all fixes: the forward filter,
# and the smoother, which knows the fixes on both sides.

# %%
forward = [outage["forward"]["horizontal_max_m"] for outage in result.outages]
both = [outage["smoothed"]["horizontal_max_m"] for outage in result.outages]
for outage, f, s in zip(result.outages, forward, both):
    print(f"from {outage['start_s']:.0f} s: forward {f:5.2f} m, smoothed {s:5.2f} m")
assert np.median(both) < 0.5 * np.median(forward)

# %% [markdown]
# ## The page and the files
#
# `out` has written what the program writes. `report.html` is complete in itself: [how to read it](../report.md). In a notebook, `result` alone shows it.

# %%
print(*sorted(file.name for file in (folder / "results").iterdir() if not file.name.startswith(".")), sep="\n")

# %% [markdown]
# `run.resolved.yaml` has every value that was used. Next: [an outage study of your own IMU](outage_study.py), or what to do
# [when the verdict is not good](../first-recording.md#the-verdict).

# %% [markdown]
# # An outage study of your own IMU
#
# How far does *this* IMU drift in a minute without GNSS, and does its error model say so? Three steps: a record at rest becomes an error model
# ([`coast calibrate`](../jobs/calibrate.md)); the model goes into a [scenario](../jobs/simulate.md); [`coast outage`](../jobs/outage.md) makes outages in
# simulated drives, and compares the model with others.
#
# The record at rest is simulated too, so that the right answer is known.

# %%
import pathlib
import tempfile

import coast
from matplotlib import pyplot

work = tempfile.TemporaryDirectory()                        # removed at the end
folder = pathlib.Path(work.name)

# %% [markdown]
# ## A sensor, and what its data sheet says
#
# Both files below have the same white noise and turn-on bias. They differ in the bias that wanders ([Gauss-Markov](../glossary.md#gauss-markov-process)): the real sensor is worse
# than its sheet, as many are outside a laboratory.

# %%
def error_model(sensor, gyro_deg_h, accel_mg, seconds):
    return f"""
schema: coast.imu_error_model/1
sensor: {sensor}
gyro:
  all:
    - {{process: white_noise, density: 0.25, unit: deg/sqrt(h)}}
    - {{process: random_constant, sigma: 0.1, unit: deg/s}}
    - {{process: gauss_markov, sigma: {gyro_deg_h}, unit: deg/h, correlation_time_s: {seconds}}}
accel:
  all:
    - {{process: white_noise, density: 60, unit: ug/sqrt(Hz)}}
    - {{process: random_constant, sigma: 3, unit: mg}}
    - {{process: gauss_markov, sigma: {accel_mg}, unit: mg, correlation_time_s: {seconds}}}
"""


(folder / "real.yaml").write_text(error_model("the real sensor", 12, 0.15, 120))
(folder / "sheet.yaml").write_text(error_model("its data sheet", 3, 0.02, 1000))

rest = coast.simulate({
    "schema": "coast.scenario/1",
    "trajectory": {"kind": "at_rest", "duration_s": 7200, "static_s": 0, "origin_deg_m": [46.52, 6.57, 400]},
    "imu": {"rate_hz": 10, "error_model": str(folder / "real.yaml")},
    "gnss": {"rate_hz": 0.1, "sd_m": [0.01, 0.01, 0.02]},
    "start_gps": {"week": 2300, "sow": 200000},
    "seed": 3,
}, out=folder / "rest", progress=False)

# %% [markdown]
# ## Calibration
#
# Two hours at rest. Which processes the sensor has can be searched for; here the sum is stated, which takes seconds instead of minutes.

# %%
processes = {"sum": ["white_noise", "gauss_markov"], "drift": False}
calibration = coast.calibrate({
    "schema": "coast.calibration_run/1",
    "sensor": "my IMU",
    "records": [{"file": str(folder / "rest/imu.csv"), "gps_week": 2300}],
    "processes": {"gyro": processes, "accel": processes},
    "turn_on_bias": {"gyro": {"sigma": 0.1, "unit": "deg/s"}, "accel": {"sigma": 3, "unit": "mg"}},
}, out=folder / "model", progress=False)
calibration

# %% [markdown]
# Every value has its 95 % interval. Of 18 intervals about one misses the truth by chance.

# %%
truth = {"gyro": {"WN density": 0.25, "GM correlation time": 120, "GM sigma": 12},
         "accel": {"WN density": 60e-6 * 9.80665 * 60, "GM correlation time": 120, "GM sigma": 150}}
hit = []
for axis in calibration.summary["axes"]:
    for parameter in (p["data_sheet"] for p in axis["parameters"]):
        true = truth[axis["sensor"]][parameter["name"]]
        hit.append(parameter["lower_95"] <= true <= parameter["upper_95"])
print(f"{sum(hit)} of {len(hit)} intervals contain the truth")
assert len(hit) == 18 and sum(hit) >= 15

# %% [markdown]
# ## The study
#
# A city drive with centimetre fixes, simulated with the errors of the real sensor, 12 seeds. In each, outages of 60 s begin at three times. The filter
# believes the calibrated model, then the data sheet. The dict has the keys of [study.yaml](../reference/study.md).

# %%
(folder / "drive.yaml").write_text("""
schema: coast.scenario/1
trajectory: {kind: city, duration_s: 400, static_s: 60, origin_deg_m: [46.52, 6.57, 400]}
imu: {rate_hz: 50, error_model: real.yaml, lever_arm_m: [0.3, -0.2, -1.1]}
gnss: {rate_hz: 2, sd_m: [0.01, 0.01, 0.02]}
start_gps: {week: 2300, sow: 200000}
seed: 1
""")
study = coast.outage({
    "schema": "coast.study/1",
    "scenario": str(folder / "drive.yaml"),
    "seeds": {"first": 1, "count": 12},
    "sweep": {"every_s": 60, "first_s": 200, "durations_s": [60]},
    "error_models": [{"name": "calibrated", "file": str(folder / "model/error_model.yaml")},
                     {"name": "data sheet", "file": str(folder / "sheet.yaml")}],
}, progress=False)

runs = study.summary["outages"][0]["runs"]
print("60 s without GNSS: largest horizontal error, and the share of errors inside their stated 95 %")
for run in runs:
    for solution in ("forward", "smoothed"):
        print(f"{run['error_model']:11} {solution:9} rms {run[solution]['largest']['horizontal']['rms_m']:6.2f} m   {run[solution]['share_inside_95']:.2f}")

# %% [markdown]
# The calibrated model drifts less, since the biases at the beginning of the outage are estimated better. Above all it states what its errors are: near
# 95 % of them lie inside the stated 95 %. With the data sheet far fewer do: its sigmas are too small.

# %%
calibrated, sheet = (run["forward"]["share_inside_95"] for run in runs)
assert calibrated > 0.85 and sheet < calibrated - 0.2

paired = next(p for p in study.summary["outages"][0]["paired"] if p["solution"] == "forward")["horizontal"]
print(f"data sheet over calibrated, outage by outage: {paired['ratio']:.2f}, 95 % from {paired['interval_95'][0]:.2f} to {paired['interval_95'][1]:.2f}")
assert paired["interval_95"][0] > 1

# %%
fig, axes = pyplot.subplots(1, 2)
for axis, solution in zip(axes, ("forward", "smoothed")):
    for place, run in enumerate(runs):
        end = run[solution]["end"]
        for n, (key, label) in enumerate((("rms_m", "rms of the errors"), ("predicted_rms_m", "rms of their stated sigmas"))):
            axis.bar(place + 0.36 * n, end["e"][key], width=0.32, color=f"C{n}", label=label if place == 0 else None)
    axis.set_xticks([0.18, 1.18], [run["error_model"] for run in runs])
    axis.set(title=f"{solution}, east, end of the outage", ylabel="m")
axes[1].legend(loc="upper left")

# %% [markdown]
# `study.page` is the report, with a figure of every outage. To study a recording of your own instead, write `run: run.yaml` in place of `scenario` and `seeds`: then
# the outages are made in it, and compared with the run that has all fixes.

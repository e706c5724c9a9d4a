#!/usr/bin/env python3
"""Merges the first K IMUs of the arrays in configs/arrays for K = 2 to all, and takes what comes out, and each IMU by itself, through the filter.

    arrays.py COAST CONFIGS OUT        writes OUT/numbers.json
"""

import json
import math
import pathlib
import re
import subprocess
import sys

coast, configs, out = sys.argv[1], pathlib.Path(sys.argv[2]).resolve(), pathlib.Path(sys.argv[3])


def run(command, yaml, folder):
    subprocess.run([coast, command, str(yaml), "--out", str(folder), "--quiet"], check=True, stderr=subprocess.DEVNULL)


def parts(name):
    """An array.yaml as its head, the text of each IMU, and its tail."""
    text = (configs / "arrays" / f"{name}.yaml").read_text()
    head, rest = text.split("imus:\n")
    imus = re.split(r"(?m)^(?=  - name:)", rest)
    imus = [i for i in imus if i.strip()]
    last, tail = re.split(r"(?m)^(?=\w)", imus[-1], maxsplit=1)
    return head, imus[:-1] + [last], tail


def merged(name, count, method):
    """Merges the first `count` IMUs; returns the folder of the result and synth.json."""
    head, imus, tail = parts(name)
    tail = re.sub(r"(?m)^merge:.*$", f"merge: {{method: {method}}}", tail)
    folder = out / f"{name}-{method}-{count}"
    yaml = out / f"{name}-{method}-{count}.yaml"
    yaml.write_text(head + "imus:\n" + "".join(imus[:count]) + tail)
    run("synth", yaml, folder)
    return folder, json.loads((folder / "synth.json").read_text())


def mean_ratio(channels, value):
    """Root mean square over channels of value over the mean own noise of the sensors."""
    ratios = [value(c) / math.sqrt(sum(s["noise_sd"] ** 2 for s in c["sensors"]) / len(c["sensors"])) for c in channels]
    return math.sqrt(sum(r * r for r in ratios) / len(ratios))


def drift(recording, imu, name):
    """Median largest horizontal error against GNSS after each duration, forward and smoothed."""
    text = (configs / "recordings" / f"{recording}.yaml").read_text().replace("../imu", str(configs / "imu"))
    begin, end = text.index("imu:\n"), text.index("gnss:\n")
    if imu is not None:
        text = text[:begin] + imu + text[end:]
    yaml = out / f"{name}.yaml"
    yaml.write_text(text + "\naccept: true\n")  # also of merges that a run doubts: how far they drift is the question
    run("process", yaml, out / name)
    summary = json.loads((out / name / "summary.json").read_text())
    return {
        f"{sweep['duration_s']:.0f}_s": {
            kind: sweep[f"{kind}_horizontal_max_against_gnss"]["median_m"] for kind in ("forward", "smoothed")
        }
        for sweep in summary["outage_sweep"]
    }


def single(recording, array, index):
    """The imu: map of one IMU by itself."""
    _, imus, _ = parts(array)
    lines = imus[index].strip("\n").split("\n")[1:]
    extra = f"    error_model: {configs}/imu/xsens-dot.yaml\n    lever_arm_m: [0, 0, 0]\n    lever_arm_sd_m: 0.3\n    noise: estimated\n"
    return "imu:\n" + "\n".join(lines) + "\n" + extra


def synthetic(folder, week):
    return (
        f"imu:\n  file: {folder}/imu.csv\n  gps_week: {week}\n  error_model: {folder}/error_model.yaml\n  noise_levels: {folder}/noise.csv\n"
        "  lever_arm_m: [0, 0, 0]\n  lever_arm_sd_m: 0.3\n  noise: estimated\n"
    )


numbers = {}
for array, count in (("xsens-dot-static", 5), ("rc-rover-mimu", 5), ("quadrotor-mimu", 4)):
    own = numbers[array] = {}
    for k in range(2, count + 1):
        entry = own[f"{k}"] = {}
        for method in ("mean", "weighted", "corrected"):
            folder, synth = merged(array, k, method)
            gyro, accel = synth["channels"][:3], synth["channels"][3:]
            entry[method] = {
                "gyro_noise_ratio": mean_ratio(gyro, lambda c: c["merged_sd"]),
                "accel_noise_ratio": mean_ratio(accel, lambda c: c["merged_sd"]),
            }
            if array != "xsens-dot-static":
                week = synth["grid"]["gps_week"]
                entry[method]["drift"] = drift(array, synthetic(folder, week), f"{array}-{method}-{k}-run")
    own["defects"] = len(synth["defects"])  # of all IMUs of the array; none is known to be defective
    own["lags_ms"] = [1e3 * imu.get("lag", {}).get("offset_s", 0.0) for imu in synth["imus"]]
    if array != "xsens-dot-static":
        own["single"] = {f"{i + 1}": drift(array, single(array, array, i), f"{array}-single-{i + 1}") for i in range(count)}
_, synth = merged("mimu-array", 8, "mean")
numbers["mimu-array"] = {"defects": len(synth["defects"])}
(out / "numbers.json").write_text(json.dumps(numbers, indent=1) + "\n")

"""Outages of one minute and of five with different aids of the same recording: drift against the truth, coverage of the 95 % bounds."""

import json
import pathlib
import re
import subprocess
import sys

coast, out = sys.argv[1], pathlib.Path(sys.argv[2])
recorded = (out / "city/run.yaml").read_text()
items = re.search(r"^aids:\n((?:  - .*\n)+)", recorded, re.M)
kinds = ["speed", "pulses", "heading", "height"]
aids = dict(zip(kinds, items[1].splitlines()))
plain = recorded.replace(items[0], "")
CAR = "vehicle: {kind: car, nhc_point_m: [-1.2, 0, 0.6]}\n"

VARIANTS = {
    "none": ("", []),
    "car": (CAR, []),
    "odometer": ("", ["speed"]),
    "car_and_odometer": (CAR, ["speed"]),
    "car_and_pulses": (CAR, ["pulses"]),
    "car_odometer_heading": (CAR, ["speed", "heading"]),
    "car_odometer_height": (CAR, ["speed", "height"]),
}


def run(name):
    vehicle, wanted = VARIANTS[name]
    text = plain + vehicle + "outages: {every_s: 150, first_s: 200, durations_s: [60, 300]}\n"
    if wanted:
        text += "aids:\n" + "".join(aids[kind] + "\n" for kind in wanted)
    yaml = out / "city" / f"{name}.yaml"
    yaml.write_text(text)
    subprocess.run([coast, "process", yaml, "--out", out / name, "--quiet"], check=True)
    summary = json.loads((out / name / "summary.json").read_text())
    numbers = {"position_rms_m": summary["reference"]["smoothed"]["position_rms_m"], "attitude_rms_deg": summary["reference"]["smoothed"]["attitude_rms_deg"]}
    for row in summary["outage_sweep"]:
        numbers[f"{row['duration_s']:g}_s"] = {"inside_95": row["smoothed_share_inside_95"]}
        for key in ("forward", "smoothed"):
            numbers[f"{row['duration_s']:g}_s"][key] = {of: row[f"{key}_horizontal_max"][of] for of in ("median_m", "max_m")}
    for aid in summary.get("aids", []):
        numbers[aid["name"]] = {"used": aid["used"], "refused": aid["refused"], "nis": aid["nis"]["mean"]}
    return numbers


numbers = {name: run(name) for name in VARIANTS}
(out / "numbers.json").write_text(json.dumps(numbers, indent=1) + "\n")

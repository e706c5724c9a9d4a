#!/usr/bin/env python3
"""Simulates the recordings of a fleet, with what is wrong in it.

missions.py COAST FOLDER: ten units with 20 missions each in two years, 220 s of a city car at 50 Hz. `coast simulate` draws motion, noise and fixes of
each mission; biases, temperatures and what goes wrong are added here to its imu.csv. Each run file states the same lever arm, which is not exactly that
of the unit, and leaves lever arm, delay and biases to be estimated. FOLDER/truth.json has the true value of every figure of every mission.
"""

import concurrent.futures
import datetime
import json
import math
import pathlib
import random
import subprocess
import sys

UNITS, MISSIONS, YEARS = 10, 20, 2.0
BEGIN = datetime.datetime(2024, 1, 7)  # a Sunday, the first day of a GPS week
WEEK = 2296
NOMINAL = (0.30, -0.20, -1.10)
AGES = {"unit": "u03", "quantity": "accel_bias", "axis": "x", "per_year": 0.008}
MOVED = {"unit": "u06", "quantity": "lever_arm", "t": 1.1, "size": [0.04, 0.0, 0.06]}
FIRMWARE = {"units": ["u01", "u04", "u08", "u10"], "quantity": "time_offset", "t": 0.7, "size": 0.010}

MODEL = """schema: coast.imu_error_model/1
sensor: simulated
gyro: {{all: [{{process: white_noise, density: 0.3, unit: deg/sqrt(h)}}{gyro}]}}
accel: {{all: [{{process: white_noise, density: 60, unit: ug/sqrt(Hz)}}{accel}]}}
"""
SCENARIO = """schema: coast.scenario/1
trajectory: {{kind: city, duration_s: 220, static_s: 20, origin_deg_m: [46.52, 6.57, 400], course_deg: {course:.1f}}}
imu: {{rate_hz: 50, error_model: ../../drawn.yaml, lever_arm_m: [{arm[0]:.5f}, {arm[1]:.5f}, {arm[2]:.5f}]}}
gnss: {{rate_hz: 1, sd_m: [0.01, 0.01, 0.02], velocity_sd_mps: [0.03, 0.03, 0.05], time_offset_s: {delay}}}
start_gps: {{week: {week}, sow: {sow}}}
"""
RUN = """schema: coast.run/1
imu: {{file: imu.csv, format: csv, gps_week: {week}, error_model: ../../model.yaml, name: {unit}, lever_arm_m: {arm}, lever_arm_sd_m: 0.1}}
gnss: {{file: gnss.pos, format: rtklib-pos, time_offset_s: 0, time_offset_sd_s: 0.02}}
"""


def truth_of(unit, t, random_, base):
    temperature = 12.0 - 10.0 * math.cos(2.0 * math.pi * t) + random_.gauss(0.0, 4.0)
    arm = list(base["arm"])
    accel = [b + s * (temperature - 12.0) + random_.gauss(0.0, 2e-3) for b, s in zip(base["accel"], base["slopes"])]
    gyro = [b + random_.gauss(0.0, 4e-5) for b in base["gyro"]]
    if unit == AGES["unit"]:
        accel[0] += AGES["per_year"] * t
    if unit == MOVED["unit"] and t > MOVED["t"]:
        arm = [a + d for a, d in zip(arm, MOVED["size"])]
    delay = FIRMWARE["size"] if unit in FIRMWARE["units"] and t > FIRMWARE["t"] else 0.0
    return {"unit": unit, "t": t, "temperature": temperature, "lever_arm": arm, "gyro_bias": gyro, "accel_bias": accel, "time_offset": delay}


def drawn():
    random_ = random.Random(2024)
    missions = {}
    for u in range(1, UNITS + 1):
        unit = f"u{u:02d}"
        base = {"arm": [a + random_.gauss(0.0, 0.02) for a in NOMINAL], "gyro": [random_.gauss(0.0, 2e-3) for _ in range(3)],
                "accel": [random_.gauss(0.0, 0.03) for _ in range(3)], "slopes": [random_.gauss(0.0, 1e-4) for _ in range(3)]}
        for m, t in enumerate(sorted(random_.uniform(0.0, YEARS) for _ in range(MISSIONS))):
            missions[f"{unit}-{m:02d}"] = truth_of(unit, t, random_, base) | {"course": random_.uniform(0.0, 360.0), "seed": 100 * u + m}
    return missions


def record(coast, folder, name, mission):
    days = int(365.25 * mission["t"])
    week, sow = WEEK + days // 7, 86400 * (days % 7) + 28800
    own = folder / "recordings" / name
    own.mkdir(parents=True)
    scenario = own / "scenario.yaml"
    scenario.write_text(SCENARIO.format(course=mission["course"], arm=mission["lever_arm"], delay=mission["time_offset"], week=week, sow=sow))
    subprocess.run([coast, "simulate", scenario, "--seed", str(mission["seed"]), "--out", own / "drawn", "--quiet"], check=True)
    biases = mission["gyro_bias"] + mission["accel_bias"]
    temperature = f"{mission['temperature']:.1f}\n"
    with open(own / "drawn/imu.csv") as clean, open(own / "imu.csv", "w") as out:
        out.write(next(clean).rstrip("\n") + ",temperature_degC\n")
        for line in clean:
            time, *values = line.split(",")
            out.write(",".join([time, *(f"{float(v) + b:.10f}" for v, b in zip(values, biases)), temperature]))
    (own / "drawn/gnss.pos").rename(own / "gnss.pos")
    for file in (own / "drawn").iterdir():
        file.unlink()
    (own / "drawn").rmdir()
    (own / "run.yaml").write_text(RUN.format(week=week, unit=mission["unit"], arm=list(NOMINAL)))


def main():
    coast, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "drawn.yaml").write_text(MODEL.format(gyro="", accel=""))
    (folder / "model.yaml").write_text(MODEL.format(gyro=", {process: random_constant, sigma: 0.5, unit: deg/s}",
                                                    accel=", {process: random_constant, sigma: 20, unit: mg}"))
    missions = drawn()
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        list(pool.map(lambda item: record(coast, folder, *item), missions.items()))
    (folder / "plan.yaml").write_text("schema: coast.campaign/1\njob: process\nmissions: recordings\nshards: 4\n")
    (folder / "truth.json").write_text(json.dumps({"ages": AGES, "moved": MOVED, "firmware": FIRMWARE, "begin": BEGIN.date().isoformat(), "missions": missions}))


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Estimates of the four runs of rc-rover-mimu as a table for coast fleet.

rover.py FOLDER: FOLDER/{h,k,l,r}/summary.json to FOLDER/estimates.csv. The recordings have no date: starts are an hour apart, in the order of names.
"""

import json
import pathlib
import sys

UNITS = {"gyro": ("gyro_bias", "rad/s"), "accel": ("accel_bias", "m/s^2")}


def rows(name, summary, hour):
    def row(quantity, axis, value, sigma, unit):
        return f"{name},imu1,2024-02-04T{hour:02d}:00:00,{quantity},{axis},{value!r},{sigma!r},{unit},\n"

    lever_arm = summary["lever_arm_misclosure"]  # against a stated one of zero
    for axis, value, sigma in zip("xyz", lever_arm["estimated_minus_configured_m"], lever_arm["sd_m"]):
        yield row("lever_arm", axis, value, sigma, "m")
    yield row("time_offset", "", summary["gnss"]["time_offset_s"], summary["gnss"]["time_offset_sd_s"], "s")
    for state, estimate in summary["states_at_end"].items():
        channel, _, process = state.partition(" ")
        if process == "random_constant":
            sensor, axis = channel.split("_")
            yield row(UNITS[sensor][0], axis, estimate["value"], estimate["sd"], UNITS[sensor][1])


def main():
    folder = pathlib.Path(sys.argv[1])
    with open(folder / "estimates.csv", "w") as out:
        out.write("mission,unit,start,quantity,axis,value,sigma,unit_of_value,temperature_degC\n")
        for hour, name in enumerate("hklr"):
            out.writelines(rows(name, json.loads((folder / name / "summary.json").read_text()), hour))


if __name__ == "__main__":
    main()

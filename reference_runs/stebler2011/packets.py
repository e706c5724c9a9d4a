#!/usr/bin/env python3
"""What a computer logs of a simulated array: packets with a counter and a time of arrival, and the array.yaml for `coast synth`.

  packets.py software FOLDER OUT    FOLDER: of `coast simulate array_scenario.yaml`, four IMUs, each by a clock of its own
  packets.py hardware FOLDER OUT    FOLDER: the same with clocks that are right; every second a pulse restarts their sampling

The four devices of Stebler et al. (2011), Fig. 7: an MTi-G, whose packets carry GPS time, and three MTx. Samples are those of the
simulation; when a packet arrives is drawn here. The true time of every sample goes to OUT/NAME_truth.csv, which `coast` does not see.
"""

import math
import os
import random
import sys

START_S = 208800.0  # of array_scenario.yaml, GPS seconds of week
WEEK = 1634
FIRST_S, LAST_S = 5.0, 325.0  # of the mission: all of it but its ends
INTERVAL_S = 0.01
MASTER = "MTi-G"
# name: offset (s) and drift (ppm) of its clock in array_scenario.yaml; delay that all its packets share, s (the MTx answer one after
# the other)
DEVICES = {"MTi-G": (0.0, 0.0, 0.0020), "MTx-1": (0.0034, 30.0, 0.0045), "MTx-2": (-0.0021, -18.0, 0.0050),
           "MTx-3": (0.0012, 9.0, 0.0055)}
POSITIONS_M = {"MTi-G": [0, 0, 0], "MTx-1": [0.05, 0, 0], "MTx-2": [0, -0.05, 0], "MTx-3": [0, 0.05, 0]}
JITTER_S = 0.001  # mean of an exponential delay of every packet
STALL_EVERY_S, STALL_S = 2.0, 0.015  # the computer is busy this often, for an exponential time; packets wait
COMPUTER_AHEAD_S, COMPUTER_PPM = -208000.0, 12.0  # its clock counts from its start


def read_rows(path):
    with open(path, encoding="utf-8") as file:
        next(file)
        return [line.rstrip("\n").split(",", 1) for line in file]


def stalls(generator):
    """Stretches in which the computer reads nothing, seconds since FIRST_S."""
    spans, t = [], 0.0
    while t < LAST_S - FIRST_S + 1.0:
        t += -math.log(1.0 - generator.random()) * STALL_EVERY_S
        end = t - math.log(1.0 - generator.random()) * STALL_S
        spans.append((t, end))
        t = end
    return spans


def true_time(mode, tag_s, offset_s, drift_ppm):
    """When a sample was taken, seconds of week."""
    if mode == "software":  # its tag is true time + offset + drift * elapsed
        return START_S + (tag_s - START_S - offset_s) / (1.0 + 1e-6 * drift_ppm)
    second = math.floor(tag_s + 0.5 * INTERVAL_S)  # the pulse: from it on the device counts by its own quartz
    return second + (tag_s - second) * (1.0 + 1e-6 * drift_ppm)


def arrival(true_s, delay_s, generator, spans, at):
    """By the computer's clock; `at` is the first stall that has not ended, kept from packet to packet."""
    t = true_s + delay_s - math.log(1.0 - generator.random()) * JITTER_S
    elapsed = t - START_S - FIRST_S
    while at[0] < len(spans) and spans[at[0]][1] < elapsed:
        at[0] += 1
    if at[0] < len(spans) and spans[at[0]][0] < elapsed:
        t = START_S + FIRST_S + spans[at[0]][1]
    return t


def by_computer(t):
    return t + COMPUTER_AHEAD_S + 1e-6 * COMPUTER_PPM * (t - START_S)


def write_device(mode, folder, out, name, spans, seed):
    offset_s, drift_ppm, delay_s = DEVICES[name]
    generator = random.Random(seed)
    at, last = [0], -math.inf
    with open(os.path.join(out, name + ".csv"), "w", encoding="utf-8") as log, \
            open(os.path.join(out, name + "_truth.csv"), "w", encoding="utf-8") as truth:
        log.write("counter,arrival_s,gps_s,pulse,gx,gy,gz,ax,ay,az\n")
        truth.write("true_s,arrival_s\n")
        for n, (tag, values) in enumerate(read_rows(os.path.join(folder, f"imu_{name}.csv"))):
            t = true_time(mode, float(tag), offset_s, drift_ppm)
            if not FIRST_S <= t - START_S < LAST_S:
                continue
            last = max(arrival(t, delay_s, generator, spans, at), last + 2e-5)  # one after the other
            second = round(t)
            pulse = second - round(START_S) if mode == "hardware" and abs(t - second) < 0.2 * INTERVAL_S else ""
            gps = f"{t:.9f}" if name == MASTER else ""
            log.write(f"{n % 65536},{by_computer(last):.9f},{gps},{pulse},{values}\n")
            truth.write(f"{t:.9f},{last:.9f}\n")


def write_array(mode, out):
    time = f"by: packets, gps_week: {WEEK}, master: {MASTER}" if mode == "software" else \
        f"by: pulses, gps_week: {WEEK}, pulses: {{first_s: {START_S:.0f}, period_s: 1}}"
    with open(os.path.join(out, "array.yaml"), "w", encoding="utf-8") as file:
        file.write(f"schema: coast.array/1\ntime: {{{time}}}\nmerge: {{method: mean}}\ndefects: {{find: false}}\nimus:\n")
        for name in DEVICES:
            more = {"software": "gps: gps_s, " if name == MASTER else "", "hardware": "pulse: pulse, "}[mode]
            file.write(f"  - name: {name}\n    file: {name}.csv\n    position_m: {POSITIONS_M[name]}\n"
                       f"    columns: {{counter: counter, arrival: arrival_s, {more}gyro: [gx, gy, gz], accel: [ax, ay, az]}}\n"
                       f"    units: {{gyro: rad/s, accel: m/s^2}}\n    counter: {{interval_s: {INTERVAL_S}, modulus: 65536}}\n")


def main(mode, folder, out):
    os.makedirs(out, exist_ok=True)
    spans = stalls(random.Random(1))  # the same computer for all
    for k, name in enumerate(DEVICES):
        write_device(mode, folder, out, name, spans, 2 + k)
    write_array(mode, out)


if __name__ == "__main__":
    if len(sys.argv) != 4 or sys.argv[1] not in ("software", "hardware"):
        sys.exit(__doc__)
    main(*sys.argv[1:])

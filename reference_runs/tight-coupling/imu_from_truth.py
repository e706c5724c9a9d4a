#!/usr/bin/env python3
"""What an IMU on the signal simulator's rover would have recorded, from the exact truth of its motion.

imu_from_truth.py PVA.csv.gz MOTION.csv.gz OUT      writes imu.csv, truth.nav and error_model.yaml

Between the 10 Hz of the truth the path is the quintic polynomial through position, velocity and acceleration of both ends, the
heading the cubic through heading and rate; the rover is level. Increments are differences of inertial attitude and integrals of
the specific force along that path, so that what the truth's last digit is off does not accumulate. Tactical-grade errors (white
noise and turn-on biases) are added; the error model says the same.
"""

import csv
import gzip
import math
import random
import sys

WEEK = 2244
RATE = 100
GYRO_WHITE, GYRO_BIAS = 0.15, 0.75  # deg/sqrt(h), deg/h
ACCEL_WHITE, ACCEL_BIAS = 60.0, 1.0  # ug/sqrt(Hz), mg
SEED = 7
OMEGA = 7.292115e-5
G0 = 9.80665


def rows(name, skip):
    with gzip.open(name, "rt") as file:
        for _ in range(skip):
            next(file)
        yield from csv.DictReader(file)


def geodetic(r):
    a, e2 = 6378137.0, 6.69437999014e-3
    p = math.hypot(r[0], r[1])
    lat = math.atan2(r[2], p * (1 - e2))
    for _ in range(6):
        n = a / math.sqrt(1 - e2 * math.sin(lat) ** 2)
        lat = math.atan2(r[2] + e2 * n * math.sin(lat), p)
    n = a / math.sqrt(1 - e2 * math.sin(lat) ** 2)
    return lat, math.atan2(r[1], r[0]), p / math.cos(lat) - n


def gravity(r):
    """Gravity in ECEF, m/s^2: central term, J2, J4 and the centrifugal acceleration; 2e-6 m/s^2 off normal gravity."""
    gm, a, j2, j4 = 3.986004418e14, 6378137.0, 1.082629821e-3, -2.370911e-6
    d = math.sqrt(sum(x * x for x in r))
    s2 = (r[2] / d) ** 2
    k2, k4 = 1.5 * j2 * (a / d) ** 2, 5.0 / 8.0 * j4 * (a / d) ** 4
    xy = 1 + k2 * (1 - 5 * s2) + k4 * (-3 + 42 * s2 - 63 * s2**2)
    z = 1 + k2 * (3 - 5 * s2) + k4 * (-15 + 70 * s2 - 63 * s2**2)
    c = -gm / d**3
    return (c * xy * r[0] + OMEGA**2 * r[0], c * xy * r[1] + OMEGA**2 * r[1], c * z * r[2])


def quintic(p0, v0, a0, p1, v1, a1, h, t):
    """Value, first and second derivative."""
    c = [p0, v0, a0 / 2]
    dp, dv, da = p1 - (p0 + v0 * h + a0 * h * h / 2), v1 - (v0 + a0 * h), a1 - a0
    c += [(10 * dp - 4 * dv * h + da * h * h / 2) / h**3, (-15 * dp + 7 * dv * h - da * h * h) / h**4,
          (6 * dp - 3 * dv * h + da * h * h / 2) / h**5]
    return (sum(c[k] * t**k for k in range(6)), sum(k * c[k] * t ** (k - 1) for k in range(1, 6)),
            sum(k * (k - 1) * c[k] * t ** (k - 2) for k in range(2, 6)))


def matmul(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def rotvec(c):
    angle = math.acos(max(-1.0, min(1.0, (c[0][0] + c[1][1] + c[2][2] - 1) / 2)))
    k = 0.5 if angle < 1e-9 else angle / (2 * math.sin(angle))
    return [k * (c[2][1] - c[1][2]), k * (c[0][2] - c[2][0]), k * (c[1][0] - c[0][1])]


class Motion:
    def __init__(self, pva, motion):
        self.t, self.p, self.v, self.a, self.yaw = [], [], [], [], []
        for row, fine in zip(rows(pva, 0), rows(motion, 1)):
            self.t.append(float(row["GpsToW [s]"]))
            self.p.append([float(fine[f"Pos_{k}"]) for k in "XYZ"])
            self.v.append([float(fine[f"Vel_{k}"]) for k in "XYZ"])
            self.a.append([float(fine[f"Acc_{k}"]) for k in "XYZ"])
            yaw = float(fine["Heading"])
            if self.yaw:
                yaw += 2 * math.pi * round((self.yaw[-1] - yaw) / (2 * math.pi))
            self.yaw.append(yaw)

    def at(self, t):
        i = max(1, min(len(self.t) - 3, int((t - self.t[0]) / 0.1 + 1e-9)))
        h, s = self.t[i + 1] - self.t[i], t - self.t[i]
        parts = [quintic(self.p[i][k], self.v[i][k], self.a[i][k], self.p[i + 1][k], self.v[i + 1][k], self.a[i + 1][k], h, s)
                 for k in range(3)]
        r, v, a = ([part[n] for part in parts] for n in range(3))
        w, x = self.yaw, s / h
        slope0, slope1 = (w[i + 1] - w[i - 1]) / 2, (w[i + 2] - w[i]) / 2
        yaw = ((1 + 2 * x) * (1 - x) ** 2 * w[i] + x * (1 - x) ** 2 * slope0 + x * x * (3 - 2 * x) * w[i + 1]
               + x * x * (x - 1) * slope1)
        return r, v, a, yaw


def body_to_ecef(r, yaw):
    lat, lon, _ = geodetic(r)
    sl, cl, so, co = math.sin(lat), math.cos(lat), math.sin(lon), math.cos(lon)
    c_n_e = [[-sl * co, -so, -cl * co], [-sl * so, co, -cl * so], [cl, 0.0, -sl]]
    s, c = math.sin(yaw), math.cos(yaw)
    return matmul(c_n_e, [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def specific_force(motion, t):
    r, v, a, yaw = motion.at(t)
    g = gravity(r)
    f = [a[0] - 2 * OMEGA * v[1] - g[0], a[1] + 2 * OMEGA * v[0] - g[1], a[2] - g[2]]
    c = body_to_ecef(r, yaw)
    return [sum(c[k][i] * f[k] for k in range(3)) for i in range(3)]


def to_inertial(c, t):
    s, k = math.sin(OMEGA * t), math.cos(OMEGA * t)
    return matmul([[k, -s, 0.0], [s, k, 0.0], [0.0, 0.0, 1.0]], c)


def main():
    motion, out = Motion(sys.argv[1], sys.argv[2]), sys.argv[3]
    random.seed(SEED)
    bias_g = [random.gauss(0, math.radians(GYRO_BIAS) / 3600) for _ in range(3)]
    bias_a = [random.gauss(0, ACCEL_BIAS * 1e-3 * G0) for _ in range(3)]
    white_g = math.radians(GYRO_WHITE) / 60 * math.sqrt(RATE)
    white_a = ACCEL_WHITE * 1e-6 * G0 * math.sqrt(RATE)
    begin, samples = motion.t[0], round((motion.t[-1] - motion.t[0]) * RATE)
    with open(f"{out}/imu.csv", "w") as imu, open(f"{out}/truth.nav", "w") as truth:
        imu.write("time_s,gyro_x_radps,gyro_y_radps,gyro_z_radps,accel_x_mps2,accel_y_mps2,accel_z_mps2\n")
        force = specific_force(motion, begin)
        r, _, _, yaw = motion.at(begin)
        attitude = to_inertial(body_to_ecef(r, yaw), 0.0)
        for k in range(samples):
            t0, t1 = begin + k / RATE, begin + (k + 1) / RATE
            r, v, _, yaw = motion.at(t1)
            c_b_e = body_to_ecef(r, yaw)
            end = to_inertial(c_b_e, t1 - begin)
            turned = [x * RATE for x in rotvec(matmul(list(zip(*attitude)), end))]
            middle, last = specific_force(motion, (t0 + t1) / 2), specific_force(motion, t1)
            mean = [(force[i] + 4 * middle[i] + last[i]) / 6 for i in range(3)]
            values = [turned[i] + bias_g[i] + random.gauss(0, white_g) for i in range(3)]
            values += [mean[i] + bias_a[i] + random.gauss(0, white_a) for i in range(3)]
            imu.write(f"{t1:.6f}," + ",".join(f"{x:.12f}" for x in values) + "\n")
            attitude, force = end, last
            if k % 10 == 9:
                lat, lon, height = geodetic(r)
                sl, cl, so, co = math.sin(lat), math.cos(lat), math.sin(lon), math.cos(lon)
                north = -sl * co * v[0] - sl * so * v[1] + cl * v[2]
                east, down = -so * v[0] + co * v[1], -cl * co * v[0] - cl * so * v[1] - sl * v[2]
                truth.write(f"{WEEK} {t1:.6f} {math.degrees(lat):.11f} {math.degrees(lon):.11f} {height:.5f} {north:.6f} "
                            f"{east:.6f} {down:.6f} 0.0 0.0 {math.degrees(yaw) % 360:.9f}\n")
    with open(f"{out}/error_model.yaml", "w") as model:
        model.write(f"""schema: coast.imu_error_model/1
sensor: tactical grade
rate_hz: {RATE}
gyro:
  all:
    - {{process: white_noise, density: {GYRO_WHITE}, unit: deg/sqrt(h)}}
    - {{process: random_constant, sigma: {GYRO_BIAS}, unit: deg/h}}
accel:
  all:
    - {{process: white_noise, density: {ACCEL_WHITE}, unit: ug/sqrt(Hz)}}
    - {{process: random_constant, sigma: {ACCEL_BIAS}, unit: mg}}
""")


if __name__ == "__main__":
    main()

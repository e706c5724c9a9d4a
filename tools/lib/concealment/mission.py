"""One mission: motion, sensors with their noise, GNSS, one concealed effect; written as files that `coast` reads."""

import math
import random
import os

from . import earth
from .effects import NAMES, label
from .motion import Motion, Roughness

# Gyro and accelerometer noise by grade: deg/sqrt(h), turn-on deg/h, ug/sqrt(Hz), turn-on mg.
GRADES = {"tactical": (0.08, 3.0, 40.0, 1.0), "industrial": (0.2, 40.0, 80.0, 3.0), "consumer": (0.6, 300.0, 200.0, 10.0)}
RATE_HZ, GNSS_HZ, STATIC_S = 100.0, 2.0, 30.0
GNSS_SD, VELOCITY_SD = (0.01, 0.01, 0.02), (0.03, 0.03, 0.05)
LEVER_ARM = (0.4, -0.25, -0.9)
START_SOW, WEEK = 208800.0, 2374


class Case:
    """What is drawn by chance of a mission, but for its noise."""

    def __init__(self, seed, duration):
        draw = random.Random(f"mission {seed}")
        self.seed, self.duration = seed, duration
        self.kind = draw.choice(["car", "drone", "aircraft"])
        self.grade = draw.choice(sorted(GRADES))
        self.place = (math.radians(draw.uniform(-65.0, 65.0)), math.radians(draw.uniform(-180.0, 180.0)), draw.uniform(0.0, 900.0))
        self.motion = Motion(self.kind, duration, STATIC_S, draw)

    def roughen(self, kinds):
        """No use of velocities then: the turn rate at a fix, and with it the antenna's velocity, is between two samples'."""
        self.motion.roughness = Roughness(kinds, self.duration, random.Random(f"rough {self.seed}"))


class Noise:
    """White noise of an IMU's grade: densities, and what they are of a sample."""

    def __init__(self, grade):
        arw, _, vrw, _ = GRADES[grade]
        self.gyro, self.accel = math.radians(arw) / 60.0, vrw * 9.80665e-6
        self.gyro_sample, self.accel_sample = self.gyro * math.sqrt(RATE_HZ), self.accel * math.sqrt(RATE_HZ)


class Sample:
    pass


class Truth:
    """The error-free mission at twice the IMU's rate."""

    def __init__(self, case):
        self.case = case
        h = 0.5 / RATE_HZ
        self.times = [k * h for k in range(int(case.duration / h) + 1)]
        latitude, longitude, height = case.place
        self.plane = earth.ned_to_ecef(latitude, longitude)
        origin = earth.ecef(latitude, longitude, height)
        earth_plane = earth.transposed_times(self.plane, [0.0, 0.0, earth.RATE])
        self.states = []  # time, position and velocity in the plane, attitude, rate, force, acceleration in the plane
        p, before = [0.0, 0.0, 0.0], None
        middle = None
        for t, (v, yaw, pitch, roll) in zip(self.times, case.motion.table(self.times)):
            sy, cy, sp, cp = math.sin(yaw[0]), math.cos(yaw[0]), math.sin(pitch[0]), math.cos(pitch[0])
            u = [cy * cp, sy * cp, -sp]
            du = [-sy * cp * yaw[1] - cy * sp * pitch[1], cy * cp * yaw[1] - sy * sp * pitch[1], -cp * pitch[1]]
            velocity = [v[0] * c for c in u]
            a = [v[1] * c + v[0] * d for c, d in zip(u, du)]
            # Position every second instant by Simpson; the instants between are used by rates and forces alone.
            if before is None:
                before = velocity
            elif middle is None:
                middle = velocity
            else:
                p = [q + h / 3.0 * (x + 4.0 * y + z) for q, x, y, z in zip(p, before, middle, velocity)]
                before, middle = velocity, None
            at = p if middle is None else [q + h * x for q, x in zip(p, before)]
            C = earth.body_to_plane(yaw[0], pitch[0], roll[0])
            sr, cr = math.sin(roll[0]), math.cos(roll[0])
            rate = [roll[1] - yaw[1] * sp, pitch[1] * cr + yaw[1] * cp * sr, -pitch[1] * sr + yaw[1] * cp * cr]
            w = [x + y for x, y in zip(rate, earth.transposed_times(C, earth_plane))]
            r = [x + y for x, y in zip(origin, earth.times(self.plane, at))]
            lat, lon, hgt = earth.geodetic(r)
            g = earth.gravity(lat, hgt)
            down = [-math.cos(lat) * math.cos(lon), -math.cos(lat) * math.sin(lon), -math.sin(lat)]
            g_plane = [g * c for c in earth.transposed_times(self.plane, down)]
            coriolis = earth.cross(earth_plane, velocity)
            f = earth.transposed_times(C, [x + 2.0 * y - z for x, y, z in zip(a, coriolis, g_plane)])
            self.states.append((t, at, velocity, C, w, f, a, rate))
        self.origin = origin
        self.earth_plane = earth_plane


def simpson(a, b, c):
    return [(x + 4.0 * y + z) / 6.0 for x, y, z in zip(a, b, c)]


def imu_rows(truth, case, concealed, realisation=0):
    """time, measured rates, forces, temperature  @param realisation  of what is random in the effects"""
    _, gyro_bias, _, accel_bias = GRADES[case.grade]
    draw = random.Random(f"imu {case.seed}")
    sd_w, sd_f = Noise(case.grade).gyro_sample, Noise(case.grade).accel_sample
    bias_w = [draw.gauss(0.0, math.radians(gyro_bias) / 3600.0) for _ in NAMES]
    bias_f = [draw.gauss(0.0, accel_bias * 9.80665e-3) for _ in NAMES]
    s = Sample()
    s.dt, s.draw = 1.0 / RATE_HZ, random.Random(f"effect on imu {case.seed}" + (f" {realisation}" if realisation else ""))
    chosen = random.Random(f"times {case.seed}")
    s.frequency, s.correlation_time = math.exp(chosen.uniform(math.log(0.02), math.log(0.5))), chosen.choice((10.0, 30.0, 100.0))
    n = (len(truth.states) - 1) // 2
    warm = random.Random(f"temperature {case.seed}").uniform(4.0, 12.0)
    rough = case.motion.roughness
    roughness = [share for share, _ in rough.share.table([state[0] for state in truth.states[1::2]])] if rough else None
    for k in range(n):
        a, b, c = truth.states[2 * k], truth.states[2 * k + 1], truth.states[2 * k + 2]
        s.t = c[0]
        s.w, s.f = simpson(a[4], b[4], c[4]), simpson(a[5], b[5], c[5])
        s.alpha = [(y - x) * RATE_HZ for x, y in zip(a[4], c[4])]
        s.plane_axes = b[3]
        s.earth_rate = earth.transposed_times(b[3], truth.earth_plane)
        if rough:
            shaking = rough.shaking(b[0], roughness[k])
            s.vibration_variance = [(rough.shakes * roughness[k]) ** 2] * 3
            s.f = [x + y for x, y in zip(s.f, shaking)]
            s.relative_rate = simpson(a[7], b[7], c[7])
            s.turned = earth.rotation_vector(a[3], c[3])
        s.speed = math.sqrt(sum(v * v for v in b[2]))
        s.acceleration_b = earth.transposed_times(b[3], b[6])
        s.temperature = warm * (1.0 - math.exp(-s.t / 200.0)) + 2.0 * math.sin(s.t / 90.0)
        s.temperature_rate = warm / 200.0 * math.exp(-s.t / 200.0) + 2.0 / 90.0 * math.cos(s.t / 90.0)
        s.out_w, s.out_f = list(s.w), list(s.f)
        for effect, axis, size, onset in concealed:
            if effect.sample and s.t > onset:
                effect.sample(s, axis, size)
        for i in range(3):
            s.out_w[i] += bias_w[i] + draw.gauss(0.0, sd_w)
            s.out_f[i] += bias_f[i] + draw.gauss(0.0, sd_f)
        for effect, axis, size, onset in concealed:
            if effect.last and s.t > onset:
                effect.last(s, axis, size)
        yield START_SOW + s.t, s.out_w, s.out_f, 25.0 + s.temperature


class Fix:
    pass


def antenna_at(truth, index, lever_arm):
    """Position and velocity in the plane at half a sample's steps since the start."""
    index = min(max(0.0, index), len(truth.states) - 1.001)
    i = int(index) & ~1
    state = truth.states[i]
    dt = (index - i) * 0.5 / RATE_HZ
    velocity = [v + dt * a for v, a in zip(state[2], state[6])]
    p = [q + dt * (v + 0.5 * dt * a) for q, v, a in zip(state[1], state[2], state[6])]
    near, behind, share = truth.states[int(index)], truth.states[int(index) + 1], index - int(index)
    moved = earth.cross([(1.0 - share) * x + share * y for x, y in zip(near[7], behind[7])], lever_arm)
    arm = [x + share * 0.5 / RATE_HZ * y for x, y in zip(lever_arm, moved)]
    return ([x + y for x, y in zip(p, earth.times(near[3], arm))],
            [x + y for x, y in zip(velocity, earth.times(near[3], moved))])


def fix_rows(truth, case, concealed, realisation=0):
    """tag, latitude, longitude, height, velocity in the plane of the antenna"""
    draw = random.Random(f"gnss {case.seed}")
    step = 2.0 * RATE_HZ
    fix = Fix()
    fix.dt, fix.sd, fix.draw = 1.0 / GNSS_HZ, GNSS_SD, random.Random(f"effect on gnss {case.seed}" + (f" {realisation}" if realisation else ""))
    fix.wandering = [fix.draw.gauss(0.0, 1.0) for _ in NAMES]
    for k in range(int(case.duration * GNSS_HZ) - 1):
        fix.elapsed = (k + 0.37) / GNSS_HZ
        fix.valid_at, fix.lever_arm, fix.ned, fix.clock_rate, fix.apart = fix.elapsed, list(LEVER_ARM), [0.0, 0.0, 0.0], 1.0, 0.0
        state = truth.states[min(len(truth.states) - 1, round(fix.elapsed * step))]
        fix.heading = math.atan2(state[3][1][0], state[3][0][0])
        fix.acceleration_b = earth.transposed_times(state[3], state[6])
        for effect, axis, size, onset in concealed:
            if effect.fix and fix.elapsed > onset:
                effect.fix(fix, axis, size)
        p, velocity = antenna_at(truth, fix.valid_at * step, fix.lever_arm)
        if fix.apart:
            before, _ = antenna_at(truth, (fix.valid_at - fix.apart) * step, fix.lever_arm)
            behind, _ = antenna_at(truth, (fix.valid_at + fix.apart) * step, fix.lever_arm)
            p = [0.5 * (x + y) for x, y in zip(before, behind)]
        r = [x + y for x, y in zip(truth.origin, earth.times(truth.plane, p))]
        lat, lon, _ = earth.geodetic(r)
        local = earth.ned_to_ecef(lat, lon)
        noise = [e + draw.gauss(0.0, sd) for e, sd in zip(fix.ned, GNSS_SD)]
        r = [x + y for x, y in zip(r, earth.times(local, noise))]
        v_n = [fix.clock_rate * v for v in earth.transposed_times(local, earth.times(truth.plane, velocity))]
        yield START_SOW + fix.elapsed, earth.geodetic(r), [v + draw.gauss(0.0, sd) for v, sd in zip(v_n, VELOCITY_SD)]


def write(folder, case, truth, concealed, realisation=0):
    os.makedirs(folder, exist_ok=True)
    with open(f"{folder}/imu.csv", "w", encoding="ascii") as file:
        file.write("time_s,gyro_x_radps,gyro_y_radps,gyro_z_radps,accel_x_mps2,accel_y_mps2,accel_z_mps2,temperature_degC\n")
        for t, w, f, temperature in imu_rows(truth, case, concealed, realisation):
            file.write("%.6f,%.12f,%.12f,%.12f,%.10f,%.10f,%.10f,%.3f\n" % (t, *w, *f, temperature))
    with open(f"{folder}/gnss.csv", "w", encoding="ascii") as file:
        file.write("time_s,lat_deg,lon_deg,height_m,sdn_m,sde_m,sdd_m,vn_mps,ve_mps,vd_mps,sdvn_mps,sdve_mps,sdvd_mps\n")
        for t, (lat, lon, height), v in fix_rows(truth, case, concealed, realisation):
            file.write("%.6f,%.11f,%.11f,%.5f,%g,%g,%g,%.6f,%.6f,%.6f,%g,%g,%g\n"
                       % (t, math.degrees(lat), math.degrees(lon), height, *GNSS_SD, *v, *VELOCITY_SD))
    arw, gyro_bias, vrw, accel_bias = GRADES[case.grade]
    with open(f"{folder}/error_model.yaml", "w", encoding="ascii") as file:
        file.write(f"""schema: coast.imu_error_model/1
sensor: {case.grade}
rate_hz: {RATE_HZ:g}
gyro:
  all: [{{process: white_noise, density: {arw}, unit: deg/sqrt(h)}}, {{process: random_constant, sigma: {gyro_bias}, unit: deg/h}}]
accel:
  all: [{{process: white_noise, density: {vrw}, unit: ug/sqrt(Hz)}}, {{process: random_constant, sigma: {accel_bias}, unit: mg}}]
""")
    with open(f"{folder}/run.yaml", "w", encoding="ascii") as file:
        file.write(f"""schema: coast.run/1
imu: {{file: imu.csv, format: csv, gps_week: {WEEK}, error_model: error_model.yaml, lever_arm_m: [{LEVER_ARM[0]}, {LEVER_ARM[1]}, {LEVER_ARM[2]}]}}
gnss: {{file: gnss.csv, format: csv, gps_week: {WEEK}, time_offset_s: 0{", use_velocity: false" if case.motion.roughness else ""}}}
""")


def describe(case, concealed):
    return {"seed": case.seed, "kind": case.kind, "grade": case.grade, "duration_s": case.duration,
            "effects": [{"name": e.name, "sensor": e.sensor, "axis": label(a) if e.name not in ("gnss_wrong_fix", "gravity_disturbance")
                         else "ned"[a], "value": e.parameter(size), "unit": e.unit, "t_start_s": START_SOW + onset if e.onset else None,
                         "relation": e.relation}
                        for e, a, size, onset in concealed]}

"""Effects that a recording may have, as physics puts them into a sensor: sample by sample, one function each.

A function takes the true signals of a sample and adds to what is measured: `s.w`, `s.f` (rad/s, m/s^2, true means over the sample),
`s.t` (s since the start), `s.alpha` (rad/s^2), `s.temperature` (degC), `s.out_w`, `s.out_f` (what is measured, changed in place).
Axes are 0, 1, 2; a pair is (response, cause).
"""

import math

X, Y, Z = 0, 1, 2
NAMES = "xyz"


class Effect:
    """`probe`: a size that is small, for sensitivities; an effect without one has a `typical` size for an IMU (its grade's noise), where
    a search begins.
    `last`: acts when the noise is in. `relation`: for effects without a name. `rough`: the vibration that it needs,
    shaking or nodding. `positive`: has no other sign. `parameter`: of a size, what the tables of docs/effects.md tell, where that is
    another number."""

    def __init__(self, name, sensor, axes, unit, probe=None, sample=None, fix=None, onset=False, typical=None, last=None, relation=None,
                 rough=None, positive=False, parameter=lambda size: size):
        self.name, self.sensor, self.axes, self.unit, self.probe = name, sensor, axes, unit, probe
        self.sample, self.fix, self.onset = sample, fix, onset
        self.typical, self.last, self.relation = typical, last, relation
        self.rough, self.positive, self.parameter = rough, positive, parameter


def label(axis):
    if axis is None:
        return ""
    if isinstance(axis, str):
        return axis
    return NAMES[axis] if isinstance(axis, int) else NAMES[axis[0]] + NAMES[axis[1]]


SINGLE = [X, Y, Z]
ALL = [(i, j) for i in SINGLE for j in SINGLE]
OFF = [(i, j) for i, j in ALL if i != j]


def gyro_scale(s, axis, c):
    s.out_w[axis] += c * s.w[axis]


def accel_scale(s, axis, c):
    s.out_f[axis] += c * s.f[axis]


def gyro_misalignment(s, axis, c):
    s.out_w[axis[0]] += c * s.w[axis[1]]


def accel_misalignment(s, axis, c):
    s.out_f[axis[0]] += c * s.f[axis[1]]


def g_sensitivity(s, axis, c):
    s.out_w[axis[0]] += c * s.f[axis[1]]


def g2_sensitivity(s, axis, c):
    s.out_w[axis[0]] += c * s.f[axis[1]] ** 2


def quadratic(s, axis, c):
    s.out_f[axis] += c * s.f[axis] ** 2


def asymmetric(s, axis, c):
    s.out_f[axis] += c * abs(s.f[axis])


def gyro_temperature(s, axis, c):
    s.out_w[axis] += c * s.temperature


def accel_temperature(s, axis, c):
    s.out_f[axis] += c * s.temperature


def gyro_warming(s, axis, c):
    s.out_w[axis] += c * s.temperature_rate


def accel_warming(s, axis, c):
    s.out_f[axis] += c * s.temperature_rate


def rectification(s, axis, c):
    s.out_f[axis] += c * s.vibration_variance[axis]


def mount_turns(s, axis, c):
    """The sensors' axes turn by c about one of them: what is measured turns back."""
    i, j = (axis + 1) % 3, (axis + 2) % 3
    for measured, true in ((s.out_w, s.w), (s.out_f, s.f)):
        measured[i] += math.cos(c) * true[i] + math.sin(c) * true[j] - true[i]
        measured[j] += math.cos(c) * true[j] - math.sin(c) * true[i] - true[j]


def earth_is_taken_out(s, axis, c):
    for i in SINGLE:
        s.out_w[i] -= c * s.earth_rate[i]


def rotations_commute(s, axis, c):
    """The angle that a sample turned by is more than the integral of its rates: that is what is missing."""
    for i in SINGLE:
        s.out_w[i] -= c * (s.turned[i] / s.dt - s.relative_rate[i])


def gyro_bias(s, axis, c):
    s.out_w[axis] += c


def accel_bias(s, axis, c):
    s.out_f[axis] += c


def gyro_ramp(s, axis, c):
    s.out_w[axis] += c * s.t


def accel_ramp(s, axis, c):
    s.out_f[axis] += c * s.t


def size(s, axis, c):
    r = [0.0, 0.0, 0.0]
    r[axis[1]] = c
    w, a = s.w, s.alpha
    v = [w[1] * r[2] - w[2] * r[1], w[2] * r[0] - w[0] * r[2], w[0] * r[1] - w[1] * r[0]]
    moved = [a[1] * r[2] - a[2] * r[1] + w[1] * v[2] - w[2] * v[1], a[2] * r[0] - a[0] * r[2] + w[2] * v[0] - w[0] * v[2],
             a[0] * r[1] - a[1] * r[0] + w[0] * v[1] - w[1] * v[0]]
    s.out_f[axis[0]] += moved[axis[0]]


def antenna_moves(fix, axis, c):
    fix.lever_arm[axis] += c


def wrong_fix(fix, axis, c):
    fix.ned[axis] += c


def time_shift(fix, axis, c):
    fix.valid_at -= c


def clock_runs(fix, axis, c):
    """The IMU's tags grow by 1 + c for every second. The motion is that of the tags' time, so fixes come later in it and faster."""
    fix.valid_at += c * fix.elapsed
    fix.clock_rate += c


def smoothed(fix, axis, c):
    """The mean of the places d before and behind is r + d^2 a / 2."""
    fix.apart = math.sqrt(2.0 * c)


def phase_centre(fix, axis, c):
    fix.ned[Z] += c * (math.cos(fix.heading) if axis == "cos" else math.sin(fix.heading))


def flexure(fix, axis, c):
    fix.lever_arm[axis] -= c * fix.acceleration_b[axis]


def clock_sample(s, axis, c):
    """In true seconds the same way has 1 + 2 c of the acceleration, and increments stand over intervals too long by c:
    (a (1 + 2 c) - g) (1 - c) = f + c (a + g), with g = a - f."""
    for i in SINGLE:
        s.out_f[i] += c * (2.0 * s.acceleration_b[i] - s.f[i])


def deflection(s, axis, c):  # gravity is larger by c along an axis of the plane: less is felt of its reaction
    for i in SINGLE:
        s.out_f[i] -= c * s.plane_axes[axis][i]


def oscillation(s, axis, c):
    s.out_w[axis] += c * math.sin(2.0 * math.pi * s.frequency * s.t)


def accel_oscillation(s, axis, c):
    s.out_f[axis] += c * math.sin(2.0 * math.pi * s.frequency * s.t)


# What no catalogue has.
def gyro_hears_speed(s, axis, c):
    s.out_w[axis] += c * s.speed


def gyro_hears_turning_force(s, axis, c):
    s.out_w[axis] += c * s.w[Z] * s.f[X]


def accel_hears_speed_squared(s, axis, c):
    s.out_f[axis] += c * s.speed * s.speed


def gyro_scale_grows_with_temperature(s, axis, c):
    s.out_w[axis] += c * s.w[axis] * s.temperature


class Wandering:
    """A Gauss-Markov process of unit variance for each of some correlation times, added up; starts anew with every recording."""

    def __init__(self, gyro, times):
        self.gyro, self.times = gyro, times

    def __call__(self, s, axis, c):
        times = self.times or (s.correlation_time,)
        if s.t < 1.5 * s.dt:
            s.wandering = [s.draw.gauss(0.0, 1.0) for _ in times]
        for i, time in enumerate(times):
            phi = math.exp(-s.dt / time)
            s.wandering[i] = phi * s.wandering[i] + math.sqrt(1.0 - phi * phi) * s.draw.gauss(0.0, 1.0)
        (s.out_w if self.gyro else s.out_f)[axis] += c * sum(s.wandering)


OCTAVES = tuple(2.0 ** k for k in range(0, 11))


def gyro_noise_of_turning(s, axis, c):
    s.out_w[axis] += c * math.sqrt((s.w[X] ** 2 + s.w[Y] ** 2 + s.w[Z] ** 2) / s.dt) * s.draw.gauss(0.0, 1.0)


def gyro_clips(s, axis, c):
    s.out_w[axis] = max(-c, min(c, s.out_w[axis]))


def gyro_rounds(s, axis, c):
    s.out_w[axis] = c * round(s.out_w[axis] / c)


def accel_rounds(s, axis, c):
    s.out_f[axis] = c * round(s.out_f[axis] / c)


def fix_noise(fix, axis, c):
    for i in SINGLE:
        fix.ned[i] += math.sqrt((1.0 + c) ** 2 - 1.0) * fix.sd[i] * fix.draw.gauss(0.0, 1.0)


def fix_wanders(fix, axis, c):
    phi = math.exp(-fix.dt / 30.0)
    for i in SINGLE:
        fix.wandering[i] = phi * fix.wandering[i] + math.sqrt(1.0 - phi * phi) * fix.draw.gauss(0.0, 1.0)
        fix.ned[i] += c * (2.0 if i == Z else 1.0) * fix.wandering[i]


EFFECTS = [
    Effect("lever_arm_error", "antenna", SINGLE, "m", 0.01, fix=antenna_moves),
    Effect("gnss_time_offset", "clock", [None], "s", 1e-3, fix=time_shift),
    Effect("gyro_scale_factor", "gyro", SINGLE, "1", 1e-4, sample=gyro_scale),
    Effect("accel_scale_factor", "accel", SINGLE, "1", 1e-4, sample=accel_scale),
    Effect("gyro_misalignment", "gyro", OFF, "rad", 1e-4, sample=gyro_misalignment),
    Effect("accel_misalignment", "accel", OFF, "rad", 1e-4, sample=accel_misalignment),
    Effect("gyro_g_sensitivity", "gyro", ALL, "rad/s/(m/s^2)", 1e-6, sample=g_sensitivity),
    Effect("gyro_g2_sensitivity", "gyro", ALL, "rad/s/(m/s^2)^2", 1e-7, sample=g2_sensitivity),
    Effect("accel_nonlinearity_quadratic", "accel", SINGLE, "1/(m/s^2)", 1e-5, sample=quadratic),
    Effect("accel_sign_asymmetric_scale", "accel", SINGLE, "1", 1e-4, sample=asymmetric),
    Effect("accel_size_effect", "accel", ALL, "m", 1e-2, sample=size),
    Effect("gyro_temperature_bias", "gyro", SINGLE, "rad/s/K", 1e-7, sample=gyro_temperature),
    Effect("accel_temperature_bias", "accel", SINGLE, "m/s^2/K", 1e-5, sample=accel_temperature),
    Effect("temperature_rate_hysteresis", "gyro", SINGLE, "rad/s/(K/s)", 1e-5, sample=gyro_warming),
    Effect("temperature_rate_hysteresis", "accel", SINGLE, "m/s^2/(K/s)", 1e-3, sample=accel_warming),
    Effect("vibration_rectification", "accel", SINGLE, "1/(m/s^2)", 1e-4, sample=rectification, rough="shaking"),
    Effect("rate_ramp", "gyro", SINGLE, "rad/s^2", 1e-9, sample=gyro_ramp),
    Effect("rate_ramp", "accel", SINGLE, "m/s^3", 1e-7, sample=accel_ramp),
    Effect("bias_step", "gyro", SINGLE, "rad/s", 1e-5, sample=gyro_bias, onset=True),
    Effect("bias_step", "accel", SINGLE, "m/s^2", 1e-4, sample=accel_bias, onset=True),
    Effect("antenna_mount_slip", "antenna", SINGLE, "m", 0.01, fix=antenna_moves, onset=True),
    Effect("imu_timestamp_gap", "clock", [None], "s", 1e-3, fix=time_shift, onset=True),
    Effect("gnss_wrong_fix", "gnss", SINGLE, "m", 0.01, fix=wrong_fix, onset=True),
    Effect("imu_clock_drift", "clock", [None], "1", 1e-6, sample=clock_sample, fix=clock_runs),
    Effect("body_flexure", "antenna", [X, Y], "s^2", 1e-3, fix=flexure),
    Effect("gravity_disturbance", "gravity", SINGLE, "m/s^2", 1e-4, sample=deflection),
    Effect("gnss_smoothing_lag", "gnss", [None], "s^2", 1e-3, fix=smoothed, positive=True),
    Effect("antenna_phase_center_heading_dependent", "antenna", ["cos", "sin"], "m", 1e-3, fix=phase_centre),
    Effect("imu_mount_rotation", "mount", SINGLE, "rad", 1e-4, sample=mount_turns, onset=True),
    Effect("earth_rotation_omitted", "gyro", [None], "1", 0.1, sample=earth_is_taken_out),
    Effect("coning_omitted", "gyro", [None], "1", 0.1, sample=rotations_commute, rough="nodding"),
]

# Typical: the density at frequency zero is that of the white noise (gyro N, accelerometer M, of the grade), and so on.
NOISE = [
    Effect("extra_gauss_markov_bias", "gyro", SINGLE, "rad/s", sample=Wandering(True, None), typical=lambda n: n.gyro / math.sqrt(30.0)),
    Effect("extra_gauss_markov_bias", "accel", SINGLE, "m/s^2", sample=Wandering(False, None), typical=lambda n: n.accel / math.sqrt(30.0)),
    # A variance of c^2 in each octave of correlation times is a density of B^2/(2 pi f) with B^2/pi = c^2/ln 2.
    Effect("flicker_noise", "gyro", SINGLE, "rad/s", sample=Wandering(True, OCTAVES), typical=lambda n: n.gyro / math.sqrt(100.0),
           parameter=lambda c: c * math.sqrt(math.pi / math.log(2.0))),
    Effect("dynamics_dependent_noise", "gyro", SINGLE, "sqrt(s)", last=gyro_noise_of_turning, typical=lambda n: n.gyro / 0.3),
    Effect("saturation", "gyro", [Z], "rad/s", last=gyro_clips),
    Effect("quantisation", "gyro", SINGLE, "rad/s", last=gyro_rounds, typical=lambda n: n.gyro_sample),
    Effect("quantisation", "accel", SINGLE, "m/s^2", last=accel_rounds, typical=lambda n: n.accel_sample),
    Effect("gnss_sd_optimistic", "gnss", ["horizontal"], "1", fix=fix_noise, typical=lambda n: 0.1, parameter=lambda c: 1.0 + c),
    Effect("gnss_correlated_error", "gnss", ["horizontal"], "m", fix=fix_wanders, typical=lambda n: 0.003),
    Effect("harmonic_disturbance", "gyro", SINGLE, "rad/s", 1e-5, sample=oscillation),
    Effect("harmonic_disturbance", "accel", SINGLE, "m/s^2", 1e-3, sample=accel_oscillation),
]

RELATIONS = [
    Effect("unknown", "gyro", SINGLE, "rad/s/(m/s)", 1e-6, sample=gyro_hears_speed, relation="speed"),
    Effect("unknown", "gyro", SINGLE, "s/(m/s)", 1e-5, sample=gyro_hears_turning_force, relation="omega_z*f_x"),
    Effect("unknown", "accel", SINGLE, "1/m", 1e-6, sample=accel_hears_speed_squared, relation="speed*speed"),
    Effect("unknown", "gyro", SINGLE, "1/K", 1e-5, sample=gyro_scale_grows_with_temperature, relation="omega*temperature"),
]

GROUPS = {"named": EFFECTS, "noise": NOISE, "relation": RELATIONS}

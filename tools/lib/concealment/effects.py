"""Effects that a recording may have, as physics puts them into a sensor: sample by sample, one function each.

A function takes the true signals of a sample and adds to what is measured: `s.w`, `s.f` (rad/s, m/s^2, true means over the sample),
`s.t` (s since the start), `s.alpha` (rad/s^2), `s.temperature` (degC), `s.out_w`, `s.out_f` (what is measured, changed in place).
Axes are 0, 1, 2; a pair is (response, cause).
"""

X, Y, Z = 0, 1, 2
NAMES = "xyz"


class Effect:
    def __init__(self, name, sensor, axes, unit, probe, sample=None, fix=None, config=None, onset=False, temperature=False):
        self.name, self.sensor, self.axes, self.unit, self.probe = name, sensor, axes, unit, probe
        self.sample, self.fix, self.config, self.onset, self.temperature = sample, fix, config, onset, temperature


def label(axis):
    if axis is None:
        return ""
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


def quadratic(s, axis, c):
    s.out_f[axis] += c * s.f[axis] ** 2


def asymmetric(s, axis, c):
    s.out_f[axis] += c * abs(s.f[axis])


def gyro_temperature(s, axis, c):
    s.out_w[axis] += c * s.temperature


def accel_temperature(s, axis, c):
    s.out_f[axis] += c * s.temperature


def gyro_bias(s, axis, c):
    s.out_w[axis] += c


def accel_bias(s, axis, c):
    s.out_f[axis] += c


def gyro_ramp(s, axis, c):
    s.out_w[axis] += c * s.t


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


EFFECTS = [
    Effect("lever_arm_error", "antenna", SINGLE, "m", 0.01, fix=antenna_moves),
    Effect("gnss_time_offset", "clock", [None], "s", 1e-3, fix=time_shift),
    Effect("gyro_scale_factor", "gyro", SINGLE, "1", 1e-4, sample=gyro_scale),
    Effect("accel_scale_factor", "accel", SINGLE, "1", 1e-4, sample=accel_scale),
    Effect("gyro_misalignment", "gyro", OFF, "rad", 1e-4, sample=gyro_misalignment),
    Effect("accel_misalignment", "accel", OFF, "rad", 1e-4, sample=accel_misalignment),
    Effect("gyro_g_sensitivity", "gyro", ALL, "rad/s/(m/s^2)", 1e-6, sample=g_sensitivity),
    Effect("accel_nonlinearity_quadratic", "accel", SINGLE, "1/(m/s^2)", 1e-5, sample=quadratic),
    Effect("accel_sign_asymmetric_scale", "accel", SINGLE, "1", 1e-4, sample=asymmetric),
    Effect("accel_size_effect", "accel", ALL, "m", 1e-2, sample=size),
    Effect("gyro_temperature_bias", "gyro", SINGLE, "rad/s/K", 1e-7, sample=gyro_temperature, temperature=True),
    Effect("accel_temperature_bias", "accel", SINGLE, "m/s^2/K", 1e-5, sample=accel_temperature, temperature=True),
    Effect("rate_ramp", "gyro", SINGLE, "rad/s^2", 1e-9, sample=gyro_ramp),
    Effect("bias_step", "gyro", SINGLE, "rad/s", 1e-5, sample=gyro_bias, onset=True),
    Effect("bias_step", "accel", SINGLE, "m/s^2", 1e-4, sample=accel_bias, onset=True),
    Effect("antenna_mount_slip", "antenna", SINGLE, "m", 0.01, fix=antenna_moves, onset=True),
    Effect("imu_timestamp_gap", "clock", [None], "s", 1e-3, fix=time_shift, onset=True),
    Effect("gnss_wrong_fix", "gnss", SINGLE, "m", 0.01, fix=wrong_fix, onset=True),
    Effect("imu_clock_drift", "clock", [None], "1", 1e-6, sample=clock_sample, fix=clock_runs),
    Effect("body_flexure", "antenna", [X, Y], "s^2", 1e-3, fix=flexure),
    Effect("gravity_disturbance", "gravity", SINGLE, "m/s^2", 1e-4, sample=deflection),
]

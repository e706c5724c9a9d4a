"""WGS 84 and small matrices, as far as a simulated recording needs them. From the definitions; nothing of the package."""

import math

A = 6378137.0
F = 1.0 / 298.257223563
E2 = F * (2.0 - F)
RATE = 7.292115e-5
GM = 3.986004418e14


def ecef(latitude, longitude, height):
    n = A / math.sqrt(1.0 - E2 * math.sin(latitude) ** 2)
    return [
        (n + height) * math.cos(latitude) * math.cos(longitude),
        (n + height) * math.cos(latitude) * math.sin(longitude),
        (n * (1.0 - E2) + height) * math.sin(latitude),
    ]


def geodetic(r):
    """Bowring (1985); exact to a micrometre near the ground."""
    x, y, z = r
    p = math.hypot(x, y)
    b = A * (1.0 - F)
    beta = math.atan2(z * A, p * b)
    for _ in range(2):
        latitude = math.atan2(z + E2 / (1.0 - E2) * b * math.sin(beta) ** 3, p - E2 * A * math.cos(beta) ** 3)
        beta = math.atan2(b * math.sin(latitude), A * math.cos(latitude))
    n = A / math.sqrt(1.0 - E2 * math.sin(latitude) ** 2)
    height = p * math.cos(latitude) + z * math.sin(latitude) - A * A / n
    return latitude, math.atan2(y, x), height


def gravity(latitude, height):
    """Normal gravity along the normal of the ellipsoid, down: Somigliana, with height to the second order."""
    s2 = math.sin(latitude) ** 2
    g0 = 9.7803253359 * (1.0 + 0.001931852652458 * s2) / math.sqrt(1.0 - E2 * s2)
    m = RATE**2 * A * A * A * (1.0 - F) / GM
    return g0 * (1.0 - 2.0 / A * (1.0 + F + m - 2.0 * F * s2) * height + 3.0 * height * height / (A * A))


def ned_to_ecef(latitude, longitude):
    sl, cl, so, co = math.sin(latitude), math.cos(latitude), math.sin(longitude), math.cos(longitude)
    return [[-sl * co, -so, -cl * co], [-sl * so, co, -cl * so], [cl, 0.0, -sl]]


def times(m, v):
    return [m[0][0] * v[0] + m[0][1] * v[1] + m[0][2] * v[2],
            m[1][0] * v[0] + m[1][1] * v[1] + m[1][2] * v[2],
            m[2][0] * v[0] + m[2][1] * v[1] + m[2][2] * v[2]]


def transposed_times(m, v):
    return [m[0][0] * v[0] + m[1][0] * v[1] + m[2][0] * v[2],
            m[0][1] * v[0] + m[1][1] * v[1] + m[2][1] * v[2],
            m[0][2] * v[0] + m[1][2] * v[1] + m[2][2] * v[2]]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def body_to_plane(yaw, pitch, roll):
    sy, cy, sp, cp, sr, cr = (math.sin(yaw), math.cos(yaw), math.sin(pitch), math.cos(pitch), math.sin(roll), math.cos(roll))
    return [[cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr]]


def rotation_vector(a, b):
    """Of the turn from body axes a to body axes b, small, in the axes of either: both body to plane."""
    skew = [0.0, 0.0, 0.0]
    for i, j, k in ((2, 1, 0), (0, 2, 1), (1, 0, 2)):
        skew[k] = 0.5 * sum(a[m][i] * b[m][j] - a[m][j] * b[m][i] for m in range(3))
    sine = math.sqrt(sum(x * x for x in skew))
    return [x * (math.asin(sine) / sine if sine > 0.0 else 1.0) for x in skew]

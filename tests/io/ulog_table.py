"""Prints the IMU and the GNSS positions of a ULog file as tables: a reader that shares nothing with coast's.

    ulog_table.py FILE
Lines "imu boot_us gx gy gz ax ay az" of sensor_combined and "gps boot_us utc_us lat lon alt_ellipsoid eph epv vn ve vd s fix n" of
vehicle_gps_position; numbers as they stand in the file.
"""

import sys

import numpy as np

TYPES = {"int8_t": "<i1", "uint8_t": "<u1", "int16_t": "<i2", "uint16_t": "<u2", "int32_t": "<i4", "uint32_t": "<u4",
         "int64_t": "<i8", "uint64_t": "<u8", "float": "<f4", "double": "<f8", "bool": "<u1", "char": "S1"}


def main(path):
    data = open(path, "rb").read()
    formats, topics, rows = {}, {}, {}
    at = 16
    while at + 3 <= len(data):
        size, kind = int.from_bytes(data[at:at + 2], "little"), chr(data[at + 2])
        body = data[at + 3:at + 3 + size]
        at += 3 + size
        if len(body) < size:
            break
        if kind == "F":
            name, fields = body.decode().split(":")
            formats[name] = [field.split(" ") for field in fields.split(";") if field]
        elif kind == "A":
            topics[int.from_bytes(body[1:3], "little")] = (body[3:].decode(), body[0])
        elif kind == "D":
            rows.setdefault(topics[int.from_bytes(body[:2], "little")], []).append(body[2:])

    def table(topic):
        fields = []
        for kind, name in formats[topic]:
            count = 1
            if "[" in kind:
                kind, count = kind[:-1].split("[")
            fields.append((name, TYPES[kind], (int(count),)) if int(count) > 1 else (name, TYPES[kind]))
        layout = np.dtype(fields)
        # The logger leaves out padding at the end.
        return np.frombuffer(b"".join(row.ljust(layout.itemsize, b"\0")[:layout.itemsize] for row in rows[topic, 0]), layout)

    for row in table("sensor_combined"):
        print("imu", row["timestamp"], *(repr(float(v)) for v in (*row["gyro_rad"], *row["accelerometer_m_s2"])))
    for row in table("vehicle_gps_position"):
        numbers = [row[name] for name in ("lat", "lon", "alt_ellipsoid")]
        numbers += [repr(float(row[name])) for name in ("eph", "epv", "vel_n_m_s", "vel_e_m_s", "vel_d_m_s", "s_variance_m_s")]
        boot = int(row["timestamp"]) + int(row["timestamp_time_relative"])
        print("gps", boot, row["time_utc_usec"], *numbers, row["fix_type"], row["satellites_used"])


main(sys.argv[1])

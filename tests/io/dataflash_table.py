"""Prints the IMU and the GNSS positions of a DataFlash log as tables: a reader that shares nothing with coast's.

    dataflash_table.py FILE
Lines "imu boot_us gx gy gz ax ay az" of IMU of the first instance, "gps boot_us week ms status lat lon alt speed course vz" and
"gpa boot_us hacc vacc sacc und" of the first receiver.
"""

import struct
import sys

CODES = {"b": "b", "B": "B", "M": "B", "h": "h", "H": "H", "c": "h", "C": "H", "i": "i", "I": "I", "e": "i", "E": "I", "L": "i",
         "f": "f", "d": "d", "q": "q", "Q": "Q", "n": "4s", "N": "16s", "Z": "64s", "a": "64s"}
FACTORS = {"c": 0.01, "C": 0.01, "e": 0.01, "E": 0.01, "L": 1e-7}


def rows(data):
    formats, at = {0x80: (89, "FMT", None, None, None)}, 0  # kind: size, name, layout, types, names
    while True:
        at = data.find(b"\xa3\x95", at)
        if at < 0 or at + 3 > len(data):
            return
        known = formats.get(data[at + 2])
        if known is None or data[at + known[0]:at + known[0] + 2] not in (b"\xa3\x95", b"", b"\xa3") or at + known[0] > len(data):
            at += 1
            continue
        size, name, layout, types, names = known
        body = data[at + 3:at + size]
        at += size
        if name == "FMT":
            kind, length, title, types, names = struct.unpack("<BB4s16s64s", body)
            types = types.rstrip(b"\0").decode()
            names = names.rstrip(b"\0").decode().split(",")
            formats[kind] = (length, title.rstrip(b"\0").decode(), "<" + "".join(CODES.get(c, "?") for c in types), types, names)
            continue
        if struct.calcsize(layout) != len(body):
            continue  # a definition that contradicts itself
        values = struct.unpack(layout, body)
        yield name, {n: v * FACTORS[c] if c in FACTORS else v for n, c, v in zip(names, types, values)}


def main(path):
    for name, row in rows(open(path, "rb").read()):
        if row.get("I", 0) != 0:
            continue
        if name == "IMU":
            print("imu", row["TimeUS"], *(repr(row[n]) for n in ("GyrX", "GyrY", "GyrZ", "AccX", "AccY", "AccZ")))
        elif name == "GPS":
            print("gps", row["TimeUS"], row["GWk"], row["GMS"], row["Status"],
                  *(repr(row[n]) for n in ("Lat", "Lng", "Alt", "Spd", "GCrs", "VZ")))
        elif name == "GPA":
            print("gpa", row["TimeUS"], *(repr(row[n]) for n in ("HAcc", "VAcc", "SAcc")), repr(row.get("Und", 0.0)))


main(sys.argv[1])

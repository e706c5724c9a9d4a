"""Writes one recording as bags of each container, and prints it: a writer that shares nothing with coast's readers.

    bag_files.py FOLDER
Files drive.bag, drive-bz2.bag, drive.mcap, drive.db3. Lines "imu stamp_ns gx gy gz ax ay az" and "fix stamp_ns lat lon h" with nine
numbers of the covariance (east, north, up).
"""

import bz2
import random
import sqlite3
import struct
import sys
import zlib

START = 1_700_000_000_000_000_000


def recording():
    draw = random.Random(7)
    for i in range(500):
        stamp = START + i * 5_000_000 + draw.randrange(1000)
        yield "imu", stamp, [draw.uniform(-4, 4) for _ in range(3)] + [draw.uniform(-20, 20) for _ in range(3)]
        if i % 50 == 0:
            a, b, c = (draw.uniform(0.5, 2) for _ in range(3))
            covariance = [a, 0.1, 0.2, 0.1, b, -0.1, 0.2, -0.1, c]
            yield "fix", stamp + 2_000_000, [draw.uniform(-80, 80), draw.uniform(-180, 180), draw.uniform(0, 900)] + covariance


class Message:
    """Fields in the serialisation of ROS 1, or of ROS 2."""

    def __init__(self, cdr):
        self.cdr, self.data = cdr, b""

    def put(self, kind, *values):
        for value in values:
            size = struct.calcsize("<" + kind)
            if self.cdr:
                self.data += b"\0" * (-len(self.data) % size)
            self.data += struct.pack("<" + kind, value)

    def header(self, stamp, frame):
        if not self.cdr:
            self.put("I", 0)
        self.put("I", stamp // 10**9, stamp % 10**9)
        text = frame.encode() + (b"\0" if self.cdr else b"")
        self.put("I", len(text))
        self.data += text

    def bytes(self):
        return (b"\0\1\0\0" if self.cdr else b"") + self.data


def encoded(kind, stamp, values, cdr):
    m = Message(cdr)
    m.header(stamp, kind)
    if kind == "imu":
        m.put("d", 0, 0, 0, 1, -1, *[0] * 8, *values[:3], *[0] * 9, *values[3:], *[0] * 9)
    else:
        m.put("b", 0)
        m.put("H", 1)
        m.put("d", *values)
        m.put("B", 3)
    return m.bytes()


def bag(path, compression):
    def sized(data):
        return struct.pack("<I", len(data)) + data

    def record(fields, data):
        return sized(b"".join(sized(name.encode() + b"=" + value) for name, value in fields)) + sized(data)

    topics = {"imu": (0, b"/imu", b"sensor_msgs/Imu"), "fix": (1, b"/fix", b"sensor_msgs/NavSatFix")}
    content = b""
    for number, topic, kind in topics.values():
        connection = sized(b"topic=" + topic) + sized(b"type=" + kind) + sized(b"md5sum=0") + sized(b"message_definition=")
        content += record([("op", b"\7"), ("conn", struct.pack("<I", number)), ("topic", topic)], connection)
    for kind, stamp, values in recording():
        time = struct.pack("<II", stamp // 10**9, stamp % 10**9)
        fields = [("op", b"\2"), ("conn", struct.pack("<I", topics[kind][0])), ("time", time)]
        content += record(fields, encoded(kind, stamp, values, False))
    packed = bz2.compress(content) if compression == "bz2" else content
    chunk = [("op", b"\5"), ("compression", compression.encode()), ("size", struct.pack("<I", len(content)))]
    head = [("op", b"\3"), ("index_pos", struct.pack("<Q", 1)), ("conn_count", struct.pack("<I", 2))]
    with open(path, "wb") as file:
        file.write(b"#ROSBAG V2.0\n" + record(head, b" " * 4000) + record(chunk, packed))


def mcap(path):
    def text(value):
        return struct.pack("<I", len(value)) + value

    def record(op, data):
        return struct.pack("<BQ", op, len(data)) + data

    content = b""
    for number, topic, kind in ((1, b"/imu", b"sensor_msgs/msg/Imu"), (2, b"/fix", b"sensor_msgs/msg/NavSatFix")):
        content += record(3, struct.pack("<H", number) + text(kind) + text(b"ros2msg") + text(b""))
        content += record(4, struct.pack("<HH", number, number) + text(topic) + text(b"cdr") + struct.pack("<I", 0))
    for kind, stamp, values in recording():
        head = struct.pack("<HIQQ", 1 if kind == "imu" else 2, 0, stamp, stamp)
        content += record(5, head + encoded(kind, stamp, values, True))
    chunk = struct.pack("<QQQI", 0, 0, len(content), zlib.crc32(content)) + text(b"") + struct.pack("<Q", len(content)) + content
    data = b"\x89MCAP0\r\n" + record(1, text(b"ros2") + text(b"")) + record(6, chunk)
    with open(path, "wb") as file:
        file.write(data + record(15, struct.pack("<I", zlib.crc32(data))) + record(2, bytes(20)) + b"\x89MCAP0\r\n")


def db3(path):
    base = sqlite3.connect(path)
    base.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT, offered_qos_profiles TEXT)")
    base.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB)")
    base.execute("INSERT INTO topics VALUES(1, '/imu', 'sensor_msgs/msg/Imu', 'cdr', ''), (2, '/fix', 'sensor_msgs/msg/NavSatFix', 'cdr', '')")
    rows = [(1 if kind == "imu" else 2, stamp, encoded(kind, stamp, values, True)) for kind, stamp, values in recording()]
    base.executemany("INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)", rows)
    base.commit()
    base.close()


def main(folder):
    bag(folder + "/drive.bag", "none")
    bag(folder + "/drive-bz2.bag", "bz2")
    mcap(folder + "/drive.mcap")
    db3(folder + "/drive.db3")
    for kind, stamp, values in recording():
        print(kind, stamp, *(repr(value) for value in values))


main(sys.argv[1])

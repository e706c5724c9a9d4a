"""table.py NUMBERS.json: what `coast diagnose` tells of each recording, as it is and a little less of it, as Markdown; and how much of it is the same."""

import json
import sys

LESS = ("first minute less", "last minute less", "every second fix")


def name(key):
    """Fixes that jump are one finding, whatever the component of the largest jump."""
    parts = key.split()
    return parts[0] if parts[0] == "gnss_wrong_fix" else " ".join(p for p in parts if not p.isdigit())


def is_of_the_imu(finding):
    return any(sensor in finding.split()[1:] for sensor in ("gyro", "accel"))


def sized(finding):
    return f'{finding["value"]:.3g}' + (f' ({len(finding["times_s"])} times)' if len(finding.get("times_s", ())) > 1 else "")


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        numbers = json.load(file)
    recordings = {}
    for key, result in numbers.items():
        recording, variant = key.split("/")
        recordings.setdefault(recording, {})[variant] = {name(k): v for k, v in result["told"].items()}
    kept = told = of_less = 0
    shared_kept = shared = 0
    print("| recording | told | " + " | ".join(("as it is",) + LESS + ("other IMUs",)) + " |")
    print("| --- " * (4 + len(LESS)) + "|")
    for recording, variants in recordings.items():
        whole = variants["as it is"]
        others = [v for v in variants if v.startswith("IMU")]
        for finding in sorted({f for v in variants.values() for f in v}):
            cells = [sized(variants[v][finding]) if finding in variants.get(v, {}) else ("" if v in variants else "-") for v in ("as it is",) + LESS]
            count = sum(finding in variants[v] for v in others)
            cells.append(f"{count} of {len(others)}" if others else "-")
            print(f"| {recording} | {finding} | " + " | ".join(cells) + " |")
            less = [v for v in LESS if v in variants]
            told += len(less) * (finding in whole)
            kept += sum(finding in variants[v] for v in less) if finding in whole else 0
            of_less += sum(finding in variants[v] for v in less)
            if not is_of_the_imu(finding) and finding in whole:
                shared += len(others)
                shared_kept += count
    print(f"\nOf what is told of a recording as it is, {kept} of {told} times it is told of a part too; of what is told of a part, {kept} of {of_less} times it is told of the whole."
          f" What is not of the IMU is told with another IMU {shared_kept} of {shared} times.")


main()

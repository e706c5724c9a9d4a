#!/usr/bin/env python3
"""Outages of 30 s, loosely and tightly coupled, with so many satellites left: numbers.json, and a table for people in table.md.

outages.py COAST OUT
"""

import json
import math
import pathlib
import statistics
import subprocess
import sys

CASES = [("loose", 0), ("tight", 0), ("tight", 1), ("tight", 2), ("tight", 3)]
MISSIONS = {"spirent": ("run.yaml", 30), "car": ("run-rinex.yaml", 60)}


def configured(text, coupling, satellites, every):
    text = text.split("\noutages:")[0].rstrip() + "\n"
    text = text.replace("gnss:\n", f"gnss:\n  coupling: {coupling}\n").replace("gnss: {", f"gnss: {{coupling: {coupling}, ")
    return text + f"outages: {{every_s: {every}, first_s: 120, durations_s: [30], satellites: {satellites}}}\n"


def drifts(outages, kind):
    horizontal = [math.hypot(*o[kind]["max_m"][:2]) for o in outages]
    ratios = [(e / s) ** 2 for o in outages for e, s in zip(o[kind]["end_m"], o[kind]["sigma_end_m"])]
    return {"median_m": statistics.median(horizontal), "largest_m": max(horizontal),
            "error_over_sigma": math.sqrt(statistics.fmean(ratios))}


def main():
    coast, out = sys.argv[1], pathlib.Path(sys.argv[2])
    numbers, table = {}, []
    for mission, (run, every) in MISSIONS.items():
        text = (out / mission / run).read_text()
        for coupling, satellites in CASES:
            name = f"{coupling}-{satellites}"
            file = out / mission / f"{name}.yaml"
            file.write_text(configured(text, coupling, satellites, every))
            subprocess.run([coast, "process", file, "--out", out / mission / name, "--quiet"], check=True)
            summary = json.loads((out / mission / name / "summary.json").read_text())
            outages = summary["outages"]
            result = {kind: drifts(outages, kind) for kind in ("forward", "smoothed")}
            position = summary["reference"]["smoothed"]["position_rms_m"]
            result["without_outage_rms_m"] = math.sqrt(sum(x * x for x in position))
            numbers.setdefault(mission, {})[name] = result
            forward, smoothed = result["forward"], result["smoothed"]
            table.append(f"| {mission} ({len(outages)}) | {coupling} | {satellites} | {forward['median_m']:.3f} | "
                         f"{forward['largest_m']:.2f} | {forward['error_over_sigma']:.2f} | {smoothed['median_m']:.3f} | "
                         f"{smoothed['largest_m']:.2f} | {smoothed['error_over_sigma']:.2f} | "
                         f"{1e3 * result['without_outage_rms_m']:.1f} |")
    (out / "numbers.json").write_text(json.dumps(numbers, indent=2) + "\n")
    (out / "table.md").write_text("\n".join(table) + "\n")


if __name__ == "__main__":
    main()

"""`coast diagnose` on one core without twins, and what it tells."""

import json
import os
import subprocess


def diagnosis(coast, folder, text):
    """diagnosis.json of the run file text(folder); one that is there already is not made again."""
    kept = f"{folder}/diagnosis/diagnosis.json"
    if not os.path.exists(kept):
        os.makedirs(folder, exist_ok=True)
        with open(f"{folder}/run.yaml", "w") as file:
            file.write(text(folder))
        subprocess.run([coast, "diagnose", f"{folder}/run.yaml", "--out", f"{folder}/diagnosis", "--twins", "0", "--threads", "1", "--quiet"], check=True)
    with open(kept) as file:
        return json.load(file)


def effects(d, more):
    """By name, sensor and axis or relation, numbered where there are several: size, sigma, gain and more(effect)."""
    found = {}
    for e in d["effects"]:
        key = f'{e["name"]} {e["sensor"]} {e.get("relation", e["axis"])}'.strip()
        key += f' {sum(k.startswith(key) for k in found) + 1}' if key in found else ""
        size = e["parameters"][0]
        found[key] = {"value": size["value"], "std": size.get("std", 0.0), "gain": e["delta_log_likelihood"], **more(e)}
    return found

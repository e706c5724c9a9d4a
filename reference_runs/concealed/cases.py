"""cases.py COAST CONCEAL OUT [SHARD OF]: conceals, diagnoses, and keeps key and result of every case.

Of the seeds to 299 every fourth is a clean mission, the others have one effect with a name. Then: 325 more clean missions; noise, converters
and oscillations; relations outside the catalogue; pairs. A case that is there already is not made again, so an interrupted run goes on;
shards share the cases out.
"""

import json
import os
import shutil
import subprocess
import sys

STRENGTHS = (1.0, 2.0, 4.0, 10.0)


def options(seed):
    if seed >= 2200:
        return ["--effects", "2", "--strength", str((4.0, 10.0)[seed % 2])]
    if seed >= 2000:
        return ["--group", "relation" if seed >= 2100 else "noise", "--strength", str(STRENGTHS[seed % 4])]
    if seed % 4 == 0:
        return ["--clean"]
    return ["--strength", str(STRENGTHS[seed // 4 % 4])]


SEEDS = [*range(300), *range(300, 1600, 4), *range(2000, 2044), *range(2100, 2116), *range(2200, 2224)]


def one(coast, conceal, out, seed):
    kept = os.path.join(out, f"{seed}.json")
    if os.path.exists(kept):
        return
    folder = os.path.join(out, f"case-{seed}")
    shutil.rmtree(folder, ignore_errors=True)
    environment = dict(os.environ, COAST=coast)
    subprocess.run([sys.executable, conceal, "--seed", str(seed), "--out", folder, *options(seed)], check=True, env=environment)
    subprocess.run([coast, "diagnose", f"{folder}/recording/run.yaml", "--out", f"{folder}/diagnosis", "--twins", "0", "--quiet"], check=True)
    with open(f"{folder}/key.json") as key, open(f"{folder}/diagnosis/diagnosis.json") as diagnosis:
        case = {"key": json.load(key), "diagnosis": json.load(diagnosis)}
    with open(kept + ".part", "w") as file:
        json.dump(case, file)
    os.rename(kept + ".part", kept)
    shutil.rmtree(folder)


def main():
    coast, conceal, out = sys.argv[1:4]
    shard, of = (int(a) for a in sys.argv[4:6]) if len(sys.argv) > 5 else (0, 1)
    os.makedirs(out, exist_ok=True)
    for i, seed in enumerate(SEEDS):
        if i % of == shard:
            one(coast, conceal, out, seed)
            print(f"{seed}: {i + 1} of {len(SEEDS)}", flush=True)


main()

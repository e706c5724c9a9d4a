"""cases.py COAST CONCEAL OUT FIRST LAST [SHARD OF]: conceals, diagnoses and keeps key and result of cases FIRST to LAST.

A quarter of the cases is clean, the others have one effect at 1, 2, 4 or 10 times the smallest detectable size of their mission. A case
that is there already is not made again, so an interrupted run goes on; shards share the cases out.
"""

import json
import os
import shutil
import subprocess
import sys

STRENGTHS = (1.0, 2.0, 4.0, 10.0)


def options(seed):
    if seed % 4 == 0:
        return ["--clean"]
    return ["--strength", str(STRENGTHS[seed // 4 % 4])]


def one(coast, conceal, out, seed):
    kept = os.path.join(out, f"{seed}.json")
    if os.path.exists(kept):
        return
    folder = os.path.join(out, f"case-{seed}")
    shutil.rmtree(folder, ignore_errors=True)
    environment = dict(os.environ, COAST=coast)
    subprocess.run([sys.executable, conceal, "--seed", str(seed), "--out", folder, *options(seed)], check=True, env=environment)
    subprocess.run([coast, "diagnose", f"{folder}/recording/run.yaml", "--out", f"{folder}/diagnosis", "--quiet"], check=True)
    with open(f"{folder}/key.json") as key, open(f"{folder}/diagnosis/diagnosis.json") as diagnosis:
        case = {"key": json.load(key), "diagnosis": json.load(diagnosis)}
    with open(kept + ".part", "w") as file:
        json.dump(case, file)
    os.rename(kept + ".part", kept)
    shutil.rmtree(folder)


def main():
    coast, conceal, out, first, last = sys.argv[1:6]
    shard, of = (int(a) for a in sys.argv[6:8]) if len(sys.argv) > 7 else (0, 1)
    os.makedirs(out, exist_ok=True)
    for seed in range(int(first), int(last) + 1):
        if seed % of == shard:
            one(coast, conceal, out, seed)
            print(seed, flush=True)


main()

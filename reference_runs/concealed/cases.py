"""cases.py COAST CONCEAL OUT [--shard I N] [--conceal-only]: conceals, diagnoses, and keeps key and result of every case.

Of the first 300 cases every fourth is a clean mission, the others have one effect with a name. Then: 325 more clean missions; noise, converters
and oscillations; relations outside the catalogue; pairs. What is there already is not made again, so an interrupted run goes on;
shards share the cases out. Recordings can be made first, and diagnosed later.
"""

import argparse
import importlib.machinery
import importlib.util
import json
import os
import shutil
import subprocess

STRENGTHS = (1.0, 2.0, 4.0, 10.0)
FIRST_SEED = 10000  # of missions that no version of the search was developed with
CASES = [*range(300), *range(300, 1600, 4), *range(2000, 2044), *range(2100, 2116), *range(2200, 2224)]


def options(case):
    if case >= 2200:
        return ["--effects", "2", "--strength", str((4.0, 10.0)[case % 2])]
    if case >= 2000:
        return ["--group", "relation" if case >= 2100 else "noise", "--strength", str(STRENGTHS[case % 4])]
    if case % 4 == 0:
        return ["--clean"]
    return ["--strength", str(STRENGTHS[case // 4 % 4])]


def program(path):
    """Of a script without an ending: one interpreter makes many recordings."""
    loader = importlib.machinery.SourceFileLoader("conceal", path)
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("conceal", loader))
    loader.exec_module(module)
    return module


def diagnose(coast, folder, kept):
    subprocess.run([coast, "diagnose", f"{folder}/recording/run.yaml", "--out", f"{folder}/diagnosis", "--twins", "0", "--threads", "1", "--quiet"],
                   check=True)
    with open(f"{folder}/key.json") as key, open(f"{folder}/diagnosis/diagnosis.json") as diagnosis:
        case = {"key": json.load(key), "diagnosis": json.load(diagnosis)}
    with open(kept + ".part", "w") as file:
        json.dump(case, file)
    os.rename(kept + ".part", kept)
    shutil.rmtree(folder)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("coast")
    parser.add_argument("conceal")
    parser.add_argument("out")
    parser.add_argument("--shard", type=int, nargs=2, default=(0, 1))
    parser.add_argument("--conceal-only", action="store_true")
    args = parser.parse_args()
    os.environ["COAST"] = args.coast
    conceal = program(args.conceal)
    os.makedirs(args.out, exist_ok=True)
    for i, case in enumerate(CASES):
        folder, kept = f"{args.out}/case-{case}", f"{args.out}/{case}.json"
        if i % args.shard[1] != args.shard[0] or os.path.exists(kept):
            continue
        if not os.path.exists(f"{folder}/key.json"):  # is written last
            shutil.rmtree(folder, ignore_errors=True)
            conceal.main(["--seed", str(FIRST_SEED + case), "--out", folder, *options(case)])
        if not args.conceal_only:
            diagnose(args.coast, folder, kept)
        print(f"{case}: {i + 1} of {len(CASES)}", flush=True)


main()

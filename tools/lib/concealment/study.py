"""A study of concealed effects: cases one by one, key and diagnosis of each kept, and how often something holds of them."""

import argparse
import glob
import json
import os
import shutil
import subprocess


def arguments(*first):
    """Of a program that works through the cases; `first`: positional ones between the program's path and the folder."""
    parser = argparse.ArgumentParser()
    for name in ("coast", *first, "out"):
        parser.add_argument(name)
    parser.add_argument("--shard", type=int, nargs=2, default=(0, 1))
    parser.add_argument("--conceal-only", action="store_true")
    return parser.parse_args()


def work_through(cases, make, recording, args):
    """`make(case, folder)` writes a recording and its key, the key last; `recording`: where in the folder its run.yaml is. What is there already
    is not made again, so an interrupted run goes on; shards share the cases out."""
    os.environ["COAST"] = args.coast
    os.makedirs(args.out, exist_ok=True)
    for i, case in enumerate(cases):
        folder, kept = f"{args.out}/case-{case}", f"{args.out}/{case}.json"
        if i % args.shard[1] != args.shard[0] or os.path.exists(kept):
            continue
        if not os.path.exists(f"{folder}/key.json"):
            shutil.rmtree(folder, ignore_errors=True)
            os.makedirs(folder)
            make(case, folder)
        if not args.conceal_only:
            diagnose(args.coast, f"{folder}/{recording}run.yaml", folder, kept)
        print(f"{case}: {i + 1} of {len(cases)}", flush=True)


def diagnose(coast, run, folder, kept):
    subprocess.run([coast, "diagnose", run, "--out", f"{folder}/diagnosis", "--twins", "0", "--threads", "1", "--quiet"], check=True)
    with open(f"{folder}/key.json") as key, open(f"{folder}/diagnosis/diagnosis.json") as diagnosis:
        case = {"key": json.load(key), "diagnosis": json.load(diagnosis)}
    with open(kept + ".part", "w") as file:
        json.dump(case, file)
    os.rename(kept + ".part", kept)
    shutil.rmtree(folder)


def kept_in(folder):
    """Cases by number, in order."""
    cases = {}
    for path in sorted(glob.glob(f"{folder}/*.json"), key=lambda path: int(os.path.basename(path)[:-5])):
        with open(path) as file:
            cases[int(os.path.basename(path)[:-5])] = json.load(file)
    return cases


def share(values):
    """Of those of which it is known (not None)."""
    values = [v for v in values if v is not None]
    return {"of": len(values), "share": sum(values) / len(values)} if values else {"of": 0, "share": None}

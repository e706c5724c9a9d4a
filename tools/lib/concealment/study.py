"""A study of concealed effects: recordings case by case, diagnosed by a campaign, and how often something holds of them."""

import argparse
import csv
import json
import os
import re
import shutil


def arguments(*first):
    """Of a program that works through the cases; `first`: positional ones between the program's path and the folder."""
    parser = argparse.ArgumentParser()
    for name in ("coast", *first, "out"):
        parser.add_argument(name)
    parser.add_argument("--shard", type=int, nargs=2, default=(0, 1))
    return parser.parse_args()


def work_through(cases, make, args):
    """`make(case, folder)` writes a recording and its key, the key last. What is there already is not made again, so an interrupted run goes on;
    shards share the cases out."""
    os.environ["COAST"] = args.coast
    for i, case in enumerate(cases):
        folder = f"{args.out}/case-{case}"
        if i % args.shard[1] != args.shard[0] or os.path.exists(f"{folder}/key.json"):
            continue
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)
        make(case, folder)
        print(f"{case}: {i + 1} of {len(cases)}", flush=True)


def diagnosed(folder):
    """Key and diagnosis of the cases by number, in order: FOLDER/cases as they were made, FOLDER/campaign as it was collected."""
    cases = {}
    with open(f"{folder}/campaign/missions.csv") as missions:
        for row in csv.DictReader(missions):
            number = re.search(r"case-(\d+)", row["mission"])[1]
            with open(f"{folder}/cases/case-{number}/key.json") as key, open(f"{folder}/campaign/{row['result']}/summary.json") as diagnosis:
                cases[int(number)] = {"key": json.load(key), "diagnosis": json.load(diagnosis)}
    return dict(sorted(cases.items()))


def share(values):
    """Of those of which it is known (not None)."""
    values = [v for v in values if v is not None]
    return {"of": len(values), "share": sum(values) / len(values)} if values else {"of": 0, "share": None}

"""cases.py COAST CONCEAL OUT [--shard I N]: makes the recording and the key of every case.

Of the first 300 cases every fourth is a clean mission, the others have one effect with a name. Then: 325 more clean missions; noise, converters
and oscillations; relations outside the catalogue; pairs. What is there already is not made again, so an interrupted run goes on.
"""

import importlib.machinery
import importlib.util
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../tools/lib"))

from concealment import study  # noqa: E402

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


def main():
    args = study.arguments("conceal")
    conceal = program(args.conceal)
    study.work_through(CASES, lambda case, folder: conceal.main(["--seed", str(FIRST_SEED + case), "--out", folder, *options(case)]), args)


main()

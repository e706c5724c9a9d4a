"""The shipped configurations of real recordings, for runs that change something of them."""

import os
import re
import sys

CONFIGS = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../../configs/recordings"))


def run(name, changes=(), drop=()):
    """The text of a run.yaml that may lie anywhere, without outages, reference and output: each change is (old text, new text), `drop`
    names keys that are left out."""
    with open(f"{CONFIGS}/{name}.yaml", encoding="ascii") as file:
        text = file.read()
    text = text.replace("error_model: ../", f"error_model: {os.path.dirname(CONFIGS)}/").replace("error_model: car-", f"error_model: {CONFIGS}/car-")
    for old, new in changes:
        if old not in text:
            sys.exit(f"{name}: no '{old}'")
        text = text.replace(old, new)
    text = "\n".join(line for line in text.split("\n") if line.split(":")[0].strip() not in drop)
    return re.sub(r"\n(outages|reference|output):[^\n]*(\n  [^\n]*)*", "", text)

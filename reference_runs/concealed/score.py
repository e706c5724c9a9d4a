"""score.py FOLDER: opens the keys of all cases and says how often what was found is what was concealed; JSON on standard output."""

import glob
import json
import sys


def found_as(effect, truth):
    return effect["name"] == truth["name"] and effect["sensor"] == truth["sensor"] and effect["axis"] == truth["axis"]


def among(effect, truth):
    return found_as(effect, truth) or any(found_as(other, truth) for other in effect["confounded_with"])


def score(case):
    truth, effects = case["key"]["effects"][0], case["diagnosis"]["effects"]
    s = {"name": truth["name"], "axis": truth["axis"], "detected": bool(effects), "first": False, "named": False, "deviation": None,
         "extra": max(0, len(effects) - 1)}
    if effects:
        s["first"] = found_as(effects[0], truth)
        s["named"] = among(effects[0], truth)
        s["said"] = f'{effects[0]["name"]} {effects[0]["axis"]}'
        for e in effects:
            if found_as(e, truth):
                p = e["parameters"][0]
                s["deviation"] = (p["value"] - truth["value"]) / p["std"]
                if truth["t_start_s"] is not None:
                    s["onset_s"] = e["t_start_s"] - truth["t_start_s"]
                    s["onset_std_s"] = e.get("t_start_std_s")
                break
    return s


def share(values):
    values = list(values)
    return {"of": len(values), "share": sum(values) / len(values)} if values else {"of": 0, "share": None}


def main():
    cases = []
    for path in sorted(glob.glob(f"{sys.argv[1]}/*.json")):
        with open(path) as file:
            cases.append(json.load(file))
    clean = [c for c in cases if not c["key"]["effects"]]
    result = {"clean": {"of": len(clean), "raised": sum(bool(c["diagnosis"]["effects"]) for c in clean)}, "strengths": {}, "effects": {}}
    scored = [(c["key"]["strength"], score(c)) for c in cases if c["key"]["effects"]]
    for strength in sorted({k for k, _ in scored}):
        here = [s for k, s in scored if k == strength]
        hits = [s for s in here if s["detected"]]
        deviations = [s["deviation"] for s in hits if s["deviation"] is not None]
        onsets = [s for s in hits if s.get("onset_s") is not None]
        result["strengths"][f"{strength:g}"] = {
            "detected": share(s["detected"] for s in here), "right_name_first": share(s["first"] for s in hits),
            "right_name_among_alternatives": share(s["named"] for s in hits), "nothing_else": share(s["extra"] == 0 for s in hits),
            "inside_95": share(abs(d) < 1.96 for d in deviations), "onset_within_2_s": share(abs(s["onset_s"]) <= 2.0 for s in onsets)}
    for name in sorted({s["name"] for _, s in scored}):
        said = {}
        here = [(k, s) for k, s in scored if s["name"] == name]
        for _, s in here:
            said[s.get("said", "nothing")] = said.get(s.get("said", "nothing"), 0) + 1
        result["effects"][name] = {"of": len(here), "detected": sum(s["detected"] for _, s in here), "first": sum(s["first"] for _, s in here),
                                   "among": sum(s["named"] for _, s in here), "said": dict(sorted(said.items(), key=lambda i: -i[1]))}
    json.dump(result, sys.stdout, indent=1)
    print()


main()

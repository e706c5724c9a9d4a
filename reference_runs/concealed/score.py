"""score.py FOLDER: opens the keys of all cases and says how often what was found is what was concealed; JSON on standard output."""

import json
import math
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../tools/lib"))

from concealment.study import diagnosed, share  # noqa: E402

FALSE_ALARM = 0.05
DETECTABLE = math.sqrt(17.07)  # sigmas of the smallest detectable size: alpha 0.1 %, power 80 % (Baarda)


def same_axis(effect, truth):
    if truth["axis"] == "horizontal":
        return True  # of all axes alike
    return effect["axis"] == truth["axis"]


def power(case):
    """Probability that anything is raised: the effect exceeds the threshold in use, which heeds all effects and onsets, or chance raises
    another, as in one of twenty recordings."""
    size, threshold = DETECTABLE * case["key"]["strength"], math.sqrt(case["diagnosis"]["threshold"])
    exceeds = 0.5 * (math.erfc((threshold - size) / math.sqrt(2.0)) + math.erfc((threshold + size) / math.sqrt(2.0)))
    return exceeds + (1.0 - exceeds) * FALSE_ALARM


def expected(powers):
    """How many of so many cases are detected: the mean, and what holds with 99 %, exactly."""
    chances = [1.0]
    for p in powers:
        chances = [(1.0 - p) * none + p * one for none, one in zip(chances + [0.0], [0.0] + chances)]
    below, low, high = 0.0, None, None
    for count, chance in enumerate(chances):
        below += chance
        low = count if low is None and below > 0.005 else low
        high = count if high is None and below >= 0.995 else high
    return {"mean": sum(powers) / len(powers), "interval_99": [low / len(powers), high / len(powers)]}


def found_as(effect, truth):
    return effect["name"] == truth["name"] and effect["sensor"] == truth["sensor"] and same_axis(effect, truth)


def among(effect, truth):
    return found_as(effect, truth) or any(found_as(other, truth) for other in effect["confounded_with"])


def score(truth, effects):
    s = {"name": truth["name"], "detected": bool(effects), "first": False, "named": False, "site": False, "relation": None,
         "deviation": None, "extra": max(0, len(effects) - 1), "held_out": None}
    if not effects:
        return s
    first = effects[0]
    s["first"], s["named"] = found_as(first, truth), among(first, truth)
    # A relation has the axis that responds and no pair.
    s["site"] = first["sensor"] == truth["sensor"] and (same_axis(first, truth) or ("relation" in first and first["axis"] == truth["axis"][:1]))
    s["said"] = f'{first["name"]} {first.get("relation", first["axis"])}'
    gains = [e["held_out_gain"] for e in effects if "held_out_gain" in e]
    s["held_out"] = min(gains) > 0.0 if gains else None
    if truth.get("relation"):
        s["relation"] = first.get("relation") in (truth["relation"], truth["relation"].replace("omega*", f'omega_{truth["axis"]}*'))
    for e in sorted(effects, key=lambda e: e["axis"] != truth["axis"]):
        if found_as(e, truth):
            p = e["parameters"][0]
            if p.get("std") and e["axis"] == truth["axis"]:
                size = abs(truth["value"]) if e["name"] == "harmonic_disturbance" else truth["value"]
                s["deviation"] = (p["value"] - size) / p["std"]
            if truth["t_start_s"] is not None:
                s["onset_s"] = e["t_start_s"] - truth["t_start_s"]
                s["onset_std_s"] = e.get("t_start_std_s")
            break
    return s


def table(scored):
    hits = [s for s in scored if s["detected"]]
    onsets = [s for s in hits if s.get("onset_s") is not None]
    return {"detected": share(s["detected"] for s in scored), "right_name_first": share(s["first"] for s in hits),
            "right_name_among_alternatives": share(s["named"] for s in hits), "sensor_and_axis": share(s["site"] for s in hits),
            "nothing_else": share(s["extra"] == 0 for s in hits), "held_out_better": share(s["held_out"] for s in hits),
            "inside_95": share(abs(s["deviation"]) < 1.96 for s in hits if s["deviation"] is not None),
            "onset_inside_95": share(abs(s["onset_s"]) <= 1.96 * s["onset_std_s"] for s in onsets if s["onset_std_s"] is not None),
            "onset_within_2_s": share(abs(s["onset_s"]) <= 2.0 for s in onsets), "relation": share(s["relation"] for s in hits)}


def by_effect(scored):
    result = {}
    for name in sorted({s["name"] for _, s in scored}):
        said, here = {}, [s for _, s in scored if s["name"] == name]
        for s in here:
            said[s.get("said", "nothing")] = said.get(s.get("said", "nothing"), 0) + 1
        result[name] = {"of": len(here), "detected": sum(s["detected"] for s in here), "first": sum(s["first"] for s in here),
                        "among": sum(s["named"] for s in here), "said": dict(sorted(said.items(), key=lambda i: -i[1]))}
    return result


def pair(case):
    truths, effects = case["key"]["effects"], case["diagnosis"]["effects"]
    found = sum(any(found_as(e, t) for e in effects) for t in truths)
    return {"both": found == 2, "one": found >= 1, "nothing_else": len(effects) <= 2}


def main():
    cases = diagnosed(sys.argv[1])
    clean = [c for c in cases.values() if not c["key"]["effects"]]
    raised = sum(bool(c["diagnosis"]["effects"]) for c in clean)
    result = {"cases": len(cases), "clean": {"of": len(clean), "raised": raised, "share": raised / max(1, len(clean)),
                                             "of_75": sum(bool(c["diagnosis"]["effects"]) for k, c in cases.items() if k < 300 and k % 4 == 0),
                                             "nominal_and_two_standard_errors": 0.05 + 2.0 * math.sqrt(0.05 * 0.95 / max(1, len(clean)))}}
    groups = {"named": range(300), "noise": range(2000, 2100), "relations": range(2100, 2200)}
    for group, numbers in groups.items():
        here = [c for k, c in cases.items() if k in numbers and c["key"]["effects"]]
        scored = [(c["key"]["strength"], score(c["key"]["effects"][0], c["diagnosis"]["effects"])) for c in here]
        result[group] = {"strengths": {f"{strength:g}": table([s for k, s in scored if k == strength])
                                       for strength in sorted({k for k, _ in scored})}, "effects": by_effect(scored)}
        result[group]["all"] = table([s for _, s in scored])
        if group == "named":
            result[group]["expected_at_1"] = expected([power(c) for c in here if c["key"]["strength"] == 1.0])
    pairs = [pair(c) for k, c in cases.items() if k >= 2200]
    result["pairs"] = {key: share(p[key] for p in pairs) for key in ("both", "one", "nothing_else")}
    json.dump(result, sys.stdout, indent=1)
    print()


main()

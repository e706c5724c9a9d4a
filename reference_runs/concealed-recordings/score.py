"""score.py FOLDER: opens the keys and says how often what was found is what was concealed; JSON on standard output. What a recording shows
as it is counts for nothing, where the same is found in the same size; of the effect that is concealed it adds to it."""

import json
import math
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../tools/lib"))

from concealment.study import diagnosed, share  # noqa: E402

OWN = math.sqrt(17.07)  # sigmas by which an effect of the recording's own has to differ to be another: the smallest detectable size (Baarda)
AS_IS = {"car": 900, "rover-h": 901, "rover-k": 902}


def place(e):
    return e["name"], e["sensor"], e.get("relation", e["axis"])


def size(e):
    value = e["parameters"][0]["value"]
    return abs(value) if e["name"] == "saturation" else value  # the lower limit is the same


def is_own(effect, as_is):
    return any(place(effect) == place(own) and abs(size(effect) - size(own)) < OWN * effect["parameters"][0].get("std", 0.0) for own in as_is)


def score(truth, effects, as_is):
    new = [e for e in effects if not is_own(e, as_is)]
    right = next((e for e in new if place(e) == place(truth)), None)
    s = {"detected": bool(new), "found": right is not None,
         "named": right is not None or any(place(o) == place(truth) for e in new for o in e["confounded_with"]),
         "site": any(e["sensor"] == truth["sensor"] and (e["axis"] == truth["axis"] or ("relation" in e and e["axis"] == truth["axis"][:1])) for e in new),
         "extra": sum(place(e) != place(truth) for e in new), "said": [f"{e['name']} {e['sensor']} {e.get('relation', e['axis'])}".strip() for e in new]}
    if right is None:
        return s
    s["held_out"] = right["held_out_gain"] > 0.0 if "held_out_gain" in right else None
    own = truth["as_is"] if "as_is" in truth else sum(size(e) for e in as_is if place(e) == place(truth))
    s["found_value"] = size(right)
    if right["parameters"][0].get("std"):
        s["deviation"] = (size(right) - own - truth["value"]) / right["parameters"][0]["std"]
        s["deviation_alone"] = (size(right) - truth["value"]) / right["parameters"][0]["std"]
    if "t_start_s" in truth:
        s["onset_s"], s["onset_std_s"] = right["t_start_s"] - truth["t_start_s"], right.get("t_start_std_s")
    return s


def table(scored):
    hits = [s for s in scored if s["detected"]]
    return {"detected": share(s["detected"] for s in scored), "found": share(s["found"] for s in scored), "among": share(s["named"] for s in scored),
            "sensor_and_axis": share(s["site"] for s in hits), "nothing_else": share(s["extra"] == 0 for s in hits),
            "held_out_better": share(s.get("held_out") for s in hits), "inside_95": share(abs(s["deviation"]) < 1.96 for s in hits if "deviation" in s),
            "inside_95_as_if_clean": share(abs(s["deviation_alone"]) < 1.96 for s in hits if "deviation_alone" in s),
            "onset_inside_95": share(abs(s["onset_s"]) <= 1.96 * s["onset_std_s"] for s in hits if s.get("onset_std_s")),
            "onset_within_2_s": share(abs(s["onset_s"]) <= 2.0 for s in hits if "onset_s" in s)}


def main():
    cases = diagnosed(sys.argv[1])
    as_is = {name: cases[number]["diagnosis"]["effects"] for name, number in AS_IS.items() if number in cases}
    scored = {}
    for number, case in cases.items():
        truth = case["key"]["effect"]
        if truth:
            own = as_is[case["key"]["recording"]]
            scored[number] = {"recording": case["key"]["recording"], "truth": truth, **score(truth, case["diagnosis"]["effects"], own)}
    result = {"cases": len(scored)}
    for group, numbers in {"car": range(100), "rover": range(100, 200), "concealed": range(200)}.items():
        here = [s for k, s in scored.items() if k in numbers]
        result[group] = {"all": table(here), **{f"{strength:g}": table([s for s in here if s["truth"]["strength"] == strength])
                                                for strength in sorted({s["truth"]["strength"] for s in here})}}
    result["falsified"] = table([s for k, s in scored.items() if k >= 200])
    result["each"] = {f"{k}": {"recording": s["recording"], "effect": " ".join(place(s["truth"])).strip(), "strength": s["truth"].get("strength"),
                               "value": float(f'{s["truth"]["value"]:.3g}'), "as_is": float(f'{s["truth"].get("as_is", 0.0):.3g}'), "found": s["found"], "among": s["named"], "said": s["said"],
                               **{key: float(f"{s[key]:.3g}") for key in ("found_value", "deviation", "onset_s", "onset_std_s") if s.get(key) is not None}} for k, s in scored.items()}
    json.dump(result, sys.stdout, indent=1)
    print()


main()

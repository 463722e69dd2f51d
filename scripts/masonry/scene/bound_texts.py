# SPDX-License-Identifier: GPL-2.0-or-later
"""What a run says of its bounds: entries of run.json, lines of curve.png, and a warning where the run is above one.

``entries`` are those of :class:`masonry.scene.bounds.Bounds`, by the name of the load.
"""

#: By how much a run may be above its bound [-]: joints of finite stiffness, and displacements that are not small.
TOLERANCE = 0.02


def describe(entries, pushes=()):
    """Entries of run.json.

    :param pushes: names of the pushes that its numbers are of: there, and back
    """
    if not entries:
        return {}
    found = {"bounds": list(entries.values())}
    known = {what: e for what, e in entries.items() if "factor" in e}
    signs = (1, "bound_base_shear_kN"), (-1, "negative_bound_base_shear_kN")
    for what, (sign, key) in zip(pushes, signs):
        if what in known:
            found[key] = sign * known[what]["factor"]
    leans = [e["factor"] for e in known.values() if e["unit"] in ("g", "")]
    if leans:
        found["bound_acceleration"] = leans[0]
    return found


def linesOfPush(entries, pushes):
    """Horizontal lines of curve.png, for a push. Parameters as in :func:`describe`."""
    found = describe(entries, pushes)
    for key in ("bound_base_shear_kN", "negative_bound_base_shear_kN"):
        if key in found:
            text = f"limit analysis: {abs(found[key]):.1f} kN at most"
            yield {"y": found[key], "text": text}


def linesOfGrowth(entry):
    """Horizontal lines of curve.png, for a load that grows, from the entry of its bound."""
    words = {"factor": "at most", "without_dilatancy": "without dilatancy"}
    for key, text in words.items():
        if key in entry:
            what = f"limit analysis: {entry[key]:.4g} {entry['unit']} {text}"
            yield {"y": entry[key], "text": " ".join(what.split())}


def over(entries, held, run):
    """Sentences about what is above its bound.

    :param held: load factors under which the structure came to rest, by the name of the load
    :param run: the entries of run.json
    """
    found = []
    for side in ("", "negative_"):
        pair = [run.get(f"{side}{of}_base_shear_kN") for of in ("peak", "bound")]
        if None not in pair:
            found.append((*map(abs, pair), "kN", "the largest force of the push"))
    for what, factor in held.items():
        entry = entries.get(what, {})
        if "factor" in entry:
            name = f"{what}: the load that was held"
            found.append((factor, entry["factor"], entry["unit"], name))
    for reached, bound, unit, what in found:
        if reached > (1 + TOLERANCE) * bound:
            yield (
                f"{what}, {reached:.4g} {unit}, is {100 * (reached / bound - 1):.1f} % above the upper bound of "
                f"limit analysis, {bound:.4g} {unit}: is the run too fast, or does the structure move far?"
            )

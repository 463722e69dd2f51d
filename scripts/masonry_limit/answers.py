# SPDX-License-Identifier: GPL-2.0-or-later
"""What a run says of its bounds: entries of run.json, lines of curve.png, warnings."""

#: By how much a run may be above its bound [-]: joints of finite stiffness, and displacements that
#: are not small.
TOLERANCE = 0.02
#: Entries of run.json with the bounds of a push: there, and back.
PUSH_KEYS = "bound_base_shear_kN", "negative_bound_base_shear_kN"


class Answers:
    """The bounds that were found for a run, and the loads that the structure held.

    :param state: :class:`masonry.run.run_state.RunState`: what was found is kept there, and so in
        checkpoints
    """

    def __init__(self, state):
        self.state = state

    @property
    def entries(self):
        """What was found, by the load: entries of run.json."""
        return self.state.bounds

    def hold(self, what, factor):
        """Note a load factor under which the structure came to rest, by the name of its bound."""
        held = self.state.held
        if what in self.entries and factor > held.get(what, 0.0):
            self.state.held = {**held, what: factor}

    def inRunJson(self, pushes=()):
        """Entries of run.json.

        :param pushes: names of the pushes that its numbers are of: there, and back
        """
        if not self.entries:
            return {}
        found = {"bounds": list(self.entries.values())}
        known = {what: e for what, e in self.entries.items() if "factor" in e}
        for what, key, sign in zip(pushes, PUSH_KEYS, (1, -1)):
            if what in known:
                found[key] = sign * known[what]["factor"]
        leans = [e["factor"] for e in known.values() if e["unit"] in ("g", "")]
        if leans:
            found["bound_acceleration"] = leans[0]
        return found

    def linesOfPush(self, pushes):
        """Horizontal lines of curve.png, for a push. Parameters as in :meth:`inRunJson`."""
        found = self.inRunJson(pushes)
        for key in PUSH_KEYS:
            if key in found:
                yield {"y": found[key], "text": f"limit analysis: {abs(found[key]):.1f} kN at most"}

    def linesOfGrowth(self, name):
        """Horizontal lines of curve.png, for a load of this name that grows."""
        entry = self.entries.get(name, {})
        for key, text in (("factor", "at most"), ("without_dilatancy", "without dilatancy")):
            if key in entry:
                what = f"limit analysis: {entry[key]:.4g} {entry['unit']} {text}"
                yield {"y": entry[key], "text": " ".join(what.split())}

    def over(self, run):
        """Sentences about what is above its bound, from the entries of run.json."""
        found = []
        for side in ("", "negative_"):
            pair = [run.get(f"{side}{of}_base_shear_kN") for of in ("peak", "bound")]
            if None not in pair:
                found.append((*map(abs, pair), "kN", "the largest force of the push"))
        for what, factor in self.state.held.items():
            entry = self.entries.get(what, {})
            if "factor" in entry:
                name = f"{what}: the load that was held"
                found.append((factor, entry["factor"], entry["unit"], name))
        for reached, bound, unit, what in found:
            if reached > (1 + TOLERANCE) * bound:
                excess = 100 * (reached / bound - 1)
                yield (
                    f"{what}, {reached:.4g} {unit}, is {excess:.1f} % above the upper bound of"
                    f" limit analysis, {bound:.4g} {unit}: is the run too fast, does the structure"
                    " move far, or does a machine press more than press() says?"
                )
